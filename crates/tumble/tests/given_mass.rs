//! Bodies with given mass properties in place of those of their particles.
#![allow(clippy::unwrap_used)]

use tumble::{
    Body, DMat3, DVec3, Damping, MassModel, Material, Mesh, Primitive, Sampling, Shape, WallPlane,
    World,
};

/// A cube with an edge of 0.2 m.
fn cube() -> Mesh {
    Primitive::Box { size: DVec3::splat(0.2), divisions: 1 }.mesh().unwrap()
}

fn shape(mass_model: MassModel) -> Shape {
    Shape::from_mesh(&cube(), Sampling::Vertices, mass_model).unwrap()
}

#[test]
fn a_given_symmetric_top_precesses_about_its_angular_momentum() {
    let (mass, moments) = (2.0, DVec3::new(0.3, 0.3, 0.5));
    let gyration = DMat3::from_diagonal(moments / mass);
    let top = shape(MassModel::Particles).with_distribution(DVec3::X * 0.05, gyration).unwrap();
    let omega = DVec3::new(1.0, 0.0, 4.0);
    let body = Body::new(top).mass(mass).angular_velocity(omega);
    let mut world = World::builder().gravity(DVec3::ZERO).dt(0.01).body(body).build().unwrap();
    let momentum = omega * moments;
    // the axis goes round L at the rate L/I₁
    for _ in 0..1000 {
        world.step().unwrap();
    }
    let angle = momentum.length() / moments.x * world.time();
    let turned = tumble::DQuat::from_axis_angle(momentum.normalize(), angle) * DVec3::Z;
    let axis = world.body(0).orientation() * DVec3::Z;
    assert!((axis - turned).length() < 1e-9, "{axis} {turned}");
    assert!((world.body(0).angular_momentum() - momentum).length() < 1e-12);
    assert_eq!(world.body(0).position(), DVec3::X * 0.05);
}

/// Free rotation with three different moments conserves energy and obeys Euler's equations, d(Iω)/dt = Iω × ω in the body.
#[test]
fn given_moments_obey_eulers_equations() {
    let moments = DVec3::new(0.2, 0.3, 0.4);
    let given =
        shape(MassModel::Solid).with_distribution(DVec3::ZERO, DMat3::from_diagonal(moments));
    let omega = DVec3::new(0.1, 3.0, -0.2);
    let body = Body::new(given.unwrap()).mass(1.0).angular_velocity(omega);
    let mut world = World::builder().gravity(DVec3::ZERO).dt(0.05).body(body).build().unwrap();
    let rate = |w: DVec3| (moments * w).cross(w) / moments;
    let (mut w, substeps) = (omega, 200);
    let h = world.dt() / f64::from(substeps);
    for _ in 0..40 {
        world.step().unwrap();
        // Runge–Kutta of fourth order
        for _ in 0..substeps {
            let a = rate(w);
            let b = rate(w + a * (0.5 * h));
            let c = rate(w + b * (0.5 * h));
            w += (a + 2.0 * (b + c) + rate(w + c * h)) * (h / 6.0);
        }
        let view = world.body(0);
        let in_body = view.orientation().inverse() * view.angular_velocity();
        assert!((in_body - w).length() < 1e-9, "{in_body} {w}");
    }
}

#[test]
fn a_body_with_the_properties_of_a_solid_moves_as_the_solid() {
    let solid = shape(MassModel::Solid);
    let particles = shape(MassModel::Particles);
    let given = particles.with_distribution(solid.centre(), solid.gyration()).unwrap();
    let run = |shape: Shape| {
        let body = Body::new(shape).mass(3.0).angular_velocity(DVec3::new(1.0, 5.0, 2.0));
        let floor = WallPlane::new(DVec3::Y, -0.5).unwrap();
        let builder = World::builder().velocity_damping_stiffness(0.1).wall(floor).body(body);
        let mut world = builder.build().unwrap();
        world.steps(600).unwrap();
        world.state().clone()
    };
    let (of_solid, of_given) = (run(solid), run(given));
    assert!(of_solid.totals.evaluations > 0, "it has touched the floor");
    assert_eq!(of_solid.bodies, of_given.bodies);
    assert!(run(particles).bodies != of_solid.bodies);
}

#[test]
fn a_loaded_die_comes_to_rest_with_its_heavy_side_down() {
    let die = shape(MassModel::Solid);
    let heavy = DVec3::new(0.0, 0.095, 0.0);
    let loaded = die.with_distribution(heavy, die.gyration()).unwrap();
    // the heavy side up, not quite in balance
    let tilt = tumble::DQuat::from_rotation_z(0.6);
    let body = Body::new(loaded).mass(1.0).orientation(tilt).position(DVec3::Y * 0.3);
    let material = Material {
        damping: Damping::Restitution(0.3),
        friction_stiffness: 0.5,
        ..Material::default()
    };
    let floor = WallPlane::new(DVec3::Y, 0.0).unwrap();
    let builder = World::builder().material(material).wall(floor).body(body).dt(5e-4);
    let mut world = builder.build().unwrap();
    world.steps(8000).unwrap();
    let side = world.body(0).orientation() * DVec3::Y;
    assert!(side.y < -0.999, "{side}");
    assert!(world.body(0).velocity().length() < 1e-3);
    // the centre of mass is 5 mm above the floor
    assert!((world.body(0).position().y - 0.005).abs() < 5e-4, "{}", world.body(0).position());
}
