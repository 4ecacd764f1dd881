use tumble_io::mesh::{Format, parse_mesh, read_mesh};

use super::samples::{VERTICES, data_uri, glb, glb_from, gltf_data, gltf_json};
use super::{area_and_volume, assert_contains, v};

/// Parses the tetrahedron with these nodes.
#[track_caller]
fn parse_with_nodes(nodes: &str) -> tumble_io::mesh::MeshFile {
    super::parse_valid(Format::Gltf, gltf_json(&data_uri(), nodes, "").as_bytes())
}

#[track_caller]
fn parse_invalid(json: &str) -> String {
    super::parse_invalid(Format::Gltf, json.as_bytes())
}

/// The error message for the document of the tetrahedron with `from` replaced by `to`.
#[track_caller]
fn parse_invalid_with(from: &str, to: &str) -> String {
    let json = gltf_json(&data_uri(), r#"{"mesh":0}"#, "");
    assert!(json.contains(from));
    parse_invalid(&json.replacen(from, to, 1))
}

#[test]
fn node_transforms_are_applied_in_double_precision() {
    // the parent node is translated, rotated by 90 degrees about z, and scaled
    let h = 0.5_f64.sqrt();
    let file = parse_with_nodes(&format!(
        r#"{{"children":[1],"translation":[0.1,0,0],"rotation":[0,0,{h},{h}],"scale":[2,2,2]}},{{"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1]}}"#
    ));
    let expected = [v(0.1, 0.0, 14.0), v(0.1, 3.0, 14.0), v(-3.9, 0.0, 14.0), v(0.1, 0.0, 13.5)];
    for (found, expected) in file.mesh.vertices.iter().zip(expected) {
        assert!((*found - expected).length() < 1e-14, "{found} {expected}");
    }
    assert!((area_and_volume(&file).1 - 8.0 * 0.75).abs() < 1e-12);
}

#[test]
fn mirrored_nodes_keep_outward_winding() {
    let (plain, mirrored) =
        (parse_with_nodes(r#"{"mesh":0}"#), parse_with_nodes(r#"{"mesh":0,"scale":[-1,1,1]}"#));
    assert_eq!(area_and_volume(&plain), area_and_volume(&mirrored));
    assert_eq!(mirrored.mesh.vertices[1], v(-1.5, 0.0, 0.0));
}

#[test]
fn each_instance_has_its_own_vertices() {
    let file =
        parse_with_nodes(r#"{"children":[1,2]},{"mesh":0},{"mesh":0,"translation":[10,0,0]}"#);
    assert_eq!((file.mesh.vertices.len(), file.object_count), (8, 2));
    assert_eq!(file.mesh.vertices[5], v(11.5, 0.0, 0.0));
}

#[test]
fn all_meshes_and_primitives_of_a_scene_are_read() {
    let primitive = r#"{"attributes":{"POSITION":0},"indices":1}"#;
    let one = format!(r#"{{"primitives":[{primitive}]}}"#);
    let two = format!(r#"{{"primitives":[{primitive},{primitive}]}}"#);
    let nodes = r#"{"children":[1,2]},{"mesh":1,"translation":[0,0,5]},{"mesh":0,"scale":[2,2,2]}"#;
    let json = gltf_json(&data_uri(), nodes, "").replacen(&one, &format!("{one},{two}"), 1);
    let file = super::parse_valid(Format::Gltf, json.as_bytes());
    assert_eq!((file.object_count, file.face_count, file.mesh.vertices.len()), (2, 12, 8));
    let (_, volume) = area_and_volume(&file);
    assert!((volume - 0.75 * (2.0 + 8.0)).abs() < 1e-12, "{volume}");
}

#[test]
fn the_transform_of_a_skinned_node_is_ignored() {
    let nodes = r#"{"mesh":0,"skin":0,"translation":[10,0,0]}"#;
    let skins = r#","skins":[{"joints":[0]}]"#;
    let json = gltf_json(&data_uri(), nodes, skins);
    // without joints its vertices stay as they are
    let file = super::parse_valid(Format::Gltf, json.as_bytes());
    assert_eq!(file.mesh.vertices[1], v(1.5, 0.0, 0.0));
    assert_contains(&parse_invalid(&json.replace(skins, "")), &["refers to skin 0"]);
}

/// A tetrahedron of volume 1/6. Corners 0 and 1 follow node 1, which has the scale 2; corner 3 follows its child, whose bind matrix
/// undoes its translation by (1, 0, 0); corner 2 follows both.
fn skinned(child: &str) -> String {
    let mut data: Vec<u8> = Vec::new();
    let points = [[0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    data.extend(points.iter().flatten().flat_map(|x| x.to_le_bytes()));
    data.extend([0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0]);
    data.extend([255, 0, 0, 0, 255, 0, 0, 0, 128, 127, 0, 0, 255, 0, 0, 0]);
    let identity = [1f32, 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    let mut back = identity;
    back[12] = -1.0;
    data.extend([identity, back].iter().flatten().flat_map(|x| x.to_le_bytes()));
    data.extend([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
    let length = data.len();
    let encoded = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, &data);
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0,1]}}],
"nodes":[{{"mesh":0,"skin":0,"translation":[9,9,9]}},{{"scale":[2,2,2],"children":[2]}},{child}],
"skins":[{{"joints":[1,2],"inverseBindMatrices":3}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}},"indices":4}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
{{"bufferView":1,"componentType":5121,"count":4,"type":"VEC4"}},
{{"bufferView":2,"componentType":5121,"normalized":true,"count":4,"type":"VEC4"}},
{{"bufferView":3,"componentType":5126,"count":2,"type":"MAT4"}},
{{"bufferView":4,"componentType":5121,"count":12,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":16}},
{{"buffer":0,"byteOffset":64,"byteLength":16}},{{"buffer":0,"byteOffset":80,"byteLength":128}},
{{"buffer":0,"byteOffset":208,"byteLength":12}}],
"buffers":[{{"byteLength":{length},"uri":"data:application/octet-stream;base64,{encoded}"}}]}}"#
    )
}

#[test]
fn a_skinned_mesh_is_in_the_pose_of_its_joints() {
    let parse = |json: &str| super::parse_valid(Format::Gltf, json.as_bytes());
    // the child is where it was bound: the scale of its parent moves all
    let bound = parse(&skinned(r#"{"translation":[1,0,0]}"#));
    let doubled = [v(0.0, 0.0, 0.0), v(2.0, 0.0, 0.0), v(0.0, 2.0, 0.0), v(0.0, 0.0, 2.0)];
    assert_eq!(bound.mesh.vertices, doubled);
    // 3 more along x, which the scale doubles; corner 2 follows by the part 127/255
    let moved = parse(&skinned(r#"{"translation":[4,0,0]}"#));
    assert_eq!(moved.mesh.vertices[3], v(6.0, 0.0, 2.0));
    assert!((moved.mesh.vertices[2] - v(6.0 * 127.0 / 255.0, 2.0, 0.0)).length() < 1e-12);
    assert_eq!(moved.mesh.vertices[..2], doubled[..2]);
    // a mirrored skeleton keeps the surface outside
    let mirrored = parse(&skinned(r#"{"translation":[1,0,0]}"#).replace("[2,2,2]", "[-2,2,2]"));
    let volumes = [&bound, &mirrored].map(|file| area_and_volume(file).1);
    assert!(volumes.iter().all(|volume| (volume / 6.0 - 8.0 / 6.0).abs() < 1e-12), "{volumes:?}");
}

#[test]
fn broken_skins_are_rejected() {
    let whole = skinned(r#"{"translation":[1,0,0]}"#);
    let message = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        parse_invalid(&whole.replacen(from, to, 1))
    };
    assert_contains(&message("[1,2],", "[1],"), &["refers to joint 1"]);
    assert_contains(&message("[1,2],", "[1,7],"), &["refers to node 7"]);
    assert_contains(&message("[1,2],", "[1,2,1],"), &["fewer inverse bind matrices than joints"]);
    assert_contains(&message("\"count\":2", "\"count\":1"), &["fewer inverse bind matrices"]);
    assert_contains(&message("JOINTS_0\":1", "JOINTS_0\":0"), &["joints", "type VEC4"]);
    assert_contains(
        &message("5121,\"count\":4,\"type\":\"VEC4\"", "5121,\"count\":3,\"type\":\"VEC4\""),
        &["as many as the vertices"],
    );
    assert_contains(&message("\"WEIGHTS_0\":2", "\"WEIGHTS_0\":1"), &["has no weights"]);
    assert_contains(&message("\"skin\":0", "\"skin\":1"), &["refers to skin 1"]);
    // a skeleton outside of the scene that is its own ancestor
    let cycle = whole.replacen(r#""nodes":[0,1]"#, r#""nodes":[0]"#, 1).replacen(
        r#"{"translation":[1,0,0]}"#,
        r#"{"children":[1]}"#,
        1,
    );
    assert_contains(&parse_invalid(&cycle), &["out of proportion"]);
}

#[test]
fn without_scenes_all_nodes_are_read_and_without_nodes_all_meshes() {
    let json = gltf_json(&data_uri(), r#"{"mesh":0},{"mesh":0,"translation":[9,0,0]}"#, "");
    let count = |json: &str| super::parse_valid(Format::Gltf, json.as_bytes()).mesh.vertices.len();
    assert_eq!(count(&json), 4);
    assert_eq!(count(&json.replace(r#""scene":0,"#, "")), 4);
    let without_scenes = json.replace(r#""scene":0,"scenes":[{"nodes":[0]}],"#, "");
    assert_eq!(count(&without_scenes), 8);
    let start = without_scenes.find(r#""nodes""#).unwrap();
    let end = without_scenes.find(r#""meshes""#).unwrap();
    assert_eq!(count(&(without_scenes[..start].to_owned() + &without_scenes[end..])), 4);
}

#[test]
fn strips_fans_and_unindexed_triangles_are_read() {
    let triangles = |mode: &str| {
        let json = gltf_json(&data_uri(), r#"{"mesh":0}"#, "").replace(r#","indices":1"#, mode);
        super::parse_valid(Format::Gltf, json.as_bytes()).mesh.triangles
    };
    assert_eq!(triangles(r#","mode":5"#), [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(triangles(r#","mode":6"#), [[0, 1, 2], [0, 2, 3]]);
    let three = gltf_json(&data_uri(), r#"{"mesh":0}"#, "")
        .replace(r#","indices":1"#, "")
        .replace(r#""count":4"#, r#""count":3"#);
    assert_eq!(super::parse_valid(Format::Gltf, three.as_bytes()).mesh.triangles, [[0, 1, 2]]);
}

#[test]
fn sparse_quantised_and_interleaved_positions_are_read() {
    let read = |accessor: &str, views: &str, data: &[u8]| {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":["KHR_mesh_quantization"],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}]}}],"accessors":[{accessor},{{"componentType":5126,"count":3,"type":"VEC2"}}],"bufferViews":[{views}],"buffers":[{{"byteLength":{}}}]}}"#,
            data.len()
        );
        super::parse_valid(Format::Gltf, &glb_from(&json, data)).mesh.vertices
    };
    // normalised signed bytes with a stride of 4
    let quantised = read(
        r#"{"bufferView":0,"componentType":5120,"normalized":true,"count":3,"type":"VEC3"}"#,
        r#"{"buffer":0,"byteLength":12,"byteStride":4}"#,
        &[127, 0, 129, 9, 0, 0, 0, 9, 128, 127, 0, 9],
    );
    assert_eq!(quantised, [v(1.0, 0.0, -1.0), v(0.0, 0.0, 0.0), v(-1.0, 1.0, 0.0)]);
    // signed words that are not normalised, interleaved with others, from the third byte on
    let words: [i16; 15] = [9, 1, 2, 3, 9, 9, -4, 5, 6, 9, 9, 7, 8, -9, 9];
    let interleaved = read(
        r#"{"bufferView":0,"byteOffset":2,"componentType":5122,"count":3,"type":"VEC3"}"#,
        r#"{"buffer":0,"byteLength":30,"byteStride":10}"#,
        &words.map(i16::to_le_bytes).concat(),
    );
    assert_eq!(interleaved, [v(1.0, 2.0, 3.0), v(-4.0, 5.0, 6.0), v(7.0, 8.0, -9.0)]);
    // the second of three vertices is replaced
    let mut data: Vec<u8> =
        [1.0_f32, 2.0, 3.0].map(|x| [x; 3]).concat().iter().flat_map(|c| c.to_le_bytes()).collect();
    data.extend([1, 0, 0, 0]);
    data.extend([8.0_f32; 3].iter().flat_map(|c| c.to_le_bytes()));
    let replaced = read(
        r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":1,"byteOffset":4}}}"#,
        r#"{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":16}"#,
        &data,
    );
    assert_eq!(replaced, [v(1.0, 1.0, 1.0), v(8.0, 8.0, 8.0), v(3.0, 3.0, 3.0)]);
    // all zeros except vertex 2
    let mut data = vec![2, 0, 0, 0];
    data.extend([5.0_f32, 6.0, 7.0].iter().flat_map(|c| c.to_le_bytes()));
    let sparse = read(
        r#"{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":1}}}"#,
        r#"{"buffer":0,"byteLength":4},{"buffer":0,"byteOffset":4,"byteLength":12}"#,
        &data,
    );
    assert_eq!(sparse, [v(0.0, 0.0, 0.0), v(5.0, 6.0, 7.0)], "two zeros are welded");
}

#[test]
fn morph_targets_displace_vertices_by_the_weights_of_the_node_or_mesh() {
    let primitive = r#"{"attributes":{"POSITION":0},"indices":1}"#;
    // the displacements are the positions themselves: weights w scale the tetrahedron by 1 + Σ w
    let with_targets = |weights: &str, node: &str, more: &str| {
        let morphed = r#"{"attributes":{"POSITION":0},"indices":1,"targets":[{"POSITION":0},{"NORMAL":9},{"POSITION":0}]}"#;
        let json = gltf_json(&data_uri(), node, "");
        assert!(json.contains(primitive));
        json.replacen(primitive, &format!("{morphed}{more}"), 1).replacen(
            r#""meshes":[{"#,
            &format!(r#""meshes":[{{{weights}"#),
            1,
        )
    };
    let volume =
        |json: &str| area_and_volume(&super::parse_valid(Format::Gltf, json.as_bytes())).1 / 0.75;
    let plain = r#"{"mesh":0}"#;
    assert_eq!(volume(&with_targets("", plain, "")), 1.0);
    assert_eq!(volume(&with_targets(r#""weights":[0,0,0],"#, plain, "")), 1.0);
    assert_eq!(volume(&with_targets(r#""weights":[1,5,0],"#, plain, "")), 8.0);
    assert_eq!(volume(&with_targets(r#""weights":[0.75,5,0.25],"#, plain, "")), 8.0);
    let own = r#"{"mesh":0,"weights":[0,0,0.5]}"#;
    assert_eq!(volume(&with_targets(r#""weights":[1,5,0],"#, own, "")), 3.375);
    // a second primitive without targets does not share the displaced vertices
    let two = with_targets(r#""weights":[1,5,0],"#, plain, &format!(",{primitive}"));
    assert_eq!(volume(&two), 9.0);
    // as many displacements as vertices
    let fewer = r#""SCALAR"},{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}"#;
    let json = with_targets(r#""weights":[1],"#, plain, "")
        .replacen(r#""targets":[{"POSITION":0}"#, r#""targets":[{"POSITION":2}"#, 1)
        .replacen(r#""SCALAR"}"#, fewer, 1);
    assert_contains(&parse_invalid(&json), &["displaces 3 vertices", "its primitive has 4"]);
    let message = parse_invalid(&with_targets(r#""weights":[1],"#, plain, "").replacen(
        r#""targets":[{"POSITION":0}"#,
        r#""targets":[{"POSITION":1}"#,
        1,
    ));
    assert_contains(&message, &["accessor 1 holds POSITION and must be of type VEC3"]);
}

#[test]
fn side_files_outside_the_folder_are_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(folder.path().join("outside.bin"), gltf_data()).unwrap();
    std::fs::write(inner.join("a b.bin"), gltf_data()).unwrap();
    std::fs::write(inner.join("short.bin"), [0; 10]).unwrap();
    let path = inner.join("tet.gltf");
    let with_uri = |uri: &str| {
        let json = gltf_json(&format!(r#""uri":"{uri}","#), r#"{"mesh":0}"#, "");
        std::fs::write(&path, json).unwrap();
        read_mesh(&path, None)
    };
    assert_eq!(with_uri("a%20b.bin").unwrap().mesh.vertices.len(), VERTICES.len());
    assert_eq!(with_uri("./a b.bin").unwrap().mesh.vertices.len(), VERTICES.len());
    let absolute = folder.path().join("outside.bin").display().to_string();
    for uri in ["../outside.bin", "%2e%2e/outside.bin", "a/../../outside.bin", &absolute] {
        assert_contains(
            &with_uri(uri).unwrap_err().to_string(),
            &["tet.gltf: ", "must lie beside the file"],
        );
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path().join("outside.bin"), inner.join("link.bin"))
            .unwrap();
        assert_contains(
            &with_uri("link.bin").unwrap_err().to_string(),
            &["must lie beside the file"],
        );
    }
    assert_contains(
        &with_uri("no.bin").unwrap_err().to_string(),
        &["side file \"no.bin\"", "no such file"],
    );
    assert_contains(&with_uri("short.bin").unwrap_err().to_string(), &["72 bytes, but only 10"]);
    assert_contains(&with_uri("%zz").unwrap_err().to_string(), &["not well formed"]);
    let json = gltf_json(r#""uri":"a.bin","#, r#"{"mesh":0}"#, "");
    assert_contains(&parse_invalid(&json), &["no folder to look in"]);
}

#[test]
fn cycles_and_shared_nodes_are_rejected() {
    let message = |nodes: &str| parse_invalid(&gltf_json(&data_uri(), nodes, ""));
    assert_contains(&message(r#"{"mesh":0,"children":[0]}"#), &["node 0 is reached twice"]);
    assert_contains(
        &message(r#"{"children":[1]},{"children":[2]},{"children":[1],"mesh":0}"#),
        &["node 1"],
    );
    assert_contains(&message(r#"{"children":[1,1]},{"mesh":0}"#), &["node 1 is reached twice"]);
    // a deep hierarchy does not overflow the stack
    let chain: String = (1..50_000).map(|i| format!(r#"{{"children":[{i}]}},"#)).collect();
    assert_eq!(parse_with_nodes(&(chain + r#"{"mesh":0}"#)).mesh.vertices.len(), 4);
}

#[test]
fn excessive_instancing_is_rejected() {
    // 2,000 nodes with a mesh of 2,000 primitives need little text
    let primitives = vec![r#"{"attributes":{"POSITION":0}}"#; 2_000].join(",");
    let children: Vec<String> = (1..2_000).map(|i| i.to_string()).collect();
    let nodes = format!(r#"{{"children":[{}]}}"#, children.join(","))
        + &vec![r#",{"mesh":0}"#; 1_999].concat();
    let json = gltf_json(&data_uri(), &nodes, "").replace(
        r#"{"attributes":{"POSITION":0},"indices":1}"#,
        &primitives.replace("}}", r#"},"mode":6}"#),
    );
    assert_contains(&parse_invalid(&json), &["out of proportion"]);
    // nor does a primitive of as many morph targets
    let targets = vec!["{}"; 2_000].join(",");
    let json = gltf_json(&data_uri(), &nodes, "").replacen(
        r#""indices":1"#,
        &format!(r#""indices":1,"targets":[{targets}]"#),
        1,
    );
    assert_contains(&parse_invalid(&json), &["out of proportion"]);
    // a sparse accessor without a base buffer
    let sparse = r#""count":4000000000,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0}},"type":"VEC3""#;
    assert_contains(
        &parse_invalid_with(
            r#""bufferView":0,"componentType":5126,"count":4,"type":"VEC3""#,
            &format!(r#""componentType":5126,{sparse}"#),
        ),
        &["out of proportion"],
    );
}

#[test]
fn unsupported_required_extensions_are_rejected() {
    let document = |name: &str| {
        gltf_json(&data_uri(), r#"{"mesh":0}"#, &format!(r#","extensionsRequired":["{name}"]"#))
    };
    assert_contains(
        &parse_invalid(&document("KHR_draco_mesh_compression")),
        &["compressed with Draco (KHR_draco_mesh_compression)", "not supported"],
    );
    assert_contains(
        &parse_invalid(&document("EXT_meshopt_compression")),
        &["compressed with meshopt (EXT_meshopt_compression)"],
    );
    assert_contains(&parse_invalid(&document("FB_ngon")), &["the extension FB_ngon"]);
    // not required, but without uncompressed data
    let used = r#","extensionsUsed":["KHR_draco_mesh_compression"]"#;
    let json = gltf_json(&data_uri(), r#"{"mesh":0}"#, used);
    super::parse_valid(Format::Gltf, json.as_bytes());
    assert_contains(
        &parse_invalid(&json.replace(r#""bufferView":0,"#, "")),
        &["no bufferView", "Draco"],
    );
    // more instances than nodes
    let used = r#","extensionsUsed":["EXT_mesh_gpu_instancing"]"#;
    let json = gltf_json(&data_uri(), r#"{"mesh":0}"#, used);
    assert_contains(&parse_invalid(&json), &["EXT_mesh_gpu_instancing", "not supported"]);
    super::parse_valid(Format::Gltf, document("KHR_materials_unlit").as_bytes());
}

#[test]
fn out_of_range_references_are_rejected() {
    assert_contains(
        &parse_invalid_with(r#""POSITION":0"#, r#""POSITION":7"#),
        &["accessor 7", "only 2"],
    );
    assert_contains(&parse_invalid_with(r#""indices":1"#, r#""indices":9"#), &["accessor 9"]);
    assert_contains(&parse_invalid_with(r#"{"mesh":0}"#, r#"{"mesh":3}"#), &["mesh 3"]);
    assert_contains(&parse_invalid_with(r#"{"nodes":[0]}"#, r#"{"nodes":[5]}"#), &["node 5"]);
    assert_contains(&parse_invalid_with(r#""scene":0"#, r#""scene":5"#), &["scene 5"]);
    assert_contains(
        &parse_invalid_with(r#"{"bufferView":0"#, r#"{"bufferView":5"#),
        &["bufferView 5"],
    );
    assert_contains(
        &parse_invalid_with(r#"{"buffer":0,"byteL"#, r#"{"buffer":8,"byteL"#),
        &["buffer 8"],
    );
    assert_contains(
        &parse_invalid_with(r#""byteLength":48"#, r#""byteLength":4800"#),
        &["reaches beyond the 72 bytes"],
    );
    assert_contains(
        &parse_invalid_with(r#""byteOffset":48"#, r#""byteOffset":18446744073709551615"#),
        &["reaches beyond"],
    );
    assert_contains(
        &parse_invalid_with(r#""count":4"#, r#""count":5"#),
        &["5 elements", "48 bytes"],
    );
    assert_contains(
        &parse_invalid_with(r#""count":4"#, r#""count":18446744073709551615"#),
        &["out of proportion"],
    );
    assert_contains(
        &parse_invalid_with(r#""count":4"#, r#""byteOffset":18446744073709551615,"count":4"#),
        &["with 4 elements reaches beyond"],
    );
    assert_contains(
        &parse_invalid_with(r#""count":4"#, r#""count":2"#),
        &["an index is 2, but its primitive has only 2"],
    );
    assert_contains(&parse_invalid_with(r#""count":12"#, r#""count":11"#), &["no multiple of 3"]);
    assert_contains(
        &parse_invalid_with(r#""byteLength":48"#, r#""byteLength":48,"byteStride":2"#),
        &["byteStride of 2"],
    );
    assert_contains(
        &parse_invalid_with(r#""byteLength":72"#, r#""byteLength":73"#),
        &["promises 73 bytes"],
    );
}

#[test]
fn malformed_documents_are_rejected() {
    assert_contains(&parse_invalid(""), &["empty"]);
    assert_contains(&parse_invalid("{\n\"asset\": 7}"), &["line 2", "no glTF"]);
    assert_contains(&parse_invalid(&"[".repeat(100_000)), &["no glTF"]);
    assert_contains(
        &parse_invalid_with(r#""version":"2.0""#, r#""version":"1.0""#),
        &["glTF 1.0", "only glTF 2"],
    );
    assert_contains(&parse_invalid_with(r#""type":"VEC3""#, r#""type":"VEC2""#), &["VEC3"]);
    assert_contains(&parse_invalid_with("5123", "5126"), &["unsigned"]);
    assert_contains(&parse_invalid_with("5126", "77"), &["componentType 77"]);
    assert_contains(&parse_invalid_with(r#""bufferView":0,"#, ""), &["no bufferView"]);
    assert_contains(&parse_invalid_with(r#""indices":1"#, r#""mode":0"#), &["no triangles"]);
    assert_contains(&parse_invalid_with("base64,", "base64,!"), &["no base64"]);
    assert_contains(&parse_invalid_with(";base64,", ","), &["must be base64"]);
    assert_contains(
        &parse_invalid_with(r#"{"mesh":0}"#, r#"{"mesh":0,"rotation":[0,0,0,0]}"#),
        &["rotation of node 0"],
    );
    assert_contains(
        &parse_invalid_with(
            r#"{"mesh":0}"#,
            r#"{"mesh":0,"scale":[1e308,1,1],"translation":[1e308,0,0]}"#,
        ),
        &["infinite"],
    );
    let mut data = gltf_data();
    data[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
    let nan = glb_from(&gltf_json("", r#"{"mesh":0}"#, ""), &data);
    assert_contains(
        &super::parse_invalid(Format::Gltf, &nan),
        &["position 0 of accessor 0", "must be finite"],
    );
}

#[test]
fn chunks_need_not_be_aligned() {
    let expected = super::parse_valid(Format::Gltf, &glb()).mesh;
    for spaces in 0..4 {
        let json = gltf_json("", r#"{"mesh":0}"#, "") + &" ".repeat(spaces);
        for padding in [&b""[..], b" ", b"  ", b"   ", b"\0", b"\0\0", b"\0\0\0"] {
            let json_chunk = json.as_bytes();
            let chunk = |kind: &[u8], content: &[u8], counted: usize| {
                [&(counted as u32).to_le_bytes(), kind, content].concat()
            };
            let padded = [json_chunk, padding].concat();
            let is_aligned = padded.len().is_multiple_of(4);
            let data = chunk(b"BIN\0", &gltf_data(), gltf_data().len());
            let mut chunks = vec![chunk(b"JSON", &padded, padded.len())];
            if is_aligned {
                // the padding may also be left out of the length
                chunks.push(chunk(b"JSON", &padded, json_chunk.len()));
            }
            for first in chunks {
                let length = (12 + first.len() + data.len()) as u32;
                let header = [&b"glTF\x02\0\0\0"[..], &length.to_le_bytes()].concat();
                let bytes = [&header[..], &first, &data].concat();
                assert_eq!(super::parse_valid(Format::Gltf, &bytes).mesh, expected);
            }
        }
    }
}

#[test]
fn other_versions_are_rejected_by_name() {
    for json in [
        r#"{"asset":{"version":"1.0"},"scene":"s","scenes":{"s":{"nodes":["n"]}},"meshes":{}}"#,
        r#"{"scene":"s","scenes":{"s":{"nodes":["n"]}},"meshes":{"m":{"primitives":[]}}}"#,
    ] {
        assert_contains(&parse_invalid(json), &["the file is glTF 1.0", "only glTF 2", "convert"]);
    }
    let mut binary = glb();
    binary[4] = 1;
    assert_contains(&super::parse_invalid(Format::Gltf, &binary), &["glTF 1.0", "only glTF 2"]);
    super::parse_valid(
        Format::Gltf,
        format!("\u{feff}{}", gltf_json(&data_uri(), r#"{"mesh":0}"#, "")).as_bytes(),
    );
}

#[test]
fn malformed_binary_containers_are_rejected() {
    let bytes = glb();
    for length in 0..bytes.len() {
        super::parse_invalid(Format::Gltf, &bytes[..length]);
    }
    let message_with = |at: usize, byte: u8| {
        let mut bytes = bytes.clone();
        bytes[at] = byte;
        super::parse_invalid(Format::Gltf, &bytes)
    };
    assert_contains(&message_with(4, 1), &["version 1"]);
    assert_contains(&message_with(11, 255), &["at byte 8", "truncated"]);
    assert_contains(&message_with(15, 255), &["at byte 12", "more than are left"]);
    assert_contains(&message_with(16, b'X'), &["must be JSON"]);
    assert_contains(&message_with(20, b'X'), &["at byte 20", "no glTF"]);
    // the tetrahedron without its binary chunk
    let json = gltf_json("", r#"{"mesh":0}"#, "");
    assert_contains(&parse_invalid(&json), &["buffer 0 has no uri"]);
    assert!(parse_mesh(Format::Gltf, &bytes, None, None).is_ok());
}
