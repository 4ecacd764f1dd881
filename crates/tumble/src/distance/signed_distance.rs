//! Queries of the signed distance to a mesh.

use fearless_simd::Level;
use glam::DVec3;

use super::bound_grid::BoundGrid;
use super::error::SurfaceError;
use super::normal_cones::NormalCones;
use super::normals::{Pseudonormals, pseudonormals};
use super::oriented_surface::OrientedSurface;
use super::planes::{Plane, convex_planes};
use super::ray_queries;
use super::search::{Closest, NO_GROUP};
use super::tree::{Extent, Tree};
use super::triangle::{ClosestPoint, FACE};
use crate::Mesh;

/// Marks ignored triangles.
const UNUSED: u32 = u32::MAX;
/// The error of coordinates in units of rounding; a smaller distance has no direction.
const ROUNDINGS: f64 = 8.0;
/// The cosine of the angle between the normals of two faces below which their edge is sharp.
const SHARP: f64 = 0.5;
/// The largest coordinate (m) whose square is in the range of doubles.
const FARTHEST: f64 = 1e140;

/// The signed distance to a surface at a point, with its gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Signed distance (m), negative inside.
    pub distance: f64,
    /// The gradient of the distance, a unit vector. On the surface, the (pseudo)normal.
    pub gradient: DVec3,
    /// Index in the mesh of the closest triangle; the lowest of equally close ones.
    pub triangle: u32,
}

/// The signed distance to a closed triangle mesh.
///
/// Coincident vertices count as one, and triangles with two coincident corners are ignored. A mesh that is wound
/// inwards is treated as if it were wound outwards. Parts should not overlap: a point inside one part and closer to
/// the surface of another, from outside, counts as outside.
///
/// # Holes
/// A mesh may have small holes: the boundary of each is at most 0.25 √A long and of all together 0.5 √A, with A the
/// area of the surface. If the closest point is on the boundary of a hole, a point is inside where the generalised
/// winding number exceeds one half. This takes a sum over all triangles. The same holds near an edge at which more
/// than two triangles meet. A hole itself has no surface: points pass through it.
///
/// ```
/// use tumble::{DVec3, Primitive, SignedDistance};
/// let ball = Primitive::Sphere { radius: 1.0, subdivisions: 5 }.mesh()?;
/// let distance = SignedDistance::new(&ball)?;
/// let nearest = distance.query(DVec3::new(0.0, 0.9, 0.0), 0, f64::INFINITY).unwrap();
/// assert!((nearest.distance + 0.1).abs() < 1e-3);
/// assert!(nearest.gradient.y > 0.99);
/// // two metres away, beyond the limit of one metre
/// assert!(distance.query(DVec3::new(3.0, 0.0, 0.0), 0, 1.0).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SignedDistance {
    pub(super) tree: Tree,
    pub(super) cones: NormalCones,
    /// Pseudonormals by slot.
    normals: Vec<Pseudonormals>,
    /// Slots by triangle of the mesh; [`UNUSED`] for ignored triangles.
    slots: Vec<u32>,
    bounds: Extent,
    /// The largest coordinate (m).
    pub(super) max_coordinate: f64,
    /// `None` for meshes with holes, at which the signed distance is discontinuous.
    pub(super) grid: Option<BoundGrid>,
    thickness: f64,
    median_thickness: f64,
    /// How much farther than the closest triangle a [`Patch`](super::Patch) extends (m).
    pub(super) patch_width: f64,
    is_turned: bool,
    has_sharp_edges: bool,
    planes: Vec<Plane>,
    holes: usize,
    pub(super) level: Level,
}

impl SignedDistance {
    /// Builds the search structures for a mesh.
    ///
    /// # Errors
    /// [`SurfaceError`] if the mesh has no triangles, large holes, inconsistent winding, no volume or a size beyond
    /// the range of doubles.
    pub fn new(mesh: &Mesh) -> Result<Self, SurfaceError> {
        let surface = OrientedSurface::new(mesh)?;
        let tree = Tree::build(surface.faces.iter().map(|face| (face.index, face.frame)));

        // from the order of faces to the order of slots
        let by_face = pseudonormals(&surface);
        let mut slots = vec![UNUSED; mesh.triangles.len()];
        tree.each_slot(|slot, index| slots[index as usize] = slot as u32);
        let mut normals = vec![Pseudonormals::NONE; tree.slots()];
        for (face, found) in surface.faces.iter().zip(by_face) {
            normals[slots[face.index as usize] as usize] = found;
        }

        let bounds = surface.bounds;
        let [thickness, median_thickness] = ray_queries::thickness(&tree, bounds.high - bounds.low);
        let mut made = Self {
            thickness,
            median_thickness,
            patch_width: tree.mean_triangle_size(),
            max_coordinate: bounds.low.abs().max(bounds.high.abs()).max_element(),
            cones: NormalCones::new(&tree),
            tree,
            normals,
            slots,
            bounds,
            grid: None,
            is_turned: surface.is_turned,
            has_sharp_edges: has_sharp_edges(&surface),
            planes: convex_planes(&surface, &mesh.vertices),
            holes: surface.holes,
            level: Level::new(),
        };
        if made.holes == 0 {
            // consecutive cells are neighbours, so the last triangle is a good hint
            let mut hint = 0;
            made.grid = Some(BoundGrid::new(&bounds, made.patch_width, |point| {
                made.query(point, hint, f64::INFINITY).map_or(0.0, |nearest| {
                    hint = nearest.triangle;
                    nearest.distance
                })
            }));
        }
        Ok(made)
    }

    /// The signed distance of a point (m), its gradient and the closest triangle.
    ///
    /// `None` if the point is farther outside than `within` (m), not finite, or has a coordinate above 1e140 m. Points
    /// inside have a result at any depth.
    ///
    /// `hint` is the index of a triangle that may be close, such as the result for a nearby point. It makes the search
    /// faster and does not change the result; any number is valid.
    #[inline]
    pub fn query(&self, point: DVec3, hint: u32, within: f64) -> Option<Nearest> {
        let most = self.search_radius(point, within)?;
        let hint = self.slots.get(hint as usize).map(|&slot| slot as usize);
        self.evaluate_within(point, self.tree.nearest(self.level, point, most * most, hint), within)
    }

    /// The result for the closest triangle; `None` if the point is farther outside than `within` (m).
    #[inline]
    pub(super) fn evaluate_within(
        &self,
        point: DVec3,
        closest: Option<Closest>,
        within: f64,
    ) -> Option<Nearest> {
        let nearest = self.evaluate(point, closest?.slot);
        (nearest.distance < 0.0 || nearest.distance <= within).then_some(nearest)
    }

    /// A lower bound of the signed distance of a point (m), without a search.
    #[inline]
    pub(crate) fn lower_bound(&self, point: DVec3) -> f64 {
        let from_box = self.bounds.distance(point);
        self.grid.as_ref().map_or(from_box, |grid| from_box.max(grid.lower_bound(point)))
    }

    /// The search radius for a point (m); `None` if the point is certainly farther outside than `within` (m).
    #[inline]
    pub(super) fn search_radius(&self, point: DVec3, within: f64) -> Option<f64> {
        // also refuses NaN
        if !point.abs().cmple(DVec3::splat(FARTHEST)).all() {
            return None;
        }
        let at_least = self.lower_bound(point);
        if at_least > within.max(0.0) {
            return None;
        }
        // inside, the distance is needed however large it is
        Some(if at_least > 0.0 { within } else { f64::INFINITY })
    }

    /// Distance, sign and gradient from the closest triangle.
    #[inline]
    fn evaluate(&self, point: DVec3, slot: usize) -> Nearest {
        let frame = self.tree.frame(slot);
        let ClosestPoint { feature, offset, squared } = frame.closest_point(point);
        let offset_world = frame.world_vector(offset);
        let distance = if feature == FACE { offset.z.abs() } else { squared.sqrt() };
        let normals = &self.normals[slot];
        let normal = if feature == FACE { frame.normal } else { normals.get(feature) };

        let outside = if !self.bounds.contains(point) {
            true
        } else if normals.is_doubtful(feature) {
            self.tree.winding(point) <= 0.5
        } else {
            offset_world.dot(normal) >= 0.0
        };
        let sign = if outside { 1.0 } else { -1.0 };
        let rounding =
            ROUNDINGS * f64::EPSILON * self.max_coordinate.max(point.abs().max_element());
        let gradient = if feature == FACE {
            // the normal itself, without the rounding of the offset
            if offset.z * sign >= 0.0 { normal } else { -normal }
        } else if distance <= rounding {
            normal
        } else {
            offset_world * (sign / distance)
        };
        // adding zero turns −0 into 0
        Nearest { distance: sign * distance + 0.0, gradient, triangle: self.tree.index(slot) }
    }

    /// Whether a ball is outside the solid, with no point inside or on the surface.
    ///
    /// The result is exact up to rounding, and then errs towards `false`. For a ball that is not finite or larger
    /// than 1e140 m it is `false`.
    pub fn is_ball_outside(&self, centre: DVec3, radius: f64) -> bool {
        self.is_ball_outside_cached(centre, radius, &mut { NO_GROUP })
    }

    /// As [`Self::is_ball_outside`]. `hint` is a group of triangles to test first, and is updated; any value is valid.
    pub(crate) fn is_ball_outside_cached(
        &self,
        centre: DVec3,
        radius: f64,
        hint: &mut u32,
    ) -> bool {
        if !(centre.is_finite() && radius <= FARTHEST) {
            return false;
        }
        let Some(most) = self.search_radius(centre, radius) else { return true };
        if radius >= 0.0 {
            let overlaps = |grid: &BoundGrid| grid.upper_bound(centre) <= radius;
            if self.grid.as_ref().is_some_and(overlaps) {
                return false;
            }
            // any triangle in the ball is enough
            if let Some(group) = self.tree.any_within(self.level, centre, radius * radius, *hint) {
                *hint = group;
                return false;
            }
        }
        // without a triangle in it the ball is entirely inside or outside
        most <= radius || self.query(centre, UNUSED, radius).is_none()
    }

    /// Whether the segment between two points outside the solid crosses its surface.
    ///
    /// If it only touches an edge or a vertex, the result depends on rounding.
    pub fn intersects_segment(&self, from: DVec3, to: DVec3) -> bool {
        from.is_finite() && to.is_finite() && ray_queries::intersects_segment(&self.tree, from, to)
    }

    /// The lowest and the highest coordinates of the surface (m).
    pub fn bounds(&self) -> (DVec3, DVec3) {
        (self.bounds.low, self.bounds.high)
    }

    /// A typical small thickness of the solid (m): the 5 % quantile, by area, of the depth below the surface.
    ///
    /// The depth is measured from the centroid of a triangle along the inward normal to the opposite surface. On
    /// large meshes it is sampled at 512 triangles, spread evenly by area.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// The median of the depth below the surface, by area (m); see [`Self::thickness`].
    pub(crate) fn median_thickness(&self) -> f64 {
        self.median_thickness
    }

    /// The thickness of the solid (m) next to a point: from the closest point of its surface along the inward normal to
    /// the opposite surface. `None` for a point that is not finite.
    pub(crate) fn thickness_near(&self, point: DVec3) -> Option<f64> {
        let nearest = self.query(point, UNUSED, f64::INFINITY)?;
        let surface = (point - nearest.gradient * nearest.distance, nearest.gradient);
        let own = self.slots[nearest.triangle as usize] as usize;
        let size = (self.bounds.high - self.bounds.low).max_element();
        ray_queries::depth_along(&self.tree, surface, Some(own), size)
    }

    /// The number of triangles that count.
    pub fn triangle_count(&self) -> usize {
        self.tree.count()
    }

    /// The number of small holes in the mesh.
    pub fn holes(&self) -> usize {
        self.holes
    }

    /// Whether the mesh is wound inwards and was reversed.
    pub fn is_inverted(&self) -> bool {
        self.is_turned
    }

    /// Whether two adjacent faces have normals at 60° or more to each other.
    pub(crate) fn has_sharp_edges(&self) -> bool {
        self.has_sharp_edges
    }

    /// The planes of the faces, if the mesh is convex and has few of them; otherwise none.
    pub(crate) fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// The normal of a triangle, by its index in the mesh; zero for one that does not count.
    pub(crate) fn normal(&self, triangle: u32) -> DVec3 {
        match self.slots.get(triangle as usize) {
            Some(&slot) if slot != UNUSED => self.tree.frame(slot as usize).normal,
            _ => DVec3::ZERO,
        }
    }

    /// Memory in use (bytes).
    pub fn memory(&self) -> usize {
        size_of::<Self>()
            + self.tree.memory()
            + size_of::<Pseudonormals>() * self.normals.capacity()
            + size_of::<u32>() * self.slots.capacity()
            + self.cones.memory()
            + size_of::<Plane>() * self.planes.capacity()
            + self.grid.as_ref().map_or(0, BoundGrid::memory)
    }
}

fn has_sharp_edges(surface: &OrientedSurface) -> bool {
    surface.edges().any(|edge| match edge {
        [one, other] => {
            surface.faces[one.face].normal().dot(surface.faces[other.face].normal()) < SHARP
        }
        _ => false,
    })
}
