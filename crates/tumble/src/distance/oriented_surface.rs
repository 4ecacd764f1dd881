//! The non-degenerate triangles of a mesh, wound outwards, with their half-edges; and whether they bound a solid.

use glam::DVec3;

use super::error::SurfaceError;
use super::tree::Extent;
use super::triangle::Frame;
use crate::Mesh;
use crate::shape::weld;

/// The longest allowed boundary of a hole, in units of the square root of the surface area. It is that of a round hole
/// in a sphere with a seventh of its radius.
const HOLE: f64 = 0.25;
/// The longest allowed boundary of all holes together, in the same unit.
const HOLES: f64 = 0.5;
/// A volume below this fraction of the bound from the mesh's size is zero up to rounding.
const NEGLIGIBLE: f64 = 1e-14;
/// Mesh sizes (m) accepted, so that products of lengths stay in the range of doubles.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// A triangle of the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    /// The welded vertices; the longest edge runs from the first to the second.
    pub corners: [u32; 3],
    /// The index of the triangle in the mesh.
    pub index: u32,
    pub(super) frame: Frame,
}

/// An edge of one face. Half-edges sort by edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct HalfEdge {
    /// The vertices at its ends, the lower first.
    pub ends: [u32; 2],
    /// The index of the face in [`OrientedSurface::faces`].
    pub face: usize,
    /// The corner of the face at which the half-edge starts.
    pub corner: usize,
}

/// The surface of a solid, wound outwards.
#[derive(Debug)]
pub(crate) struct OrientedSurface {
    pub faces: Vec<Face>,
    /// All half-edges, sorted by edge.
    half_edges: Vec<HalfEdge>,
    /// The number of vertices of the mesh.
    pub vertices: usize,
    /// The bounding box.
    pub(super) bounds: Extent,
    /// Whether the mesh was wound inwards and has been reversed.
    pub is_turned: bool,
    /// The number of holes.
    pub holes: usize,
}

impl OrientedSurface {
    /// The surface of a mesh; small holes are allowed.
    pub fn new(mesh: &Mesh) -> Result<Self, SurfaceError> {
        let welded = weld(&mesh.vertices);
        let mut corners: Vec<(u32, [u32; 3])> = (0..)
            .zip(&mesh.triangles)
            .filter(|&(_, &t)| mesh.corners(t).is_some())
            .map(|(index, &t)| (index, t.map(|i| welded[i as usize])))
            .filter(|(_, [a, b, c])| a != b && b != c && c != a)
            .collect();
        let places = |t: [u32; 3]| t.map(|i| mesh.vertices[i as usize]);
        let bounds = corners
            .iter()
            .flat_map(|&(_, t)| places(t))
            .fold(Extent::NONE, |all, p| all.union(Extent { low: p, high: p }));
        if corners.is_empty() {
            return Err(SurfaceError::NoTriangles);
        }
        let size = (bounds.high - bounds.low).max_element();
        if !SIZES.contains(&size) {
            return Err(SurfaceError::OutOfRange { size });
        }

        let is_turned = wind_outwards(&mut corners, &bounds, places);
        let faces: Vec<Face> = corners.iter().map(|&(i, t)| Face::new(i, t, places)).collect();
        let half_edges = half_edges(&faces);
        let holes = check_edges(mesh, &faces, &half_edges)?;
        let Some(is_turned) = is_turned else { return Err(SurfaceError::NoVolume) };
        Ok(Self { faces, half_edges, vertices: mesh.vertices.len(), bounds, is_turned, holes })
    }

    /// The lowest and the highest coordinates (m).
    pub fn box_corners(&self) -> (DVec3, DVec3) {
        (self.bounds.low, self.bounds.high)
    }

    /// The half-edges of each edge.
    pub fn edges(&self) -> impl Iterator<Item = &[HalfEdge]> {
        edges(&self.half_edges)
    }

    /// Whether a half-edge runs from its lower to its higher vertex.
    pub fn is_ascending(&self, half_edge: &HalfEdge) -> bool {
        is_ascending(&self.faces, half_edge)
    }
}

impl Face {
    /// The unit normal, outwards.
    pub fn normal(&self) -> DVec3 {
        self.frame.normal
    }

    /// The area (m²).
    pub fn area(&self) -> f64 {
        self.frame.area()
    }

    fn new(index: u32, mut corners: [u32; 3], places: impl Fn([u32; 3]) -> [DVec3; 3]) -> Self {
        let first = Frame::first_corner(places(corners));
        corners.rotate_left(first);
        Self { corners, index, frame: Frame::new(places(corners)) }
    }
}

/// Reverses all triangles if the enclosed volume is negative, and returns whether it did; `None` if it is zero.
fn wind_outwards(
    corners: &mut [(u32, [u32; 3])],
    bounds: &Extent,
    places: impl Fn([u32; 3]) -> [DVec3; 3],
) -> Option<bool> {
    // about the centre of the box, which reduces the effect of small holes and of rounding far from the origin
    let middle = 0.5 * bounds.low + 0.5 * bounds.high;
    let (mut volume, mut area) = (0.0, 0.0);
    for &(_, t) in corners.iter() {
        let [a, b, c] = places(t).map(|p| p - middle);
        volume += a.dot(b.cross(c));
        area += (b - a).cross(c - a).length();
    }
    let size = (bounds.high - bounds.low).max_element();
    if volume.abs() <= NEGLIGIBLE * size * area {
        return None;
    }
    if volume < 0.0 {
        corners.iter_mut().for_each(|(_, t)| t.swap(1, 2));
    }
    Some(volume < 0.0)
}

fn half_edges(faces: &[Face]) -> Vec<HalfEdge> {
    let mut half_edges = Vec::with_capacity(3 * faces.len());
    for (face, triangle) in faces.iter().enumerate() {
        for corner in 0..3 {
            let (a, b) = (triangle.corners[corner], triangle.corners[(corner + 1) % 3]);
            half_edges.push(HalfEdge { ends: [a.min(b), a.max(b)], face, corner });
        }
    }
    half_edges.sort_unstable();
    half_edges
}

fn edges(half_edges: &[HalfEdge]) -> impl Iterator<Item = &[HalfEdge]> {
    half_edges.chunk_by(|a, b| a.ends == b.ends)
}

fn is_ascending(faces: &[Face], half_edge: &HalfEdge) -> bool {
    faces[half_edge.face].corners[half_edge.corner] == half_edge.ends[0]
}

/// Refuses inconsistent winding and large holes; returns the number of small holes.
fn check_edges(
    mesh: &Mesh,
    faces: &[Face],
    half_edges: &[HalfEdge],
) -> Result<usize, SurfaceError> {
    let mut boundary = Vec::new();
    for edge in edges(half_edges) {
        let ascending = edge.iter().filter(|half_edge| is_ascending(faces, half_edge)).count();
        if 2 * ascending == edge.len() {
            continue;
        }
        if edge.len() % 2 == 0 {
            return Err(SurfaceError::WronglyWound(mesh.watertightness()));
        }
        let [a, b] = edge[0].ends.map(|i| mesh.vertices[i as usize]);
        boundary.push((edge[0].ends, a.distance(b)));
    }
    let holes = hole_lengths(&boundary);
    let largest = holes.iter().fold(0.0f64, |most, &length| most.max(length));
    let total: f64 = boundary.iter().map(|(_, length)| length).sum();
    let unit = faces.iter().map(|face| face.frame.area()).sum::<f64>().sqrt();
    if largest > HOLE * unit || total > HOLES * unit {
        return Err(SurfaceError::Open {
            watertightness: mesh.watertightness(),
            holes: holes.len(),
            largest,
            largest_allowed: HOLE * unit,
            total,
            total_allowed: HOLES * unit,
        });
    }
    Ok(holes.len())
}

/// The length of each connected component of a set of edges, in a fixed order.
fn hole_lengths(boundary: &[([u32; 2], f64)]) -> Vec<f64> {
    let mut vertices: Vec<u32> = boundary.iter().flat_map(|(ends, _)| *ends).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let place = |vertex: u32| vertices.partition_point(|&v| v < vertex);

    // union-find: each vertex points to another of its component, the root to itself
    let mut parent: Vec<usize> = (0..vertices.len()).collect();
    let root = |parent: &mut Vec<usize>, mut at: usize| {
        while parent[at] != at {
            parent[at] = parent[parent[at]];
            at = parent[at];
        }
        at
    };
    for (ends, _) in boundary {
        let [a, b] = ends.map(|v| root(&mut parent, place(v)));
        parent[a.max(b)] = a.min(b);
    }
    let mut lengths = vec![0.0; vertices.len()];
    for (ends, length) in boundary {
        lengths[root(&mut parent, place(ends[0]))] += length;
    }
    lengths.retain(|&length| length > 0.0);
    lengths
}
