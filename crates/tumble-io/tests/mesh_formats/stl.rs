use tumble_io::mesh::{Format, parse_mesh};

use super::samples::{stl_binary, stl_text};
use super::{good, measures, says, v};

#[track_caller]
fn bad(bytes: &[u8]) -> String {
    super::bad(Format::Stl, bytes)
}

#[test]
fn a_binary_file_may_begin_with_solid() {
    for header in ["", "solid made by a program", "solid\nfacet normal"] {
        let file = good(Format::Stl, &stl_binary(header.as_bytes()));
        assert_eq!((file.mesh.vertices.len(), file.mesh.triangles.len()), (4, 4), "{header:?}");
        assert_eq!((file.file_vertex_count, file.face_count, file.welded), (12, 4, true));
    }
}

#[test]
fn welding_can_be_turned_off() {
    let file = parse_mesh(Format::Stl, &stl_text(), None, Some(false)).unwrap();
    assert_eq!(file.mesh.vertices.len(), 12);
    assert_eq!(file.mesh.triangles[1], [3, 4, 5]);
    assert_eq!(measures(&file), measures(&good(Format::Stl, &stl_text())));
}

#[test]
fn text_is_read_at_double_precision_in_any_layout() {
    let text = "  SOLID\r\nFacet Normal nan nan nan\r\nOUTER loop\r\n vertex 0.1 0 0\r\n\r\nvertex 1 0 0\r\nvertex 0 1 0\r\nendloop\r\nendfacet\r\nendsolid\r\nsolid two\r\nendsolid two";
    let file = good(Format::Stl, text.as_bytes());
    assert_eq!(file.mesh.vertices, [v(0.1, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0)]);
    assert_eq!(file.object_count, 2);
}

#[test]
fn truncated_files() {
    let binary = stl_binary(b"");
    says(
        &bad(&binary[..binary.len() - 1]),
        &["promises 4 triangles", "284 bytes", "has 283", "truncated"],
    );
    let mut longer = binary.clone();
    longer.push(0);
    says(&bad(&longer), &["followed by something else"]);
    says(&bad(&binary[..40]), &["only 40 bytes"]);
    let mut huge = binary.clone();
    huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    says(&bad(&huge), &["at byte 80", "4294967295 triangles", "214748364834 bytes"]);
    let text = stl_text();
    says(&bad(&text[..text.len() - 14]), &["without `endsolid`"]);
    says(&bad(&text[..100]), &["line"]);
}

#[test]
fn malformed_files() {
    says(&bad(b""), &["empty"]);
    says(&bad(&[0; 84]), &["no triangles"]);
    says(&bad(b"solid a\nendsolid a\n"), &["no triangles"]);
    says(
        &bad(b"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"),
        &["line 6", "exactly 3"],
    );
    says(&bad(b"solid a\nvertex 0 0 1e999\n"), &["line 2", "larger than a double"]);
    says(&bad(b"solid a\nvertex 0 nan 0\n"), &["must be finite"]);
    says(&bad(b"solid a\nvertex 0 0\n"), &["z coordinate is missing"]);
    says(&bad(b"solid a\nfaces 0 0\n"), &["`faces` is no STL statement"]);
    let mut nan = stl_binary(b"");
    nan[84 + 50 + 24..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    says(&bad(&nan), &["at byte 158", "triangle 2", "must be finite"]);
}
