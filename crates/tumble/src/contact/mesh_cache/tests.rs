//! Bounds on the motion of particles relative to a mesh, and how long lists stay valid.

use glam::DQuat;
use proptest::prelude::*;

use super::*;
use crate::ContactKind;
use crate::state::pair_order;

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
}

fn pose(translation: DVec3, rotation: DVec3, extent: f64) -> RelativePose {
    let rotation = DMat3::from_quat(DQuat::from_scaled_axis(rotation));
    RelativePose { rotation, translation, extent, rounding: 1e-15 }
}

proptest! {
    #[test]
    fn no_particle_moves_farther_than_the_bound(
        translations in [vector(1.0), vector(1.0)],
        rotations in [vector(3.0), vector(3.0)],
        point in vector(1.0),
        nearness in 0.0..1.0f64,
    ) {
        let extent = 0.3;
        let point = point.clamp_length_max(1.0) * extent;
        // from far apart to nearly the same
        let before = pose(translations[0], rotations[0], extent);
        let part = nearness.powi(6);
        let after = pose(
            translations[0].lerp(translations[1], part),
            rotations[0].lerp(rotations[1], part),
            extent,
        );
        let position = |pose: &RelativePose| pose.translation + pose.rotation * point;
        let displacement = position(&before).distance(position(&after));
        let bound = after.max_displacement(&before);
        prop_assert!(displacement <= bound, "{} and {}", displacement, bound);
    }
}

#[test]
fn a_list_is_valid_until_its_margin_is_used_up() {
    let order = pair_order(0, 1, ContactKind::PointMesh);
    let at = |x: f64| pose(DVec3::X * x, DVec3::ZERO, 0.1);
    let (mut first, mut second, mut third) = Default::default();
    let margin = MeshCache::add_pair(&mut first, &MeshCache::default(), order, &at(0.0), 1.0);
    assert_eq!(margin, Some(MARGIN_FACTOR));
    assert_eq!(first.finish_pair(3 * BLOCK + 1), 0);
    *first.block_clear_until(0, 3) = 7.0;
    // half of the margin is left, and then none
    let half = at(0.5 * (MARGIN_FACTOR - 1.0));
    assert_eq!(MeshCache::add_pair(&mut second, &first, order, &half, 1.0), None);
    assert_eq!((second.finish_pair(0), *second.block_clear_until(0, 3)), (0, 7.0));
    let used_up = at(MARGIN_FACTOR - 1.0);
    let margin = MeshCache::add_pair(&mut third, &second, order, &used_up, 1.0);
    assert_eq!(margin, Some(MARGIN_FACTOR));
    // points that are listed again are queried again
    third.finish_pair(1);
    assert_eq!((*third.block_clear_until(0, 0), third.block_clear_until.len()), (0.0, 1));
}

#[test]
fn the_relative_path_ignores_common_motion() {
    let order = pair_order(0, 1, ContactKind::PointMesh);
    let mut cache = MeshCache::default();
    let (near, away) = (pose(DVec3::X, DVec3::ZERO, 0.1), pose(DVec3::X * 1.5, DVec3::Z, 0.1));
    cache.add_pair(&MeshCache::default(), order, &near, 1.0);
    let pair = cache.finish_pair(1);
    let (start, _) = cache.advance(pair, &near, 0.0);
    let (fallen, _) = cache.advance(pair, &near, 100.0);
    assert!((fallen - start).abs() < 1e-12, "{fallen}");
    // at most as far as both bodies have moved
    let (moved, _) = cache.advance(pair, &away, 100.5);
    assert!((moved - fallen - 0.5).abs() < 1e-12, "{moved}");
    let (back, _) = cache.advance(pair, &near, 200.0);
    assert!(back > moved + 0.5 && back < moved + 1.0, "{back}");
}
