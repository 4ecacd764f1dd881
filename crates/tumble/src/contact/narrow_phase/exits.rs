//! The ways by which a contact point inside a mesh can leave it.

use glam::{DMat3, DVec3};

use crate::contact_points::MOST_NORMALS;
use crate::distance::{Exit, NormalCone, Plane, Share, THROUGH};
use crate::smooth_step::{smooth_step, smooth_step_slope};
use crate::{Nearest, SignedDistance};

/// Cosine of the angle between the normals of two faces, with opposite sign, at which they begin to oppose each other, and
/// from which on they do so fully.
const OPPOSING: [f64; 2] = [0.1, 0.4];

/// The same angle for faces beside a point: those that face the same way are the far side of a plate.
const ACROSS: [f64; 2] = [-0.8, -0.5];

/// A way to leave the mesh.
#[derive(Clone, Copy)]
pub(super) struct Way {
    /// Its length, divided by the root of its share (m).
    pub distance: f64,
    /// How fast it shrinks as the point moves, and as its body turns in place (m/rad).
    pub gradient: DVec3,
    pub turn: DVec3,
}

impl Way {
    /// No way at all.
    const NONE: Self = Self { distance: f64::INFINITY, gradient: DVec3::ZERO, turn: DVec3::ZERO };
}

/// The shortest ways.
pub(super) struct Exits {
    /// Through faces that oppose the point; with an infinite distance if there is none.
    pub out: Way,
    /// Through others, where one may be shorter than `out`.
    pub beside: Option<Way>,
    /// Through faces at a right angle to the point or so, not through the far side of a plate, where one may be close enough
    /// to count.
    pub across: Option<Way>,
}

/// A contact point and a mesh, in the frame of the mesh.
pub(super) struct View<'a> {
    mesh: &'a SignedDistance,
    /// Normals of the faces around the point.
    normals: [DVec3; MOST_NORMALS],
    count: usize,
}

impl<'a> View<'a> {
    /// The normals of a point and a mesh, given the rotation into its frame.
    pub fn new(normals: &[DVec3], mesh: &'a SignedDistance, to_mesh: DMat3) -> Self {
        let mut turned = [DVec3::ZERO; MOST_NORMALS];
        for (turned, normal) in turned.iter_mut().zip(normals) {
            *turned = to_mesh * *normal;
        }
        Self { mesh, normals: turned, count: normals.len().min(MOST_NORMALS) }
    }

    /// Whether [`Self::exits_through_planes`] are the ways out.
    pub fn has_planes(&self) -> bool {
        self.has_ways() && !self.mesh.planes().is_empty()
    }

    /// A smooth surface has no rims, and its nearest face is the way out.
    fn has_ways(&self) -> bool {
        self.count > 0 && self.mesh.has_sharp_edges()
    }

    fn own_normals(&self) -> &[DVec3] {
        &self.normals[..self.count]
    }

    /// The ways out of a place inside; `nearest` is the result of a query there. Rims count up to a distance `fade` (m).
    pub fn exits(&self, place: DVec3, nearest: &Nearest, fade: f64) -> Exits {
        let depth = -nearest.distance;
        let plain = Way { distance: depth, gradient: nearest.gradient, turn: DVec3::ZERO };
        if !self.has_ways() {
            return Exits { out: plain, beside: None, across: None };
        }
        if self.has_planes() {
            return self.exits_through_planes(place);
        }
        let across = |depth: f64| match fade > depth {
            true => self.way(place, fade, Kind::Across),
            false => None,
        };
        let normal = self.mesh.normal(nearest.triangle);
        let is_through = nearest.gradient.dot(normal) >= THROUGH;
        if is_through && self.facing(normal).0 >= OPPOSING[1] {
            // any rim is at least as far as the nearest face
            return Exits { out: plain, beside: None, across: across(depth) };
        }
        let out = self.way(place, f64::INFINITY, Kind::Opposing).unwrap_or(Way::NONE);
        let beside = self.way(place, out.distance, Kind::Beside);
        Exits { out, beside, across: across(out.distance) }
    }

    /// The depth below the nearest plane (m), negative outside, and the normal of that plane.
    pub fn nearest_plane(&self, place: DVec3) -> Option<(f64, DVec3)> {
        let depths = self.mesh.planes().iter().map(|plane| (plane.depth(place), plane.normal));
        depths.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The ways out of a convex solid. Their lengths are concave functions of the place, as those to faces are not.
    pub fn exits_through_planes(&self, place: DVec3) -> Exits {
        let mut ways = [None; 3];
        for plane in self.mesh.planes() {
            let depth = plane.depth(place).max(0.0);
            for (way, kind) in ways.iter_mut().zip([Kind::Opposing, Kind::Beside, Kind::Across]) {
                let shortest = way.map_or(f64::INFINITY, |way: Way| way.distance);
                // a share makes it longer
                if depth < shortest
                    && let Some(found) = self.through_plane(depth, plane, kind)
                    && found.distance < shortest
                {
                    *way = Some(found);
                }
            }
        }
        let [out, beside, across] = ways;
        Exits { out: out.unwrap_or(Way::NONE), beside, across }
    }

    fn through_plane(&self, depth: f64, plane: &Plane, kind: Kind) -> Option<Way> {
        let share = kind.share(self.facing(plane.normal).0);
        if share <= 0.0 {
            return None;
        }
        let scale = 1.0 / share.sqrt();
        Some(self.weighted(depth * scale, plane.normal * scale, plane.normal, kind))
    }

    /// The shortest way of one kind through faces, if it is within a limit (m).
    fn way(&self, place: DVec3, within: f64, kind: Kind) -> Option<Way> {
        let share = KindShare { view: self, kind };
        let Exit { distance, gradient, normal } = self.mesh.nearest_exit(place, within, &share)?;
        Some(self.weighted(distance, gradient, normal, kind))
    }

    /// Adds how a way of length d/√w changes as the body of the point turns: w depends on the normals.
    fn weighted(&self, distance: f64, gradient: DVec3, normal: DVec3, kind: Kind) -> Way {
        let (cosine, own) = self.facing(normal);
        let scale = -0.5 * distance * kind.slope(cosine) / kind.share(cosine);
        Way { distance, gradient, turn: own.cross(normal) * scale }
    }

    /// The share of a face that opposes the point, from 0 to 1.
    pub fn opposes(&self, normal: DVec3) -> f64 {
        Kind::Opposing.share(self.facing(normal).0)
    }

    /// The cosine c of the angle between the opposite of a face's normal and the normal of the point's own surface that is
    /// closest to it; and that normal.
    fn facing(&self, normal: DVec3) -> (f64, DVec3) {
        let mut most = (f64::NEG_INFINITY, DVec3::ZERO);
        for own in self.own_normals() {
            let cosine = -own.dot(normal);
            if cosine > most.0 {
                most = (cosine, *own);
            }
        }
        most
    }
}

/// Ways through faces, as a share that is a smooth function of c, see [`View::facing`].
#[derive(Clone, Copy)]
enum Kind {
    /// See [`Exits`].
    Opposing,
    Beside,
    Across,
}

impl Kind {
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

/// The shares of the ways of one kind for one point.
struct KindShare<'a> {
    view: &'a View<'a>,
    kind: Kind,
}

impl Share for KindShare<'_> {
    fn of(&self, normal: DVec3) -> f64 {
        self.kind.share(self.view.facing(normal).0)
    }

    fn is_zero_in(&self, cone: &NormalCone) -> bool {
        let own = self.view.own_normals();
        let is_below = |limit: f64| own.iter().all(|own| cone.least_cosine(*own) >= -limit);
        let is_opposing = || own.iter().any(|own| cone.least_cosine(-*own) >= OPPOSING[1]);
        match self.kind {
            Kind::Opposing => is_below(OPPOSING[0]),
            Kind::Beside => is_opposing(),
            Kind::Across => is_opposing() || is_below(ACROSS[0]),
        }
    }
}
