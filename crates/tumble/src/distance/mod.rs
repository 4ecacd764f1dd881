//! The signed distance from a point to a closed triangle mesh, exact but for rounding.
//!
//! The closest triangle is found in a tree of boxes; its closest feature, face, side or corner, tells the side by its
//! angle-weighted pseudonormal. The result is a function of mesh and point alone, to the last bit: the order of the
//! search, a hint or the width of the processor's registers have no part in it.

mod coarse;
mod crossing;
mod error;
mod normals;
mod outline;
mod patch;
mod search;
mod tree;
mod triangle;

use fearless_simd::Level;
use glam::DVec3;

use crate::Mesh;
use coarse::Coarse;
pub use error::SurfaceError;
use normals::Pseudonormals;
use outline::Outline;
pub(crate) use patch::Patch;
use search::{Closest, NO_GROUP};
use tree::{Extent, Tree};
use triangle::{FACE, Foot};

/// Marks triangles that do not count.
const UNUSED: u32 = u32::MAX;
/// Coordinates carry an error of this many roundings; a distance as small has no direction.
const ROUNDINGS: f64 = 8.0;
/// Points with larger coordinates (m) would lose their squares to the range of doubles.
const FARTHEST: f64 = 1e140;

/// The closest point of a surface, told from the point that asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Signed distance (m), negative inside.
    pub distance: f64,
    /// Its gradient: the unit vector along which the distance grows. On the surface itself, its (pseudo)normal.
    pub gradient: DVec3,
    /// Index in the mesh of the closest triangle; of equally close ones the lowest.
    pub triangle: u32,
}

/// The signed distance to a closed triangle mesh.
///
/// Vertices at equal coordinates count as one, and triangles with two corners at one place as none. A mesh that is
/// wound inwards as a whole is taken as if it were wound outwards. Parts should not overlap: a point inside
/// one part and close to the surface of another, from outside, counts as outside.
///
/// # Holes
/// A mesh may have small holes: the boundary of each is at most 0.25 √A long and all together 0.5 √A, with A the area
/// of the surface. Where the closest point lies on the boundary of a hole, inside is where the generalised winding
/// number is above one half. That takes a sum over all triangles, and so does a point close to an edge
/// at which more than two triangles meet. There is no surface in a hole: points pass through.
///
/// ```
/// use tumble::{DVec3, Primitive, SignedDistance};
/// let ball = Primitive::Sphere { radius: 1.0, subdivisions: 5 }.mesh()?;
/// let distance = SignedDistance::new(&ball)?;
/// let nearest = distance.query(DVec3::new(0.0, 0.9, 0.0), 0, f64::INFINITY).unwrap();
/// assert!((nearest.distance + 0.1).abs() < 1e-3);
/// assert!(nearest.gradient.y > 0.99);
/// // two metres away, and asked for up to one
/// assert!(distance.query(DVec3::new(3.0, 0.0, 0.0), 0, 1.0).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SignedDistance {
    tree: Tree,
    /// By slot.
    normals: Vec<Pseudonormals>,
    /// By triangle of the mesh; [`UNUSED`] where it does not count.
    slots: Vec<u32>,
    bounds: Extent,
    /// The largest coordinate (m).
    reach: f64,
    /// None where holes let the sign jump.
    coarse: Option<Coarse>,
    thickness: f64,
    /// How much farther than the closest triangle a [`Patch`] reaches (m).
    grain: f64,
    turned: bool,
    holes: usize,
    level: Level,
}

impl SignedDistance {
    /// Prepares a mesh for queries.
    ///
    /// # Errors
    /// [`SurfaceError`] where the mesh has no triangles, large holes, sides wound against each other, no volume or
    /// a size beyond the range of doubles.
    pub fn new(mesh: &Mesh) -> Result<Self, SurfaceError> {
        let outline = Outline::of(mesh)?;
        let tree = Tree::build(outline.faces.iter().map(|face| (face.index, face.frame)));

        // by slot, what was by face
        let by_face = normals::pseudonormals(&outline);
        let mut slots = vec![UNUSED; mesh.triangles.len()];
        tree.each_slot(|slot, index| slots[index as usize] = slot as u32);
        let mut normals = vec![Pseudonormals::NONE; tree.slots()];
        for (face, found) in outline.faces.iter().zip(by_face) {
            normals[slots[face.index as usize] as usize] = found;
        }

        let bounds = outline.bounds;
        let mut made = Self {
            thickness: crossing::thickness(&tree, bounds.high - bounds.low),
            grain: tree.grain(),
            reach: bounds.low.abs().max(bounds.high.abs()).max_element(),
            tree,
            normals,
            slots,
            bounds,
            coarse: None,
            turned: outline.turned,
            holes: outline.holes,
            level: Level::new(),
        };
        if made.holes == 0 {
            // the cells come one beside the other
            let mut hint = 0;
            made.coarse = Some(Coarse::over(&bounds, made.grain, |point| {
                made.query(point, hint, f64::INFINITY).map_or(0.0, |nearest| {
                    hint = nearest.triangle;
                    nearest.distance
                })
            }));
        }
        Ok(made)
    }

    /// The signed distance of a point (m), its gradient and the closest triangle; `None` where the point is farther
    /// outside than `within` (m), not finite, or farther from the origin than 1e140 m. Points inside are found at any depth.
    ///
    /// `hint` is a triangle that may be close, as from the last query of a nearby point: it makes the search faster and
    /// changes nothing else. Any number will do.
    #[inline]
    pub fn query(&self, point: DVec3, hint: u32, within: f64) -> Option<Nearest> {
        let most = self.search_radius(point, within)?;
        let hint = self.slots.get(hint as usize).map(|&slot| slot as usize);
        self.answer(point, self.tree.nearest(self.level, point, most * most, hint), within)
    }

    /// What to say of the closest triangle.
    #[inline]
    fn answer(&self, point: DVec3, closest: Option<Closest>, within: f64) -> Option<Nearest> {
        let nearest = self.judge(point, closest?.slot);
        (nearest.distance < 0.0 || nearest.distance <= within).then_some(nearest)
    }

    /// The signed distance of a point is at least this (m), by a glance.
    #[inline]
    pub(crate) fn at_least(&self, point: DVec3) -> f64 {
        let from_box = self.bounds.distance(point);
        self.coarse.as_ref().map_or(from_box, |coarse| from_box.max(coarse.at_least(point)))
    }

    /// How far from a point the surface matters (m); `None` where the point surely is farther outside than `within` (m).
    #[inline]
    fn search_radius(&self, point: DVec3, within: f64) -> Option<f64> {
        // NaN is not below it
        if !point.abs().cmple(DVec3::splat(FARTHEST)).all() {
            return None;
        }
        let at_least = self.at_least(point);
        if at_least > within.max(0.0) {
            return None;
        }
        // only outside the surface is of no interest beyond that radius
        Some(if at_least > 0.0 { within } else { f64::INFINITY })
    }

    /// The sign and the gradient from the closest triangle.
    #[inline]
    fn judge(&self, point: DVec3, slot: usize) -> Nearest {
        let frame = self.tree.frame(slot);
        let Foot { feature, offset, squared } = frame.foot(point);
        let away = frame.turned_back(offset);
        let distance = if feature == FACE { offset.z.abs() } else { squared.sqrt() };
        let normals = &self.normals[slot];
        let normal = if feature == FACE { frame.normal } else { normals.of(feature) };

        let outside = if !self.bounds.contains(point) {
            true
        } else if normals.is_doubtful(feature) {
            self.tree.winding(point) <= 0.5
        } else {
            away.dot(normal) >= 0.0
        };
        let sign = if outside { 1.0 } else { -1.0 };
        let rounding = ROUNDINGS * f64::EPSILON * self.reach.max(point.abs().max_element());
        let gradient = if feature == FACE {
            // the normal itself, without the rounding of the way
            if offset.z * sign >= 0.0 { normal } else { -normal }
        } else if distance <= rounding {
            normal
        } else {
            away * (sign / distance)
        };
        // adding zero turns -0 into 0
        Nearest { distance: sign * distance + 0.0, gradient, triangle: self.tree.index(slot) }
    }

    /// Whether a ball is sure to be outside the solid: no point of it inside or on the surface.
    ///
    /// But for rounding, `false` means that some point is. A ball that is not finite, or larger than 1e140 m, is never sure to be.
    pub fn outside_ball(&self, centre: DVec3, radius: f64) -> bool {
        self.outside_ball_near(centre, radius, &mut { NO_GROUP })
    }

    /// As [`Self::outside_ball`], where `hint` is a group of triangles that may be in the ball, as those in the last ball nearby. Any number
    /// will do.
    pub(crate) fn outside_ball_near(&self, centre: DVec3, radius: f64, hint: &mut u32) -> bool {
        if !(centre.is_finite() && radius <= FARTHEST) {
            return false;
        }
        let Some(most) = self.search_radius(centre, radius) else { return true };
        if radius >= 0.0 {
            let part_of_it = |coarse: &Coarse| coarse.at_most(centre) <= radius;
            if self.coarse.as_ref().is_some_and(part_of_it) {
                return false;
            }
            // any triangle in it is enough
            if let Some(group) = self.tree.any_within(self.level, centre, radius * radius, *hint) {
                *hint = group;
                return false;
            }
        }
        // no triangle in it: it is wholly inside or outside
        most <= radius || self.query(centre, UNUSED, radius).is_none()
    }

    /// Whether the segment between two points outside the solid crosses its surface. Where it only touches an edge or a
    /// corner, rounding decides.
    pub fn passes_through(&self, from: DVec3, to: DVec3) -> bool {
        from.is_finite() && to.is_finite() && crossing::passes_through(&self.tree, from, to)
    }

    /// The lowest and the highest coordinates of the surface (m).
    pub fn bounds(&self) -> (DVec3, DVec3) {
        (self.bounds.low, self.bounds.high)
    }

    /// A small but typical thickness of the solid (m): from the middle of a triangle straight inwards to where one leaves
    /// the solid; a twentieth of the surface, by area, has less below it.
    ///
    /// Of large meshes 512 triangles, spread evenly by area, are asked.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// How many triangles count.
    pub fn triangle_count(&self) -> usize {
        self.tree.count()
    }

    /// How many small holes the mesh has.
    pub fn holes(&self) -> usize {
        self.holes
    }

    /// Whether the mesh is wound inwards, and was taken the other way round.
    pub fn is_turned(&self) -> bool {
        self.turned
    }

    /// Bytes in use.
    pub fn memory(&self) -> usize {
        size_of::<Self>()
            + self.tree.memory()
            + size_of::<Pseudonormals>() * self.normals.capacity()
            + size_of::<u32>() * self.slots.capacity()
            + self.coarse.as_ref().map_or(0, Coarse::memory)
    }
}

#[cfg(test)]
mod tests;
