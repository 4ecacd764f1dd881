//! The readers do not panic on random bytes or on damaged valid files.

use proptest::prelude::*;
use tumble_io::mesh::{Format, Repair, Weld, parse_mesh, prepare};

use super::samples;

/// Parses the bytes and checks the invariants of the mesh or the length of the message.
fn check_parse(format: Format, bytes: &[u8]) {
    for weld in [Weld::Never, Weld::Auto, Weld::Within(1.0)] {
        match parse_mesh(format, bytes, None, Some(weld)) {
            Ok(file) => {
                let mesh = file.mesh.clone();
                assert_eq!(
                    tumble::Mesh::new(mesh.vertices, mesh.triangles).as_ref(),
                    Ok(&file.mesh)
                );
                check_prepared(&file.mesh);
                assert!(file.object_count > 0);
            }
            Err(error) => assert!(error.to_string().len() < 1000, "{error}"),
        }
    }
}

/// Puts the triangles right and checks what must be so afterwards.
fn check_prepared(mesh: &tumble::Mesh) {
    let prepared = prepare(mesh, Repair::None).unwrap();
    assert_eq!(prepared.mesh.vertices, mesh.vertices);
    assert!(prepared.mesh.triangles.len() <= mesh.triangles.len());
    if let Ok(closed) = prepare(mesh, Repair::Close) {
        assert_eq!(closed.mesh.vertices, mesh.vertices);
        assert!(
            closed.mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.vertices.len())
        );
    }
    let _ = mesh.holes();
}

/// Edits of a file: the kind of edit, its position, and the bytes to overwrite, insert or remove.
fn damage() -> impl Strategy<Value = Vec<(u8, prop::sample::Index, Vec<u8>)>> {
    let token = prop::sample::select(vec![
        b"0".as_slice(),
        b"-1",
        b"9",
        b"4294967295",
        b"99999999999999999999",
        b"1e999",
        b"nan",
        b" ",
        b"\n",
        b"\\\n",
        b"/",
        b"-",
        b".",
        b"#",
        b"\xff\xff\xff\xff",
        b"\0\0\0\0",
        b"{",
        b"}",
        b"[]",
        b"\"",
        b"f",
        b"v",
        b",0",
    ])
    .prop_map(<[u8]>::to_vec);
    let piece = prop_oneof![token, prop::collection::vec(any::<u8>(), 1..6)];
    prop::collection::vec((0_u8..4, any::<prop::sample::Index>(), piece), 1..6)
}

fn damaged(mut bytes: Vec<u8>, damage: Vec<(u8, prop::sample::Index, Vec<u8>)>) -> Vec<u8> {
    for (kind, at, piece) in damage {
        if bytes.is_empty() {
            break;
        }
        let at = at.index(bytes.len());
        let end = (at + piece.len()).min(bytes.len());
        match kind {
            0 => bytes[at..end].copy_from_slice(&piece[..end - at]),
            1 => drop(bytes.splice(at..at, piece)),
            2 => drop(bytes.drain(at..end)),
            _ => bytes.truncate(at.max(bytes.len() / 2)),
        }
    }
    bytes
}

/// Sequences of tokens of the text formats, which get further into the readers than random bytes.
fn format_tokens() -> impl Strategy<Value = Vec<u8>> {
    let words = prop::sample::select(vec![
        "v ",
        "f ",
        "1 ",
        "2 ",
        "-1 ",
        "3/1 ",
        "0.5 ",
        "\n",
        "\\\n",
        "# ",
        "o a",
        "\r",
        "solid ",
        "vertex ",
        "facet ",
        "normal 0 0 1 ",
        "outer loop ",
        "vertex 0 0 1 ",
        "end ",
        "endloop\n",
        "endfacet\n",
        "endsolid\n",
        "{",
        "}",
        "\"nodes\":",
        "[0]",
        ",",
    ]);
    prop::collection::vec(words, 0..60).prop_map(|words| words.concat().into_bytes())
}

macro_rules! panic_tests {
    ($($name:ident: $format:expr, $start:expr, $samples:expr;)*) => {
        $(mod $name {
            use super::*;
            proptest! {
                #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..Default::default() })]
                #[test]
                fn random_bytes_do_not_panic(bytes in prop::collection::vec(any::<u8>(), 0..400), words in format_tokens(), with_start: bool) {
                    for rest in [bytes, words] {
                        let start: &[u8] = if with_start { $start } else { b"" };
                        check_parse($format, &[start, &rest].concat());
                    }
                }
                #[test]
                fn damaged_files_do_not_panic(sample in prop::sample::select($samples), damage in damage()) {
                    check_parse($format, &damaged(sample, damage));
                }
            }
        })*
    };
}

panic_tests! {
    obj: Format::Obj, b"v 0 0 0\nv 0 1 2\nv 3 4 5\n", vec![samples::obj(), b"v 0 0 0\nv 1 0 0\nv 0.2 0.2 0\nv 0 1 0\nf 1 2 3 4\nf -1/2/3 -2//1 -3/1\n".to_vec()];
    stl: Format::Stl, b"solid ", vec![
        samples::stl_text(), samples::stl_binary(b""), samples::stl_binary(b"solid "), samples::stl_text().iter().map(|&b| if b == b'\n' { b' ' } else { b }).collect(),
        [samples::stl_binary(b""), vec![1; 60]].concat(),
    ];
    ply: Format::Ply, b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 7\nproperty list uint uchar vertex_index\nend_header\n", vec![
        samples::ply("ascii"), samples::ply("binary_little_endian"), samples::ply("binary_big_endian"),
        [samples::ply("ascii"), b"\n".to_vec()].concat(),
    ];
    gltf: Format::Gltf, b"glTF\x02\0\0\0", vec![samples::gltf(), samples::glb(), samples::glb_from(&samples::gltf_json("", r#"{"children":[1,2],"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]},{"mesh":0,"scale":[-1,1,1]},{"mesh":0,"rotation":[0,0,1,0]}"#, ""), &samples::gltf_data())];
}
