//! A parameter study in parallel threads: restitution against bounce height.
//!
//! A particle falls from 1 m onto a floor. It hits at v = √(2 g) and leaves at e v, so that it rises to e² of
//! the height. Each value of e is a world of its own, and worlds share nothing: one thread each.

use std::error::Error;
use std::thread;

use tumble::{Body, DVec3, Damping, Material, Shape, WallPlane, World};

const DROP: f64 = 1.0; // height of the fall (m)

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let values = [0.3, 0.5, 0.7, 0.8, 0.9, 1.0];
    let heights: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> =
            values.iter().map(|&e| scope.spawn(move || bounce_height(e))).collect();
        threads
            .into_iter()
            .map(|t| t.join().map_err(|_| "a thread panicked"))
            .collect::<Result<_, _>>()
    })?;

    println!("restitution e   height (m)   e² × drop (m)");
    for (e, height) in values.into_iter().zip(heights) {
        let (height, theory) = (height?, e * e * DROP);
        println!("{e:13.1}   {height:10.4}   {theory:13.4}");
        // the spring is not infinitely stiff, so gravity acts during the contact too
        assert!((height - theory).abs() < 0.01 * theory, "e = {e}: {height} m, not {theory} m");
    }
    Ok(())
}

/// How high a particle rises after its first bounce (m).
fn bounce_height(restitution: f64) -> Result<f64, Box<dyn Error + Send + Sync>> {
    let material = Material {
        collision_stiffness: 1e7,
        damping: Damping::Restitution(restitution),
        ..Material::default()
    };
    let floor = WallPlane::new(DVec3::Y, 0.0).ok_or("the floor has no normal")?;
    let mut world = World::builder()
        .dt(5e-6)
        .material(material)
        .wall(floor)
        .body(Body::new(Shape::from_particles(&[DROP * DVec3::Y])?))
        .build()?;
    // down and through the bounce, then up to the highest point
    let rises = |world: &World| world.body(0).velocity().y > 0.0;
    while !rises(&world) || world.body(0).position().y < 0.0 {
        world.step()?;
    }
    while rises(&world) {
        world.step()?;
    }
    Ok(world.body(0).position().y)
}
