use super::*;
const BALL: f64 = 4.0 / 3.0 * PI;

fn largest(m: DMat3) -> f64 {
    m.to_cols_array().iter().fold(0.0f64, |most, x| most.max(x.abs()))
}

/// Volume and ∫ x² of the part x < h of a unit ball, and ∫ x: by integrating π (1 − x²) slice by slice.
fn cap_integrals(h: f64) -> (f64, f64, f64) {
    let volume = |x: f64| PI * (x - x * x * x / 3.0);
    let first = |x: f64| PI * (x * x / 2.0 - x.powi(4) / 4.0);
    let second = |x: f64| PI * (x.powi(3) / 3.0 - x.powi(5) / 5.0);
    (volume(h) - volume(-1.0), first(h) - first(-1.0), second(h) - second(-1.0))
}

#[test]
fn balls_that_do_not_overlap_are_exact() {
    let centres = [DVec3::ZERO, DVec3::new(0.4, 0.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
    let found = ball_integrals(&centres, 0.2).unwrap();
    let one = BALL * 0.008;
    assert!((found.measure / (3.0 * one) - 1.0).abs() < 1e-15);
    let centre = DVec3::new(0.4, 1.0, 0.0) / 3.0;
    assert!((found.centre - centre).length() < 1e-15);
    let points = centres.iter().map(|&c| outer(c - centre, c - centre));
    let second = points.fold(DMat3::ZERO, |sum, m| sum + m) * one
        + DMat3::IDENTITY * (3.0 * one * 0.04 / 5.0);
    assert!(largest(found.second_moment - second) < 1e-15 * largest(second));
}

#[test]
fn two_balls_that_overlap_lack_a_lens() {
    let mut worst = 0.0f64;
    for distance in [0.01, 0.3, 1.0, 1.7, 1.99] {
        for axis in [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.3, -0.5, 0.8)] {
            let axis = axis.normalize();
            let found = ball_integrals(&[DVec3::ZERO, distance * axis], 1.0).unwrap();
            // the textbook's lens: π (4 + d) (2 − d)² / 12
            let volume = 2.0 * BALL - PI * (4.0 + distance) * (2.0 - distance).powi(2) / 12.0;
            worst = worst.max((found.measure / volume - 1.0).abs());
            assert!((found.centre - 0.5 * distance * axis).length() < 1e-9);
            // about the middle, along the axis
            let h = distance / 2.0;
            let (v, first, second) = cap_integrals(h);
            let along = 2.0 * (second - 2.0 * h * first + h * h * v);
            let measured = axis.dot(found.second_moment * axis);
            worst = worst.max((measured / along - 1.0).abs());
        }
    }
    assert!(worst < 2e-5, "{worst:e}");
}

#[test]
fn a_clump_of_the_corners_of_a_cube() {
    // neighbours along the edges overlap, those across the faces just do not: V = 8 balls − 12 lenses
    let corners: Vec<DVec3> = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 0.3)
        .collect();
    let (radius, distance) = (0.2, 1.5);
    let found = ball_integrals(&corners, radius).unwrap();
    let lens = PI * (4.0 + distance) * (2.0f64 - distance).powi(2) / 12.0;
    let volume = (8.0 * BALL - 12.0 * lens) * radius.powi(3);
    assert!((found.measure / volume - 1.0).abs() < 1e-6, "{}", found.measure / volume - 1.0);
    assert!((found.centre - DVec3::splat(0.15)).length() < 1e-7);
    // as round as the cube itself
    let moments = found.second_moment;
    let off = moments - DMat3::IDENTITY * moments.x_axis.x;
    assert!(largest(off) < 1e-5 * moments.x_axis.x, "{moments}");
}

#[test]
fn balls_within_each_other_and_twice_the_same_weigh_once() {
    let one = ball_integrals(&[DVec3::X], 2.0).unwrap();
    assert_eq!(ball_integrals(&[DVec3::X; 5], 2.0).unwrap(), one);
    assert!((one.measure / (8.0 * BALL) - 1.0).abs() < 1e-15);
    // a ball in the middle of a dense cluster adds next to nothing
    let ring: Vec<DVec3> = (0..12)
        .map(|i| 1e-9 * DVec3::new(f64::from(i), f64::from(i % 5), f64::from(i % 3)))
        .collect();
    let close = ball_integrals(&ring, 2.0).unwrap();
    assert!((close.measure / one.measure - 1.0).abs() < 1e-5);
}

#[test]
fn of_a_row_each_ball_shares_a_lens_with_the_next() {
    let row: Vec<DVec3> = (0..21).map(|i| DVec3::new(1e3, 0.0, 0.5 * f64::from(i))).collect();
    let found = ball_integrals(&row, 1.0).unwrap();
    let lens = PI * 4.5 * 1.5f64.powi(2) / 12.0;
    let volume = 21.0 * BALL - 20.0 * lens;
    assert!((found.measure / volume - 1.0).abs() < 1e-8, "{}", found.measure / volume - 1.0);
    assert!((found.centre - DVec3::new(1e3, 0.0, 5.0)).length() < 1e-9);
}

#[test]
fn what_takes_too_long_or_is_out_of_range_is_refused() {
    let crowd: Vec<DVec3> = (0..2000).map(|i| DVec3::X * 1e-4 * f64::from(i)).collect();
    let error = ball_integrals(&crowd, 1.0).unwrap_err();
    assert_eq!(error, BallsError::TooManyOverlaps { balls: 2000 });
    assert!(error.to_string().contains("overlap more than 25000 times"), "{error}");
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-70, 1e70] {
        assert!(matches!(ball_integrals(&crowd, radius), Err(BallsError::Radius { .. })));
    }
    // far apart beyond what doubles tell apart from each other
    let far = [DVec3::ZERO, DVec3::X * 1e30, DVec3::X * -1e30, DVec3::new(1e30, 1.0, 0.0)];
    let found = ball_integrals(&far, 1.0).unwrap();
    assert!(found.second_moment.is_finite());
}

#[test]
fn of_dense_rows_and_blocks_the_crossings_may_be_left_out() {
    // twenty neighbours each, all about one axis and about none of z's
    let axis = DVec3::new(0.6, 0.48, 0.64);
    let row: Vec<DVec3> = (0..60).map(|i| axis * 0.19 * f64::from(i)).collect();
    let found = ball_integrals(&row, 1.0).unwrap();
    let lens = PI * 4.19 * 1.81f64.powi(2) / 12.0;
    let volume = 60.0 * BALL - 59.0 * lens;
    assert!((found.measure / volume - 1.0).abs() < 1e-4, "{}", found.measure / volume - 1.0);
    // a block in two places, turned: as large, with the same moments
    let block = |turn: glam::DQuat, shift: DVec3| {
        let place = |i: i32| DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9));
        let places: Vec<DVec3> = (0..27).map(|i| turn * (place(i) * 0.8) + shift).collect();
        ball_integrals(&places, 1.0).unwrap()
    };
    let here = block(glam::DQuat::IDENTITY, DVec3::ZERO);
    let there = block(glam::DQuat::from_xyzw(0.1, 0.5, -0.3, 0.8).normalize(), DVec3::X * 50.0);
    assert!((here.measure / there.measure - 1.0).abs() < 1e-4);
    let trace = |i: &Integrals| i.second_moment.to_cols_array_2d();
    let sum = |m: [[f64; 3]; 3]| m[0][0] + m[1][1] + m[2][2];
    assert!((sum(trace(&here)) / sum(trace(&there)) - 1.0).abs() < 1e-4);
}
