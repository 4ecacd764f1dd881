//! The triangles of a mesh that count, wound outwards, their sides matched to edges; and whether they have an inside.

use glam::DVec3;

use super::SurfaceError;
use super::tree::Extent;
use super::triangle::Frame;
use crate::Mesh;
use crate::shape::weld;

/// The boundary of a hole may be this long, in units of the root of the surface's area. A round hole in a ball has
/// this where its radius is a seventh of the ball's.
const HOLE: f64 = 0.25;
/// The boundaries of all holes together may be this long, in the same unit.
const HOLES: f64 = 0.5;
/// A volume below this part of what the mesh's size allows is rounding, not substance.
const NOTHING: f64 = 1e-14;
/// Meshes smaller or larger (m) would lose their squares to the range of doubles.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// A triangle that counts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Its corners, welded: the longest side is from the first to the second.
    pub corners: [u32; 3],
    /// Its index in the mesh.
    pub index: u32,
    pub frame: Frame,
}

/// A side of a triangle, by the edge of which it is part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    /// The vertices at its ends, the lower first.
    pub ends: [u32; 2],
    /// The place of the face among the faces.
    pub face: usize,
    /// The side starts at this corner of the face.
    pub corner: usize,
}

/// The surface of a solid.
#[derive(Debug)]
pub(super) struct Outline {
    pub faces: Vec<Face>,
    /// All sides, by edge.
    pub sides: Vec<Side>,
    /// How many vertices the mesh has.
    pub vertices: usize,
    /// The box around it.
    pub bounds: Extent,
    /// Whether the mesh was wound inwards, and has been turned.
    pub turned: bool,
    /// How many holes there are.
    pub holes: usize,
}

impl Outline {
    /// The surface of the solid that a mesh bounds, but for small holes.
    pub fn of(mesh: &Mesh) -> Result<Self, SurfaceError> {
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
            .fold(Extent::NONE, |all, p| all.with(Extent { low: p, high: p }));
        if corners.is_empty() {
            return Err(SurfaceError::NoTriangles);
        }
        let size = (bounds.high - bounds.low).max_element();
        if !SIZES.contains(&size) {
            return Err(SurfaceError::OutOfRange { size });
        }

        let turned = turn_outwards(&mut corners, &bounds, places);
        let faces: Vec<Face> = corners.iter().map(|&(i, t)| Face::of(i, t, places)).collect();
        let sides = sides(&faces);
        let holes = check_edges(mesh, &faces, &sides)?;
        let Some(turned) = turned else { return Err(SurfaceError::NoVolume) };
        Ok(Self { faces, sides, vertices: mesh.vertices.len(), bounds, turned, holes })
    }

    /// The sides, one slice an edge.
    pub fn edges(&self) -> impl Iterator<Item = &[Side]> {
        edges(&self.sides)
    }

    /// Whether a side is passed from its lower to its upper vertex.
    pub fn goes_up(&self, side: &Side) -> bool {
        goes_up(&self.faces, side)
    }
}

impl Face {
    fn of(index: u32, mut corners: [u32; 3], places: impl Fn([u32; 3]) -> [DVec3; 3]) -> Self {
        let first = Frame::first_corner(places(corners));
        corners.rotate_left(first);
        Self { corners, index, frame: Frame::of(places(corners)) }
    }
}

/// Winds all triangles the other way if the volume inside is negative, and says so; `None` if there is none.
fn turn_outwards(
    corners: &mut [(u32, [u32; 3])],
    bounds: &Extent,
    places: impl Fn([u32; 3]) -> [DVec3; 3],
) -> Option<bool> {
    // about the middle of the box, so that a small hole or a large distance from the origin matters little
    let middle = 0.5 * bounds.low + 0.5 * bounds.high;
    let (mut volume, mut area) = (0.0, 0.0);
    for &(_, t) in corners.iter() {
        let [a, b, c] = places(t).map(|p| p - middle);
        volume += a.dot(b.cross(c));
        area += (b - a).cross(c - a).length();
    }
    let size = (bounds.high - bounds.low).max_element();
    if volume.abs() <= NOTHING * size * area {
        return None;
    }
    if volume < 0.0 {
        corners.iter_mut().for_each(|(_, t)| t.swap(1, 2));
    }
    Some(volume < 0.0)
}

fn sides(faces: &[Face]) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * faces.len());
    for (face, triangle) in faces.iter().enumerate() {
        for corner in 0..3 {
            let (a, b) = (triangle.corners[corner], triangle.corners[(corner + 1) % 3]);
            sides.push(Side { ends: [a.min(b), a.max(b)], face, corner });
        }
    }
    sides.sort_unstable();
    sides
}

fn edges(sides: &[Side]) -> impl Iterator<Item = &[Side]> {
    sides.chunk_by(|a, b| a.ends == b.ends)
}

fn goes_up(faces: &[Face], side: &Side) -> bool {
    faces[side.face].corners[side.corner] == side.ends[0]
}

/// Refuses what is wound wrongly or has large holes; returns how many small ones there are.
fn check_edges(mesh: &Mesh, faces: &[Face], sides: &[Side]) -> Result<usize, SurfaceError> {
    let mut boundary = Vec::new();
    for edge in edges(sides) {
        let up = edge.iter().filter(|side| goes_up(faces, side)).count();
        if 2 * up == edge.len() {
            continue;
        }
        if edge.len() % 2 == 0 {
            return Err(SurfaceError::WronglyWound(mesh.closedness()));
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
            closedness: mesh.closedness(),
            holes: holes.len(),
            largest,
            largest_allowed: HOLE * unit,
            total,
            total_allowed: HOLES * unit,
        });
    }
    Ok(holes.len())
}

/// The length of each connected part of a set of edges, in no particular but a fixed order.
fn hole_lengths(boundary: &[([u32; 2], f64)]) -> Vec<f64> {
    let mut vertices: Vec<u32> = boundary.iter().flat_map(|(ends, _)| *ends).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let place = |vertex: u32| vertices.partition_point(|&v| v < vertex);

    // each vertex points to another of its part, the last to itself
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
