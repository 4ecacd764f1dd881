//! Angle-weighted pseudonormals, which give the side of a point from its closest feature.
//!
//! Source: J. A. Bærentzen and H. Aanæs, "Signed distance computation using the angle weighted pseudonormal",
//! IEEE TVCG 11 (2005) 243.

use glam::DVec3;

use super::oriented_surface::{Face, OrientedSurface};
use super::triangle::{EDGE, FACE, Feature, VERTEX};

/// The height of a triangle, in units of its longest edge, below which its normal is unreliable.
const THIN: f64 = 1e-10;
/// The length of a sum of normals, in units of their weights, below which it is unreliable.
const CANCELLED: f64 = 1e-6;

/// The pseudonormals of a triangle's edges and vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pseudonormals {
    /// Unit normals of the edges ab, bc, ca and of the vertices a, b, c.
    normals: [DVec3; 6],
    /// One bit per feature: set if its normal does not determine the side of a point.
    doubtful: u8,
}

impl Pseudonormals {
    /// The content of an unused slot.
    pub const NONE: Self = Self { normals: [DVec3::ZERO; 6], doubtful: 0 };

    /// The normal of an edge or vertex.
    #[inline(always)]
    pub fn get(&self, feature: Feature) -> DVec3 {
        self.normals[feature - EDGE]
    }

    /// Whether the normal of a feature does not determine the side of a point.
    #[inline(always)]
    pub fn is_doubtful(&self, feature: Feature) -> bool {
        self.doubtful >> feature & 1 == 1
    }

    fn set(&mut self, feature: Feature, normal: DVec3, doubtful: bool) {
        self.normals[feature - EDGE] = normal;
        self.doubtful |= u8::from(doubtful) << feature;
    }
}

/// The unit vector along a weighted sum of normals; `None` if they cancel.
fn unit(sum: DVec3, weight: f64) -> Option<DVec3> {
    let length = sum.length();
    (length > CANCELLED * weight).then(|| sum / length)
}

/// The pseudonormals of each face.
///
/// Doubtful are the boundaries of holes, edges at which more than two triangles meet, triangles without a normal, and
/// all features that touch one of these.
pub(super) fn pseudonormals(surface: &OrientedSurface) -> Vec<Pseudonormals> {
    let faces = &surface.faces;
    let mut found = vec![Pseudonormals::NONE; faces.len()];
    let mut corners = vec![(DVec3::ZERO, 0.0, false); surface.vertices];

    // vertices: the normals of their faces, weighted by the angles at the vertex
    for face in faces {
        let thin = is_thin(face);
        for (corner, angle) in angles(face).into_iter().enumerate() {
            let (sum, weight, doubtful) = &mut corners[face.corners[corner] as usize];
            *sum += face.frame.normal * angle;
            *weight += angle;
            *doubtful |= thin;
        }
    }

    // edges: the sum of the normals of both faces
    for edge in surface.edges() {
        let ascending = edge.iter().filter(|half_edge| surface.is_ascending(half_edge)).count();
        let sum: DVec3 = edge.iter().map(|half_edge| faces[half_edge.face].frame.normal).sum();
        let unit = unit(sum, edge.len() as f64);
        let is_manifold = edge.len() == 2 && ascending == 1;
        let thin = edge.iter().any(|half_edge| is_thin(&faces[half_edge.face]));
        for half_edge in edge {
            let normal = unit.unwrap_or(faces[half_edge.face].frame.normal);
            let doubtful = unit.is_none() || !is_manifold || thin;
            found[half_edge.face].set(EDGE + half_edge.corner, normal, doubtful);
        }
        if !is_manifold {
            for end in edge[0].ends {
                corners[end as usize].2 = true;
            }
        }
    }

    for (face, found) in faces.iter().zip(&mut found) {
        found.doubtful |= u8::from(is_thin(face)) << FACE;
        for (corner, &vertex) in face.corners.iter().enumerate() {
            let (sum, weight, doubtful) = corners[vertex as usize];
            let unit = unit(sum, weight);
            let normal = unit.unwrap_or(face.frame.normal);
            found.set(VERTEX + corner, normal, doubtful || unit.is_none());
        }
    }
    found
}

fn is_thin(face: &Face) -> bool {
    face.frame.apex[1] <= THIN * face.frame.length
}

/// The angles at the corners of a face.
fn angles(face: &Face) -> [f64; 3] {
    let frame = &face.frame;
    let [x, y] = frame.apex;
    let at_a = libm::atan2(y, x);
    let at_b = libm::atan2(y, frame.length - x);
    [at_a, at_b, std::f64::consts::PI - at_a - at_b]
}
