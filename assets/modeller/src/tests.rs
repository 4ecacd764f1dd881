//! Properties of the cat mesh that simulations rely on.

use crate::{build_mesh, cat, mesh::Mesh, obj};
use glam::DVec3;
use std::sync::LazyLock;

/// The mesh, built once for all tests.
static CAT: LazyLock<Mesh> = LazyLock::new(|| build_mesh(&cat::solid()).unwrap());

#[test]
fn the_mesh_is_watertight_and_faces_outwards() {
    CAT.edges().unwrap();
    assert!(CAT.volume() > 0.0, "the triangles face inwards");
}

#[test]
fn the_surface_is_connected_and_has_genus_zero() {
    let edges = CAT.edges().unwrap();
    assert_eq!(CAT.points.len() + CAT.triangles.len(), edges.len() + 2);

    // visit all vertices that are connected to the first one
    let mut visited = vec![false; CAT.points.len()];
    visited[0] = true;
    let mut changed = true;
    while changed {
        changed = false;
        for [a, b] in edges.iter().map(|edge| edge.ends) {
            changed |= visited[a] != visited[b];
            visited[a] |= visited[b];
            visited[b] = visited[a];
        }
    }
    assert!(visited.iter().all(|&visited| visited));
}

#[test]
fn the_triangles_around_a_vertex_form_one_fan() {
    for (vertex, faces) in CAT.vertex_faces().into_iter().enumerate() {
        // the edges opposite the vertex form one closed loop
        let opposite_edge = |face: usize| {
            let [a, b, c] = CAT.triangles[face];
            if a == vertex {
                (b, c)
            } else if b == vertex {
                (c, a)
            } else {
                (a, b)
            }
        };
        let (start, mut current) = opposite_edge(faces[0]);
        let mut count = 1;
        while current != start {
            let mut edges = faces.iter().map(|&face| opposite_edge(face));
            current = edges.find(|&(from, _)| from == current).unwrap().1;
            count += 1;
        }
        assert_eq!(count, faces.len(), "vertex {vertex}");
    }
}

#[test]
fn the_mesh_has_about_four_thousand_vertices() {
    assert!((3_700..=4_300).contains(&CAT.points.len()), "{}", CAT.points.len());
}

#[test]
fn no_triangle_is_degenerate() {
    let smallest = CAT.triangles.iter().map(|&t| CAT.smallest_angle(t)).fold(180.0, f64::min);
    assert!(smallest > 20.0, "{smallest} degrees");
    let shortest = CAT.edges().unwrap().iter().map(|edge| CAT.length(edge)).fold(1.0, f64::min);
    assert!(shortest > 0.01, "{shortest}");
}

#[test]
fn the_bounding_box_is_centred_and_two_units_tall() {
    let low = CAT.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = CAT.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    assert!((low + high).length() < 1e-12, "the bounding box is centred");
    assert!((high.y - low.y - 2.0).abs() < 1e-12, "two units tall");
    let farthest = CAT.points.iter().map(|point| point.length()).fold(0.0, f64::max);
    assert!(farthest < 1.5, "{farthest}");
}

#[test]
fn the_centre_of_mass_lies_above_the_base() {
    // the centre of mass of the enclosed volume, from tetrahedra with their apex at the origin
    let moment: DVec3 = CAT
        .triangles
        .iter()
        .map(|triangle| triangle.map(|corner| CAT.points[corner]))
        .map(|[a, b, c]| a.dot(b.cross(c)) / 24.0 * (a + b + c))
        .sum();
    let centre = moment / CAT.volume();

    // in every horizontal direction, the base extends well beyond the centre of mass
    let base: Vec<DVec3> = CAT.points.iter().copied().filter(|p| p.y < -1.0 + 1e-4).collect();
    assert!(base.len() > 150, "{} vertices touch the ground", base.len());
    for step in 0..32 {
        let (sine, cosine) = libm::sincos(f64::from(step) / 32.0 * std::f64::consts::TAU);
        let direction = DVec3::new(cosine, 0.0, sine);
        let extent = base.iter().map(|&p| (p - centre).dot(direction)).fold(-1.0, f64::max);
        assert!(extent > 0.2, "{extent} towards {direction}");
    }
}

#[test]
fn parts_have_distinct_names() {
    let mut names: Vec<_> = cat::solid().parts.iter().map(|part| part.name).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn cat_obj_is_up_to_date() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../cat.obj");
    // assert_eq would print both files
    let same = std::fs::read_to_string(file).unwrap() == obj::to_obj(&CAT, &cat::solid());
    assert!(same, "cat.obj differs from the model; `cargo run -p tumble-modeller` writes it again");
}
