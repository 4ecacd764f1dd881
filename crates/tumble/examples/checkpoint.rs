//! A checkpoint in memory: take the state, go on from it later, and get the same bits.
//!
//! [`State`](tumble::State) holds all that evolves. With the same description of the world it determines every later
//! step, in another process and on another machine too. The crate `tumble-io` writes it to a file.

use tumble::{Body, DVec3, Damping, Material, Shape, WallBox, World};

/// A rod of particles that bounces and slides in a box. Every call builds the same world.
fn world() -> Result<World, Box<dyn std::error::Error>> {
    let rod: Vec<DVec3> = (0..10).map(|i| DVec3::new(0.03 * f64::from(i), 0.0, 0.0)).collect();
    let body = Body::new(Shape::from_particles(&rod)?)
        .mass(1.0)
        .velocity(DVec3::new(2.0, 0.0, 1.0))
        .angular_velocity(DVec3::new(0.0, 5.0, 8.0));
    let material = Material {
        damping: Damping::Restitution(0.8),
        friction_stiffness: 0.4,
        ..Material::default()
    };
    let builder = World::builder().dt(1e-4).material(material);
    Ok(builder.box_walls(&WallBox::arena()).body(body).build()?)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut straight = world()?;
    while straight.time() < 1.0 {
        straight.step()?;
    }
    // the state is plain data: clone it, keep it, send it to another thread
    let checkpoint = straight.state().clone();

    let mut resumed = world()?;
    resumed.restore(checkpoint)?;

    println!("time (s)   straight through                   resumed at 1 s");
    for end in [1.0, 1.5, 2.0, 3.0] {
        while straight.time() < end {
            straight.step()?;
            resumed.step()?;
        }
        let (a, b) = (straight.state().hash(), resumed.state().hash());
        println!("{end:8.1}   {a}   {b}");
        assert_eq!(a, b, "the two runs differ");
    }
    Ok(())
}
