//! Queries of the tree against a plain loop over the particles.

use glam::{DMat3, DQuat};
use proptest::prelude::*;

use super::*;
use crate::lanes::levels;

/// The same sums, one particle after the other.
fn plain(
    particles: &Particles,
    function: &AffineFunction,
    within: Option<&AffineFunction>,
) -> (AffineSums, f64) {
    let (mut sums, mut largest) = (AffineSums::default(), 0.0f64);
    for (index, place) in particles.iter().enumerate() {
        let value = function.at(place);
        if value > 0.0 && within.is_none_or(|within| within.at(place) > 0.0) {
            let share = value * particles.weight(index);
            sums.count += particles.weight(index);
            sums.sum += share;
            sums.moment += place * share;
            sums.squares += value * share;
        }
        largest = largest.max(value);
    }
    (sums, largest)
}

/// Test points: a cloud, a sphere, a plane of any orientation, a line, or a few positions repeated.
fn places(kind: u8, count: usize, seeds: &[DVec3]) -> Vec<DVec3> {
    let turn =
        DMat3::from_quat(DQuat::from_rotation_arc(DVec3::X, seeds[0].normalize_or(DVec3::X)));
    let one = |i: usize| {
        // a quasi-random sequence in the cube from −1 to 1
        let spread = |factor: f64| 2.0 * ((i as f64 + 1.0) * factor).fract() - 1.0;
        let p = DVec3::new(spread(0.819_172_513), spread(0.671_043_607), spread(0.549_700_478));
        match kind {
            0 => p,
            1 => p.normalize_or(DVec3::X),
            2 => turn * DVec3::new(0.3, p.y, p.z),
            3 => turn * DVec3::new(p.x, 0.2, -0.1),
            _ => seeds[i % seeds.len()],
        }
    };
    (0..count).map(one).collect()
}

fn vector() -> impl Strategy<Value = DVec3> {
    [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
}

/// Test weights: none, all one, uniform with some zero or nearly zero, or a few much heavier than the rest.
fn weights(kind: u8, count: usize) -> Option<Vec<f64>> {
    let one = |i: usize| {
        let even = ((i as f64 + 1.0) * 0.754_877_666).fract();
        match kind {
            1 => 1.0,
            2 if i.is_multiple_of(5) => 0.0,
            2 if i.is_multiple_of(7) => 1e-300 * even,
            2 => 2.0 * even,
            _ if i.is_multiple_of(97) => 100.0 * even,
            _ => 1e-3 * even,
        }
    };
    (kind > 0).then(|| (0..count).map(one).collect())
}

fn check(
    places: &[DVec3],
    function: &AffineFunction,
    within: Option<&AffineFunction>,
) -> Result<(), TestCaseError> {
    check_all(&Particles::new(places.iter().copied()), function, within)
}

fn check_all(
    particles: &Particles,
    function: &AffineFunction,
    within: Option<&AffineFunction>,
) -> Result<(), TestCaseError> {
    let places: Vec<DVec3> = particles.iter().collect();
    let weight: f64 = (0..places.len()).map(|i| particles.weight(i)).sum();
    let (expected, largest) = plain(particles, function, within);
    // bounds from rounding of the sums and of their arguments
    let reach = places.iter().fold(0.0f64, |m, p| m.max(p.length()));
    let size = function.offset.abs() + function.slope.length() * reach;
    let play = 1e-12 * expected.sum + 1e-15 * size * weight;
    let best = particles.sums(levels()[0], function, within);
    prop_assert!((best.sum - expected.sum).abs() <= play, "{best:?} {expected:?}");
    prop_assert!((best.moment - expected.moment).length() <= play * reach, "{best:?} {expected:?}");
    prop_assert!((best.squares - expected.squares).abs() <= play * size, "{best:?} {expected:?}");
    let found = particles.largest(levels()[0], function);
    if let (Some(exact), None) = (best.largest, within) {
        prop_assert!((exact - largest).abs() <= 1e-14 * size, "{exact} {largest}");
    }
    prop_assert!(found <= largest * (1.0 + 1e-14) + 1e-14 * size, "{found} {largest}");
    prop_assert!(found >= largest * (1.0 - 1.1e-4) - 1e-14 * size, "{found} {largest}");
    // the list has all particles with clearly positive values, and none with others
    let mut slots = Vec::new();
    particles.collect_positive_slots(levels()[0], function, &mut slots);
    prop_assert!(slots.is_sorted_by(|a, b| a < b));
    prop_assert!(slots.iter().all(|&slot| function.at(particles.at(slot)) > 0.0));
    let clear = places.iter().filter(|p| function.at(**p) > 1e-7 * size).count();
    prop_assert!(slots.len() >= clear, "{} {clear}", slots.len());
    // the same bits at every SIMD level
    for level in levels() {
        prop_assert_eq!(particles.sums(level, function, within), best, "{:?}", level);
        prop_assert_eq!(particles.largest(level, function), found, "{:?}", level);
        let mut again = Vec::new();
        particles.collect_positive_slots(level, function, &mut again);
        prop_assert_eq!(&again, &slots, "{:?}", level);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn sums_agree_with_a_plain_loop(
        kind in 0u8..5,
        count in prop_oneof![1usize..40, 100usize..3000],
        seeds in prop::collection::vec(vector(), 3),
        slope in vector(),
        offset in -1.5..1.5f64,
        other in prop::option::of((vector(), -1.0..1.0f64)),
        on_a_particle in any::<bool>(),
        size in prop_oneof![Just(1.0), Just(1e-100), Just(1e100)],
        weigh in 0u8..4,
    ) {
        let places = places(kind, count, &seeds);
        let mut function = AffineFunction { offset, slope };
        let mut other = other.map(|(slope, offset)| AffineFunction { offset, slope });
        if on_a_particle {
            function.offset = slope.dot(places[count / 2]);
            other = other.map(|r| AffineFunction { offset: r.slope.dot(places[count / 3]), ..r });
        }
        let function = AffineFunction { offset: function.offset * size, slope: function.slope * size };
        let mut particles = Particles::new(places.iter().copied());
        if let Some(weights) = weights(weigh, count) {
            particles = particles.with_weights(&weights);
        }
        check_all(&particles, &function, other.as_ref())?;
    }

    #[test]
    fn sums_over_a_flat_face_on_a_wall_agree_with_a_plain_loop(
        seed in vector(),
        depth in prop_oneof![Just(0.0), 1e-6..1e-3f64],
    ) {
        let places = places(2, 5000, &[seed]);
        let normal = seed.normalize_or(DVec3::X);
        check(&places, &AffineFunction { offset: 0.3 + depth, slope: normal }, None)?;
    }
}

#[test]
fn sums_over_a_million_particles_agree_with_a_plain_loop() {
    let places = places(1, 1_000_000, &[DVec3::X]);
    let slope = DVec3::new(0.36, -0.48, 0.8);
    check(&places, &AffineFunction { offset: -0.9, slope }, None).unwrap();
    let other = AffineFunction { offset: 0.1, slope: DVec3::new(0.1, 0.9, -0.2) };
    check(&places, &AffineFunction { offset: 0.2, slope }, Some(&other)).unwrap();
}

#[test]
fn weights_do_not_change_slots_or_bounds() {
    let places = places(1, 10_000, &[DVec3::X]);
    let plain = Particles::new(places.iter().copied());
    let weighted = plain.clone().with_weights(&weights(2, places.len()).unwrap());
    assert_eq!(plain.nodes(), weighted.nodes());
    assert!((0..10_000).all(|i| plain.slot_of_index(i) == weighted.slot_of_index(i)));
    assert_eq!((plain.weight(1), weighted.weight(0)), (1.0, 0.0));
    let function = AffineFunction { offset: -0.2, slope: DVec3::new(0.36, -0.48, 0.8) };
    assert_eq!(plain.largest(levels()[0], &function), weighted.largest(levels()[0], &function));
    // particles of zero weight contribute nothing
    let nothing = plain.with_weights(&[0.0; 10_000]);
    assert_eq!(nothing.sums(levels()[0], &function, None).sum, 0.0);
    assert_eq!(
        nothing.sums(levels()[0], &AffineFunction { offset: 9.0, ..function }, None).sum,
        0.0
    );
}

#[test]
fn the_root_of_a_tilted_flat_face_close_to_a_wall_is_not_opened() {
    // the box alone would be as thick as the face is wide
    let places = places(2, 100_000, &[DVec3::new(1.0, 1.0, 1.0)]);
    let slope = DVec3::ONE.normalize();
    let particles = Particles::new(places.iter().copied());
    let root = &particles.nodes()[0];
    assert_eq!(root.coverage(&AffineFunction { offset: 0.3 + 1e-4, slope }, false), Coverage::All);
    assert_eq!(root.coverage(&AffineFunction { offset: 0.3 - 1e-4, slope }, false), Coverage::None);
}

#[test]
fn particles_on_the_zero_plane_of_the_other_ramp_do_not_count() {
    let layer: Vec<_> = (0..1000)
        .map(|i| DVec3::new(f64::from(i % 32) * 0.25, 0.0, f64::from(i / 32) * 0.25))
        .collect();
    let particles = Particles::new(layer);
    let function = AffineFunction { offset: 1.0, slope: DVec3::ZERO };
    let on = AffineFunction { offset: 0.0, slope: DVec3::Y };
    assert_eq!(particles.sums(levels()[0], &function, Some(&on)).sum, 0.0);
}

#[test]
fn the_sums_over_no_particles_are_zero() {
    let none = Particles::default();
    let function = AffineFunction { offset: 1.0, slope: DVec3::X };
    assert_eq!(
        none.sums(levels()[0], &function, None),
        AffineSums { largest: Some(0.0), ..AffineSums::default() }
    );
    assert_eq!(none.largest(levels()[0], &function), 0.0);
}
