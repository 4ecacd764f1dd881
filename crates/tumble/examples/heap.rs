//! A heap of clumps: bodies of three overlapping spheres fall into a box and come to rest.
//!
//! The mean height of the heap tells how densely it is packed: bodies of volume V each, N of them on a floor
//! of area A, fill the part φ = N V / (A · 2 × mean height) of the heap. Random packings lie between
//! about 0.5 (loose) and 0.74 (spheres in a crystal).

use tumble::{
    Body, DVec3, Damping, Material, Mesh, Shape, Surface, WallBox, World, sphere_union_integrals,
};

const RADIUS: f64 = 0.04; // of each sphere (m)
const DENSITY: f64 = 1000.0; // kg/m³
const SIDE: f64 = 0.4; // of the box's floor (m)

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // three spheres at the corners of a triangle; overlaps count once in volume, mass and inertia
    let centres = [DVec3::ZERO, 0.05 * DVec3::X, DVec3::new(0.025, 0.04, 0.0)];
    let solid = sphere_union_integrals(&centres, RADIUS)?;
    let volume = solid.measure;
    let gyration = solid.inertia() * (1.0 / volume);
    let shape = Shape::from_distribution(&centres, Mesh::default(), solid.centre, gyration)?;
    let clump =
        Body::new(shape).mass(DENSITY * volume).surface(Surface::Spheres { radius: RADIUS });

    let half = SIDE / 2.0;
    let walls = WallBox {
        min: DVec3::new(-half, 0.0, -half),
        max: DVec3::new(half, 1.0, half),
        open: [false, false, false, true, false, false], // no lid
        ..WallBox::arena()
    };
    let material = Material {
        collision_stiffness: 5e4,           // N/m
        damping: Damping::Restitution(0.3), // of a single sphere
        friction_stiffness: 0.3,            // Coulomb's coefficient
        ..Material::default()
    };
    let mut builder = World::builder().dt(1e-4).material(material).box_walls(&walls);
    // a loose lattice of 3 × 16 × 3 bodies, nudged so that no two fall alike
    for i in 0..144u32 {
        let (column, layer) = (i % 9, i / 9);
        let place =
            DVec3::new(f64::from(column % 3) - 1.0, f64::from(layer), f64::from(column / 3) - 1.0);
        let nudge = 0.1 * f64::from(i * 7 % 11) - 0.5;
        builder = builder.body(
            clump
                .clone()
                .position(DVec3::new(0.0, 0.08, 0.0) + 0.13 * place)
                .angular_velocity(DVec3::new(3.0 * nudge, nudge, -2.0 * nudge)),
        );
    }
    let mut world = builder.build()?;

    println!("time (s)   mean height (m)   kinetic energy (J)");
    for second in [0.0, 0.5, 1.0, 1.5, 2.0, 2.5] {
        while world.time() < second {
            world.step()?;
        }
        println!("{second:8.1}   {:15.4}   {:18.2e}", mean_height(&world), world.energy().kinetic);
    }
    let bodies = world.body_count() as f64;
    let packing = bodies * volume / (SIDE * SIDE * 2.0 * mean_height(&world));
    println!("{packing:.2} of the heap's volume is filled");
    assert!((0.45..0.74).contains(&packing), "no heap is packed like that: {packing}");
    Ok(())
}

/// Mean height of the centres of mass above the floor (m).
fn mean_height(world: &World) -> f64 {
    world.bodies().map(|body| body.position().y).sum::<f64>() / world.body_count() as f64
}
