//! The same tetrahedron in every format. Its coordinates are exact in single precision.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

pub const VERTICES: [[f32; 3]; 4] =
    [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -0.25]];
/// The first occurrences of the vertices, in the order of an STL file, have the order of `VERTICES`.
pub const TRIANGLES: [[u16; 3]; 4] = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];

pub fn obj() -> Vec<u8> {
    let mut text = String::from("# a tetrahedron\no tet\n");
    for [x, y, z] in VERTICES {
        text += &format!("v {x} {y} {z}\n");
    }
    for [a, b, c] in TRIANGLES {
        text += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
    text.into_bytes()
}

pub fn stl_text() -> Vec<u8> {
    let mut text = String::from("solid tet\n");
    for triangle in TRIANGLES {
        text += " facet normal 0 0 0\n  outer loop\n";
        for [x, y, z] in triangle.map(|i| VERTICES[i as usize]) {
            text += &format!("   vertex {x} {y} {z}\n");
        }
        text += "  endloop\n endfacet\n";
    }
    (text + "endsolid tet\n").into_bytes()
}

pub fn stl_binary(header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((TRIANGLES.len() as u32).to_le_bytes());
    for triangle in TRIANGLES {
        bytes.extend([0; 12]);
        for c in triangle.iter().flat_map(|&i| VERTICES[i as usize]) {
            bytes.extend(c.to_le_bytes());
        }
        bytes.extend([0, 0]);
    }
    bytes
}

pub fn ply(format: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {format} 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let mut bytes = header.into_bytes();
    let big = format == "binary_big_endian";
    let mut push = |le: &[u8]| {
        let start = bytes.len();
        bytes.extend(le);
        if big {
            bytes[start..].reverse();
        }
    };
    if format == "ascii" {
        for [x, y, z] in VERTICES {
            push(format!("{x} {y} {z} 255\n").as_bytes());
        }
        for [a, b, c] in TRIANGLES {
            push(format!("3 {a} {b} {c}\n").as_bytes());
        }
        return bytes;
    }
    for [x, y, z] in VERTICES {
        push(&x.to_le_bytes());
        push(&f64::from(y).to_le_bytes());
        push(&z.to_le_bytes());
        push(&[255]);
    }
    for triangle in TRIANGLES {
        push(&[3]);
        triangle.iter().for_each(|&i| push(&i32::from(i).to_le_bytes()));
    }
    bytes
}

/// The buffer: positions (48 bytes), then indices (24 bytes).
pub fn gltf_data() -> Vec<u8> {
    let mut bytes: Vec<u8> = VERTICES.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
    bytes.extend(TRIANGLES.iter().flatten().flat_map(|i| i.to_le_bytes()));
    bytes
}

/// A document with one mesh of the data of [`gltf_data`]; `nodes` and `extra` are JSON.
pub fn gltf_json(buffer: &str, nodes: &str, extra: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
{{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":24}}],
"buffers":[{{{buffer}"byteLength":72}}]{extra}}}"#
    )
}

pub fn data_uri() -> String {
    let data = STANDARD.encode(gltf_data());
    format!(r#""uri":"data:application/octet-stream;base64,{data}","#)
}

pub fn gltf() -> Vec<u8> {
    gltf_json(&data_uri(), r#"{"mesh":0}"#, "").into_bytes()
}

pub fn glb_from(json: &str, data: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((12 + 8 + json.len() as u32 + 8 + data.len() as u32).to_le_bytes());
    for (kind, content) in [(b"JSON", json.as_slice()), (b"BIN\0", data)] {
        bytes.extend((content.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(content);
    }
    bytes
}

pub fn glb() -> Vec<u8> {
    glb_from(&gltf_json("", r#"{"mesh":0}"#, ""), &gltf_data())
}
