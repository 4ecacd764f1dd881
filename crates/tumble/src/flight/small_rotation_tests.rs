//! The series with a fixed number of terms against the general formulas.

use glam::DVec3;
use proptest::prelude::*;

use super::free_rotation::any_rotation;
use super::small_rotation::{ELEVEN, SQUARES, small_rotation};

fn inverse() -> impl Strategy<Value = DVec3> {
    let nearly = prop::array::uniform3(0.0..1.0f64);
    prop_oneof![
        4 => prop::array::uniform3(0.0..1.0f64).prop_map(DVec3::from_array),
        // nearly equal, down to rounding
        2 => (nearly, -16.0..-1.0f64)
            .prop_map(|(a, e)| DVec3::ONE + DVec3::from_array(a) * 10f64.powf(e)),
        // needle and disc
        2 => (0.0..0.1f64, 1.0..1e3f64).prop_map(|(a, b)| DVec3::new(b, 1.0, 1.0 + a)),
        2 => (0.0..1e-6f64).prop_map(|a| DVec3::new(1.0, 0.5, 0.5 + a)),
        // sphere, line, plane, point
        1 => Just(DVec3::ONE),
        1 => Just(DVec3::new(0.0, 1.0, 1.0)),
        1 => Just(DVec3::new(1.0, 1.0, 0.0)),
        1 => Just(DVec3::ZERO),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    /// Both have errors of a few roundings, and the general formulas stop at terms of 1e-18.
    #[test]
    fn small_rotations_agree_with_the_general_formulas(
        inverse in inverse(),
        axis in prop::array::uniform3(-1.0..1.0f64),
        thin in prop::array::uniform3(prop_oneof![3 => Just(0.0), 1 => -30.0..0.0f64]),
        angle in (-12.0..0.0f64).prop_map(|e| 10f64.powf(e)),
        scales in (-60.0..60.0f64, -20.0..20.0f64),
        backwards in any::<bool>(),
    ) {
        let [size, pace] = [scales.0, scales.1].map(|e| 10f64.powf(e));
        let momentum = DVec3::from_array(axis) * DVec3::from_array(thin.map(|e| 10f64.powf(e)));
        let spin = (inverse * momentum).length();
        prop_assume!(momentum.length() > 0.0 && (spin > 0.0 || inverse == DVec3::ZERO));
        let time = if spin > 0.0 { angle / spin } else { angle };
        let time = if backwards { -time } else { time };
        let arguments = (inverse / size, momentum * (size * pace), time / pace);
        let general = any_rotation(arguments.0, arguments.1, arguments.2);
        if let Some(small) = small_rotation(arguments.0, arguments.1, arguments.2) {
            let length = general.vector.length();
            let error = (small.vector - general.vector).length();
            prop_assert!(error <= 3e-15 * length + 2e-18, "error by {:e} of {length:e}", error / length);
            let error = (small.scalar - general.scalar).abs();
            prop_assert!(error <= 3e-16 * length + 2e-18, "scalar error by {:e} of {length:e}", error / length);
        } else {
            let range = inverse.max_element() - inverse.min_element();
            let epsilon = 0.5 * range * momentum.length() * time.abs();
            let out_of_range = !SQUARES.contains(&arguments.1.length_squared());
            prop_assert!(
                epsilon > 0.99 * ELEVEN || angle > 0.12 || out_of_range,
                "{epsilon:e} was refused"
            );
        }
    }
}

#[test]
fn momenta_whose_squares_overflow_or_underflow_need_the_general_formulas() {
    let inverse = DVec3::new(1.0, 2.0, 3.0);
    for size in [1e-200, 1e200, f64::INFINITY, f64::NAN] {
        assert!(small_rotation(inverse / size, DVec3::ONE * size, 1e-3).is_none(), "{size}");
    }
}
