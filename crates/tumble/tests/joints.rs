//! Joints together with contact, loads and both integrators, and what is refused.

#![allow(clippy::unwrap_used)]

use tumble::{
    Body, DMat3, DQuat, DVec3, Damping, Integrator, Joint, Load, LoadCourse, MassModel, Material,
    Mesh, Motion, Motor, Overlaps, Prescribed, Primitive, Sampling, Shape, State, Surface,
    WallPlane, World, WorldBuilder,
};

const INTEGRATORS: [Integrator; 2] = [Integrator::Splitting, Integrator::Implicit];

/// A solid box with a surface.
fn block(name: &str, size: DVec3, at: DVec3) -> Body {
    let mesh = Primitive::Box { size, divisions: 1 }.mesh().unwrap();
    let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap();
    Body::new(shape).name(name).mass(1.0).surface(Surface::Mesh).position(at)
}

fn ball(name: &str, at: DVec3) -> Body {
    let inertia = DMat3::IDENTITY * (0.4 * 0.01);
    let shape =
        Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, inertia).unwrap();
    let surface = Surface::Spheres { radius: 0.1 };
    Body::new(shape).name(name).mass(1.0).surface(surface).position(at)
}

fn world(integrator: Integrator) -> WorldBuilder {
    let material = Material {
        collision_stiffness: 1e4,
        damping: Damping::Restitution(0.3),
        friction_stiffness: 0.5,
        ..Material::default()
    };
    World::builder().integrator(integrator).dt(5e-4).material(material)
}

const FLOOR: WallPlane = WallPlane { normal: DVec3::Y, offset: 0.0 };

/// An arm on a hinge falls on the floor.
fn arm(integrator: Integrator) -> WorldBuilder {
    world(integrator)
        .wall(FLOOR)
        .body(block("arm", DVec3::new(1.0, 0.1, 0.1), DVec3::new(0.5, 0.3, 0.0)))
        .joint(Joint::hinge(["arm", "world"], DVec3::new(0.0, 0.3, 0.0), DVec3::Z))
}

#[test]
fn an_arm_comes_to_rest_on_the_floor_and_the_ledger_closes() {
    for integrator in INTEGRATORS {
        let mut world = arm(integrator).build().unwrap();
        let start = world.energy().total();
        let mut worst = 0.0f64;
        for _ in 0..10_000 {
            world.step().unwrap();
            worst = worst.max(world.constraint_error());
        }
        let (body, energy) = (world.body(0), world.energy());
        assert!(worst < 1e-13, "{integrator:?} {worst:e}");
        assert!(body.velocity().length() < 1e-9, "{integrator:?} {}", body.velocity());
        assert!(body.position().y < 0.25);
        let released = 9.8 * (0.3 - body.position().y);
        assert!((energy.total() - start).abs() < 5e-3 * released, "{integrator:?} {energy:?}");
        // hinge and floor carry the weight
        let sum = world.joint(0).wrench.force + world.contact_wrench(0).force;
        assert!((sum - DVec3::Y * 9.8).length() < 1e-6, "{integrator:?} {sum}");
    }
}

#[test]
fn an_arm_that_friction_holds_does_not_creep() {
    for integrator in INTEGRATORS {
        let mut world = arm(integrator).build().unwrap();
        world.steps(10_000).unwrap();
        let before = world.body(0).position();
        world.steps(4_000).unwrap();
        let creep = (world.body(0).position() - before).length();
        assert!(creep < 1e-12, "{integrator:?} {creep:e}");
    }
}

#[test]
fn both_integrators_agree_about_a_pulled_chain_on_the_floor() {
    let ends = INTEGRATORS.map(|integrator| {
        let mut builder = world(integrator).wall(FLOOR);
        for number in 0..4 {
            let at = DVec3::new(0.25 * f64::from(number), 0.0999, 0.0);
            builder = builder.body(ball(&format!("{number}"), at));
        }
        for number in 1..4 {
            let at = [number - 1, number].map(|k| DVec3::new(0.25 * f64::from(k), 0.0999, 0.0));
            let names = [format!("{}", number - 1), format!("{number}")];
            builder = builder.joint(Joint::rope([&names[0], &names[1]], at).length(0.3));
        }
        let course = LoadCourse::Periodic { frequency: 0.5, phase: 0.0 };
        let load = Load::force("3", DVec3::X * 6.0).course(course);
        let mut world = builder.load(load).build().unwrap();
        let start = world.energy().total();
        world.steps(3_000).unwrap();
        let energy = world.energy();
        assert!((energy.total() - start).abs() < 0.02 * energy.work, "{integrator:?} {energy:?}");
        world.body(3).position().x
    });
    assert!(ends[0] > 1.2 && (ends[0] - ends[1]).abs() < 0.02, "{ends:?}");
}

#[test]
fn joined_bodies_do_not_touch_unless_asked() {
    for contact in [false, true] {
        let at = DVec3::X * 0.05;
        let mut joint = Joint::spring(["a", "b"], [DVec3::ZERO, at], 0.1, 0.0);
        joint.contact = contact;
        let world = world(Integrator::Splitting)
            .gravity(DVec3::ZERO)
            .body(ball("a", DVec3::ZERO))
            .body(ball("b", at))
            .joint(joint)
            .build();
        // they overlap at the start
        assert_eq!(world.is_err(), contact);
    }
}

/// Every kind of joint, a motor, limits, a load and contact.
fn machine(integrator: Integrator) -> World {
    let motor = Motor::Speed { speed: 3.0, effort: 20.0 };
    world(integrator)
        .wall(FLOOR)
        .overlaps(Overlaps::Refuse)
        .body(block("crank", DVec3::new(0.4, 0.1, 0.1), DVec3::new(0.2, 1.0, 0.0)))
        .body(block("rod", DVec3::new(0.6, 0.1, 0.1), DVec3::new(0.7, 1.0, 0.0)))
        .body(ball("bob", DVec3::new(1.0, 0.4, 0.0)))
        .body(block("cart", DVec3::new(0.2, 0.2, 0.2), DVec3::new(2.0, 1.0, 0.0)))
        .body(block("flap", DVec3::new(0.3, 0.1, 0.1), DVec3::new(2.25, 1.0, 0.0)))
        .body(ball("weight", DVec3::new(2.0, 0.5, 0.0)))
        .body(block("tail", DVec3::new(0.1, 0.1, 0.1), DVec3::new(2.0, 0.3, 0.0)))
        .joint(Joint::hinge(["crank", "world"], DVec3::Y, DVec3::Z).motor(motor))
        .joint(Joint::ball(["rod", "crank"], DVec3::new(0.4, 1.0, 0.0)))
        .joint(Joint::rope(["bob", "rod"], [DVec3::new(1.0, 0.4, 0.0), DVec3::new(1.0, 1.0, 0.0)]))
        .joint(
            Joint::slider(["cart", "world"], DVec3::new(2.0, 1.0, 0.0), DVec3::X)
                .limits([-0.2, 0.3])
                .friction(0.5),
        )
        .joint(
            Joint::hinge(["flap", "cart"], DVec3::new(2.1, 1.0, 0.0), DVec3::Z)
                .limits([-1.0, 0.5])
                .spring_back(1.0, 0.02),
        )
        .joint(Joint::spring(
            ["weight", "cart"],
            [DVec3::new(2.0, 0.5, 0.0), DVec3::new(2.0, 1.0, 0.0)],
            50.0,
            0.5,
        ))
        .joint(Joint::weld(["tail", "weight"], DVec3::new(2.0, 0.4, 0.0)))
        .load(
            Load::force("cart", DVec3::X * 5.0)
                .course(LoadCourse::Periodic { frequency: 1.0, phase: 0.5 }),
        )
        .build()
        .unwrap()
}

#[test]
fn a_machine_keeps_its_joints_and_its_ledger_and_resumes_with_the_same_bits() {
    for integrator in INTEGRATORS {
        let mut world = machine(integrator);
        let start = world.energy();
        let mut middle = State::default();
        let mut most = 0.0f64;
        for step in 0..4_000 {
            if step == 2_000 {
                middle = world.state().clone();
            }
            world.step().unwrap();
            assert!(world.constraint_error() < 1e-12, "{integrator:?}");
            most = most.max(world.energy().kinetic);
        }
        let energy = world.energy();
        let residual = energy.total() - start.total();
        let scale = most + energy.motor.abs() + energy.work.abs();
        assert!(residual.abs() < 0.01 * scale, "{integrator:?} {residual} {energy:?}");
        assert!(energy.joint_friction > 0.0);
        let [low, high] = world.model().joints.list[3].limits;
        let place = world.joint(3).coordinate;
        assert!(place >= low - 1e-9 && place <= high + 1e-9);
        let mut resumed = machine(integrator);
        resumed.restore(middle).unwrap();
        for _ in 0..2_000 {
            resumed.clear_scratch();
            resumed.step().unwrap();
        }
        assert_eq!(resumed.state().hash(), world.state().hash(), "{integrator:?}");
    }
}

/// Without losses a run with velocities reversed goes back to where it came from.
#[test]
fn a_double_pendulum_is_reversible() {
    let build = |bodies: Option<&World>| {
        let mut builder = World::builder().dt(1e-3);
        for (index, name) in ["a", "b"].iter().enumerate() {
            let at = DVec3::X * (0.5 + index as f64);
            let mut body = block(name, DVec3::new(1.0, 0.2, 0.1), at).surface(Surface::None);
            if let Some(world) = bodies {
                let old = world.body(index);
                body = body.position(old.position()).orientation(old.orientation());
                body = body.velocity(-old.velocity()).angular_velocity(-old.angular_velocity());
            }
            builder = builder.body(body);
        }
        for (index, between) in [["a", "world"], ["b", "a"]].into_iter().enumerate() {
            let joint = Joint::hinge(between, DVec3::X * index as f64, DVec3::Z);
            let joint = match bodies {
                Some(world) => {
                    let model = world.model();
                    model.joints.list[index].description(&model.names, world.state(), index)
                }
                None => joint,
            };
            builder = builder.joint(joint);
        }
        builder.build().unwrap()
    };
    let mut forth = build(None);
    forth.steps(1_000).unwrap();
    assert!(forth.body(1).position().y < -0.5);
    let mut back = build(Some(&forth));
    back.steps(1_000).unwrap();
    let miss = (back.body(1).position() - DVec3::X * 1.5).length();
    assert!(miss < 1e-9, "{miss:e}");
}

#[test]
fn a_prescribed_support_does_the_work_of_its_joint() {
    let support = block("support", DVec3::splat(0.1), DVec3::ZERO)
        .velocity(DVec3::X * 2.0)
        .motion(Motion::Prescribed(Prescribed::default()));
    let cart = block("cart", DVec3::splat(0.1), DVec3::X);
    let joint = Joint::spring(["cart", "support"], [DVec3::X, DVec3::ZERO], 100.0, 10.0);
    let builder = world(Integrator::Splitting).gravity(DVec3::ZERO).body(support).body(cart);
    let mut world = builder.joint(joint).build().unwrap();
    let start = world.energy().total();
    world.steps(20_000).unwrap();
    let energy = world.energy();
    assert!((world.body(1).velocity().x - 2.0).abs() < 1e-3, "{}", world.body(1).velocity());
    // what the cart has now, and what the damper took
    let expected = energy.kinetic + energy.joint_friction;
    assert!((energy.work - expected).abs() < 1e-3 * expected, "{energy:?}");
    assert!((energy.total() - start).abs() < 1e-9);
}

#[test]
fn a_force_function_may_depend_on_time_and_body() {
    // a spring to the origin, with a period of 2π s
    let body = block("mass", DVec3::splat(0.1), DVec3::X).surface(Surface::None);
    let mut world = World::builder()
        .dt(1e-3)
        .gravity(DVec3::ZERO)
        .body(body)
        .force_function("mass", |_, body| tumble::Wrench {
            force: -body.position(),
            torque: DVec3::ZERO,
        })
        .build()
        .unwrap();
    world.steps(3142).unwrap();
    assert!((world.body(0).position().x + 1.0).abs() < 1e-5);
}

#[test]
fn impossible_joints_are_refused_with_their_reason() {
    let arm = || block("arm", DVec3::ONE, DVec3::ZERO).surface(Surface::None);
    let fixed = || {
        let motion = Motion::Prescribed(Prescribed::default());
        block("fixed", DVec3::ONE, DVec3::Y * 5.0).surface(Surface::None).motion(motion)
    };
    let point = || Body::new(Shape::from_particles(&[DVec3::ZERO]).unwrap()).name("point");
    let with = |joint: Joint| {
        let builder = World::builder().body(arm()).body(fixed()).body(point());
        builder.joint(joint.name("j")).build().map(drop).unwrap_err().to_string()
    };
    let (x, zero) = (DVec3::X, DVec3::ZERO);
    for (joint, message) in [
        (Joint::hinge(["arm", "world"], zero, zero), "`axis` is [0, 0, 0]"),
        (Joint::ball(["arm", "arm"], zero), "\"arm\" twice, but must be two different bodies"),
        (Joint::ball(["world", "world"], zero), "\"world\" twice"),
        (Joint::ball(["leg", "world"], zero), "\"leg\", but must be names of bodies"),
        (Joint::ball(["fixed", "world"], zero), "at least one body that moves by forces"),
        (Joint::ball(["point", "world"], x), "without inertia it would not turn"),
        (Joint { at: [x, zero], ..Joint::ball(["arm", "world"], x) }, "meet there"),
        (Joint::distance(["arm", "world"], [x, x]), "two points at a distance"),
        (Joint::rope(["arm", "world"], [x, zero]).length(0.5), "at least the distance"),
        (Joint::ball(["arm", "world"], zero).limits([-1.0, 1.0]), "has none"),
        (Joint::hinge(["arm", "world"], zero, x).limits([0.5, 1.0]), "with 0"),
        (Joint::ball(["arm", "world"], zero).friction(1.0), "has none"),
        (Joint::hinge(["arm", "world"], zero, x).friction(f64::NAN), "0 or more"),
        (
            Joint::slider(["arm", "world"], zero, x)
                .motor(Motor::Speed { speed: 1.0, effort: 0.0 }),
            "above 0",
        ),
    ] {
        let found = with(joint);
        assert!(found.starts_with("joint \"j\": ") && found.contains(message), "{found}");
    }
    let euler = World::builder().integrator(Integrator::Euler).body(arm());
    let found = euler.joint(Joint::ball(["arm", "world"], zero)).build().map(drop).unwrap_err();
    assert!(found.to_string().contains("\"splitting\" or \"implicit\""), "{found}");
}

#[test]
fn velocities_that_are_left_out_follow_from_the_joints() {
    let turned = DQuat::IDENTITY;
    let arm = |name: &str, x: f64| {
        block(name, DVec3::ONE, DVec3::X * x).surface(Surface::None).orientation(turned)
    };
    let build = |first: Body| {
        World::builder()
            .body(first)
            .body(arm("b", 1.5))
            .joint(Joint::hinge(["a", "world"], DVec3::ZERO, DVec3::Z))
            .joint(Joint::hinge(["b", "a"], DVec3::X, DVec3::Z))
            .build()
    };
    let world = build(arm("a", 0.5).angular_velocity(DVec3::Z * 2.0)).unwrap();
    assert!((world.body(0).velocity() - DVec3::Y).length() < 1e-14);
    // it does not turn, and moves as its joint
    assert!((world.body(1).velocity() - DVec3::Y * 2.0).length() < 1e-14);
    let refused = build(arm("a", 0.5).velocity(DVec3::X)).map(drop).unwrap_err().to_string();
    assert!(refused.contains("come apart"), "{refused}");
}
