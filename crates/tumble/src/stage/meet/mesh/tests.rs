//! How far particles may have come, and how long lists hold.

use glam::DQuat;
use proptest::prelude::*;

use super::*;
use crate::ContactKind;
use crate::state::pair_order;

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
}

fn view(way: DVec3, turn: DVec3, extent: f64) -> View {
    let turn = DMat3::from_quat(DQuat::from_scaled_axis(turn));
    View { turn, way, extent, rounding: 1e-15 }
}

proptest! {
    #[test]
    fn no_particle_comes_farther_than_is_thought(
        ways in [vector(1.0), vector(1.0)],
        turns in [vector(3.0), vector(3.0)],
        point in vector(1.0),
        nearness in 0.0..1.0f64,
    ) {
        let extent = 0.3;
        let point = point.clamp_length_max(1.0) * extent;
        // from far apart to nearly the same
        let before = view(ways[0], turns[0], extent);
        let part = nearness.powi(6);
        let after = view(ways[0].lerp(ways[1], part), turns[0].lerp(turns[1], part), extent);
        let place = |view: &View| view.way + view.turn * point;
        let way = place(&before).distance(place(&after));
        prop_assert!(way <= after.travel(&before), "{} and {}", way, after.travel(&before));
    }
}

#[test]
fn a_list_holds_until_its_room_is_used_up() {
    let key = pair_order(0, 1, ContactKind::FirstInSecond);
    let at = |x: f64| view(DVec3::X * x, DVec3::ZERO, 0.1);
    let (mut first, mut second, mut third) = Default::default();
    let room = Known::list(&mut first, &Known::default(), key, &at(0.0), 1.0);
    assert_eq!(room, Some(ROOM));
    assert_eq!(first.finish(3 * BLOCK + 1), 0);
    *first.of_block(0, 3) = 7.0;
    // half of the room is left, and then none
    assert_eq!(Known::list(&mut second, &first, key, &at(0.5 * (ROOM - 1.0)), 1.0), None);
    assert_eq!((second.finish(0), *second.of_block(0, 3)), (0, 7.0));
    assert_eq!(Known::list(&mut third, &second, key, &at(ROOM - 1.0), 1.0), Some(ROOM));
    // what is listed anew is looked at, on the same clock
    third.finish(1);
    assert_eq!((*third.of_block(0, 0), third.quiet.len()), (0.0, 1));
}

#[test]
fn the_clock_of_a_pair_knows_nothing_of_what_both_have_in_common() {
    let key = pair_order(0, 1, ContactKind::FirstInSecond);
    let mut known = Known::default();
    let (near, away) = (view(DVec3::X, DVec3::ZERO, 0.1), view(DVec3::X * 1.5, DVec3::Z, 0.1));
    known.list(&Known::default(), key, &near, 1.0);
    let listing = known.finish(1);
    let (start, _) = known.time(listing, &near, 0.0);
    let (fallen, _) = known.time(listing, &near, 100.0);
    assert!((fallen - start).abs() < 1e-12, "{fallen}");
    // as far as both have travelled at most
    let (moved, _) = known.time(listing, &away, 100.5);
    assert!((moved - fallen - 0.5).abs() < 1e-12, "{moved}");
    let (back, _) = known.time(listing, &near, 200.0);
    assert!(back > moved + 0.5 && back < moved + 1.0, "{back}");
}
