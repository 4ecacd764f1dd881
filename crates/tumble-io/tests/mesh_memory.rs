//! The memory that reading needs is proportional to the size of the file, whatever counts it declares.
//!
//! There is only one test, because it measures the memory of the whole process.
#![allow(clippy::unwrap_used)]

use peak_alloc::PeakAlloc;
use tumble_io::mesh::{Format, Weld, parse_mesh};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Memory allowed for a file of any size (bytes): glTF allows a million instanced vertices.
const BASE_MEMORY: usize = 64 << 20;
/// Additional memory allowed per byte of the file (bytes).
const MEMORY_PER_BYTE: usize = 64;

#[test]
fn memory_is_proportional_to_file_size() {
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let ply = |count: &str, body: &[u8]| {
        let header = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{xyz}element face 1\nproperty list uint uchar vertex_index\nend_header\n"
        );
        [header.as_bytes(), body].concat()
    };
    let stl = [[b' '; 80].as_slice(), &u32::MAX.to_le_bytes(), &[0; 5000]].concat();
    let facet = b"facet outer loop vertex 0 0 0 vertex 0 0 1 vertex 0 1 0 endloop endfacet\n";
    let gltf = |accessor: &str, nodes: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"nodes":[{nodes}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{{"componentType":5126,"type":"VEC3",{accessor}}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":"data:;base64,{}"}}]}}"#,
            "A".repeat(48)
        )
        .into_bytes()
    };
    let sparse = r#""count":4000000000,"sparse":{"count":1,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}"#;
    let cases = [
        ("vertices", Format::Ply, ply("4294967295", &[0; 5000])),
        ("list", Format::Ply, ply("1", &[&[0; 12], [255; 4].as_slice(), &[0; 5000]].concat())),
        ("triangles", Format::Stl, stl),
        ("sparse", Format::Gltf, gltf(sparse, r#"{"mesh":0}"#)),
        ("elements", Format::Gltf, gltf(r#""bufferView":0,"count":4000000000"#, r#"{"mesh":0}"#)),
        (
            "instances",
            Format::Gltf,
            gltf(r#""bufferView":0,"count":3"#, &vec![r#"{"mesh":0}"#; 400_000].join(",")),
        ),
        (
            "nodes",
            Format::Gltf,
            gltf(r#""bufferView":0,"count":3"#, &vec!["{}"; 2_000_000].join(",")),
        ),
        ("face", Format::Obj, [b"v 0 0 0\nf".to_vec(), b" 1".repeat(5_000_000)].concat()),
        ("vertices", Format::Obj, b"v 0 0 0\n".repeat(1_000_000)),
        ("keyword", Format::Obj, vec![b'a'; 20_000_000]),
        ("soup", Format::Stl, [b"solid\n".to_vec(), facet.repeat(200_000)].concat()),
    ];
    for (name, format, bytes) in cases {
        for weld in [Weld::Never, Weld::Auto] {
            let before = MEMORY.current_usage();
            MEMORY.reset_peak_usage();
            let _ = parse_mesh(format, &bytes, None, Some(weld));
            let used = MEMORY.peak_usage() - before;
            let allowed = BASE_MEMORY + MEMORY_PER_BYTE * bytes.len();
            println!("{format} {name}: {} bytes need {used}", bytes.len());
            assert!(used < allowed, "{format} {name}: {} bytes need {used}", bytes.len());
        }
    }
}
