//! The part of a surface that is close to a point, remembered so that the next search nearby is short.
//!
//! A search that ends at one triangle has also seen how far away all but a few groups of triangles are at least. A distance changes
//! by no more than the way of the point: while the point stays near, the closest triangle of those few groups is the closest of all
//! as long as it is closer than what is left of that. Where rounding could decide, everything is searched.

use glam::DVec3;

use super::search::{Around, Closest, KEPT, NO_GROUP};
use super::{Nearest, SignedDistance};

/// Part by which a distance, or a way, may be off by rounding.
const ROUNDING: f64 = 1e-11;
/// Part of a squared distance below which rounding does not decide whether something is closer.
const NEAR: f64 = 0.99;
/// Patches are kept in single precision: part by which a coordinate may be off.
const SINGLE: f64 = f32::EPSILON as f64;

/// What a search from one place has seen of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    /// Where the point was, to single precision (m).
    place: [f32; 3],
    /// All groups but the first were at least this far away (m).
    second: f32,
    /// All groups but those that are kept were at least this far away (m).
    others: f32,
    /// The signed distance was at least this (m).
    at_least: f32,
    groups: [u32; KEPT],
}

impl Patch {
    /// Nothing is known.
    pub const NONE: Self = Self {
        place: [0.0; 3],
        second: f32::NEG_INFINITY,
        others: f32::NEG_INFINITY,
        at_least: f32::NEG_INFINITY,
        groups: [NO_GROUP; KEPT],
    };

    /// How far a point is from where the patch is from (m), and then some for rounding.
    fn way(&self, point: DVec3) -> f64 {
        let place = DVec3::from_array(self.place.map(f64::from));
        (point - place).length_squared().sqrt() * (1.0 + ROUNDING)
    }

    /// The signed distance of a point is at least this (m), if it is more than zero.
    #[inline]
    pub fn at_least(&self, point: DVec3) -> f64 {
        f64::from(self.at_least) - self.way(point)
    }
}

/// The largest number of single precision that is not above a positive one; of any other, nothing to go by.
fn below(x: f64) -> f32 {
    let below = (x * (1.0 - SINGLE)).min(f64::from(f32::MAX));
    if x > 0.0 { below as f32 } else { f32::NEG_INFINITY }
}

impl SignedDistance {
    /// The same as [`Self::query`] to the last bit, faster where the patch is from a place nearby. The patch is of this surface or
    /// [`Patch::NONE`]; where it does not help, it is made anew.
    pub(crate) fn query_near(
        &self,
        point: DVec3,
        patch: &mut Patch,
        within: f64,
    ) -> Option<Nearest> {
        let closest = self.closest_by(point, patch);
        if let Some(closest) = closest
            && closest.squared < NEAR * within * within
        {
            // what else could say that it is too far away need not be asked
            return self.answer(point, Some(closest), within);
        }
        let most = self.search_radius(point, within)?;
        match closest {
            Some(closest) if closest.squared <= most * most => {
                self.answer(point, Some(closest), within)
            }
            Some(_) => None,
            None => self.query_anew(point, patch, within, most),
        }
    }

    /// The closest triangle, if the patch is enough to tell.
    fn closest_by(&self, point: DVec3, patch: &Patch) -> Option<Closest> {
        let way = patch.way(point);
        if way >= f64::from(patch.others) {
            return None;
        }
        let closest_of = |groups: &[u32], beyond: f32| {
            let closest = self.tree.nearest_of(self.level, point, groups)?;
            let distance = closest.squared.sqrt() * (1.0 + ROUNDING);
            (distance + way < f64::from(beyond)).then_some(closest)
        };
        closest_of(&patch.groups[..1], patch.second)
            .or_else(|| closest_of(&patch.groups, patch.others))
    }

    /// A full search, remembered.
    fn query_anew(
        &self,
        point: DVec3,
        patch: &mut Patch,
        within: f64,
        most: f64,
    ) -> Option<Nearest> {
        let (closest, around) =
            self.tree.nearest_around(self.level, point, most * most, patch.groups[0], self.grain);
        let nearest = self.answer(point, closest, within);
        *patch = self.patch(point, &around, nearest.map_or(within, |nearest| nearest.distance));
        nearest
    }

    fn patch(&self, point: DVec3, around: &Around, distance: f64) -> Patch {
        // what the place loses by being kept in single precision, and rounding of distances of large coordinates
        let size = self.reach.max(point.abs().max_element());
        let slack = 2.0 * SINGLE * size + f64::from(f32::MIN_POSITIVE);
        let at_least = if self.coarse.is_some() { distance - slack } else { f64::NEG_INFINITY };
        let beyond = |squared: f64| below(squared.sqrt() * (1.0 - ROUNDING) - slack);
        Patch {
            place: point.to_array().map(|x| x as f32),
            second: beyond(around.others.min(around.groups[1].0)),
            others: beyond(around.others),
            at_least: below(at_least),
            groups: around.groups.map(|(_, group)| group),
        }
    }
}
