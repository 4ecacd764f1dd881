//! Which meshes are accepted, their thickness, and segments that cross them.

use super::*;

fn distance(mesh: &Mesh) -> SignedDistance {
    SignedDistance::new(mesh).unwrap()
}

fn refusal(mesh: &Mesh) -> String {
    SignedDistance::new(mesh).unwrap_err().to_string()
}

/// Asserts equal distances and gradients; the triangles may differ.
fn same(a: &SignedDistance, b: &SignedDistance, points: &[DVec3]) {
    for &p in points {
        let [a, b] = [a, b].map(|d| d.query(p, NO_HINT, f64::INFINITY).unwrap());
        assert!((a.distance - b.distance).abs() < 1e-15, "{p}: {a:?} {b:?}");
        assert!(
            a.gradient.distance(b.gradient) < 1e-9 || a.distance.abs() < 1e-12,
            "{p}: {a:?} {b:?}"
        );
    }
}

#[test]
fn open_and_wrongly_wound_meshes_are_refused() {
    let sheet =
        Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y], vec![[0, 1, 2], [0, 2, 3]]);
    let text = refusal(&sheet.unwrap());
    assert!(text.contains("open from vertex 0 (0, 0, 0) to vertex 1 (1, 0, 0)"), "{text}");
    assert!(text.contains("close the mesh"), "{text}");

    let sphere = primitive("sphere");
    let mut half = sphere.clone();
    half.triangles.retain(|t| t.iter().all(|&i| sphere.vertices[i as usize].y > -1e-9));
    assert!(matches!(SignedDistance::new(&half), Err(SurfaceError::Open { holes: 1, .. })));

    let mut turned = sphere.clone();
    turned.triangles[7].swap(0, 1);
    assert!(refusal(&turned).contains("wrongly wound"), "{}", refusal(&turned));

    assert!(refusal(&Mesh::default()).contains("no triangles"));
    let flat = Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        triangles: vec![[0, 1, 2], [0, 2, 1]],
    };
    assert!(refusal(&flat).contains("no volume"));
    assert!(refusal(&moved(&sphere, |v| v * 1e70)).contains("1e60"));
    assert!(refusal(&moved(&sphere, |v| v * 1e-70)).contains("check its units"));
    let broken = Mesh { vertices: vec![DVec3::NAN; 3], triangles: vec![[0, 1, 2], [7, 8, 9]] };
    assert_eq!(SignedDistance::new(&broken).unwrap_err(), SurfaceError::NoTriangles);
}

#[test]
fn a_mesh_wound_inwards_is_reversed() {
    let mesh = primitive("knot");
    let mut inwards = mesh.clone();
    inwards.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let (a, b) = (distance(&mesh), distance(&inwards));
    assert!(b.is_inverted() && !a.is_inverted());
    same(&a, &b, &points(&mesh, 300, 1));
}

#[test]
fn duplicate_vertices_and_degenerate_triangles_are_accepted() {
    let mesh = primitive("box");
    let mut soup = Mesh::default();
    for t in &mesh.triangles {
        let start = soup.vertices.len() as u32;
        soup.vertices.extend(t.map(|i| mesh.vertices[i as usize]));
        soup.triangles.push([start, start + 1, start + 2]);
        soup.triangles.push([start, start, start + 2]);
    }
    let found = distance(&soup);
    assert_eq!(found.triangle_count(), 12);
    same(&distance(&mesh), &found, &points(&mesh, 300, 1));
    // every hint is valid, even that of an ignored triangle
    for hint in [0, 1, 23, 24, u32::MAX] {
        assert_eq!(found.query(DVec3::ZERO, hint, 0.0).unwrap().distance, -0.05);
    }
}

#[test]
fn a_triangle_of_zero_height_does_not_change_the_distance() {
    // a tetrahedron of which one edge is split in one face only, and the gap closed by a triangle without height
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, 0.5 * DVec3::X];
    let whole = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let split = vec![[0, 2, 4], [4, 2, 1], [0, 4, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let whole = Mesh::new(vertices.clone(), whole).unwrap();
    let split = Mesh::new(vertices, split).unwrap();
    let (a, b) = (distance(&whole), distance(&split));
    for p in points(&split, 600, 2) {
        let [a, b] = [&a, &b].map(|d| d.query(p, NO_HINT, f64::INFINITY).unwrap().distance);
        assert!((a - b).abs() < 1e-15, "{p}: {a} {b}");
    }
}

#[test]
fn the_sign_is_right_for_long_thin_triangles() {
    let mesh = moved(&primitive("knot"), |v| v * DVec3::new(1.0, 1e-6, 1e3));
    let found = distance(&mesh);
    let (low, high) = found.bounds();
    for p in points(&mesh, 300, 4) {
        let nearest = found.query(p, NO_HINT, f64::INFINITY).unwrap();
        // the sum of solid angles tells the side away from the surface
        if nearest.distance.abs() > 1e-12 * (high - low).max_element() {
            assert_eq!(nearest.distance < 0.0, plain_inside(&mesh, p), "{p}: {nearest:?}");
        }
    }
}

#[test]
fn a_small_hole_does_not_change_inside_and_outside() {
    let mesh = primitive("sphere");
    let mut holed = mesh.clone();
    let lost = holed.triangles.swap_remove(100).map(|i| mesh.vertices[i as usize]);
    let (a, b) = (distance(&mesh), distance(&holed));
    assert_eq!(b.holes(), 1);
    let middle = (lost[0] + lost[1] + lost[2]) / 3.0;
    for p in points(&mesh, 400, 8) {
        let [a, b] = [&a, &b].map(|d| d.query(p, NO_HINT, f64::INFINITY).unwrap());
        // away from the hole nothing changes, and close to it the side does not
        if p.distance(middle) > 0.05 {
            assert!((a.distance - b.distance).abs() < 1e-15, "{p}: {a:?} {b:?}");
        }
        assert!(a.distance.signum() == b.distance.signum() || a.distance.abs() < 0.01, "{p}");
    }
    for way in [0.9, 0.95, 1.05, 1.1] {
        let nearest = b.query(middle * way, NO_HINT, f64::INFINITY).unwrap();
        assert_eq!(nearest.distance < 0.0, way < 1.0, "{way}: {nearest:?}");
    }
    // nothing is in the hole
    assert!(a.intersects_segment(2.0 * middle, -2.0 * middle));
    assert!(!b.intersects_segment(2.0 * middle, 0.5 * middle));
}

#[test]
fn the_sign_is_right_near_an_edge_shared_by_two_solids() {
    let cube = Primitive::Box { size: DVec3::ONE, divisions: 1 }.mesh().unwrap();
    let mut both = cube.clone();
    both.vertices.extend(cube.vertices.iter().map(|v| *v + DVec3::new(1.0, 1.0, 0.0)));
    both.triangles.extend(cube.triangles.iter().map(|t| t.map(|i| i + 8)));
    let found = distance(&both);
    let edge = DVec3::new(0.5, 0.5, 0.1);
    for (way, inside) in
        [(DVec3::ONE, true), (-DVec3::ONE, true), (DVec3::new(1.0, -1.0, 0.0), false)]
    {
        let nearest = found.query(edge + 0.01 * way, NO_HINT, 1.0).unwrap();
        assert_eq!(nearest.distance < 0.0, inside, "{nearest:?}");
    }
}

#[test]
fn a_cavity_is_outside() {
    let mut mesh = primitive("sphere");
    let inner = moved(&mesh, |v| 0.5 * v);
    let count = mesh.vertices.len() as u32;
    mesh.vertices.extend(inner.vertices);
    mesh.triangles.extend(inner.triangles.iter().map(|&[a, b, c]| [a, c, b].map(|i| i + count)));
    let found = distance(&mesh);
    let at = |y| found.query(DVec3::Y * y, NO_HINT, f64::INFINITY).unwrap();
    assert!(at(0.01).distance > 0.0 && at(0.01).gradient.y < 0.0);
    assert!(at(0.08).distance < 0.0 && at(0.08).gradient.y < 0.0);
    assert!(at(0.14).distance < 0.0 && at(0.14).gradient.y > 0.0);
    assert!((found.thickness() - 0.075).abs() < 0.005, "{}", found.thickness());
}

#[test]
fn the_thickness_of_simple_solids_is_right() {
    let thickness = |shape: Primitive| distance(&shape.mesh().unwrap()).thickness();
    let size = DVec3::new(0.3, 0.2, 0.1);
    let of_box = thickness(Primitive::Box { size, divisions: 4 });
    assert!((of_box - 0.1).abs() < 1e-12, "{of_box}");
    // more triangles than are sampled
    let of_ball = thickness(Primitive::Sphere { radius: 0.15, subdivisions: 4 });
    assert!((of_ball - 0.3).abs() < 0.003, "{of_ball}");
    let of_torus = thickness(Primitive::Torus { radius: 0.1, tube_radius: 0.02, segments: 48 });
    assert!((of_torus - 0.04).abs() < 0.004, "{of_torus}");
    // two boxes on one another: where they touch they are not thin
    let mut stack = Primitive::Box { size, divisions: 1 }.mesh().unwrap();
    let upper = moved(&stack, |v| v + DVec3::Z * 0.1);
    stack.vertices.extend(upper.vertices);
    stack.triangles.extend(upper.triangles.iter().map(|t| t.map(|i| i + 8)));
    let of_stack = distance(&stack).thickness();
    assert!((of_stack - 0.1).abs() < 1e-9, "{of_stack}");
}

#[test]
fn segments_that_cross_the_surface_are_found() {
    let mesh = moved(&primitive("torus"), |v| turn() * v);
    let found = distance(&mesh);
    let at = |x: f64, y: f64, z: f64| turn() * DVec3::new(x, y, z);
    // through the hole, through the tube, past it, along the plane
    assert!(!found.intersects_segment(at(0.0, -1.0, 0.0), at(0.0, 1.0, 0.0)));
    assert!(found.intersects_segment(at(0.1, -1.0, 0.0), at(0.1, 1.0, 0.0)));
    assert!(!found.intersects_segment(at(0.1, -1.0, 0.0), at(0.1, -0.05, 0.0)));
    assert!(found.intersects_segment(at(-1.0, 0.0, 0.0), at(0.0, 0.0, 0.0)));
    assert!(!found.intersects_segment(at(1.0, 1.0, 1.0), at(1.0, 1.0, 1.0)));
    assert!(!found.intersects_segment(DVec3::NAN, DVec3::ZERO));
}

#[test]
fn no_line_passes_between_two_triangles() {
    let mesh = moved(&primitive("sphere"), |v| turn() * v + 0.1);
    let found = distance(&mesh);
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| mesh.vertices[i as usize]);
        for on in [a, 0.5 * (a + b), 0.3 * b + 0.7 * c, (a + b + c) / 3.0] {
            let way = (on - 0.1) * 3.0;
            assert!(found.intersects_segment(0.1 + way, 0.1 - way * 0.5), "{on}");
        }
    }
}

#[test]
fn extreme_points_have_defined_results() {
    let found = distance(&primitive("box"));
    for p in [DVec3::NAN, DVec3::INFINITY, DVec3::new(0.0, f64::NEG_INFINITY, 0.0)] {
        assert_eq!(found.query(p, 0, f64::INFINITY), None);
        assert!(!found.is_ball_outside(p, 1.0));
    }
    let far = found.query(DVec3::X * 1e100, NO_HINT, f64::INFINITY).unwrap();
    assert!((far.distance / 1e100 - 1.0).abs() < 1e-14 && far.gradient.x > 0.999_999, "{far:?}");
    assert_eq!(found.query(DVec3::X * 1e300, NO_HINT, 1.0), None);
    assert_eq!(found.query(DVec3::X, NO_HINT, f64::NAN), None);
    assert_eq!(found.query(DVec3::X, NO_HINT, -1.0), None);
    assert!(found.query(DVec3::ZERO, NO_HINT, -1.0).is_some());
    assert!(found.memory() > 12 * 300 && found.memory() < 100_000, "{}", found.memory());
}

#[test]
fn the_traversal_stack_is_large_enough_for_any_tree() {
    // each level divides the number of groups by four
    let (mut groups, mut depth) = (u32::MAX, 0);
    while groups > 1 {
        groups = groups.div_ceil(2).div_ceil(2);
        depth += 1;
    }
    assert!(3 * depth < 64, "{depth}");
}
