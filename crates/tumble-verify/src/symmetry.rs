//! What must not matter: units of measure, and how a wall is described.

use tumble::{
    Body, BodyState, DQuat, DVec3, Damping, Material, MaterialOverride, Primitive, Shape, WallBox,
    WallPlane, World,
};

use crate::check::{Case, Check, Outcome};
use crate::flight::run;

type Error = Box<dyn std::error::Error>;

pub(crate) const SCALE: Case = Case {
    name: "scale",
    about: "a bouncing box with dashpots and friction, its lengths, masses and times a million times larger or \
            smaller: the same motion",
    run: scale,
    slow: false,
};

pub(crate) const WALLS: Case = Case {
    name: "walls",
    about: "a bounce off a floor given as a plane, as a face of a box, and as a face of a turned box",
    run: walls,
    slow: false,
};

/// A box with dashpots and friction thrown at the floor, measured in other units.
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
    let floor = WallPlane { normal: DVec3::Y, offset: 0.0 };
    let world = World::builder()
        .gravity(DVec3::new(0.0, -9.8, 0.0) * (length / time / time))
        .velocity_damping_stiffness(0.01 * mass / time)
        .dt(1e-4 * time)
        .material(material)
        .wall_of(floor, MaterialOverride::default())
        .body(body);
    Ok(world.build()?)
}

fn state_after(mut world: World, time: f64) -> Result<BodyState, Error> {
    run(&mut world, time)?;
    Ok(world.state().bodies[0])
}

fn scale() -> Outcome {
    let plain = state_after(thrown(1.0, 1.0, 1.0)?, 0.5)?;
    let mut checks = Vec::new();
    for (name, which) in [("length", 0), ("mass", 1), ("time", 2)] {
        for factor in [1e-6, 1e6] {
            let mut units = [1.0; 3];
            units[which] = factor;
            let [length, mass, time] = units;
            let other = state_after(thrown(length, mass, time)?, 0.5 * time)?;
            let place = (other.position / length - plain.position).length();
            let turn = (other.orientation - plain.orientation).length();
            let setting = format!("{name} × {factor:e}");
            checks.push(Check::error(format!("place, {setting}"), place, 1e-9, "m"));
            checks.push(Check::error(format!("orientation, {setting}"), turn, 1e-9, "rad"));
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
    // a quarter turn about z and a third of a turn about the diagonal carry the cube onto itself
    let quarter = WallBox { orientation: DQuat::from_xyzw(0.0, 0.0, half, half), ..closed };
    let third = WallBox { orientation: DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5), ..closed };
    let plane = thrown(&[WallPlane { normal: DVec3::Y, offset: -1.0 }])?;
    let mut checks = Vec::new();
    for (name, walls) in [("box", closed), ("quarter-turned box", quarter), ("turned box", third)] {
        let other = thrown(&walls.planes())?;
        let place = (other.position - plane.position).length();
        let turn = (other.orientation - plane.orientation).length();
        checks.push(Check::error(format!("place, {name}"), place, 1e-11, "m"));
        checks.push(Check::error(format!("orientation, {name}"), turn, 1e-11, "rad"));
    }
    Ok(checks)
}
