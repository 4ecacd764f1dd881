//! Closes holes, on request.
//!
//! A planar hole is filled with triangles in its plane. Another one is filled with the triangles of the least area, if it is
//! small: the shape that is missing there is not known, but hardly matters. Cracks (`cracks`) have no area to fill.

use glam::DVec3;

use super::cracks::{close_cracks, is_crack};
use super::holes::{Hole, path_normal};
use super::triangulate::{fill_least_area, fill_planar, is_within};
use crate::shape::mesh::Mesh;
use crate::shape::watertight::short;

/// The longest path that is filled if it is not planar, in units of the square root of the area of the mesh.
const SMALL: f64 = 0.25;
/// The most edges of a hole that is not planar.
const MAX_EDGES: usize = 64;
/// The most planar holes of more than three edges that are searched for rings.
const MAX_HOLES: usize = 3000;

/// A mesh with its holes closed: the result of [`Mesh::with_closed_holes`].
#[derive(Clone, Debug, PartialEq)]
pub struct Closed {
    /// The mesh; the new triangles are the last ones.
    pub mesh: Mesh,
    /// The holes that were closed.
    pub holes: Vec<Hole>,
    /// The number of triangles added.
    pub added: usize,
}

/// Why a hole cannot be closed without guessing.
#[derive(Clone, Debug, PartialEq)]
pub struct HoleError {
    /// The hole.
    pub hole: Box<Hole>,
    /// Why.
    pub cause: HoleFault,
}

/// What is wrong with a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HoleFault {
    /// It is neither planar nor shorter than this (m).
    Large(f64),
    /// It is not planar and has more than this number of edges.
    Intricate(usize),
    /// It is planar, but its rim crosses or touches itself.
    Crossed,
    /// It lies within another one in the same plane, so that a ring is missing.
    Ring,
    /// There are more than this number of planar holes.
    Many(usize),
}

impl std::fmt::Display for HoleError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Hole { centre, perimeter, .. } = *self.hole;
        let edges = self.hole.vertices.len();
        // what is rounding beside the hole is 0
        let is_small = centre.abs().cmplt(DVec3::splat(1e-9 * perimeter));
        let at = short(DVec3::select(is_small, DVec3::ZERO, centre));
        write!(f, "the hole of {edges} edges at {at} cannot be closed: ")?;
        match self.cause {
            HoleFault::Large(most) => write!(
                f,
                "it is not planar, and its perimeter of {perimeter:.4} is above {most:.4}"
            ),
            HoleFault::Intricate(most) => {
                write!(f, "it is not planar, and has more than {most} edges")
            }
            HoleFault::Crossed => write!(f, "its rim crosses itself"),
            HoleFault::Ring => write!(f, "it lies within another one, so that a ring is missing"),
            HoleFault::Many(most) => write!(f, "there are more than {most} like it"),
        }?;
        write!(f, "; close it in the program that made the mesh")
    }
}

impl std::error::Error for HoleError {}

impl Mesh {
    /// Closes all holes: cracks between triangles of different size, planar ones, and others if they are short, with a perimeter below a quarter of the square root of the area, and
    /// have at most 64 edges. The winding must be consistent; see [`Mesh::oriented`].
    ///
    /// # Errors
    /// [`HoleError`] with the first hole that cannot be closed.
    pub fn with_closed_holes(&self) -> Result<Closed, HoleError> {
        let holes = self.holes();
        check_rings(self, &holes)?;
        let longest = SMALL * self.shell_integrals().map_or(0.0, |shell| shell.measure.sqrt());
        let mut mesh = self.clone();
        let (cracks, open): (Vec<&Hole>, Vec<&Hole>) =
            holes.iter().partition(|hole| is_crack(self, hole));
        close_cracks(&mut mesh, &cracks);
        for hole in open {
            let places = places(self, hole);
            let filled = fill(hole, &places, longest);
            let filled =
                filled.map_err(|cause| HoleError { hole: Box::new(hole.clone()), cause })?;
            // against the triangles beside the hole
            let corners = filled.iter().map(|&[a, b, c]| [c, b, a].map(|i| hole.vertices[i]));
            mesh.triangles.extend(corners);
        }
        let added = mesh.triangles.len() - self.triangles.len();
        Ok(Closed { mesh, holes, added })
    }
}

/// The bounding box of points, with a margin for rounding.
fn extent(places: &[DVec3]) -> [DVec3; 2] {
    let low = places.iter().fold(DVec3::INFINITY, |low, &p| low.min(p));
    let high = places.iter().fold(DVec3::NEG_INFINITY, |high, &p| high.max(p));
    let margin = DVec3::splat(1e-5 * (high - low).max_element());
    [low - margin, high + margin]
}

fn places(mesh: &Mesh, hole: &Hole) -> Vec<DVec3> {
    hole.vertices.iter().map(|&i| mesh.vertices[i as usize]).collect()
}

fn fill(hole: &Hole, places: &[DVec3], longest: f64) -> Result<Vec<[usize; 3]>, HoleFault> {
    if places.len() <= 3 {
        return Ok(fill_least_area(places));
    }
    if places.len() > MAX_EDGES && !hole.is_planar {
        return Err(HoleFault::Intricate(MAX_EDGES));
    }
    if hole.is_planar {
        let normal = path_normal(places, hole.centre).normalize_or_zero();
        return fill_planar(places, normal).ok_or(HoleFault::Crossed);
    }
    if hole.perimeter > longest {
        return Err(HoleFault::Large(longest));
    }
    Ok(fill_least_area(places))
}

/// Refuses holes in the same plane of which one lies within another: filling both would fill what is open.
fn check_rings(mesh: &Mesh, holes: &[Hole]) -> Result<(), HoleError> {
    let planar: Vec<&Hole> =
        holes.iter().filter(|hole| hole.is_planar && hole.vertices.len() > 3).collect();
    let refuse = |hole: &Hole, cause| Err(HoleError { hole: Box::new(hole.clone()), cause });
    if planar.len() > MAX_HOLES {
        return refuse(planar[0], HoleFault::Many(MAX_HOLES));
    }
    for outer in &planar {
        let rim = places(mesh, outer);
        let normal = path_normal(&rim, outer.centre).normalize_or_zero();
        if normal == DVec3::ZERO {
            continue;
        }
        let bounds = extent(&rim);
        for inner in &planar {
            // of holes that share a vertex, neither is in the other
            let point = mesh.vertices[inner.vertices[0] as usize];
            let is_boxed = point.cmpge(bounds[0]).all() && point.cmple(bounds[1]).all();
            let off = normal.dot(point - outer.centre).abs();
            if is_boxed
                && off <= 1e-5 * outer.perimeter
                && !outer.vertices.contains(&inner.vertices[0])
                && is_within(&rim, normal, point)
            {
                return refuse(inner, HoleFault::Ring);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{cube, cuboid};
    use super::*;
    use crate::Primitive;

    fn volume(mesh: &Mesh) -> f64 {
        mesh.solid_integrals().unwrap().measure
    }

    /// The mesh without triangles whose corners all satisfy a condition.
    fn without(mut mesh: Mesh, is_gone: impl Fn(DVec3) -> bool) -> Mesh {
        let vertices = mesh.vertices.clone();
        mesh.triangles.retain(|t| !t.iter().all(|&i| is_gone(vertices[i as usize])));
        mesh
    }

    #[test]
    fn planar_holes_of_any_shape_are_closed() {
        let open = without(cube(DVec3::ZERO), |p| p.z > 0.0);
        let closed = open.with_closed_holes().unwrap();
        assert_eq!((closed.holes.len(), closed.added), (1, 2));
        assert!(closed.mesh.watertightness().is_manifold());
        assert_eq!(volume(&closed.mesh), 1.0);
        // the caps of a cylinder
        let solid = Primitive::Cylinder { radius: 1.0, height: 2.0, segments: 48 }.mesh().unwrap();
        let open = without(solid.clone(), |p| p.y.abs() > 0.999);
        let closed = open.with_closed_holes().unwrap();
        assert_eq!(closed.holes.len(), 2);
        assert!((volume(&closed.mesh) - volume(&solid)).abs() < 1e-12);
        // a hole that is not convex
        let solid = Primitive::THandle { length: 0.3, width: 0.2, thickness: 0.05, divisions: 2 };
        let solid = solid.mesh().unwrap();
        let top = solid.vertices.iter().fold(0.0f64, |most, v| most.max(v.z)) - 1e-9;
        let open = without(solid.clone(), |p| p.z > top);
        let closed = open.with_closed_holes().unwrap();
        assert!((volume(&closed.mesh) - volume(&solid)).abs() < 1e-15);
    }

    #[test]
    fn small_holes_are_closed_and_large_ones_refused_with_their_place() {
        let mut ball = Primitive::Sphere { radius: 1.0, subdivisions: 4 }.mesh().unwrap();
        let whole = volume(&ball);
        let corner = ball.triangles[0][0];
        ball.triangles.retain(|t| !t.contains(&corner));
        let closed = ball.with_closed_holes().unwrap();
        assert!(closed.holes.len() == 1 && !closed.holes[0].is_planar || closed.added > 0);
        assert!((volume(&closed.mesh) / whole - 1.0).abs() < 1e-3);
        // two faces of a cube at an edge
        let open = without(without(cube(DVec3::ZERO), |p| p.z > 0.0), |p| p.x > 0.0);
        let error = open.with_closed_holes().unwrap_err();
        assert!(matches!(error.cause, HoleFault::Large(_)));
        let text = error.to_string();
        assert!(
            text.contains("6 edges at (0.166667, 0, 0.166667)")
                && text.contains("perimeter of 6.0000 is"),
            "{text}"
        );
    }

    #[test]
    fn rings_and_crossed_rims_are_refused() {
        let tube = Primitive::Tube {
            radius: 0.1,
            bottom_radius: 0.1,
            height: 0.2,
            thickness: 0.02,
            segments: 48,
        };
        let tube = tube.mesh().unwrap();
        let top = tube.vertices.iter().fold(0.0f64, |most, v| most.max(v.y)) - 1e-9;
        let error = without(tube, |p| p.y > top).with_closed_holes().unwrap_err();
        assert_eq!(error.cause, HoleFault::Ring);
        let mut crossed = without(cube(DVec3::ZERO), |p| p.z > 0.0);
        crossed.vertices.swap(4, 5);
        assert_eq!(crossed.with_closed_holes().unwrap_err().cause, HoleFault::Crossed);
    }

    #[test]
    fn nothing_to_close_is_no_error() {
        assert_eq!(Mesh::default().with_closed_holes().unwrap().added, 0);
        assert_eq!(cube(DVec3::ZERO).with_closed_holes().unwrap().added, 0);
        let huge = without(cuboid(DVec3::ZERO, DVec3::splat(1e300)), |p| p.z > 0.0);
        let _ = huge.with_closed_holes();
    }
}
