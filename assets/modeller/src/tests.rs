//! What the cat promises to those who simulate it.

use crate::{cat, mesh::Mesh, model, obj};
use glam::DVec3;
use std::sync::LazyLock;

/// Modelled once for all tests.
static CAT: LazyLock<Mesh> = LazyLock::new(|| model(&cat::solid()).unwrap());

#[test]
fn every_edge_joins_two_triangles_that_agree_on_outside() {
    CAT.edges().unwrap();
    assert!(CAT.volume() > 0.0, "the triangles face inwards");
}

#[test]
fn the_surface_is_one_ball_without_handles() {
    let edges = CAT.edges().unwrap();
    assert_eq!(CAT.points.len() + CAT.triangles.len(), edges.len() + 2);

    // walk from the first vertex along edges until nothing new turns up
    let mut reached = vec![false; CAT.points.len()];
    reached[0] = true;
    let mut news = true;
    while news {
        news = false;
        for [a, b] in edges.iter().map(|edge| edge.ends) {
            news |= reached[a] != reached[b];
            reached[a] |= reached[b];
            reached[b] = reached[a];
        }
    }
    assert!(reached.iter().all(|&reached| reached));
}

#[test]
fn the_triangles_around_a_vertex_form_one_fan() {
    for (vertex, ring) in CAT.rings().into_iter().enumerate() {
        // in a single fan, the outer edges of the triangles close up after all of them
        let outer = |side: usize| {
            let [a, b, c] = CAT.triangles[side];
            if a == vertex {
                (b, c)
            } else if b == vertex {
                (c, a)
            } else {
                (a, b)
            }
        };
        let (start, mut at) = outer(ring[0]);
        let mut count = 1;
        while at != start {
            at = ring.iter().map(|&side| outer(side)).find(|&(from, _)| from == at).unwrap().1;
            count += 1;
        }
        assert_eq!(count, ring.len(), "vertex {vertex}");
    }
}

#[test]
fn there_are_about_four_thousand_vertices() {
    assert!((3_700..=4_300).contains(&CAT.points.len()), "{}", CAT.points.len());
}

#[test]
fn no_triangle_is_a_sliver() {
    let sharpest = CAT.triangles.iter().map(|&t| CAT.sharpest_angle(t)).fold(180.0, f64::min);
    assert!(sharpest > 20.0, "{sharpest} degrees");
    let shortest = CAT.edges().unwrap().iter().map(|edge| CAT.length(edge)).fold(1.0, f64::min);
    assert!(shortest > 0.01, "{shortest}");
}

#[test]
fn the_cat_fits_its_box() {
    let low = CAT.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = CAT.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    assert!((low + high).length() < 1e-12, "the bounding box is centred");
    assert!((high.y - low.y - 2.0).abs() < 1e-12, "two units tall");
    let farthest = CAT.points.iter().map(|point| point.length()).fold(0.0, f64::max);
    assert!(farthest < 1.5, "{farthest}");
}

#[test]
fn the_cat_sits_without_falling_over() {
    // the centre of mass of the enclosed volume, from tetrahedra with their apex at the origin
    let moment: DVec3 = CAT
        .triangles
        .iter()
        .map(|triangle| triangle.map(|corner| CAT.points[corner]))
        .map(|[a, b, c]| a.dot(b.cross(c)) / 24.0 * (a + b + c))
        .sum();
    let centre = moment / CAT.volume();

    // in every direction along the ground some touching vertex lies well beyond the centre
    let touching: Vec<DVec3> = CAT.points.iter().copied().filter(|p| p.y < -1.0 + 1e-4).collect();
    assert!(touching.len() > 150, "{} vertices touch the ground", touching.len());
    for step in 0..32 {
        let (sine, cosine) = libm::sincos(f64::from(step) / 32.0 * std::f64::consts::TAU);
        let direction = DVec3::new(cosine, 0.0, sine);
        let reach = touching.iter().map(|&p| (p - centre).dot(direction)).fold(-1.0, f64::max);
        assert!(reach > 0.2, "reach {reach} towards {direction}");
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
fn the_file_in_the_tree_is_what_the_program_writes() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../cat.obj");
    // not assert_eq: the texts are long
    let same = std::fs::read_to_string(file).unwrap() == obj::write(&CAT, &cat::solid());
    assert!(same, "run cargo run -p tumble-modeller");
}
