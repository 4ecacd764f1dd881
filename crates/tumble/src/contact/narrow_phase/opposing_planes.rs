//! The contact of a point with a convex body in a step that is too long for the forces of rims.
//!
//! Near the rim of a face the force of a point fades over a path as short as the depth, micrometres in a stack of stiff boxes. A long
//! implicit step cannot follow that: it would take such a force for a wall. Here a point touches the planes that oppose it, with
//! its full weight, where it is on the inner side of all others; beyond a rim the weight fades over [`FADE`].

use glam::{DMat3, DVec3};

use super::exits::View;
use super::segment::{Sample, minimum};
use super::surface_point::{OUTSIDE, PointContact};
use crate::SignedDistance;
use crate::smooth_step::smooth_step;

/// How deep a point may be, in units of the thickness of the body: at a greater depth it leaves by another way.
const DEEPEST: f64 = 0.25;

/// How far beyond a rim a point still touches, in units of the thickness of the body.
const FADE: f64 = 2e-3;

/// The contact and the vector from `place` to it (m), up to a gap of `reach` (m), which is minus its depth. `half` is half of the segment
/// that the point stands for, in the frame of the mesh.
pub(super) fn contact(
    view: &View,
    mesh: &SignedDistance,
    half: DVec3,
    place: DVec3,
    reach: f64,
) -> Option<(DVec3, PointContact)> {
    let is_near = |depth: f64| depth > -reach && depth < DEEPEST * mesh.thickness();
    if half == DVec3::ZERO {
        let (depth, normal) = deepest(view, mesh, place)?;
        let weight = view.opposes(normal) * within_rims(view, mesh, place);
        let contact = PointContact { weight, ..PointContact::plain(normal, depth) };
        return (is_near(depth) && weight > 0.0).then_some((DVec3::ZERO, contact));
    }
    let [start, end] = part_inside(view, mesh, place, half)?;
    let (middle, half) = (half * (0.5 * (start + end)), half * (0.5 * (end - start)));
    let limit = reach * OUTSIDE;
    let found = minimum(half, limit, |offset| {
        let (depth, normal) = deepest(view, mesh, place + middle + offset)?;
        let (value, gradient) = (-depth * OUTSIDE, normal * OUTSIDE);
        Some(Sample { value, gradient, turn: DVec3::ZERO })
    })?;
    let size = found.gradient.length();
    let (depth, normal) = (-found.value / OUTSIDE, found.gradient / size);
    let offset = middle + found.offset;
    let weight = view.opposes(normal) * within_rims(view, mesh, place + offset);
    let contact = PointContact { weight, ..PointContact::plain(normal, depth) };
    let is_contact = is_near(depth) && size > 0.0 && weight > 0.0;
    is_contact.then_some((offset, contact))
}

/// The weight that is left of a point beyond rims.
fn within_rims(view: &View, mesh: &SignedDistance, place: DVec3) -> f64 {
    let beyond = mesh.planes().iter().filter(|plane| view.opposes(plane.normal) <= 0.0);
    let depth = beyond.map(|plane| plane.depth(place)).fold(0.0, f64::min);
    smooth_step(1.0 + depth / (FADE * mesh.thickness()))
}

/// The depth below the nearest plane that opposes the point (m), negative outside, and its normal.
fn deepest(view: &View, mesh: &SignedDistance, place: DVec3) -> Option<(f64, DVec3)> {
    let planes = mesh.planes().iter().filter(|plane| view.opposes(plane.normal) > 0.0);
    let depths = planes.map(|plane| (plane.depth(place), plane.normal));
    depths.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The part of the segment, from −1 to 1, that is on the inner side of the planes that do not oppose it.
fn part_inside(view: &View, mesh: &SignedDistance, place: DVec3, half: DVec3) -> Option<[f64; 2]> {
    let [mut start, mut end] = [-1.0f64, 1.0];
    for plane in mesh.planes().iter().filter(|plane| view.opposes(plane.normal) <= 0.0) {
        let depth = plane.depth(place) + FADE * mesh.thickness();
        let slope = -plane.normal.dot(half);
        // depth + slope t ≥ 0
        if slope == 0.0 {
            if depth < 0.0 {
                return None;
            }
        } else if slope > 0.0 {
            start = start.max(-depth / slope);
        } else {
            end = end.min(-depth / slope);
        }
    }
    (start < end).then_some([start, end])
}

/// What [`contact`] needs of a point: the view of the mesh, if that consists of planes.
pub(super) fn view<'a>(
    normals: &[DVec3],
    mesh: &'a SignedDistance,
    to_mesh: DMat3,
) -> Option<View<'a>> {
    let view = View::new(normals, mesh, to_mesh);
    view.has_planes().then_some(view)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::Primitive;

    #[test]
    fn a_corner_at_a_rim_touches_the_face_that_it_stands_on() {
        let mesh = Primitive::Box { size: DVec3::splat(2.0), divisions: 1 }.mesh().unwrap();
        let mesh = SignedDistance::new(&mesh).unwrap();
        // the lower corner of a box on another: its faces look down, to −x and to −z
        let normals = [DVec3::NEG_Y, DVec3::NEG_X, DVec3::NEG_Z];
        let view = view(&normals, &mesh, DMat3::IDENTITY).unwrap();
        let at = |place: DVec3| contact(&view, &mesh, DVec3::ZERO, place, 1e-3);
        let (_, touching) = at(DVec3::new(-1.0 + 1e-9, 1.0 - 1e-4, -1.0 + 1e-9)).unwrap();
        assert_eq!(touching.outward, DVec3::Y);
        assert!((touching.depth - 1e-4).abs() < 1e-12 && touching.weight == 1.0);
        let (_, apart) = at(DVec3::new(-0.5, 1.0 + 1e-4, 0.3)).unwrap();
        assert!((apart.depth + 1e-4).abs() < 1e-12 && apart.outward == DVec3::Y);
        let (_, beyond) = at(DVec3::new(-1.0 - 2e-3, 1.0 - 1e-4, 0.0)).unwrap();
        assert!((beyond.weight - 0.5).abs() < 1e-9);
        assert!(at(DVec3::new(-1.0 - 5e-3, 1.0 - 1e-4, 0.0)).is_none());
        assert!(at(DVec3::new(-0.5, 1.0 + 1e-2, 0.3)).is_none());
    }

    #[test]
    fn an_edge_touches_where_it_is_deepest() {
        let mesh = Primitive::Box { size: DVec3::splat(2.0), divisions: 1 }.mesh().unwrap();
        let mesh = SignedDistance::new(&mesh).unwrap();
        let normals = [DVec3::NEG_Y, DVec3::NEG_Z];
        let view = view(&normals, &mesh, DMat3::IDENTITY).unwrap();
        // one end is deeper by 2 mm than the other
        let half = DVec3::new(0.5, -1e-3, 0.0);
        let place = DVec3::new(0.2, 1.0 - 1e-4, 0.0);
        let (offset, touching) = contact(&view, &mesh, half, place, 1e-6).unwrap();
        assert!((offset - half).length() < 1e-6 && touching.outward == DVec3::Y, "{offset}");
        assert!((touching.depth - 1.1e-3).abs() < 2e-4 && touching.weight == 1.0, "{touching:?}");
    }
}
