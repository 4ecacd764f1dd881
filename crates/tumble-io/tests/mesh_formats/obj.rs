use tumble_io::mesh::{Format, MeshFile};

use super::{area_and_volume, assert_contains, v};

#[track_caller]
fn parse_valid(text: &str) -> MeshFile {
    super::parse_valid(Format::Obj, text.as_bytes())
}

#[track_caller]
fn parse_invalid(text: &str) -> String {
    super::parse_invalid(Format::Obj, text.as_bytes())
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn all_vertices_are_kept_in_order_in_double_precision() {
    let file =
        parse_valid("v 0.1 0.2 0.3\nv 9 9 9\nv 1 0 0\nv 0.1 0.2 0.3\nv 0 1e-300 0\nf 5 3 1\n");
    let expected = [
        v(0.1, 0.2, 0.3),
        v(9.0, 9.0, 9.0),
        v(1.0, 0.0, 0.0),
        v(0.1, 0.2, 0.3),
        v(0.0, 1e-300, 0.0),
    ];
    assert_eq!(file.mesh.vertices, expected);
    assert_eq!(file.mesh.triangles, [[4, 2, 0]]);
    assert!(file.weld.is_none());
    assert_eq!((file.object_count, file.face_count, file.file_vertex_count), (1, 1, 5));
}

#[test]
fn all_forms_of_face_corners_are_read() {
    let text = format!(
        "{SQUARE}vt 0 0\nvn 0 0 1\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\nf -4 -3 -2\nf -4/-1/-1 -3// -2/1/\n"
    );
    assert_eq!(parse_valid(&text).mesh.triangles, [[0, 1, 2]; 6]);
}

#[test]
fn faces_may_come_before_vertices_and_names_in_any_encoding() {
    let text = [b"o caf\xe9\nf 1/ 2/ 3/ 4/\nusemtl \xff\xfe\n", SQUARE.as_bytes()].concat();
    let file = super::parse_valid(Format::Obj, &text);
    assert_eq!(file.mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    let upper = parse_valid(&format!("{SQUARE}f 1 2 3 4\n").to_uppercase());
    assert_eq!(upper.mesh, file.mesh);
}

#[test]
fn geometry_that_is_not_read_is_rejected() {
    for statement in ["surf 0 1 0 1 1 2 3 4", "bzp 1 2 3 4", "bsp 1 2 3 4", "cdp 1 2 3 4"] {
        assert_contains(&parse_invalid(&format!("{SQUARE}{statement}\n")), &["line 5", "curved"]);
    }
    assert_contains(&parse_invalid(&format!("{SQUARE}call more.obj\n")), &["another file"]);
}

#[test]
fn negative_indices_count_back_from_the_face() {
    let file = parse_valid("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -3 -2 -1\n");
    assert_eq!(file.mesh.triangles, [[0, 1, 2], [1, 2, 3]]);
}

#[test]
fn weights_colours_and_other_statements_are_ignored() {
    let text = "mtllib a.mtl\nusemtl red\ns off\nv 1 2 3 1.0\nv 4 5 6 0.1 0.2 0.3\nv 7 8 9 1 0.1 0.2 0.3\nvt 0 0\nvn 0 0 1\nvp 0.5\nl 1 2\np 1\ncstype bspline\nmy_own-word 7\nf 1 2 3\n";
    let file = parse_valid(text);
    assert_eq!(file.mesh.vertices, [v(1.0, 2.0, 3.0), v(4.0, 5.0, 6.0), v(7.0, 8.0, 9.0)]);
}

#[test]
fn comments_continued_lines_and_all_line_endings_are_read() {
    let plain = parse_valid("v 1 2 3\nv 4 5 6\nv 7 8 9\nf 1 2 3\n").mesh;
    for text in [
        "v 1 2 3\r\nv 4 5 6\r\nv 7 8 9\r\nf 1 2 3\r\n",
        "v 1 2 3\rv 4 5 6\rv 7 8 9\rf 1 2 3",
        "\u{feff}v 1 2 3\n\n  \tv  4\t5 6  \n# v 0 0 0 \\\nv 7 8 9 # a comment\n f 1 2 3",
        "v 1 \\\n2 3\nv 4 5 6\nv 7 8\\\r\n 9\nf 1 \\\n 2\\\n 3\n",
        "o back\\slash\\\n v 8 8 8\nv 1 2 3\nv 4 5 6\nv 7 8 9\nf 1 2 3\n",
    ] {
        assert_eq!(parse_valid(text).mesh, plain, "{text:?}");
    }
}

#[test]
fn groups_are_counted_if_there_are_no_objects() {
    assert_eq!(parse_valid(&format!("{SQUARE}o a\no b\ng c\n")).object_count, 2);
    assert_eq!(parse_valid(&format!("{SQUARE}g a\ng b\ng c\n")).object_count, 3);
    assert_eq!(parse_valid(SQUARE).object_count, 1);
}

#[test]
fn convex_polygons_become_fans() {
    let file = parse_valid(&format!("{SQUARE}f 1 2 3 4\n"));
    assert_eq!(file.mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(file.face_count, 1);
}

#[test]
fn concave_polygons_are_triangulated_without_overlap() {
    // an L of area 3, an arrow whose fan would overlap, and a comb, in planes of any direction
    let cases: [(&[[f64; 2]], f64); 3] = [
        (&[[2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.0, 0.0], [2.0, 0.0]], 3.0),
        (&[[2.0, -1.0], [0.0, 3.0], [-2.0, -1.0], [0.0, 0.0]], 6.0),
        (
            &[
                [0.0, 0.0],
                [5.0, 0.0],
                [5.0, 2.0],
                [4.0, 2.0],
                [4.0, 1.0],
                [3.0, 1.0],
                [3.0, 2.0],
                [2.0, 2.0],
                [2.0, 1.0],
                [1.0, 1.0],
                [1.0, 2.0],
                [0.0, 2.0],
            ],
            8.0,
        ),
    ];
    for (points, area) in cases {
        for plane in ["x y 0", "0 x y", "y 0 x", "y x 0", "x y x"] {
            let mut text = String::new();
            for [x, y] in points {
                let at = plane.replace('x', &x.to_string()).replace('y', &y.to_string());
                text += &format!("v {at}\n");
            }
            // a face may come before its vertices
            let face: String = (1..=points.len()).map(|i| format!(" {i}")).collect();
            let file = parse_valid(&format!("f{face}\n{text}"));
            let slope = if plane == "x y x" { 2.0_f64.sqrt() } else { 1.0 };
            let (twice, _) = area_and_volume(&file);
            assert!((twice - 2.0 * area * slope).abs() < 1e-12, "{points:?} {plane}: {twice}");
            assert_eq!(file.mesh.triangles.len(), points.len() - 2);
        }
    }
}

#[test]
fn degenerate_polygons_stay_fans() {
    // a single point, self-intersecting, and overflowing in the cross product
    let cases = [
        "0 0 0 0 0 0 0 0 0 0 0 0",
        "0 0 0 1 1 0 1 0 0 0 1 0",
        "0 0 0 1e300 0 0 1e299 1e299 0 0 1e300 0",
    ];
    for numbers in cases {
        let words: Vec<&str> = numbers.split(' ').collect();
        let text: String = words.chunks(3).map(|p| format!("v {}\n", p.join(" "))).collect();
        assert_eq!(parse_valid(&format!("{text}f 1 2 3 4\n")).mesh.triangles.len(), 2);
    }
}

#[test]
fn polygons_with_many_corners_take_bounded_time() {
    let mut text = String::new();
    let mut face = String::from("f");
    for i in 0..300_000 {
        text += &format!("v {} {} 0\n", i % 7, i % 11);
        face += &format!(" {}", i + 1);
    }
    assert_eq!(parse_valid(&format!("{text}{face}\n")).mesh.triangles.len(), 299_998);
}

#[test]
fn out_of_range_indices_are_rejected() {
    assert_contains(
        &parse_invalid(&format!("{SQUARE}f 1 2 9000\n")),
        &["line 5, column 7: face refers to vertex 9000, but the file has only 4 vertices"],
    );
    assert_contains(
        &parse_invalid(&format!("{SQUARE}f 1 2 -5\n")),
        &["vertex -5, but there are only 4 vertices before it"],
    );
    assert_contains(
        &parse_invalid(&format!("{SQUARE}f 0 1 2\n")),
        &["vertex 0, but vertices count from 1"],
    );
    assert_contains(
        &parse_invalid(&format!("{SQUARE}f 1 2 99999999999999999999999\n")),
        &["99999999999999999999999"],
    );
    assert_contains(
        &parse_invalid(&format!("{SQUARE}f 1 2 -99999999999999999999999\n")),
        &["only 4 vertices"],
    );
    assert_contains(&parse_invalid(&format!("{SQUARE}f 1 2 4294967296\n")), &["vertex 4294967296"]);
}

#[test]
fn malformed_statements_are_rejected() {
    assert_contains(&parse_invalid("v 1 2\n"), &["line 1", "the z coordinate is missing"]);
    assert_contains(
        &parse_invalid("v 1 2 x3\n"),
        &["column 7", "the z coordinate is `x3`, which is not a number"],
    );
    assert_contains(&parse_invalid("v nan 0 0\n"), &["must be finite"]);
    assert_contains(&parse_invalid("v 0 -inf 0\n"), &["y coordinate", "must be finite"]);
    assert_contains(&parse_invalid("v 0 1e999 0\n"), &["larger than a double"]);
    assert_contains(&parse_invalid("v 1 2 3 4 5 6 7 8 9\n"), &["9 numbers"]);
    assert_contains(
        &parse_invalid(&format!("{SQUARE}f 1 2\n")),
        &["line 5", "2 corners; 3 or more"],
    );
    assert_contains(&parse_invalid(&format!("{SQUARE}f 1 2 3.5\n")), &["no corner of a face"]);
    assert_contains(&parse_invalid(&format!("{SQUARE}f 1 2 3/x\n")), &["`3/x`"]);
    assert_contains(&parse_invalid(&format!("{SQUARE}f 1 2 3/1/1/1\n")), &["`3/1/1/1`"]);
    assert_contains(&parse_invalid(&format!("{SQUARE}{{\"a\": 1}}\n")), &["is no OBJ statement"]);
    assert_contains(&parse_invalid("v 1 2 \\\n x\n"), &["line 2, column 2"]);
}

#[test]
fn files_of_other_formats_are_rejected() {
    assert_contains(&parse_invalid(""), &["empty"]);
    assert_contains(&parse_invalid("# nothing\nvn 0 0 1\n"), &["no vertices"]);
    assert_contains(&parse_invalid("v\u{0}1 2 3\n"), &["at byte 1", "not a text file"]);
    assert_contains(&super::parse_invalid(Format::Obj, b"\xff\xfev\0 \0"), &["UTF-16"]);
    assert_contains(
        &super::parse_invalid(Format::Obj, &super::samples::stl_text()),
        &["no vertices", "looks like STL"],
    );
    assert_contains(
        &super::parse_invalid(Format::Obj, &super::samples::glb()),
        &["looks like glTF"],
    );
    // control characters and long words are not printed
    assert!(parse_invalid(&format!("\u{1b}[31m{}", "x".repeat(10_000))).len() < 300);
}
