//! Properties of contact with walls, for random bodies, walls and materials.
#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use tumble::{
    Body, DQuat, DVec3, Damping, Integrator, Material, Mesh, Scratch, Shape, State, WallBox,
    WallPlane, World, critical_dt, step::step,
};

/// What a random scene is made of; a world follows from it, at any scale.
#[derive(Clone, Debug)]
struct Scene {
    points: Vec<DVec3>,
    solid: bool,
    mass: f64,
    start: (DVec3, DVec3, DVec3, DQuat),
    gravity: DVec3,
    drag: f64,
    material: Material,
    walls: Vec<WallPlane>,
    integrator: Integrator,
    tolerance: Option<f64>,
    /// Step as a part of the critical one.
    part: f64,
}

/// Units of length, mass and time.
#[derive(Clone, Copy, Debug)]
struct Units {
    length: f64,
    mass: f64,
    time: f64,
}

const SI: Units = Units { length: 1.0, mass: 1.0, time: 1.0 };

impl Units {
    fn velocity(self) -> f64 {
        self.length / self.time
    }
    fn damping(self) -> f64 {
        self.mass / self.time
    }
    fn stiffness(self) -> f64 {
        self.mass / self.time / self.time
    }
    fn energy(self) -> f64 {
        self.stiffness() * self.length * self.length
    }
    fn angular_momentum(self) -> f64 {
        self.damping() * self.length * self.length
    }
}

impl Scene {
    /// The world in these units, at the step `dt` (in units of time).
    fn at(&self, units: Units, dt: f64) -> World {
        let places: Vec<_> = self.points.iter().map(|&p| p * units.length).collect();
        let mut shape = Shape::from_particles(&places).unwrap();
        if self.solid {
            // mass spread otherwise than over the particles
            let gyration = shape.gyration() * 1.5;
            let centre = shape.centre();
            shape = Shape::from_distribution(&places, Mesh::default(), centre, gyration).unwrap();
        }
        let (position, velocity, omega, orientation) = self.start;
        let body = Body::new(shape)
            .mass(self.mass * units.mass)
            .position(position * units.length)
            .velocity(velocity * units.velocity())
            .angular_velocity(omega / units.time)
            .orientation(orientation);
        let m = self.material;
        let material = Material {
            collision_stiffness: m.collision_stiffness * units.stiffness(),
            damping: match m.damping {
                Damping::Dashpot(c) => Damping::Dashpot(c * units.damping()),
                restitution => restitution,
            },
            friction_spring: m.friction_spring.map(|k| k * units.stiffness()),
            friction_damping: m.friction_damping.map(|c| c * units.damping()),
            ..m
        };
        let walls = self.walls.iter().map(|w| WallPlane { offset: w.offset * units.length, ..*w });
        let builder = World::builder()
            .gravity(self.gravity * (units.length / units.time / units.time))
            .velocity_damping_stiffness(self.drag * units.damping())
            .material(material)
            .integrator(self.integrator)
            .energy_tolerance(self.tolerance)
            .dt(dt * units.time)
            .accept_start_in_walls(true)
            .force(true);
        walls.fold(builder, |b, w| b.wall(w)).body(body).build().unwrap()
    }

    /// The step (s): a part of what is stable.
    fn dt(&self) -> f64 {
        critical_dt(self.at(SI, 1.0).model()).unwrap().dt.min(0.02) * self.part
    }

    fn world(&self) -> World {
        self.at(SI, self.dt())
    }
}

fn vector(range: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-range..range).prop_map(DVec3::from_array)
}

fn rotation() -> impl Strategy<Value = DQuat> {
    prop::array::uniform4(-1.0..1.0f64)
        .prop_map(DQuat::from_array)
        .prop_filter("not zero", |q| q.length() > 0.1)
        .prop_map(DQuat::normalize)
}

fn material() -> impl Strategy<Value = Material> {
    let damping = prop_oneof![
        Just(Damping::Dashpot(0.0)),
        (0.0..60.0f64).prop_map(Damping::Dashpot),
        (0.05..1.0f64).prop_map(Damping::Restitution),
    ];
    (
        1e3..1e5f64,
        damping,
        prop_oneof![Just(0.0), 0.01..1.5f64],
        prop::option::of(1e2..1e5f64),
        prop::option::of(0.0..50.0f64),
    )
        .prop_map(|(k, damping, friction, spring, brake)| Material {
            collision_stiffness: k,
            collision_stiffness_per_area: None,
            damping,
            friction_stiffness: friction,
            friction_spring: spring,
            friction_damping: brake,
        })
}

/// A floor, and walls about as far from the origin, some of which meet.
fn walls() -> impl Strategy<Value = Vec<WallPlane>> {
    let other = (vector(1.0), -1.0..-0.4f64).prop_filter_map("a normal", |(n, offset)| {
        let plane = WallPlane::new(n, 0.0)?;
        Some(WallPlane { offset, ..plane })
    });
    prop::collection::vec(other, 0..4).prop_map(|mut walls| {
        walls.push(WallPlane { normal: DVec3::Y, offset: -0.6 });
        walls
    })
}

fn scene() -> impl Strategy<Value = Scene> {
    (
        (prop::collection::vec(vector(0.3), 4..24), any::<bool>(), 0.1..30.0f64),
        (vector(0.1), vector(4.0), vector(30.0), rotation()),
        prop_oneof![2 => Just(DVec3::new(0.0, -9.8, 0.0)), 1 => vector(10.0)],
        prop_oneof![Just(0.0), 0.0..1.0f64],
        material(),
        walls(),
    )
        .prop_map(|((points, solid, mass), start, gravity, drag, material, walls)| Scene {
            points,
            solid,
            mass,
            start,
            gravity,
            drag,
            material,
            walls,
            integrator: Integrator::Splitting,
            tolerance: None,
            part: 0.1,
        })
}

fn any_scene() -> impl Strategy<Value = Scene> {
    let tolerance = prop_oneof![3 => Just(None), 1 => Just(Some(1e-4))];
    (scene(), any::<bool>(), tolerance).prop_map(|(scene, euler, tolerance)| Scene {
        integrator: if euler { Integrator::Euler } else { Integrator::Splitting },
        tolerance: tolerance.filter(|_| !euler),
        ..scene
    })
}

/// The largest relative difference of two states whose second is in `units`.
fn difference(a: &State, b: &State, units: Units) -> f64 {
    let (a, b) = (&a.bodies[0], &b.bodies[0]);
    let apart = |a: DVec3, b: DVec3, unit: f64| (a - b / unit).length() / a.length().max(1.0);
    apart(a.position, b.position, units.length)
        .max(apart(a.velocity, b.velocity, units.velocity()))
        .max(apart(a.angular_momentum, b.angular_momentum, units.angular_momentum()))
        .max((a.orientation - b.orientation).length())
}

/// So many scenes, the same ones in every run: how far rounding is magnified depends on the scene, and a
/// check must not depend on luck. Another seed looks at other scenes.
fn cases(count: u32) -> ProptestConfig {
    let rng_seed = proptest::test_runner::RngSeed::Fixed(1);
    ProptestConfig { rng_seed, ..ProptestConfig::with_cases(count) }
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn energy_is_conserved_and_losses_never_decrease(scene in scene()) {
        let mut world = scene.world();
        let start = world.energy();
        let mut in_play = start.kinetic + start.elastic;
        let mut before = world.energy();
        for _ in 0..1500 {
            world.step().unwrap();
            let now = world.energy();
            in_play = in_play.max(now.kinetic + now.elastic);
            let dust = 1e-11 * in_play;
            // a dashpot feels a forecast of its mean velocity; where that is all but zero, the true one
            // may have the other sign
            let forecast = 1e-6 * in_play;
            prop_assert!(now.dashpot >= before.dashpot - forecast, "dashpots gave {:e} J of {in_play}", before.dashpot - now.dashpot);
            // a spring that turns about between two kicks gives back what the mean force had taken
            let turned = 1e-3 * in_play;
            prop_assert!(now.slip >= before.slip - turned, "slip gave {:e} J of {in_play}", before.slip - now.slip);
            prop_assert!(now.drag >= before.drag - dust, "drag gave {:e} J of {in_play}", before.drag - now.drag);
            let off = (now.total() - start.total()) / in_play;
            let (low, high) =
                if scene.material.friction_stiffness == 0.0 { (-0.01, 0.01) } else { (-0.05, 0.05) };
            prop_assert!(off > low && off < high, "total energy off by {off:e} of that in play");
            before = now;
        }
    }

    #[test]
    fn scaling_units_by_powers_of_two_does_not_change_any_bit(
        scene in any_scene(),
        exponents in (-20..=20i32, -10..=10i32, -20..=20i32),
    ) {
        let units = Units {
            length: 2f64.powi(exponents.0),
            // the root of a mass is a number of its own where the power is odd
            mass: 2f64.powi(2 * exponents.1),
            time: 2f64.powi(exponents.2),
        };
        let dt = scene.dt();
        let (mut one, mut other) = (scene.at(SI, dt), scene.at(units, dt));
        for _ in 0..300 {
            one.step().unwrap();
            other.step().unwrap();
        }
        let (a, b) = (one.state(), other.state());
        let (body, scaled) = (&a.bodies[0], &b.bodies[0]);
        prop_assert_eq!(body.position * units.length, scaled.position);
        prop_assert_eq!(body.velocity * units.velocity(), scaled.velocity);
        prop_assert_eq!(body.orientation, scaled.orientation);
        prop_assert_eq!(body.angular_momentum * units.angular_momentum(), scaled.angular_momentum);
        for (spring, scaled) in a.springs[0].iter().zip(&b.springs[0]) {
            prop_assert_eq!(spring.anchor * units.length, scaled.anchor);
        }
        prop_assert_eq!(a.springs[0].len(), b.springs[0].len());
        prop_assert_eq!(a.totals.dashpot * units.energy(), b.totals.dashpot);
        prop_assert_eq!(a.totals.slip * units.energy(), b.totals.slip);
        prop_assert_eq!(a.totals.drag * units.energy(), b.totals.drag);
        prop_assert_eq!(a.totals.max_depth * units.length, b.totals.max_depth);
    }

    #[test]
    fn scaling_units_by_powers_of_ten_changes_only_rounding(
        scene in any_scene(),
        exponents in prop::array::uniform3(prop::sample::select(vec![-6, 0, 6])),
    ) {
        let [length, mass, time] = exponents.map(|e| 10f64.powi(e));
        let units = Units { length, mass, time };
        let dt = scene.dt();
        let (mut one, mut other) = (scene.at(SI, dt), scene.at(units, dt));
        for _ in 0..200 {
            one.step().unwrap();
            other.step().unwrap();
        }
        let off = difference(one.state(), other.state(), units);
        prop_assert!(off < 1e-9, "off by {off:e}");
    }

    #[test]
    fn dropping_cached_data_does_not_change_any_bit(scene in any_scene()) {
        let mut world = scene.world();
        let mut state = world.state().clone();
        for _ in 0..300 {
            world.step().unwrap();
            step(world.model(), &mut state, &mut Scratch::default()).unwrap();
        }
        prop_assert_eq!(world.state(), &state);
    }

    #[test]
    fn an_isolated_body_conserves_its_momenta(scene in any_scene()) {
        let far = WallPlane { normal: DVec3::Y, offset: -1e6 };
        let scene = Scene { gravity: DVec3::ZERO, drag: 0.0, walls: vec![far], ..scene };
        let mut world = scene.world();
        let start = world.state().bodies[0];
        for _ in 0..300 {
            world.step().unwrap();
        }
        let end = world.state().bodies[0];
        prop_assert_eq!(end.velocity, start.velocity);
        prop_assert_eq!(end.angular_momentum, start.angular_momentum);
        let way = start.velocity * world.time();
        let off = (end.position - start.position - way).length();
        prop_assert!(off < 1e-13 * (1.0 + way.length()), "off its line by {off:e} m");
    }

    #[test]
    fn equivalent_descriptions_of_a_floor_agree(scene in any_scene(), turn in 0.1..3.0f64) {
        let floor = |walls: Vec<WallPlane>| Scene { walls, ..scene.clone() };
        let plane = floor(vec![WallPlane::new(DVec3::new(0.0, 3.0, 0.0), -1.8).unwrap()]);
        let open = |face: usize| std::array::from_fn(|i| i != face);
        let upright = WallBox {
            min: DVec3::new(-2.0, -0.6, -1.0),
            max: DVec3::ONE,
            orientation: DQuat::IDENTITY,
            open: open(2),
        };
        // −x of this box looks up: about z by a right angle, and about y by any
        let orientation = DQuat::from_rotation_y(turn) * DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let turned = WallBox { min: DVec3::new(-0.6, -1.0, -1.0), orientation, open: open(0), ..upright };
        let mut worlds = [plane, floor(upright.planes()), floor(turned.planes())].map(|s| s.at(SI, plane_dt(&scene)));
        for _ in 0..200 {
            for world in &mut worlds {
                world.step().unwrap();
            }
        }
        for other in &worlds[1..] {
            let off = difference(worlds[0].state(), other.state(), SI);
            // rounding of the walls, as far as bounces magnify it
            prop_assert!(off < 1e-10, "off by {off:e}");
        }
    }
}

/// A step for this scene on a floor alone (s).
fn plane_dt(scene: &Scene) -> f64 {
    let walls = vec![WallPlane { normal: DVec3::Y, offset: -0.6 }];
    Scene { walls, ..scene.clone() }.dt()
}

/// Numbers of any size that a double has.
fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -10.0..10.0f64,
        2 => (-300.0..300.0f64, any::<bool>())
            .prop_map(|(e, minus)| if minus { -(10f64.powf(e)) } else { 10f64.powf(e) }),
        1 => Just(0.0),
    ]
}

fn wild_vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(wild()).prop_map(DVec3::from_array)
}

proptest! {
    #![proptest_config(cases(4000))]

    #[test]
    fn a_state_that_is_not_finite_is_reported_as_an_error(
        points in prop::collection::vec(wild_vector(), 1..8),
        mass in wild(),
        start in (wild_vector(), wild_vector(), wild_vector(), rotation()),
        gravity in wild_vector(),
        (drag, k, friction, dt) in (wild(), wild(), wild(), wild()),
        damping in prop_oneof![wild().prop_map(|c| Damping::Dashpot(c.abs())), (0.0..=1.0f64).prop_map(Damping::Restitution)],
        euler in any::<bool>(),
    ) {
        let Ok(shape) = Shape::from_particles(&points) else { return Ok(()) };
        let body = Body::new(shape)
            .mass(mass.abs())
            .position(start.0)
            .velocity(start.1)
            .angular_velocity(start.2)
            .orientation(start.3);
        let world = World::builder()
            .gravity(gravity)
            .velocity_damping_stiffness(drag.abs())
            .material(Material {
                collision_stiffness: k.abs(),
                damping,
                friction_stiffness: friction.abs(),
                ..Material::default()
            })
            .integrator(if euler { Integrator::Euler } else { Integrator::Splitting })
            .dt(dt.abs())
            .force(true)
            .box_walls(&WallBox::arena())
            .body(body)
            .build();
        let Ok(mut world) = world else { return Ok(()) };
        for _ in 0..5 {
            if world.step().is_err() {
                return Ok(());
            }
            let body = &world.state().bodies[0];
            prop_assert!(body.position.is_finite() && body.velocity.is_finite());
            prop_assert!(body.orientation.is_finite() && body.angular_momentum.is_finite());
            let unit = body.orientation.length();
            prop_assert!((unit - 1.0).abs() < 1e-6, "orientation of length {unit}");
            let anchors = &world.state().springs[0];
            prop_assert!(anchors.iter().all(|s| s.anchor.is_finite()), "anchor not finite");
        }
    }
}

/// Regression: the energy of a friction spring cut by slip within a step must not be counted twice.
#[test]
fn fast_slip_is_not_counted_as_spring_energy() {
    let material =
        Material { collision_stiffness: 1e4, friction_stiffness: 0.03, ..Material::default() };
    let shape = Shape::from_particles(&[DVec3::ZERO]).unwrap();
    let sag = 9.8 / 1e4;
    let body = Body::new(shape).position(DVec3::Y * -sag).velocity(DVec3::X * 4.0);
    let floor = WallPlane { normal: DVec3::Y, offset: 0.0 };
    let mut world =
        World::builder().dt(2e-3).material(material).wall(floor).body(body).build().unwrap();
    let start = world.energy();
    for _ in 0..500 {
        world.step().unwrap();
    }
    let end = world.energy();
    let off = (end.total() - start.total()) / start.kinetic;
    // the ledger sees the friction spring half a step after it was cut: ½ k_t (v h/2)² = 0.0029 of it
    assert!(off.abs() < 5e-3, "unaccounted: {off:e} of the energy at the start");
    // v = v₀ − μ g t, and the work of μ m g along the way
    let speed = 4.0 - 0.03 * 9.8;
    let lost = 0.5 * (16.0 - speed * speed);
    assert!((end.slip / lost - 1.0).abs() < 0.01, "slip {} J of {lost}", end.slip);
}
