//! The part of a surface closest to a point, cached to speed up the next query nearby.
//!
//! A search also yields a lower bound on the distance to all groups of triangles except the few closest. Distances
//! change by at most the displacement of the point. So after a small displacement, the closest triangle of the
//! cached groups is the closest of all if it is closer than that bound minus the displacement. If the comparison is
//! within rounding, the whole tree is searched.

use glam::DVec3;

use super::search::{Closest, NO_GROUP, Neighbourhood, PATCH_GROUPS};
use super::signed_distance::{Nearest, SignedDistance};

/// Relative rounding error of a distance or displacement.
const ROUNDING: f64 = 1e-11;
/// Factor on a squared distance that makes a comparison safe from rounding.
const NEAR: f64 = 0.99;
/// Relative rounding error of single precision, in which patches are stored.
const SINGLE: f64 = f32::EPSILON as f64;

/// The result of a search from one point: the closest groups of triangles and bounds on all others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    /// The point, in single precision (m).
    place: [f32; 3],
    /// Lower bound on the distance of all groups but the first (m).
    second: f32,
    /// Lower bound on the distance of all groups that are not in the patch (m).
    others: f32,
    /// Lower bound on the signed distance (m).
    at_least: f32,
    groups: [u32; PATCH_GROUPS],
}

impl Patch {
    /// The empty patch.
    pub const NONE: Self = Self {
        place: [0.0; 3],
        second: f32::NEG_INFINITY,
        others: f32::NEG_INFINITY,
        at_least: f32::NEG_INFINITY,
        groups: [NO_GROUP; PATCH_GROUPS],
    };

    /// An upper bound on the displacement of a point from that of the patch (m).
    fn displacement(&self, point: DVec3) -> f64 {
        let place = DVec3::from_array(self.place.map(f64::from));
        (point - place).length_squared().sqrt() * (1.0 + ROUNDING)
    }

    /// A lower bound on the signed distance of a point (m), valid if positive.
    #[inline]
    pub fn lower_bound(&self, point: DVec3) -> f64 {
        f64::from(self.at_least) - self.displacement(point)
    }
}

/// A positive number rounded down to single precision; −∞ for other numbers.
fn round_down(x: f64) -> f32 {
    let below = (x * (1.0 - SINGLE)).min(f64::from(f32::MAX));
    if x > 0.0 { below as f32 } else { f32::NEG_INFINITY }
}

impl SignedDistance {
    /// The same as [`Self::query`], bit for bit, but faster if the patch is from a point nearby.
    ///
    /// The patch must belong to this surface or be [`Patch::NONE`]. It is replaced if it does not help.
    pub(crate) fn query_cached(
        &self,
        point: DVec3,
        patch: &mut Patch,
        within: f64,
    ) -> Option<Nearest> {
        let closest = self.closest_in_patch(point, patch);
        if let Some(closest) = closest
            && closest.squared < NEAR * within * within
        {
            // clearly within the limit: no need for the search radius
            return self.evaluate_within(point, Some(closest), within);
        }
        let most = self.search_radius(point, within)?;
        match closest {
            Some(closest) if closest.squared <= most * most => {
                self.evaluate_within(point, Some(closest), within)
            }
            Some(_) => None,
            None => self.query_and_cache(point, patch, within, most),
        }
    }

    /// The closest triangle, if the patch is sufficient to determine it.
    fn closest_in_patch(&self, point: DVec3, patch: &Patch) -> Option<Closest> {
        let displacement = patch.displacement(point);
        if displacement >= f64::from(patch.others) {
            return None;
        }
        let closest_of = |groups: &[u32], bound: f32| {
            let closest = self.tree.nearest_of(self.level, point, groups)?;
            let distance = closest.squared.sqrt() * (1.0 + ROUNDING);
            (distance + displacement < f64::from(bound)).then_some(closest)
        };
        closest_of(&patch.groups[..1], patch.second)
            .or_else(|| closest_of(&patch.groups, patch.others))
    }

    /// A full search that replaces the patch.
    fn query_and_cache(
        &self,
        point: DVec3,
        patch: &mut Patch,
        within: f64,
        most: f64,
    ) -> Option<Nearest> {
        let (closest, neighbourhood) = self.tree.nearest_with_neighbourhood(
            self.level,
            point,
            most * most,
            patch.groups[0],
            self.patch_width,
        );
        let nearest = self.evaluate_within(point, closest, within);
        let distance = nearest.map_or(within, |nearest| nearest.distance);
        *patch = self.patch(point, &neighbourhood, distance);
        nearest
    }

    fn patch(&self, point: DVec3, neighbourhood: &Neighbourhood, distance: f64) -> Patch {
        // the error of the point in single precision, and rounding of distances at large coordinates
        let size = self.max_coordinate.max(point.abs().max_element());
        let slack = 2.0 * SINGLE * size + f64::from(f32::MIN_POSITIVE);
        let at_least = if self.grid.is_some() { distance - slack } else { f64::NEG_INFINITY };
        let lower_bound = |squared: f64| round_down(squared.sqrt() * (1.0 - ROUNDING) - slack);
        Patch {
            place: point.to_array().map(|x| x as f32),
            second: lower_bound(neighbourhood.others.min(neighbourhood.groups[1].0)),
            others: lower_bound(neighbourhood.others),
            at_least: round_down(at_least),
            groups: neighbourhood.groups.map(|(_, group)| group),
        }
    }
}
