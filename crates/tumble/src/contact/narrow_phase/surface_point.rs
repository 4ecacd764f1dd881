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

use super::segment::{Minimum, Sample, minimum};
use crate::contact_points::MOST_NORMALS;
use crate::distance::{Exit, NormalCone, WayWeight};
use crate::{ContactPoints, Nearest, SignedDistance};

/// Cosine of the angle between the normals of two faces, with opposite sign, at which they begin to oppose each other, and
/// from which on they do so fully.
const OPPOSING: [f64; 2] = [0.1, 0.4];

/// The same angle for faces beside a point: those that face the same way are the far side of a plate.
const ACROSS: [f64; 2] = [-0.8, -0.5];

/// √3, the largest slope of √s.
const OUTSIDE: f64 = 1.7320508075688772;

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

    /// Half the length of its segment (m).
    pub fn half_length(&self) -> f64 {
        self.half_segment.length()
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
        let view = View::new(self, mesh, to_mesh);
        if self.half_segment == DVec3::ZERO {
            return Some((DVec3::ZERO, view.energy(place, nearest).contact()?));
        }
        let Minimum { offset, value, gradient, turn } =
            minimum(to_mesh * self.half_segment, mesh.is_convex(), |offset| {
                view.sample(place, offset, nearest)
            })?;
        let (force, couple) = (gradient * -value, turn * -value);
        Some((offset, Energy { twice_energy: value * value, force, couple }.contact()?))
    }
}

/// Energy of a point and its derivatives, over its stiffness.
struct Energy {
    /// E₂ = 2 E/k (m²).
    twice_energy: f64,
    /// −½ ∇E₂ (m).
    force: DVec3,
    /// −½ ∂E₂/∂θ (m²).
    couple: DVec3,
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
}

/// A way to leave the mesh.
#[derive(Clone, Copy)]
struct Way {
    /// Its length (m).
    distance: f64,
    /// How fast it shrinks as the point moves, and as its body turns in place (m/rad).
    gradient: DVec3,
    turn: DVec3,
}

/// A contact point and a mesh, in the frame of the mesh.
struct View<'a> {
    mesh: &'a SignedDistance,
    /// Normals of the faces around the point.
    normals: [DVec3; MOST_NORMALS],
    count: usize,
    /// See [`SurfacePoint`].
    fade: f64,
}

impl<'a> View<'a> {
    fn new(point: &SurfacePoint, mesh: &'a SignedDistance, to_mesh: DMat3) -> Self {
        let mut normals = [DVec3::ZERO; MOST_NORMALS];
        for (turned, normal) in normals.iter_mut().zip(point.normals) {
            *turned = to_mesh * *normal;
        }
        Self { mesh, normals, count: point.normals.len().min(MOST_NORMALS), fade: point.fade }
    }

    /// A convex function along an edge, if the mesh is convex: less than zero inside, minus the root of the energy. Outside it
    /// is the distance times √3, the steepest slope of that root, where it begins at a rim.
    fn sample(&self, middle: DVec3, offset: DVec3, at_middle: &Nearest) -> Option<Sample> {
        let place = middle + offset;
        let nearest = if offset == DVec3::ZERO {
            *at_middle
        } else {
            self.mesh.query(place, at_middle.triangle, f64::INFINITY)?
        };
        if nearest.distance >= 0.0 {
            let (value, gradient) = (nearest.distance, nearest.gradient);
            let (value, gradient) = (value * OUTSIDE, gradient * OUTSIDE);
            return Some(Sample { value, gradient, turn: DVec3::ZERO });
        }
        let Energy { twice_energy, force, couple } = self.energy(place, &nearest);
        let depth = twice_energy.sqrt();
        // a point exactly on a rim has no direction
        let scale = 1.0 / depth.max(f64::MIN_POSITIVE);
        Some(Sample { value: -depth, gradient: force * scale, turn: couple * scale })
    }

    /// The cosine c of the angle between the opposite of a face's normal and the normal of the point's own surface that is
    /// closest to it; and that normal.
    fn facing(&self, normal: DVec3) -> (f64, DVec3) {
        let mut most = (f64::NEG_INFINITY, DVec3::ZERO);
        for own in &self.normals[..self.count] {
            let cosine = -own.dot(normal);
            if cosine > most.0 {
                most = (cosine, *own);
            }
        }
        most
    }

    /// Energy and force at a place inside the mesh; `nearest` is the result of a query there.
    fn energy(&self, place: DVec3, nearest: &Nearest) -> Energy {
        let (depth, fade) = (-nearest.distance, self.fade);
        let plain = Way { distance: depth, gradient: nearest.gradient, turn: DVec3::ZERO };
        // a smooth surface has no rims, and its nearest face is the way out
        if self.count == 0 || !self.mesh.has_sharp_edges() {
            return far_from_rim(&plain);
        }
        if self.facing(nearest.gradient).0 >= OPPOSING[1] {
            // any rim is at least as far as the nearest face
            let rim = if fade > depth { self.way(place, fade, Ways::Across) } else { None };
            return energy_of(&plain, rim, fade);
        }
        let none = Way { distance: f64::INFINITY, gradient: DVec3::ZERO, turn: DVec3::ZERO };
        let way_out = self.way(place, f64::INFINITY, Ways::Opposing).unwrap_or(none);
        let depth = way_out.distance;
        let rim = self.way(place, depth, Ways::Beside);
        let across = if fade > depth { self.way(place, fade, Ways::Across) } else { None };
        match across {
            // the lesser part of its range counts
            Some(across) if rim.is_none_or(|rim| across.distance * depth < rim.distance * fade) => {
                energy_of(&way_out, Some(across), fade)
            }
            _ => energy_of(&way_out, rim, 0.0),
        }
    }

    /// The shortest of some ways, its length divided by the root of its share.
    fn way(&self, place: DVec3, within: f64, ways: Ways) -> Option<Way> {
        let Exit { distance, gradient, normal } =
            self.mesh.nearest_exit(place, within, &Weight { view: self, ways })?;
        let (cosine, own) = self.facing(normal);
        // d/√w, where w depends on −own·normal
        let scale = -0.5 * distance * ways.slope(cosine) / ways.share(cosine);
        Some(Way { distance, gradient, turn: own.cross(normal) * scale })
    }
}

/// Ways through faces, as a share that is a smooth function of c, see [`View::facing`].
#[derive(Clone, Copy)]
enum Ways {
    /// Through faces that oppose the point.
    Opposing,
    /// Through all others.
    Beside,
    /// Through faces at a right angle to it or so, not through the far side of a plate.
    Across,
}

impl Ways {
    /// The share of a face, from 0 to 1.
    fn share(self, cosine: f64) -> f64 {
        match self {
            Self::Opposing => smooth_step(within(OPPOSING, cosine)),
            Self::Across if cosine < ACROSS[1] => smooth_step(within(ACROSS, cosine)),
            Self::Across | Self::Beside => 1.0 - smooth_step(within(OPPOSING, cosine)),
        }
    }

    /// Its derivative.
    fn slope(self, cosine: f64) -> f64 {
        let slope = |range| smooth_step_slope(within(range, cosine)) / (range[1] - range[0]);
        match self {
            Self::Opposing => slope(OPPOSING),
            Self::Across if cosine < ACROSS[1] => slope(ACROSS),
            Self::Across | Self::Beside => -slope(OPPOSING),
        }
    }
}

/// The place of a number in a range, 0 at its start and 1 at its end.
fn within([start, end]: [f64; 2], x: f64) -> f64 {
    (x - start) / (end - start)
}

/// The weight of some ways for one point.
struct Weight<'a> {
    view: &'a View<'a>,
    ways: Ways,
}

impl WayWeight for Weight<'_> {
    fn of(&self, normal: DVec3) -> f64 {
        self.ways.share(self.view.facing(normal).0).sqrt()
    }

    fn is_zero_in(&self, cone: &NormalCone) -> bool {
        let own = &self.view.normals[..self.view.count];
        let is_below = |limit: f64| own.iter().all(|own| cone.least_cosine(*own) >= -limit);
        let is_opposing = || own.iter().any(|own| cone.least_cosine(-*own) >= OPPOSING[1]);
        match self.ways {
            Ways::Opposing => is_below(OPPOSING[0]),
            Ways::Beside => is_opposing(),
            Ways::Across => is_opposing() || is_below(ACROSS[0]),
        }
    }
}

/// x² (3 − 2 x) between 0 and 1.
fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The derivative of [`smooth_step`].
fn smooth_step_slope(x: f64) -> f64 {
    if (0.0..=1.0).contains(&x) { 6.0 * x * (1.0 - x) } else { 0.0 }
}

/// The energy of a point, given its way out and a rim, if there is one that is closer than `fade` or the way out (m).
fn energy_of(way_out: &Way, rim: Option<Way>, fade: f64) -> Energy {
    match rim {
        Some(rim) if rim.distance < fade.max(way_out.distance) => near_rim(way_out, &rim, fade),
        _ if way_out.distance.is_finite() => far_from_rim(way_out),
        _ => Energy { twice_energy: 0.0, force: DVec3::ZERO, couple: DVec3::ZERO },
    }
}

/// The energy away from rims, δ².
fn far_from_rim(way_out: &Way) -> Energy {
    let Way { distance, gradient, turn } = *way_out;
    Energy {
        twice_energy: distance * distance,
        force: gradient * distance,
        couple: turn * distance,
    }
}

/// The energy near a rim, which is closer than `fade` or the way out (m).
fn near_rim(way_out: &Way, rim: &Way, fade: f64) -> Energy {
    let (depth, r) = (way_out.distance, rim.distance);
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
        force += way_out.gradient * by_depth;
        couple += way_out.turn * by_depth;
    }
    Energy { twice_energy, force, couple }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::contact_points::contact_points;
    use crate::{MassModel, Mesh, Primitive, Sampling, Shape};

    /// Energy and force, over k, of a point in a cube with an edge of 2 m.
    fn contact(normals: &[DVec3], fade: f64, turn: DMat3, place: DVec3) -> (f64, DVec3) {
        let mesh = Primitive::Box { size: DVec3::splat(2.0), divisions: 1 }.mesh().unwrap();
        let mesh = SignedDistance::new(&mesh).unwrap();
        let nearest = mesh.query(place, 0, f64::INFINITY).unwrap();
        let point = SurfacePoint { half_segment: DVec3::ZERO, normals, fade };
        let contact = point.contact(&mesh, turn, place, &nearest);
        contact.map_or((0.0, DVec3::ZERO), |(_, PointContact { outward, depth, weight, .. })| {
            (0.5 * weight * depth * depth, outward * (weight * depth))
        })
    }

    #[test]
    fn the_force_is_the_gradient_of_the_energy_everywhere_below_a_face_and_its_rim() {
        let sharp = [-DVec3::Y, DVec3::X, DVec3::Z];
        for (normals, fade) in [(&sharp[..1], 0.2), (&sharp[..], 0.0), (&sharp[1..2], 0.05)] {
            for place in [
                DVec3::new(0.3, 0.95, 0.1),
                DVec3::new(0.9, 0.95, 0.1),
                DVec3::new(0.98, 0.9, 0.1),
                DVec3::new(0.98, 0.97, 0.99),
                DVec3::new(0.7, 0.2, 0.3),
            ] {
                let turn = DMat3::from_rotation_z(0.02);
                let energy = |place| contact(normals, fade, turn, place).0;
                let (_, force) = contact(normals, fade, turn, place);
                for axis in DVec3::AXES {
                    let h = axis * 1e-6;
                    let slope = (energy(place - h) - energy(place + h)) / 2e-6;
                    assert!((slope - force.dot(axis)).abs() < 1e-5, "{fade} {place} {force}");
                }
            }
        }
    }

    #[test]
    fn a_flat_point_near_a_side_face_is_pushed_up_not_out() {
        // 0.01 below the top and 0.005 from the side: the nearest face is the side
        let place = DVec3::new(0.995, 0.99, 0.0);
        let (energy, force) = contact(&[-DVec3::Y], 0.005, DMat3::IDENTITY, place);
        assert!(energy > 0.0 && force.y > 0.0);
        // halfway through a fade of 0.5, half of the force is left
        let place = DVec3::new(0.75, 0.99, 0.0);
        let (_, force) = contact(&[-DVec3::Y], 0.5, DMat3::IDENTITY, place);
        assert!((force.y - 0.005).abs() < 1e-12 && force.x < 2e-4, "{force}");
    }

    #[test]
    fn the_energy_is_continuous_as_the_point_turns() {
        let place = DVec3::new(0.97, 0.95, 0.1);
        let mut before = None;
        for step in 0..2000 {
            let turn = DMat3::from_rotation_z(f64::from(step) * 0.002);
            let (energy, _) = contact(&[-DVec3::Y], 0.01, turn, place);
            if let Some(before) = before {
                let change: f64 = energy - before;
                assert!(change.abs() < 4e-5, "{step}: {before} {energy}");
            }
            before = Some(energy);
        }
    }

    /// Two equal tetrahedra that pass through each other's corners, each pose a function of s from 0 to 1.
    struct Passage {
        shape: Shape,
        points: ContactPoints,
        mesh: SignedDistance,
        direction: DVec3,
        axis: DVec3,
        start: f64,
    }

    impl Passage {
        /// Angle through which the body turns.
        const ANGLE: f64 = 0.6;

        fn new(run: u32) -> Self {
            let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * 0.25;
            let tetrahedron = Mesh {
                vertices: vec![
                    corner(1.0, 1.0, 1.0),
                    corner(1.0, -1.0, -1.0),
                    corner(-1.0, 1.0, -1.0),
                    corner(-1.0, -1.0, 1.0),
                ],
                triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
            };
            let run = f64::from(run);
            let shape = Shape::from_mesh(&tetrahedron, Sampling::Vertices, MassModel::Solid);
            let shape = shape.unwrap();
            Self {
                points: contact_points(&shape),
                shape,
                mesh: SignedDistance::new(&tetrahedron).unwrap(),
                direction: DVec3::new(0.3 + 0.1 * run, -0.7, 0.5 - 0.2 * run).normalize(),
                axis: DVec3::new(-0.2, 0.9, 0.3 * run).normalize(),
                start: 0.7 * run,
            }
        }

        fn pose(&self, s: f64) -> (DMat3, DVec3) {
            let turn = DMat3::from_axis_angle(self.axis, self.start + Self::ANGLE * s);
            (turn, self.direction * (0.2 * s.min(1.0 - s) - 0.4))
        }

        /// Energy, force and couple of one point, and the place of contact in the body.
        fn contact(&self, s: f64, index: u32) -> (f64, DVec3, DVec3, DVec3) {
            let (turn, shift) = self.pose(s);
            let all = self.points.points(&self.shape);
            let place = turn * all.get(index as usize) + shift;
            let nearest = self.mesh.query(place, 0, f64::INFINITY).unwrap();
            let point = SurfacePoint::new(&self.points, index);
            let touches = nearest.distance < point.half_length();
            let found = touches.then(|| point.contact(&self.mesh, turn, place, &nearest));
            let Some((offset, contact)) = found.flatten() else {
                return (0.0, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
            };
            let k = contact.weight * all.weight(index as usize);
            let force = contact.outward * (k * contact.depth);
            let in_body = turn.transpose() * (place + offset - shift);
            (0.5 * k * contact.depth * contact.depth, force, contact.couple, in_body)
        }
    }

    #[test]
    fn the_work_of_vertices_and_faces_is_the_change_of_their_energy() {
        const STEPS: u32 = 1500;
        for run in 0..4 {
            let passage = Passage::new(run);
            let count = passage.points.points(&passage.shape).len() as u32;
            let mut touching = 0;
            // the minimum along an edge is tested in `segment`
            let is_fixed = |index: &u32| passage.points.half_segment(*index) == DVec3::ZERO;
            for index in (0..count).filter(is_fixed) {
                let (mut highest, mut error) = (0.0f64, 0.0f64);
                for step in 0..STEPS {
                    let [s0, s1] = [step, step + 1].map(|s| f64::from(s) / f64::from(STEPS));
                    let (a, b) = (passage.contact(s0, index), passage.contact(s1, index));
                    let ((turn0, shift0), (turn1, shift1)) = (passage.pose(s0), passage.pose(s1));
                    let moved = |place: DVec3| turn1 * place + shift1 - (turn0 * place + shift0);
                    let turned = passage.axis * (Passage::ANGLE / f64::from(STEPS));
                    let work = a.1.dot(moved(a.3))
                        + b.1.dot(moved(b.3))
                        + (a.2 + b.2).dot(turned) * weight_of(&passage, index);
                    error += b.0 - a.0 + 0.5 * work;
                    highest = highest.max(b.0);
                }
                if highest > 0.0 {
                    touching += 1;
                    assert!(
                        error.abs() < 2e-5 + 5e-3 * highest,
                        "{run} {index}: {error} {highest}"
                    );
                }
            }
            assert!(touching > 1, "{touching}");
        }
    }

    fn weight_of(passage: &Passage, index: u32) -> f64 {
        passage.points.points(&passage.shape).weight(index as usize)
    }
}
