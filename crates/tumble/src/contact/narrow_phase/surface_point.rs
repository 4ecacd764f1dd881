//! A point of one body inside the mesh of another: how deep it is, and which way it leaves.
//!
//! The force is the negative gradient of an energy of the relative pose. A point leaves through a face that *opposes* one of
//! the faces around it, at distance δ; a face beside it, at a right angle or so, is a *rim*, at distance r. With
//! x = min(1, r / max(δ, ℓ)) the energy is
//!
//! > E = ½ k δ² s(x), s(x) = x² (3 − 2 x),
//!
//! which is ½ k δ² away from the rim and fades to zero there, so that a point can pass the rim without a jolt. ℓ is the
//! spacing of the points of a flat face and zero at edges. Whether a face opposes the point is a smooth function of its
//! normal, so that E is continuous as bodies turn.

use glam::{DMat3, DVec3};

use super::exits::{Exits, View, Way};
use super::opposing_planes;
use super::segment::{Extremum, Sample, extrema, minimum};
use crate::smooth_step::{smooth_step, smooth_step_slope};
use crate::{ContactPoints, Nearest, SignedDistance};

/// √3, the largest slope of √s.
pub(super) const OUTSIDE: f64 = 1.7320508075688772;

/// The contact of a point, in the frame of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointContact {
    /// Outward unit vector: the direction of the force.
    pub outward: DVec3,
    /// Depth (m).
    pub depth: f64,
    /// Factor w on the stiffness. Force and energy are k w δ and ½ k w δ².
    pub weight: f64,
    /// Torque on the body of the point, in addition to that of the force, over k (m²): the energy depends on its orientation
    /// where a face begins to oppose it.
    pub couple: DVec3,
}

impl PointContact {
    /// A contact with the full stiffness.
    pub fn plain(outward: DVec3, depth: f64) -> Self {
        Self { outward, depth, weight: 1.0, couple: DVec3::ZERO }
    }
}

/// A contact point, as seen from its own body.
#[derive(Clone, Copy)]
pub(super) struct SurfacePoint<'a> {
    /// Half of the segment that it stands for (m), zero for a fixed point.
    half_segment: DVec3,
    /// Normals of the faces around it.
    normals: &'a [DVec3],
    /// Distance from the rim of a face over which the force fades (m).
    fade: f64,
}

impl<'a> SurfacePoint<'a> {
    /// The contact point with an index.
    pub fn new(points: &'a ContactPoints, index: u32) -> Self {
        let half_segment = points.half_segment(index);
        Self { half_segment, normals: points.normals(index), fade: points.fade(index) }
    }

    /// The contact with a mesh, given the rotation into its frame, the place of the point there, and the result of a query
    /// there; and the vector from that place to the point of contact (m). `None` if it does not touch.
    pub fn contact(
        &self,
        mesh: &SignedDistance,
        to_mesh: DMat3,
        place: DVec3,
        nearest: &Nearest,
    ) -> Option<(DVec3, PointContact)> {
        let view = View::new(self.normals, mesh, to_mesh);
        if self.half_segment == DVec3::ZERO {
            let energy = Energy::of(&view.exits(place, nearest, self.fade), self.fade);
            return Some((DVec3::ZERO, energy.contact()?));
        }
        let half = to_mesh * self.half_segment;
        if view.has_planes() {
            let found = minimum(half, 0.0, |offset| plane_sample(&view, place + offset))?;
            return Some((found.offset, Energy::at(&found).contact()?));
        }
        let mut total = EdgeTotal::default();
        let evaluate = |offset: DVec3| {
            let is_middle = offset == DVec3::ZERO;
            let nearest = if is_middle {
                *nearest
            } else {
                mesh.query(place + offset, nearest.triangle, f64::INFINITY)?
            };
            Some(face_sample(&view, place + offset, &nearest))
        };
        extrema(half, mesh.thickness(), evaluate, |extremum| total.add(&extremum));
        Some((total.offset, total.energy.contact()?))
    }
}

impl SurfacePoint<'_> {
    /// The contact with a convex mesh in a step that is too long for the forces of rims, see [`opposing_planes`]; `None` where the mesh
    /// is not made of planes.
    pub fn with_planes(
        &self,
        mesh: &SignedDistance,
        to_mesh: DMat3,
        place: DVec3,
        reach: f64,
    ) -> Option<Option<(DVec3, PointContact)>> {
        let view = opposing_planes::view(self.normals, mesh, to_mesh)?;
        let half = to_mesh * self.half_segment;
        Some(opposing_planes::contact(&view, mesh, half, place, reach))
    }

    /// The contact with a convex mesh of a point that is outside of it, at a gap of less than `reach` (m): with the plane that separates
    /// them most. Its depth is minus the gap. `None` also where the mesh is not made of planes.
    pub fn apart(
        &self,
        mesh: &SignedDistance,
        to_mesh: DMat3,
        place: DVec3,
        reach: f64,
    ) -> Option<(DVec3, PointContact)> {
        let view = View::new(self.normals, mesh, to_mesh);
        if !view.has_planes() {
            return None;
        }
        if self.half_segment == DVec3::ZERO {
            let (depth, normal) = view.nearest_plane(place)?;
            let is_near = depth <= 0.0 && depth > -reach;
            return is_near.then_some((DVec3::ZERO, PointContact::plain(normal, depth)));
        }
        let half = to_mesh * self.half_segment;
        let limit = reach * OUTSIDE;
        let found = minimum(half, limit, |offset| {
            let (depth, normal) = view.nearest_plane(place + offset)?;
            Some(outside_sample(-depth, normal))
        })?;
        let size = found.gradient.length();
        let is_apart = found.value >= 0.0 && size > 0.0;
        let contact = PointContact::plain(found.gradient / size, -found.value / OUTSIDE);
        is_apart.then_some((found.offset, contact))
    }
}

/// A function along an edge: inside, minus the root of the energy; outside, the distance times √3, the steepest slope of that
/// root, where it begins at a rim. For planes it is convex.
fn plane_sample(view: &View, place: DVec3) -> Option<Sample> {
    let (depth, normal) = view.nearest_plane(place)?;
    if depth <= 0.0 {
        return Some(outside_sample(-depth, normal));
    }
    Some(inside_sample(&Energy::of(&view.exits_through_planes(place), 0.0)))
}

/// The same for any mesh, given the result of a query.
fn face_sample(view: &View, place: DVec3, nearest: &Nearest) -> Sample {
    if nearest.distance >= 0.0 {
        return outside_sample(nearest.distance, nearest.gradient);
    }
    inside_sample(&Energy::of(&view.exits(place, nearest, 0.0), 0.0))
}

fn outside_sample(distance: f64, gradient: DVec3) -> Sample {
    Sample { value: distance * OUTSIDE, gradient: gradient * OUTSIDE, turn: DVec3::ZERO }
}

fn inside_sample(energy: &Energy) -> Sample {
    let depth = energy.twice_energy.sqrt();
    // a point exactly on a rim has no direction
    let scale = 1.0 / depth.max(f64::MIN_POSITIVE);
    Sample { value: -depth, gradient: energy.force * scale, turn: energy.couple * scale }
}

/// Energy of a point and its derivatives, over its stiffness.
#[derive(Clone, Copy, Default)]
struct Energy {
    /// E₂ = 2 E/k (m²).
    twice_energy: f64,
    /// −½ ∇E₂ (m).
    force: DVec3,
    /// −½ ∂E₂/∂θ (m²).
    couple: DVec3,
}

/// The sum over the extrema along an edge: minima of the depth count negative, so that a maximum is not felt before it is
/// deeper than the places around it, and appears without a jolt.
#[derive(Default)]
struct EdgeTotal {
    energy: Energy,
    /// The largest value of E₂ (m²) and the vector from the middle to its place (m), at which the force acts.
    deepest: f64,
    offset: DVec3,
}

impl EdgeTotal {
    fn add(&mut self, extremum: &Extremum) {
        let sign = if extremum.is_minimum { 1.0 } else { -1.0 };
        let Energy { twice_energy, force, couple } = Energy::at(extremum);
        if extremum.is_minimum && twice_energy > self.deepest {
            self.energy.couple += (self.offset - extremum.offset).cross(self.energy.force);
            (self.deepest, self.offset) = (twice_energy, extremum.offset);
        }
        let arm = extremum.offset - self.offset;
        self.energy.twice_energy += twice_energy * sign;
        self.energy.force += force * sign;
        self.energy.couple += (couple + arm.cross(force)) * sign;
    }
}

impl Energy {
    /// The contact with this energy and force.
    fn contact(&self) -> Option<PointContact> {
        let size = self.force.length();
        let (depth, weight) = (self.twice_energy / size, size * size / self.twice_energy);
        let is_contact = self.twice_energy > 0.0 && depth.is_finite() && weight.is_finite();
        let (outward, couple) = (self.force / size, self.couple);
        is_contact.then_some(PointContact { outward, depth, weight, couple })
    }

    /// The energy at an extremum along an edge.
    fn at(extremum: &Extremum) -> Self {
        let Extremum { value, gradient, turn, .. } = *extremum;
        Self { twice_energy: value * value, force: gradient * -value, couple: turn * -value }
    }

    /// The energy of a point, given its ways out, and the distance from a rim over which it fades (m).
    fn of(exits: &Exits, fade: f64) -> Self {
        let Exits { out, beside, across } = exits;
        let depth = out.distance;
        let near = |rim: &Option<Way>, fade: f64| rim.filter(|rim| rim.distance < fade.max(depth));
        let (beside, across) = (near(beside, 0.0), near(across, fade));
        // the lesser part of its range counts
        let is_closer = |across: &Way| {
            beside.is_none_or(|beside| across.distance * depth < beside.distance * fade)
        };
        match (across.filter(is_closer), beside) {
            (Some(across), _) if fade > depth => Self::near_rim(out, &across, fade),
            (_, Some(beside)) => Self::near_rim(out, &beside, 0.0),
            _ if depth.is_finite() => Self::far_from_rim(out),
            _ => Self::default(),
        }
    }

    /// The energy away from rims, δ².
    fn far_from_rim(out: &Way) -> Self {
        let Way { distance, gradient, turn } = *out;
        let (force, couple) = (gradient * distance, turn * distance);
        Self { twice_energy: distance * distance, force, couple }
    }

    /// The energy near a rim, which is closer than `fade` or the way out (m).
    fn near_rim(out: &Way, rim: &Way, fade: f64) -> Self {
        let (depth, r) = (out.distance, rim.distance);
        // half the derivatives with respect to δ and r
        let (twice_energy, by_depth, by_rim) = if depth < fade {
            let x = r / fade;
            let slope = smooth_step_slope(x) / fade;
            (smooth_step(x) * depth * depth, smooth_step(x) * depth, 0.5 * slope * depth * depth)
        } else {
            // δ² s(r/δ) = 3 r² − 2 r³/δ, also where no face opposes and δ is infinite
            let x = r / depth;
            (r * r * (3.0 - 2.0 * x), r * x * x, 3.0 * r * (1.0 - x))
        };
        let mut force = rim.gradient * by_rim;
        let mut couple = rim.turn * by_rim;
        if by_depth > 0.0 {
            force += out.gradient * by_depth;
            couple += out.turn * by_depth;
        }
        Self { twice_energy, force, couple }
    }
}

#[cfg(test)]
mod tests;
