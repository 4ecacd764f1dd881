//! Times of the mesh routines on large meshes:
//! `cargo test --release --test shape_speed -- --ignored --nocapture`.

use std::time::Instant;
use tumble::{Primitive, Sampling};

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    println!("{what}: {:.3} s", start.elapsed().as_secs_f64());
    result
}

#[test]
#[ignore = "a measurement"]
fn millions_of_vertices_and_points_take_seconds() {
    let sphere = Primitive::Sphere { radius: 1.0, subdivisions: 9 };
    let sphere = timed("mesh of a sphere, 2.6 million vertices", || sphere.mesh()).unwrap();
    timed("its closedness", || assert!(sphere.closedness().is_manifold()));
    let torus = Primitive::Torus { radius: 1.0, tube_radius: 0.4, segments: 2230 };
    let torus = timed("mesh of a torus", || torus.mesh()).unwrap();
    println!("{} vertices", torus.vertices.len());
    timed("its closedness", || assert!(torus.closedness().is_manifold()));
    timed("its solid integrals", || torus.solid_integrals()).unwrap();

    let shape = Primitive::named("torus").unwrap().mesh().unwrap();
    for spacing in [1.2e-3, 4e-4] {
        let points = timed("surface", || shape.sample(Sampling::Surface { spacing })).unwrap();
        println!("{} surface points", points.len());
    }
    for spacing in [2e-3, 1e-3] {
        let points = timed("volume", || shape.sample(Sampling::Volume { spacing })).unwrap();
        println!("{} inner points", points.len());
    }
}
