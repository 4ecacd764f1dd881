//! Unions of spheres against closed formulas.

use super::*;

/// Volume of the unit sphere.
const UNIT_VOLUME: f64 = 4.0 / 3.0 * PI;

fn largest(m: DMat3) -> f64 {
    m.to_cols_array().iter().fold(0.0f64, |max, x| max.max(x.abs()))
}

/// Volume, ∫ x and ∫ x² of the part x < h of the unit sphere, by integrating over slices of area π (1 − x²).
fn cap_integrals(h: f64) -> (f64, f64, f64) {
    let volume = |x: f64| PI * (x - x * x * x / 3.0);
    let first = |x: f64| PI * (x * x / 2.0 - x.powi(4) / 4.0);
    let second = |x: f64| PI * (x.powi(3) / 3.0 - x.powi(5) / 5.0);
    (volume(h) - volume(-1.0), first(h) - first(-1.0), second(h) - second(-1.0))
}

#[test]
fn spheres_that_do_not_overlap_are_exact() {
    let centres = [DVec3::ZERO, DVec3::new(0.4, 0.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
    let found = sphere_union_integrals(&centres, 0.2).unwrap();
    let one = UNIT_VOLUME * 0.008;
    assert!((found.measure / (3.0 * one) - 1.0).abs() < 1e-15);
    let centre = DVec3::new(0.4, 1.0, 0.0) / 3.0;
    assert!((found.centre - centre).length() < 1e-15);
    let points = centres.iter().map(|&c| outer(c - centre, c - centre));
    let second = points.fold(DMat3::ZERO, |sum, m| sum + m) * one
        + DMat3::IDENTITY * (3.0 * one * 0.04 / 5.0);
    assert!(largest(found.second_moment - second) < 1e-15 * largest(second));
}

#[test]
fn two_overlapping_spheres_lack_the_volume_of_their_lens() {
    let mut worst = 0.0f64;
    for distance in [0.01, 0.3, 1.0, 1.7, 1.99] {
        for axis in [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.3, -0.5, 0.8)] {
            let axis = axis.normalize();
            let found = sphere_union_integrals(&[DVec3::ZERO, distance * axis], 1.0).unwrap();
            // the volume of the lens: π (4 + d) (2 − d)² / 12
            let volume =
                2.0 * UNIT_VOLUME - PI * (4.0 + distance) * (2.0 - distance).powi(2) / 12.0;
            worst = worst.max((found.measure / volume - 1.0).abs());
            assert!((found.centre - 0.5 * distance * axis).length() < 1e-14);
            // second moment about the middle, along the axis
            let h = distance / 2.0;
            let (v, first, second) = cap_integrals(h);
            let along = 2.0 * (second - 2.0 * h * first + h * h * v);
            let measured = axis.dot(found.second_moment * axis);
            worst = worst.max((measured / along - 1.0).abs());
            // and across it, by slices of second moment π (1 − x²)²/4
            let slices = |x: f64| PI / 4.0 * (x - 2.0 * x.powi(3) / 3.0 + x.powi(5) / 5.0);
            let across = 2.0 * (slices(h) - slices(-1.0));
            let normal = axis.any_orthonormal_vector();
            worst = worst.max((normal.dot(found.second_moment * normal) / across - 1.0).abs());
        }
    }
    assert!(worst < 1e-14, "{worst:e}");
}

/// Spheres on a line are a solid of revolution of discs of radius √(1 − x²), whatever the number of spheres that overlap.
#[test]
fn spheres_on_a_line_are_a_solid_of_revolution() {
    let primitives = |x: f64| {
        let (x3, x5) = (x.powi(3), x.powi(5));
        [
            PI * (x - x3 / 3.0),
            PI * (x * x / 2.0 - x.powi(4) / 4.0),
            PI * (x3 / 3.0 - x5 / 5.0),
            PI / 4.0 * (x - 2.0 * x3 / 3.0 + x5 / 5.0),
        ]
    };
    let mut worst = 0.0f64;
    for (count, distance) in [(3, 0.9), (5, 0.5), (4, 0.1), (12, 0.3)] {
        let centres = |i: i32| distance * (f64::from(i) - 0.5 * f64::from(count - 1));
        let (mut volume, mut along, mut across) = (0.0, 0.0, 0.0);
        for i in 0..count {
            let low = if i == 0 { -1.0 } else { -0.5 * distance };
            let high = if i == count - 1 { 1.0 } else { 0.5 * distance };
            let [a, b] = [primitives(low), primitives(high)];
            let c = centres(i);
            let [v, first, second, q] = std::array::from_fn(|n| b[n] - a[n]);
            volume += v;
            along += second + 2.0 * c * first + c * c * v;
            across += q;
        }
        for axis in [DVec3::Z, DVec3::X, DVec3::new(0.3, -0.5, 0.8), DVec3::new(1e-3, 1.0, 0.02)] {
            let axis = axis.normalize();
            let places: Vec<DVec3> = (0..count).map(|i| axis * centres(i)).collect();
            let found = sphere_union_integrals(&places, 1.0).unwrap();
            let normal = axis.any_orthonormal_vector();
            let moment = |n: DVec3| n.dot(found.second_moment * n);
            worst = worst
                .max((found.measure / volume - 1.0).abs())
                .max((moment(axis) / along - 1.0).abs())
                .max((moment(normal) / across - 1.0).abs())
                .max(found.centre.length());
        }
    }
    assert!(worst < 1e-7, "{worst:e}");
}

/// Turned clumps have the same integrals, although other circles cut them.
#[test]
fn the_integrals_of_random_clumps_turn_with_them() {
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f64 / (1u64 << 24) as f64 - 0.5
    };
    let mut worst = 0.0f64;
    for count in [3, 4, 8, 12, 24] {
        let places: Vec<DVec3> =
            (0..count).map(|_| DVec3::new(random(), random(), random()) * 2.5).collect();
        let here = sphere_union_integrals(&places, 1.0).unwrap();
        let turn = glam::DQuat::from_xyzw(random(), random(), random(), random()).normalize();
        let turned: Vec<DVec3> = places.iter().map(|&place| turn * place).collect();
        let there = sphere_union_integrals(&turned, 1.0).unwrap();
        let matrix = DMat3::from_quat(turn);
        let expected = matrix * here.second_moment * matrix.transpose();
        let scale = largest(expected);
        worst = worst
            .max((here.measure / there.measure - 1.0).abs())
            .max((turn * here.centre - there.centre).length())
            .max(largest(expected - there.second_moment) / scale);
    }
    assert!(worst < 1e-6, "{worst:e}");
}

#[test]
fn a_clump_of_spheres_at_the_corners_of_a_cube_lacks_twelve_lenses() {
    // neighbours along the edges overlap, those along the face diagonals do not
    let corners: Vec<DVec3> = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 0.3)
        .collect();
    let (radius, distance) = (0.2, 1.5);
    let found = sphere_union_integrals(&corners, radius).unwrap();
    let lens = PI * (4.0 + distance) * (2.0f64 - distance).powi(2) / 12.0;
    let volume = (8.0 * UNIT_VOLUME - 12.0 * lens) * radius.powi(3);
    assert!((found.measure / volume - 1.0).abs() < 1e-14, "{}", found.measure / volume - 1.0);
    assert!((found.centre - DVec3::splat(0.15)).length() < 1e-14);
    // isotropic, like the cube
    let moments = found.second_moment;
    let off = moments - DMat3::IDENTITY * moments.x_axis.x;
    assert!(largest(off) < 1e-14 * moments.x_axis.x, "{moments}");
}

#[test]
fn coincident_and_nearly_coincident_spheres_count_once() {
    let one = sphere_union_integrals(&[DVec3::X], 2.0).unwrap();
    assert_eq!(sphere_union_integrals(&[DVec3::X; 5], 2.0).unwrap(), one);
    assert!((one.measure / (8.0 * UNIT_VOLUME) - 1.0).abs() < 1e-15);
    // spheres within 1e-8 of each other add almost nothing
    let ring: Vec<DVec3> = (0..12)
        .map(|i| 1e-9 * DVec3::new(f64::from(i), f64::from(i % 5), f64::from(i % 3)))
        .collect();
    let close = sphere_union_integrals(&ring, 2.0).unwrap();
    assert!((close.measure / one.measure - 1.0).abs() < 1e-5);
}

#[test]
fn each_sphere_of_a_row_shares_a_lens_with_the_next() {
    let row: Vec<DVec3> = (0..21).map(|i| DVec3::new(1e3, 0.0, 0.5 * f64::from(i))).collect();
    let found = sphere_union_integrals(&row, 1.0).unwrap();
    let lens = PI * 4.5 * 1.5f64.powi(2) / 12.0;
    let volume = 21.0 * UNIT_VOLUME - 20.0 * lens;
    assert!((found.measure / volume - 1.0).abs() < 1e-8, "{}", found.measure / volume - 1.0);
    assert!((found.centre - DVec3::new(1e3, 0.0, 5.0)).length() < 1e-9);
}

#[test]
fn too_many_overlaps_and_radii_out_of_range_are_refused() {
    let many: Vec<DVec3> = (0..2000).map(|i| DVec3::X * 1e-4 * f64::from(i)).collect();
    let error = sphere_union_integrals(&many, 1.0).unwrap_err();
    assert_eq!(error, SphereUnionError::TooManyOverlaps { balls: 2000 });
    assert!(error.to_string().contains("overlap more than 25000 times"), "{error}");
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-70, 1e70] {
        assert!(matches!(
            sphere_union_integrals(&many, radius),
            Err(SphereUnionError::Radius { .. })
        ));
    }
    // so far apart that doubles do not resolve a sphere
    let far = [DVec3::ZERO, DVec3::X * 1e30, DVec3::X * -1e30, DVec3::new(1e30, 1.0, 0.0)];
    let found = sphere_union_integrals(&far, 1.0).unwrap();
    assert!(found.second_moment.is_finite());
}

#[test]
fn dense_rows_and_blocks_are_accurate_without_rim_crossings() {
    // twenty neighbours each, along an axis other than z
    let axis = DVec3::new(0.6, 0.48, 0.64);
    let row: Vec<DVec3> = (0..60).map(|i| axis * 0.19 * f64::from(i)).collect();
    let found = sphere_union_integrals(&row, 1.0).unwrap();
    let lens = PI * 4.19 * 1.81f64.powi(2) / 12.0;
    let volume = 60.0 * UNIT_VOLUME - 59.0 * lens;
    assert!((found.measure / volume - 1.0).abs() < 1e-6, "{}", found.measure / volume - 1.0);
    // a block and its rotated copy have the same volume and trace
    let block = |turn: glam::DQuat, shift: DVec3| {
        let place = |i: i32| DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9));
        let places: Vec<DVec3> = (0..27).map(|i| turn * (place(i) * 0.8) + shift).collect();
        sphere_union_integrals(&places, 1.0).unwrap()
    };
    let here = block(glam::DQuat::IDENTITY, DVec3::ZERO);
    let there = block(glam::DQuat::from_xyzw(0.1, 0.5, -0.3, 0.8).normalize(), DVec3::X * 50.0);
    assert!((here.measure / there.measure - 1.0).abs() < 1e-6);
    let trace = |i: &Integrals| i.second_moment.to_cols_array_2d();
    let sum = |m: [[f64; 3]; 3]| m[0][0] + m[1][1] + m[2][2];
    assert!((sum(trace(&here)) / sum(trace(&there)) - 1.0).abs() < 1e-6);
}
