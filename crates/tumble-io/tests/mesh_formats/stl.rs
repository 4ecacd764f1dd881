use tumble_io::mesh::{Format, Weld, parse_mesh};

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
        assert_eq!((file.file_vertex_count, file.face_count, file.weld.is_some()), (12, 4, true));
    }
}

#[test]
fn welding_can_be_disabled() {
    let file = parse_mesh(Format::Stl, &stl_text(), None, Some(Weld::Never)).unwrap();
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
    assert_contains(&parse_invalid(&binary[..40]), &["only 40 bytes"]);
    let mut huge = binary.clone();
    huge[80..84].copy_from_slice(&(u32::MAX - 1).to_le_bytes());
    assert_contains(
        &parse_invalid(&huge),
        &["at byte 80", "4294967294 triangles", "214748364784 bytes"],
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
    let with_facet = |facet: &str| parse_invalid(format!("solid a\nfacet {facet}").as_bytes());
    assert_contains(
        &with_facet("outer loop\nvertex 0 0 1e999\n"),
        &["line 3", "larger than a double"],
    );
    assert_contains(&with_facet("outer loop vertex 0 nan 0\n"), &["must be finite"]);
    assert_contains(&with_facet("outer loop vertex 0 0\n"), &["z coordinate is missing"]);
    assert_contains(&with_facet("outer loop vertex 0 0\nendloop"), &["`endloop`", "not a number"]);
    assert_contains(&with_facet("normal 0 0 1 vertex"), &["`vertex` stands where `outer loop`"]);
    assert_contains(&with_facet("normal 0 0 1 outer"), &["ends where `loop` is expected"]);
    assert_contains(&parse_invalid(b"solid a\nvertex 0 0 0\n"), &["line 2", "out of place"]);
    assert_contains(&parse_invalid(b"solid a\nfaces 0 0\n"), &["`faces` is no STL statement"]);
    let mut nan = stl_binary(b"");
    nan[84 + 50 + 24..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_contains(&parse_invalid(&nan), &["at byte 158", "triangle 2", "must be finite"]);
}

/// A facet on one line.
const FACET: &str =
    "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet";

/// Checks the number of triangles and solids of a text.
#[track_caller]
fn assert_counts(text: &[u8], triangles: usize, solids: usize) {
    let file = parse_valid(Format::Stl, text);
    assert_eq!((file.face_count, file.object_count), (triangles, solids));
}

#[test]
fn the_lines_of_a_text_do_not_matter() {
    // the tetrahedron with every second facet on one line, then with all words on one line, and each on its own
    let text = String::from_utf8(stl_text()).unwrap();
    let expected = parse_valid(Format::Stl, text.as_bytes()).mesh;
    let (name, facets) = text.split_once('\n').unwrap();
    let mut mixed = name.to_owned();
    for (i, facet) in facets.split_inclusive("endfacet\n").enumerate() {
        let facet = if i % 2 == 0 { facet.to_owned() } else { facet.replace('\n', " ") + "\n" };
        mixed += &format!("\n{facet}");
    }
    let words: Vec<&str> = text.split_whitespace().collect();
    let long = words.join(" ");
    let tall = words.join("\r\n").replace("\r\ntet", " tet");
    for text in [mixed, long, tall] {
        assert_eq!(parse_valid(Format::Stl, text.as_bytes()).mesh, expected, "{text}");
    }
}

#[test]
fn ends_may_be_spelled_apart_in_any_case() {
    let apart = FACET.replace("endloop", "end loop").replace("endfacet", "END\nFacet");
    assert_counts(format!("solid a\n{apart}\n{apart}\nEnd Solid a\n").as_bytes(), 2, 1);
    let upper = format!("\n\nsolid a\n{FACET}\nendsolid a").to_uppercase();
    assert_counts(upper.as_bytes(), 1, 1);
    let without_normal = FACET.replace("normal 0 0 1 ", "");
    assert_counts(format!("solid\n{without_normal}\nendsolid").as_bytes(), 1, 1);
    let no_number = FACET.replace("0 0 1", "-1.#IND -nan(ind) 0");
    assert_counts(format!("solid\ncolor 1 0 0 {no_number}\nendsolid").as_bytes(), 1, 1);
}

#[test]
fn several_solids_form_one_mesh() {
    let [a, b] =
        ["a", "b"].map(|name| format!("solid {name}\n{FACET}\n{FACET}\nendsolid {name}\n"));
    assert_counts(format!("{a}{b}").as_bytes(), 4, 2);
    assert_counts(format!("{a}{b}").replace('\n', " ").as_bytes(), 4, 2);
}

#[test]
fn names_of_solids_may_hold_anything() {
    for name in [
        &b"caf\xe9 \xff\x80"[..],
        "ein Würfel".as_bytes(),
        b"facet",
        b"facet normal",
        b"outer loop vertex endloop",
        b"my solid facet endsolid vertex 1",
        b"end",
    ] {
        let text = [b"solid ", name, b"\n", FACET.as_bytes(), b"\nendsolid ", name, b"\n"].concat();
        assert_counts(&text, 1, 1);
    }
    // a damaged facet is no part of a name
    let damaged = FACET.replace("normal 0", "normal x");
    assert_contains(
        &parse_invalid(format!("solid a {damaged}\n{FACET}\nendsolid").as_bytes()),
        &["line 1", "a vertex stands in the line of a solid's name"],
    );
}

#[test]
fn facets_that_are_no_triangles_are_rejected() {
    let corner = "vertex 1 0 0 ";
    let quad = FACET.replace(corner, &corner.repeat(2));
    let hexagon = FACET.replace(corner, &corner.repeat(4));
    for text in [quad, hexagon, FACET.replace(corner, "")] {
        let message = parse_invalid(format!("solid a\n{text}\nendsolid").as_bytes());
        assert_contains(&message, &["line 2", "exactly 3"]);
    }
    let text = format!("solid a\n{FACET}\n{FACET}\nendsolid");
    for length in 8..text.len() - 1 {
        parse_invalid(&text.as_bytes()[..length]);
    }
}

#[test]
fn what_follows_the_triangles_of_a_binary_file_is_ignored() {
    for header in [&b""[..], b"solid made by a program"] {
        let binary = stl_binary(header);
        let expected = parse_valid(Format::Stl, &binary).mesh;
        for tail in [vec![0], vec![7; 49], b"a program".repeat(10), vec![b'x'; 50], vec![0; 100]] {
            let file = parse_valid(Format::Stl, &[&binary[..], &tail].concat());
            assert_eq!(file.mesh, expected, "{tail:?}");
        }
    }
}

#[test]
fn a_wrong_count_is_corrected_or_rejected() {
    let binary = stl_binary(b"");
    let expected = parse_valid(Format::Stl, &binary).mesh;
    let with_count = |count: u32, tail: &[u8]| {
        let mut bytes = [&binary[..], tail].concat();
        bytes[80..84].copy_from_slice(&count.to_le_bytes());
        bytes
    };
    // the length of the file is that of four triangles
    for count in [0, 1, 3, u32::MAX] {
        assert_eq!(parse_valid(Format::Stl, &with_count(count, b"")).mesh, expected, "{count}");
    }
    assert_contains(
        &parse_invalid(&with_count(5, b"")),
        &[
            "at byte 80",
            "promises 5 triangles",
            "334 bytes",
            "has 284",
            "4 triangles and 0 bytes",
            "truncated",
        ],
    );
    // there may be more triangles than promised, but the length does not say how many
    for (count, tail) in [(0, 1), (3, 1), (u32::MAX, 20)] {
        parse_invalid(&with_count(count, &vec![b'x'; tail]));
    }
    assert_contains(
        &parse_invalid(&with_count(4, &[1; 50])),
        &["5 triangles and 0 bytes", "wrong"],
    );
    assert_contains(&parse_invalid(&[&binary[..], &binary].concat()), &["another STL follows"]);
    // text in UTF-16, and text with a zero byte
    let text = format!("\u{feff}solid a\n{FACET}\n{FACET}\nendsolid");
    let utf16: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_contains(&parse_invalid(&utf16), &["UTF-16", "save it as UTF-8"]);
    assert_contains(
        &parse_invalid(format!("solid \0{FACET}{FACET}").as_bytes()),
        &["begins with `solid`", "zero bytes"],
    );
}
