//! A particle of one body and the mesh of another.

use glam::DVec3;

use super::list::{Pair, Point};
use super::pose::Pose;
use crate::BodyModel;

/// Where a particle touches the mesh of a body: its place (m), the direction out of the mesh there, and how deep it is (m), below zero
/// where it does not touch.
pub(super) fn touch_mesh(
    pair: &Pair,
    point: &mut Point,
    (body, pose): (&BodyModel, &Pose),
    (other, other_pose): (&BodyModel, &Pose),
) -> (DVec3, DVec3, f64) {
    let place = pose.place(body, point.particle);
    let inward = other_pose.rotation.transpose() * (place - other_pose.position);
    let within = pair.reach + pair.margin;
    let nearest = other.solid.as_ref().and_then(|solid| solid.query(inward, point.other, within));
    let Some(nearest) = nearest else { return (place, DVec3::ZERO, -pair.margin) };
    point.other = nearest.triangle;
    (place, other_pose.rotation * nearest.gradient, pair.reach - nearest.distance)
}
