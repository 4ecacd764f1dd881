//! The grid against brute force.

use proptest::prelude::*;

use super::*;

/// All pairs, by testing each.
fn brute_force(balls: &[Ball]) -> Vec<[u32; 2]> {
    Order::default().brute_force(balls).to_vec()
}

/// Checks a grid, which may hold earlier balls, against brute force.
fn check(grid: &mut Grid, balls: &[Ball]) {
    assert_eq!(grid.pairs(balls), brute_force(balls));
}

fn ball(centre: DVec3, radius: f64) -> Ball {
    Ball { centre, radius, active: true }
}

/// Points of the unit cube and numbers from 0 to 1, evenly distributed.
fn spread(count: usize) -> impl Iterator<Item = (DVec3, f64)> {
    (0..count).map(|i| {
        let even = |factor: f64| (i as f64 * factor).fract();
        let place = DVec3::new(even(0.819_172_5), even(0.671_043_6), even(0.549_700_4));
        (place, even(0.754_877_666))
    })
}

/// Balls whose sizes span a factor of ten; some are inactive.
fn gravel(count: usize) -> Vec<Ball> {
    let grain = |(place, size): (DVec3, f64)| Ball {
        centre: place,
        radius: 0.06 * 10_f64.powf(-size),
        active: size < 0.7,
    };
    spread(count).map(grain).collect()
}

/// A radius of any size from 10⁻⁵ to 1, or none.
fn any_radius() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 2 => Just(0.05), 6 => (-5.0..0.0_f64).prop_map(|e| 10_f64.powf(e))]
}

/// Balls in clusters of any size, at any distance from the origin.
fn any_balls() -> impl Strategy<Value = Vec<Ball>> {
    let far =
        prop::array::uniform3((-1.0..1.0_f64, 0..4_i32).prop_map(|(x, e)| x * 10_f64.powi(3 * e)));
    let centres = prop::collection::vec((far, -6.0..1.0_f64), 1..4);
    let offset = prop::array::uniform3(-1.0..1.0_f64);
    let member = (any::<prop::sample::Index>(), offset, any_radius(), prop::bool::weighted(0.7));
    (centres, prop::collection::vec(member, 33..200)).prop_map(|(centres, members)| {
        let place =
            |(cluster, offset, radius, active): (prop::sample::Index, [f64; 3], f64, bool)| {
                let (centre, size) = cluster.get(&centres);
                let centre =
                    DVec3::from_array(*centre) + 10_f64.powf(*size) * DVec3::from_array(offset);
                Ball { centre, radius, active }
            };
        members.into_iter().map(place).collect()
    })
}

/// Balls on a lattice whose spacing is a simple fraction of the width of a cell or of a radius, so that centres lie
/// on borders of cells and balls just touch.
fn any_lattice() -> impl Strategy<Value = Vec<Ball>> {
    let parts =
        prop::sample::select(vec![0.5, 1.0, 2.0, 1.0 + 1.0 / 256.0, 2.0 + 2.0 / 256.0, 4.0]);
    let numbers = prop::collection::vec((prop::array::uniform3(-3..4_i32), 0..4_i32), 33..200);
    (parts, 0.001..10.0_f64, numbers).prop_map(|(part, radius, numbers)| {
        let place = |([x, y, z], halvings): ([i32; 3], i32)| {
            ball(
                part * radius * DVec3::new(x.into(), y.into(), z.into()),
                radius * 0.5_f64.powi(halvings),
            )
        };
        numbers.into_iter().map(place).collect()
    })
}

proptest! {
    #[test]
    fn pairs_equal_those_of_brute_force(first in any_balls(), second in any_balls()) {
        let mut grid = Grid::default();
        for balls in [&first, &second, &first] {
            check(&mut grid, balls);
        }
    }

    #[test]
    fn no_pair_is_missed_on_cell_boundaries(balls in any_lattice()) {
        check(&mut Grid::default(), &balls);
    }

    #[test]
    fn no_pair_is_missed_at_any_magnitude(
        bits in prop::collection::vec((prop::array::uniform3(any::<u64>()), any::<u64>()), 33..100),
    ) {
        // random bits as numbers; those that are not finite become 1
        let number = |bits: u64| Some(f64::from_bits(bits)).filter(|x| x.is_finite()).unwrap_or(1.0);
        let balls: Vec<Ball> =
            bits.iter().map(|(x, r)| ball(x.map(number).into(), number(*r).abs())).collect();
        check(&mut Grid::default(), &balls);
    }
}

#[test]
fn cell_indices_may_repeat() {
    // a pile, and bodies far away by whole periods, whose cell indices look like neighbours
    let mut balls = gravel(500);
    let largest = balls.iter().map(|ball| ball.radius).fold(0.0, f64::max);
    let width = 2.0 * largest * (1.0 + 1.0 / 256.0) * f64::from(1 << 21);
    for (i, (place, _)) in spread(300).enumerate() {
        let periods =
            DVec3::new(f64::from(i as u32 % 3), f64::from(i as u32 % 5), -f64::from(i as u32 % 7));
        balls.push(ball(place + width * periods, 0.03));
    }
    check(&mut Grid::default(), &balls);
}

#[test]
fn pairs_are_found_across_the_end_of_a_period() {
    // rows of touching balls that cross the end of the period, along each axis and diagonally
    for direction in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0)] {
        let period = 2.0 * (1.0 + 1.0 / 256.0) * f64::from(1 << 21);
        let row = (-40..40).map(|i| ball(direction * (period + 1.1 * f64::from(i)), 1.0));
        let fine = (-40..40).map(|i| ball(direction * (period + 1.3 * f64::from(i)), 0.2));
        let ends = [ball(DVec3::ZERO, 1.0), ball(2.0 * period * direction, 1.0)];
        let balls: Vec<Ball> = row.chain(fine).chain(ends).collect();
        let mut grid = Grid::default();
        check(&mut grid, &balls);
        assert!(grid.levels[..2].iter().all(|level| level.len() > 50));
    }
}

#[test]
fn few_balls_are_handled() {
    let mut grid = Grid::default();
    for count in [0, 1, 2, 31, 32, 33, 34] {
        check(&mut grid, &vec![ball(DVec3::ONE, 1.0); count]);
        assert_eq!(
            grid.pairs(&vec![ball(DVec3::ONE, 0.0); count]).len(),
            count * count.saturating_sub(1) / 2
        );
        assert!(grid.pairs(&vec![Ball::default(); count]).is_empty());
    }
}

#[test]
fn coincident_balls_are_all_pairs() {
    let mut grid = Grid::default();
    for radius in [0.0, 1e-300, 1.0, 1e300, f64::MAX] {
        let pairs = grid.pairs(&[ball(DVec3::splat(-3.0), radius); 2_000]);
        assert_eq!(pairs.len(), 2_000 * 1_999 / 2);
        assert!(pairs.is_sorted());
    }
}

#[test]
fn balls_of_zero_or_tiny_radius_are_separated() {
    for radius in [0.0, 1e-300, 1e-17] {
        let mut balls: Vec<Ball> = spread(5_000).map(|(place, _)| ball(place, radius)).collect();
        let mut grid = Grid::default();
        assert!(grid.pairs(&balls).is_empty());
        // and not by brute force
        assert!(grid.levels[0].max_cell_count() < 10);
        balls[4_000].centre = balls[70].centre;
        assert_eq!(grid.pairs(&balls), [[70, 4_000]]);
    }
}

#[test]
fn a_large_ball_among_small_ones_finds_all_of_them() {
    let mut balls = gravel(3_000);
    balls.insert(1_234, ball(DVec3::splat(0.5), 100.0));
    let mut grid = Grid::default();
    check(&mut grid, &balls);
    assert!(grid.pairs(&balls).len() > 3_000);
}

#[test]
fn numbers_that_are_not_finite_do_not_panic() {
    let mut balls = gravel(200);
    for (i, odd) in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -0.0].into_iter().enumerate()
    {
        balls[10 * i].centre.x = odd;
        balls[10 * i + 5].radius = odd;
        Grid::default().pairs(&balls);
    }
    Grid::default().pairs(&[ball(DVec3::NAN, f64::NAN); 100]);
}

#[test]
fn pairs_are_the_same_for_any_number_of_threads() {
    let balls = gravel(3_000);
    let expected = brute_force(&balls);
    assert!(expected.len() > 300);
    for thread_count in [1, 2, 3, 8] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count).build().unwrap();
        assert_eq!(
            pool.install(|| Grid::default().pairs(&balls).to_vec()),
            expected,
            "{thread_count}"
        );
    }
}

#[test]
fn a_reused_grid_does_not_allocate() {
    let balls = gravel(3_000);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let mut grid = Grid::default();
        grid.pairs(&balls);
        let used = allocation_counter::measure(|| {
            grid.pairs(&balls);
        });
        assert_eq!(used.count_total, 0);
    });
}
