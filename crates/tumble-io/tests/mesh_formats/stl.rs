use tumble_io::mesh::{Format, parse_mesh};

use super::samples::{stl_binary, stl_text};
use super::{area_and_volume, assert_contains, parse_valid, v};

#[track_caller]
fn parse_invalid(bytes: &[u8]) -> String {
    super::parse_invalid(Format::Stl, bytes)
}

#[test]
fn a_binary_file_may_begin_with_solid() {
    for header in ["", "solid made by a program", "solid\nfacet normal"] {
        let file = parse_valid(Format::Stl, &stl_binary(header.as_bytes()));
        assert_eq!((file.mesh.vertices.len(), file.mesh.triangles.len()), (4, 4), "{header:?}");
        assert_eq!((file.file_vertex_count, file.face_count, file.welded), (12, 4, true));
    }
}

#[test]
fn welding_can_be_disabled() {
    let file = parse_mesh(Format::Stl, &stl_text(), None, Some(false)).unwrap();
    assert_eq!(file.mesh.vertices.len(), 12);
    assert_eq!(file.mesh.triangles[1], [3, 4, 5]);
    assert_eq!(area_and_volume(&file), area_and_volume(&parse_valid(Format::Stl, &stl_text())));
}

#[test]
fn text_is_read_in_double_precision_in_any_layout() {
    let text = "  SOLID\r\nFacet Normal nan nan nan\r\nOUTER loop\r\n vertex 0.1 0 0\r\n\r\nvertex 1 0 0\r\nvertex 0 1 0\r\nendloop\r\nendfacet\r\nendsolid\r\nsolid two\r\nendsolid two";
    let file = parse_valid(Format::Stl, text.as_bytes());
    assert_eq!(file.mesh.vertices, [v(0.1, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0)]);
    assert_eq!(file.object_count, 2);
}

#[test]
fn files_of_the_wrong_length_are_rejected() {
    let binary = stl_binary(b"");
    assert_contains(
        &parse_invalid(&binary[..binary.len() - 1]),
        &["promises 4 triangles", "284 bytes", "has 283", "truncated"],
    );
    let mut longer = binary.clone();
    longer.push(0);
    assert_contains(&parse_invalid(&longer), &["followed by something else"]);
    assert_contains(&parse_invalid(&binary[..40]), &["only 40 bytes"]);
    let mut huge = binary.clone();
    huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert_contains(
        &parse_invalid(&huge),
        &["at byte 80", "4294967295 triangles", "214748364834 bytes"],
    );
    let text = stl_text();
    assert_contains(&parse_invalid(&text[..text.len() - 14]), &["without `endsolid`"]);
    assert_contains(&parse_invalid(&text[..100]), &["line"]);
}

#[test]
fn malformed_files_are_rejected() {
    assert_contains(&parse_invalid(b""), &["empty"]);
    assert_contains(&parse_invalid(&[0; 84]), &["no triangles"]);
    assert_contains(&parse_invalid(b"solid a\nendsolid a\n"), &["no triangles"]);
    assert_contains(
        &parse_invalid(
            b"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
        ),
        &["line 6", "exactly 3"],
    );
    assert_contains(
        &parse_invalid(b"solid a\nvertex 0 0 1e999\n"),
        &["line 2", "larger than a double"],
    );
    assert_contains(&parse_invalid(b"solid a\nvertex 0 nan 0\n"), &["must be finite"]);
    assert_contains(&parse_invalid(b"solid a\nvertex 0 0\n"), &["z coordinate is missing"]);
    assert_contains(&parse_invalid(b"solid a\nfaces 0 0\n"), &["`faces` is no STL statement"]);
    let mut nan = stl_binary(b"");
    nan[84 + 50 + 24..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_contains(&parse_invalid(&nan), &["at byte 158", "triangle 2", "must be finite"]);
}
