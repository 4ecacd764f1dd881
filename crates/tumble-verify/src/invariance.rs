//! Invariance of the motion under a change of units, and under a change of the description of a wall.

use tumble::{
    Body, BodyState, DQuat, DVec3, Damping, Material, MaterialOverride, Primitive, Shape, WallBox,
    WallPlane, World,
};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{FLOOR, G, step_until};

pub(crate) const SCALE: Case = Case {
    name: "scale",
    description: "A box with dashpots and friction bounces off a floor. Units of length, mass or time that are a million times \
            larger or smaller give the same motion. Errors are in the original units.",
    run: scale,
    slow: false,
};

pub(crate) const WALLS: Case = Case {
    name: "walls",
    description: "A body bounces off a floor that is given as a plane, as a face of a box, and as a face of a rotated box. The motion is \
            the same.",
    run: walls,
    slow: false,
};

/// A box with dashpots and friction that is thrown at the floor. The arguments are factors on lengths, masses and times.
fn thrown(length: f64, mass: f64, time: f64) -> Result<World, Error> {
    let force = mass * length / time / time;
    let material = Material {
        collision_stiffness: 2e4 * force / length,
        damping: Damping::Restitution(0.6),
        friction_stiffness: 0.4,
        ..Material::default()
    };
    let shape = Primitive::Box { size: DVec3::new(0.3, 0.2, 0.1) * length, divisions: 2 }.mesh()?;
    let body = Body::new(Shape::with_surface(&shape.vertices.clone(), shape)?)
        .particle_mass(0.1 * mass)
        .position(DVec3::new(0.0, 0.4, 0.0) * length)
        .velocity(DVec3::new(1.0, -0.5, 0.3) * (length / time))
        .angular_velocity(DVec3::new(3.0, 2.0, 1.0) / time);
    let world = World::builder()
        .gravity(DVec3::new(0.0, -G, 0.0) * (length / time / time))
        .velocity_damping_stiffness(0.01 * mass / time)
        .dt(1e-4 * time)
        .material(material)
        .wall_with_material(FLOOR, MaterialOverride::default())
        .body(body);
    Ok(world.build()?)
}

fn state_after(mut world: World, time: f64) -> Result<BodyState, Error> {
    step_until(&mut world, time)?;
    Ok(world.state().bodies[0])
}

fn scale() -> Outcome {
    let reference = state_after(thrown(1.0, 1.0, 1.0)?, 0.5)?;
    let mut checks = Vec::new();
    for (name, index) in [("length", 0), ("mass", 1), ("time", 2)] {
        for factor in [1e-6, 1e6] {
            let mut units = [1.0; 3];
            units[index] = factor;
            let [length, mass, time] = units;
            let other = state_after(thrown(length, mass, time)?, 0.5 * time)?;
            let position = (other.position / length - reference.position).length();
            let orientation = (other.orientation - reference.orientation).length();
            let setting = format!("{name} × {factor:e}");
            checks.push(Check::error(format!("position error, {setting}"), position, 1e-9, "m"));
            let quantity = format!("quaternion error, {setting}");
            checks.push(Check::error(quantity, orientation, 1e-9, ""));
        }
    }
    Ok(checks)
}

fn walls() -> Outcome {
    let thrown = |walls: &[WallPlane]| -> Result<BodyState, Error> {
        let mesh = Primitive::Box { size: DVec3::new(0.3, 0.2, 0.1), divisions: 2 }.mesh()?;
        let body = Body::new(Shape::with_surface(&mesh.vertices.clone(), mesh)?)
            .position(DVec3::new(0.1, -0.5, 0.2))
            .velocity(DVec3::new(1.0, -2.0, 0.3))
            .angular_velocity(DVec3::new(3.0, 2.0, 1.0));
        let world = walls.iter().fold(World::builder().dt(1e-4), |world, wall| world.wall(*wall));
        state_after(world.body(body).build()?, 0.4)
    };
    let closed = WallBox { open: [false; 6], ..WallBox::arena() };
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // rotations by 90° about z and by 120° about the diagonal map the cube onto itself
    let quarter = WallBox { orientation: DQuat::from_xyzw(0.0, 0.0, half, half), ..closed };
    let third = WallBox { orientation: DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5), ..closed };
    let plane = thrown(&[WallPlane { normal: DVec3::Y, offset: -1.0 }])?;
    let mut checks = Vec::new();
    for (name, walls) in
        [("box", closed), ("box rotated by 90°", quarter), ("box rotated by 120°", third)]
    {
        let other = thrown(&walls.planes())?;
        let position = (other.position - plane.position).length();
        let orientation = (other.orientation - plane.orientation).length();
        checks.push(Check::error(format!("position error, {name}"), position, 1e-11, "m"));
        checks.push(Check::error(format!("quaternion error, {name}"), orientation, 1e-11, ""));
    }
    Ok(checks)
}
