use tumble_io::mesh::{Format, MeshFile};

use super::samples::ply;
use super::{assert_contains, v};

const XYZ: &str = "property double x\nproperty double y\nproperty double z\n";
const LIST: &str = "property list uchar int vertex_indices\n";

#[track_caller]
fn parse_valid(text: &str) -> MeshFile {
    super::parse_valid(Format::Ply, text.as_bytes())
}

#[track_caller]
fn parse_invalid(bytes: impl AsRef<[u8]>) -> String {
    super::parse_invalid(Format::Ply, bytes.as_ref())
}

fn ascii(vertices: usize, faces: usize, body: &str) -> String {
    format!(
        "ply\nformat ascii 1.0\nelement vertex {vertices}\n{XYZ}element face {faces}\n{LIST}end_header\n{body}"
    )
}

#[test]
fn numbers_are_read_in_double_precision() {
    let file = parse_valid(&ascii(3, 0, "0.1 1. .5\n-1e-7 +2 3\n0.1 1. .5"));
    assert_eq!(file.mesh.vertices, [v(0.1, 1.0, 0.5), v(-1e-7, 2.0, 3.0), v(0.1, 1.0, 0.5)]);
    assert!(file.mesh.triangles.is_empty());
    assert!(file.weld.is_none());
}

#[test]
fn polygons_become_fans_and_other_properties_are_ignored() {
    let text = "ply\r\nformat ascii 1.0\r\ncomment c\r\nobj_info o\r\nelement face 2\r\nproperty uchar flags\r\nproperty list uint8 uint32 vertex_index\r\nproperty list uchar float uv\r\nelement vertex 5\r\nproperty float nx\r\nproperty int16 z\r\nproperty float64 x\r\nproperty float y\r\nelement edge 1\r\nproperty int a\r\nend_header\r\n7 5 0 1 2 3 4 0\r\n\r\n7 3 4 3 2 2 0.5 nan\r\nnan 3 1 2\r\nnan 3 2 2\r\nnan 3 3 3\r\nnan 3 2 4\r\nnan 3 1 4\r\n9\r\n";
    let file = parse_valid(text);
    assert_eq!(file.mesh.vertices[0], v(1.0, 2.0, 3.0));
    assert_eq!(file.mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [4, 3, 2]]);
    assert_eq!(file.face_count, 2);
}

#[test]
fn triangle_strips_become_triangles() {
    let text = ascii(5, 1, "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n8 0 1 2 3 -1 2 3 4\n")
        .replace("element face", "element tristrips");
    assert_eq!(parse_valid(&text).mesh.triangles, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
}

#[test]
fn excessive_counts_are_handled_without_reading() {
    for format in ["ascii", "binary_little_endian"] {
        let text = ascii(4_000_000_000, 0, "1 2 3\n").replace("ascii", format);
        assert_contains(&parse_invalid(text), &["4000000000 times `vertex`", "truncated"]);
        let text = ascii(1, 0, "1 2 3\n").replace("vertex 1", "vertex 18446744073709551615");
        assert_contains(&parse_invalid(text.replace("ascii", format)), &["truncated"]);
    }
    // elements without properties have no data
    let text = ascii(1, 0, "1 2 3\n")
        .replace("end_header", "element air 18446744073709551615\nend_header");
    assert_eq!(parse_valid(&text).mesh.vertices.len(), 1);
    // a list of four billion entries
    assert_contains(
        &parse_invalid(ascii(1, 1, "1 2 3\n4000000000 0 0 0\n").replace("uchar", "uint")),
        &["line 11", "missing"],
    );
    let mut bytes = ply("binary_little_endian");
    let text =
        String::from_utf8_lossy(&bytes[..bytes.len() - 120]).replace("list uchar", "list uint");
    bytes = [text.as_bytes(), &[0xff; 200]].concat();
    assert_contains(&parse_invalid(&bytes), &["at byte"]);
}

#[test]
fn truncated_binary_files_are_rejected() {
    let bytes = ply("binary_big_endian");
    for length in 0..bytes.len() {
        parse_invalid(&bytes[..length]);
    }
    assert_contains(&parse_invalid(&bytes[..bytes.len() - 1]), &["at byte", "truncated"]);
}

/// A triangle as binary PLY of either byte order, with other elements and lists around its vertices and faces.
fn binary_between_others(big_endian: bool, list: &str, line_end: &str) -> Vec<u8> {
    let endian = if big_endian { "big" } else { "little" };
    let header = format!(
        "ply\nformat binary_{endian}_endian 1.0\ncomment caf\u{e9}\nelement camera 1\nproperty list uchar short view\nproperty double focus\nelement vertex 3\nproperty list uint float weights\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar uchar colours\nproperty list ushort uint {list}\nproperty float quality\nelement edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    );
    // Latin-1: one byte for each character
    let mut bytes: Vec<u8> =
        header.replace('\n', line_end).chars().map(|c| c as u32 as u8).collect();
    let mut push = |number: &[u8]| {
        bytes.extend_from_slice(number);
        if big_endian {
            let start = bytes.len() - number.len();
            bytes[start..].reverse();
        }
    };
    // the first byte of the data is that of a line break
    push(&[10]);
    (0..10_i16).for_each(|i| push(&i.to_le_bytes()));
    push(&0.5_f64.to_le_bytes());
    for corner in [[1.0_f32, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        push(&2_u32.to_le_bytes());
        [0.5, 0.25].iter().chain(&corner).for_each(|c: &f32| push(&c.to_le_bytes()));
    }
    push(&[3]);
    (0..3).for_each(|_| push(&[255]));
    push(&3_u16.to_le_bytes());
    (0..3_u32).for_each(|i| push(&i.to_le_bytes()));
    push(&0.75_f32.to_le_bytes());
    (0..4_i32).for_each(|i| push(&i.to_le_bytes()));
    bytes
}

#[test]
fn other_elements_and_lists_are_skipped_in_either_byte_order() {
    for big_endian in [false, true] {
        for list in ["vertex_index", "vertex_indices"] {
            for line_end in ["\n", "\r\n", "\r"] {
                let bytes = binary_between_others(big_endian, list, line_end);
                let mesh = super::parse_valid(Format::Ply, &bytes).mesh;
                assert_eq!(mesh.vertices, [v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0), v(0.0, 0.0, 1.0)]);
                assert_eq!(mesh.triangles, [[0, 1, 2]]);
                for length in 0..bytes.len() {
                    parse_invalid(&bytes[..length]);
                }
            }
        }
    }
}

#[test]
fn what_follows_the_last_element_is_rejected() {
    for format in ["binary_little_endian", "binary_big_endian"] {
        let bytes = ply(format);
        super::parse_valid(Format::Ply, &[&bytes[..], b"\r\n\0"].concat());
        assert_contains(
            &parse_invalid([&bytes[..], b"\x03abc"].concat()),
            &[&format!("at byte {}: 4 bytes follow", bytes.len())],
        );
    }
}

#[test]
fn elements_with_vertices_that_are_not_read_are_rejected() {
    let body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let text = |name: &str| ascii(3, 1, body).replace("element face", &format!("element {name}"));
    assert_contains(&parse_invalid(text("polygon")), &["`polygon`", "only `face` and `tristrips`"]);
    // a scanner's grid of points
    assert!(parse_valid(&text("range_grid")).mesh.triangles.is_empty());
}

#[test]
fn malformed_headers_are_rejected() {
    assert_contains(&parse_invalid(""), &["empty"]);
    assert_contains(&parse_invalid("plyx\n"), &["does not begin with `ply`"]);
    assert_contains(&parse_invalid("ply\nformat ascii 1.0\n"), &["without `end_header`"]);
    assert_contains(&parse_invalid("ply\nend_header\n"), &["no line `format`"]);
    assert_contains(&parse_invalid("ply\nformat utf8 1.0\n"), &["`utf8`", "binary_big_endian"]);
    assert_contains(&parse_invalid("ply\nproperty int x\n"), &["must follow an element"]);
    assert_contains(&parse_invalid("ply\nelement vertex many\n"), &["`many`", "whole number"]);
    assert_contains(
        &parse_invalid("ply\nelement vertex 1\nproperty real x\n"),
        &["line 3, column 10", "`real`", "double"],
    );
    assert_contains(&parse_invalid("ply\nelement vertex 1\nproperty int\n"), &["no name"]);
    assert_contains(
        &parse_invalid("ply\nelement face 1\nproperty list float int a\n"),
        &["whole-number"],
    );
    assert_contains(&parse_invalid("ply\nfoo\n"), &["`foo`"]);
    assert_contains(
        &parse_invalid("ply\nformat ascii 1.0\nend_header\n"),
        &["exactly one `element vertex`"],
    );
    assert_contains(
        &parse_invalid(ascii(1, 0, "1 2 3\n").replace("double y", "double q")),
        &["no number `y`"],
    );
    assert_contains(&parse_invalid(ascii(0, 0, "")), &["no vertices"]);
    assert_contains(
        &parse_invalid(ascii(1, 1, "1 2 3\n3 0 0 0\n").replace("vertex_indices", "corners")),
        &["vertex_indices"],
    );
}

#[test]
fn malformed_bodies_are_rejected() {
    assert_contains(&parse_invalid(ascii(1, 0, "1 2\n1 1 1\n")), &["line 10", "missing"]);
    assert_contains(&parse_invalid(ascii(1, 0, "1 2 3 4\n")), &["line 10", "more values"]);
    assert_contains(&parse_invalid(ascii(1, 0, "1 2 3\n4 5 6\n")), &["line 11", "goes on"]);
    assert_contains(
        &parse_invalid(ascii(2, 0, "1 2 3\n\n\n\n\n\n\n")),
        &["ends before its last element"],
    );
    assert_contains(&parse_invalid(ascii(1, 0, "1 nan 3\n")), &["must be finite"]);
    assert_contains(&parse_invalid(ascii(1, 0, "1 2e999 3\n")), &["larger than a double"]);
    assert_contains(&parse_invalid(ascii(1, 0, "1 two 3\n")), &["`two`", "column 3"]);
    assert_contains(
        &parse_invalid(ascii(1, 1, "1 2 3\n3 0 0 1\n")),
        &["vertex 1, but there are only 1 (0 to 0)"],
    );
    assert_contains(&parse_invalid(ascii(1, 1, "1 2 3\n3 0 0 -1\n")), &["vertex -1"]);
    assert_contains(&parse_invalid(ascii(1, 1, "1 2 3\n3 0 0 0.5\n")), &["whole number"]);
    assert_contains(&parse_invalid(ascii(1, 1, "1 2 3\n2 0 0\n")), &["2 corners"]);
    assert_contains(&parse_invalid(ascii(1, 1, "1 2 3\n-3 0 0\n")), &["-3 entries"]);
    let mut bytes = ply("binary_little_endian");
    let at = bytes.len() - 52 - 4 * 17;
    bytes[at..at + 4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert_contains(&parse_invalid(&bytes), &[&format!("at byte {at}"), "must be finite"]);
}
