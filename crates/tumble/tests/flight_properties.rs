//! Properties of exact free flight: composition, conservation, and agreement with closed formulas.
#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use tumble::{
    Body, BodyState, DMat3, DQuat, DVec3, Mesh, Model, Scratch, Shape, State, World,
    for_each_batch, stage,
};

/// One flight of bodies that may be near a wall for the time `h` (s).
fn fly_step(model: &Model, state: &mut State, h: f64) {
    let mut scratch = Scratch::default();
    for_each_batch(model, state, &mut scratch, |batch| {
        batch.may_touch.fill(true);
        stage::drift(batch, h);
    });
}

/// A body of 1 kg with these principal moments (kg·m²) about x, y, z, carried by six particles in
/// pairs on the axes, so that drag slows both momenta at one rate.
fn of_particles(moments: DVec3) -> Body {
    // I_x = (b² + c²)/3 and so on, for pairs at a, b, c
    let total = 0.5 * moments.element_sum();
    let arm = |moment: f64| (3.0 * (total - moment)).max(0.0).sqrt();
    let arms = [DVec3::X * arm(moments.x), DVec3::Y * arm(moments.y), DVec3::Z * arm(moments.z)];
    let places: Vec<_> = arms.into_iter().flat_map(|a| [a, -a]).collect();
    Body::new(Shape::from_particles(&places).unwrap()).mass(1.0)
}

/// A body of 1 kg with exactly these principal moments (kg·m²) about x, y, z.
fn of_distribution(moments: DVec3) -> Body {
    let gyration = DMat3::from_diagonal(moments);
    let places = [DVec3::X, -DVec3::X];
    let shape = Shape::from_distribution(&places, Mesh::default(), DVec3::ZERO, gyration).unwrap();
    Body::new(shape).mass(1.0)
}

fn world(body: Body, omega: DVec3, drag: f64) -> World {
    let body = body.angular_velocity(omega).velocity(DVec3::new(1.0, 2.0, -0.5));
    let free = World::builder().gravity(DVec3::ZERO).velocity_damping_stiffness(drag);
    free.body(body).build().unwrap()
}

/// The world's body after `parts` flights that take `time` together.
fn fly(world: &World, time: f64, parts: u32) -> BodyState {
    let mut state: State = world.state().clone();
    for _ in 0..parts {
        fly_step(world.model(), &mut state, time / f64::from(parts));
    }
    state.bodies[0]
}

/// Angle between two orientations (rad).
fn angle(a: DQuat, b: DQuat) -> f64 {
    let apart = if a.dot(b) < 0.0 { a + b } else { a - b };
    2.0 * apart.length()
}

/// The length of a vector, without underflow of the squares.
fn length_of(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    if largest == 0.0 { 0.0 } else { (v / largest).length() * largest }
}

fn rotational_energy(world: &World, state: &BodyState) -> f64 {
    let rotation = DMat3::from_quat(state.orientation);
    let omega = world.model().bodies[0].angular_velocity(rotation, state.angular_momentum);
    0.5 * omega.dot(state.angular_momentum)
}

/// By how much rounding at the start may be magnified in `time` by motion near the separatrix: it
/// grows as e^(λ t), or, over many turns, as the inverse of the distance to the separatrix.
fn conditioning(world: &World, time: f64) -> f64 {
    let (model, state) = (&world.model().bodies[0], &world.state().bodies[0]);
    let axes = DMat3::from_quat(state.orientation) * model.shape.principal().axes;
    let u = axes.transpose() * state.angular_momentum;
    let length = u.length();
    if length == 0.0 {
        return 1.0;
    }
    let u = u / length;
    // the moments ascend, so their inverses descend; but zero stands for no inertia, and no spin
    let mut order: Vec<_> = (0..3).map(|i| (model.inverse_moments[i] * length, u[i])).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (ab, bc) = (order[1].0 - order[0].0, order[2].0 - order[1].0);
    let lambda = (ab * bc).sqrt();
    let side = (ab * order[0].1 * order[0].1 - bc * order[2].1 * order[2].1).abs();
    let far = (ab + bc) / side;
    (lambda * time).exp().min(far).max(1.0)
}

/// What rounding may turn the body by (rad): each of `parts` flights by a few units, and the whole
/// angle by its relative rounding.
fn rounding(world: &World, time: f64, parts: u32) -> f64 {
    let model = &world.model().bodies[0];
    let spin =
        model.inverse_moments.max_element() * world.state().bodies[0].angular_momentum.length();
    let turned = spin * time;
    1e-15 * (10.0 + f64::from(parts) + 4.0 * turned) * conditioning(world, time)
}

fn log_uniform(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

fn direction() -> impl Strategy<Value = DVec3> {
    prop_oneof![
        4 => prop::array::uniform3(-1.0..1.0f64)
            .prop_map(DVec3::from_array)
            .prop_filter("not zero", |v| v.length() > 0.1)
            .prop_map(DVec3::normalize),
        1 => prop::sample::select(vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_Y]),
    ]
}

/// Moments that some distribution of mass can have: each at most the sum of the others.
fn moments() -> impl Strategy<Value = DVec3> {
    let shape = prop_oneof![
        // second moments along the axes, each 0 or more: the triangle inequality holds
        4 => prop::array::uniform3(0.01..1.0f64)
            .prop_map(|[a, b, c]| DVec3::new(b + c, c + a, a + b)),
        // oblate and prolate, about any axis
        2 => (0.1..2.0f64, 0..3usize).prop_map(|(axial, axis)| {
            let mut m = DVec3::ONE;
            m[axis] = axial;
            m
        }),
        1 => Just(DVec3::ONE),
        // in a plane
        1 => (0.05..1.0f64).prop_map(|a| DVec3::new(a, 1.0, 1.0 + a)),
        // symmetric but for the twelfth digit
        1 => (0.1..1.9f64).prop_map(|a| DVec3::new(1.0, 1.0 + 1e-12, a)),
        // on a line
        1 => Just(DVec3::new(0.0, 1.0, 1.0)),
        1 => Just(DVec3::new(1.0, 0.0, 1.0)),
        // at a point
        1 => Just(DVec3::ZERO),
    ];
    (shape, log_uniform(1e-3, 1e3)).prop_map(|(m, scale)| m * scale)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn one_flight_equals_many_short_ones(
        moments in moments(),
        axis in direction(),
        speed in log_uniform(1e-6, 1e4),
        time in log_uniform(1e-4, 10.0),
        parts in 2..12u32,
        drag in prop_oneof![Just(0.0), log_uniform(1e-3, 1e4)],
        carried in any::<bool>(),
    ) {
        // with drag on mass spread otherwise, flight is a splitting of its own
        let body = if carried || drag > 0.0 { of_particles(moments) } else { of_distribution(moments) };
        let world = world(body, axis * speed, drag);
        let start = world.state().bodies[0];
        let (once, often) = (fly(&world, time, 1), fly(&world, time, parts));

        let off = angle(once.orientation, often.orientation);
        let allowed = rounding(&world, time, parts);
        prop_assert!(off <= allowed, "off by {off:e} rad of {allowed:e}");

        let rate = drag / world.model().bodies[0].particle_mass();
        let left = (-rate * time).exp();
        let length = length_of(start.angular_momentum);
        for end in [&once, &often] {
            let unit = (end.orientation.length() - 1.0).abs();
            prop_assert!(unit < 3e-16, "orientation of length 1 + {unit:e}");
            let decayed = (length_of(end.angular_momentum) - length * left).abs();
            let bound = 1e-15 * (f64::from(parts) + rate * time);
            prop_assert!(decayed <= bound * length * left + 1e-300, "decay off by {decayed:e}");
            let (now, before) = (rotational_energy(&world, end), rotational_energy(&world, &start));
            let energy_off = (now - before * left * left).abs();
            let bound = 2.0 * bound + 1e-15 * (10.0 + f64::from(parts));
            prop_assert!(
                energy_off <= bound * before * left * left + 1e-300,
                "energy off by {:e}", energy_off / before / left / left
            );
        }
    }

    #[test]
    fn a_symmetric_top_precesses_regularly(
        axial in prop_oneof![0.05..1.99f64, 0.999_999..1.000_001f64],
        scale in log_uniform(1e-3, 1e3),
        axis in direction(),
        speed in log_uniform(1e-6, 1e4),
        time in log_uniform(1e-4, 10.0),
    ) {
        let moments = DVec3::new(1.0, axial, 1.0) * scale;
        let world = world(of_distribution(moments), axis * speed, 0.0);
        let momentum = world.state().bodies[0].angular_momentum;
        let found = fly(&world, time, 1).orientation;
        // L about itself at |L|/I_perp, then the spin about the body's own axis
        let precession = momentum.length() / moments.x * time;
        let spin = momentum.y * (1.0 / moments.y - 1.0 / moments.x) * time;
        let expected = DQuat::from_axis_angle(momentum.normalize(), precession)
            * DQuat::from_axis_angle(DVec3::Y, spin);
        let off = angle(found, expected);
        let allowed = 1e-15 * (10.0 + 4.0 * (precession.abs() + spin.abs()));
        prop_assert!(off <= allowed, "off by {off:e} rad of {allowed:e}");
    }

    #[test]
    fn a_body_without_spin_keeps_its_orientation(
        moments in moments(),
        drag in prop_oneof![Just(0.0), log_uniform(1e-3, 1e4)],
        time in log_uniform(1e-4, 1e6),
    ) {
        let world = world(of_particles(moments), DVec3::ZERO, drag);
        let end = fly(&world, time, 3);
        prop_assert_eq!(end.orientation, DQuat::IDENTITY);
        prop_assert_eq!(end.angular_momentum, DVec3::ZERO);
    }

    #[test]
    fn near_the_separatrix_flight_composes_and_conserves(
        // a middle axis well apart from both others
        low in 1.0..1.8f64,
        apart in 0.05..0.9f64,
        off in prop::sample::select(vec![0.0, 1e-300, 1e-160, 1e-20, 1e-12, 1e-8, 1e-4]),
        speed in log_uniform(1e-2, 1e4),
        turned in log_uniform(0.1, 3e3),
        parts in 2..9u32,
    ) {
        let moments = DVec3::new(low, low + apart, low + 2.0 * apart * 0.9);
        let omega = DVec3::new(off, 1.0, -off) * speed;
        let world = world(of_distribution(moments), omega, 0.0);
        let time = turned / speed;
        let (once, often) = (fly(&world, time, 1), fly(&world, time, parts));
        let start = world.state().bodies[0];
        for end in [&once, &often] {
            prop_assert_eq!(end.angular_momentum, start.angular_momentum);
            let drift = rotational_energy(&world, end) / rotational_energy(&world, &start) - 1.0;
            prop_assert!(drift.abs() < 1e-15 * (20.0 + turned.sqrt()), "energy drifts by {drift:e}");
        }
        if off == 0.0 {
            // exactly on the axis it stays there
            let expected = DQuat::from_axis_angle(DVec3::Y, turned);
            let found = angle(once.orientation, expected);
            prop_assert!(found <= 1e-15 * (10.0 + 4.0 * turned), "off by {found:e} rad");
        }
        let found = angle(once.orientation, often.orientation);
        let allowed = rounding(&world, time, parts);
        prop_assert!(found <= allowed, "off by {found:e} rad of {allowed:e}");
    }

    #[test]
    fn a_flight_of_a_million_revolutions_is_accurate(
        moments in moments().prop_filter("it turns", |m| m.min_element() > 0.0),
        axis in direction(),
        speed in log_uniform(1e-6, 1e4),
    ) {
        let world = world(of_distribution(moments), axis * speed, 0.0);
        let time = 1e6 * std::f64::consts::TAU / speed;
        let (once, often) = (fly(&world, time, 1), fly(&world, time, 7));
        let off = angle(once.orientation, often.orientation);
        let allowed = rounding(&world, time, 7);
        prop_assert!(off <= allowed, "off by {off:e} rad of {allowed:e}");
        let start = world.state().bodies[0];
        let drift = rotational_energy(&world, &once) / rotational_energy(&world, &start) - 1.0;
        prop_assert!(drift.abs() < 2e-14, "energy drifts by {drift:e}");
    }

    #[test]
    fn drag_on_a_solid_never_adds_energy(
        moments in moments(),
        axis in direction(),
        speed in log_uniform(1e-3, 1e4),
        drag in prop_oneof![Just(1.0), Just(1e4), log_uniform(1e-3, 1e6)],
        dt in prop_oneof![Just(1e-3), log_uniform(1e-5, 10.0)],
    ) {
        let world = world(of_distribution(moments), axis * speed, drag);
        let mut state = world.state().clone();
        let kinetic = |state: &State| tumble::Energy::new(world.model(), state).kinetic;
        let start = kinetic(&state);
        for _ in 0..50 {
            let before = kinetic(&state);
            fly_step(world.model(), &mut state, dt);
            let after = kinetic(&state);
            // what rounding left along an axis without inertia may come back as such
            let dust = 1e-30 * start;
            prop_assert!(after <= before * (1.0 + 1e-14) + dust, "kinetic energy rose: {before} {after}");
            let unaccounted = (after + state.totals.drag) / start - 1.0;
            prop_assert!(unaccounted.abs() < 1e-13, "unaccounted: {unaccounted:e}");
        }
    }
}

/// Regression: rotation about a principal axis must not be divided into substeps, whatever the angle.
#[test]
fn uniform_rotation_takes_one_step() {
    for (moments, axis) in [
        (DVec3::new(1.0, 2.0, 3.0), DVec3::Y),
        (DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.0, 0.6, 0.8)),
        (DVec3::new(1.0, 1.0, 0.3), DVec3::new(0.6, -0.8, 0.0)),
    ] {
        let world = world(of_distribution(moments), axis * 1e30, 0.0);
        let end = fly(&world, 1.0, 1);
        assert!((end.orientation.length() - 1.0).abs() < 3e-16);
        assert!(end.orientation.xyz().cross(axis).length() < 1e-12, "{}", end.orientation);
    }
}
