//! Angle-weighted pseudonormals: on which side of the surface a point is, told from the closest feature.
//!
//! Source: J. A. Bærentzen and H. Aanæs, "Signed distance computation using the angle weighted pseudonormal",
//! IEEE TVCG 11 (2005) 243.

use glam::DVec3;

use super::outline::{Face, Outline};
use super::triangle::{CORNER, FACE, Feature, SIDE};

/// A triangle lower than this part of its length has no normal to rely on.
const THIN: f64 = 1e-10;
/// Normals that cancel to less than this part of their sum tell no side.
const CANCELLED: f64 = 1e-6;

/// The pseudonormals of a triangle's sides and corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pseudonormals {
    /// Unit normals of the sides ab, bc, ca and of the corners a, b, c.
    normals: [DVec3; 6],
    /// Bit by feature: it does not tell on which side a point is.
    doubtful: u8,
}

impl Pseudonormals {
    /// What an unused slot holds.
    pub const NONE: Self = Self { normals: [DVec3::ZERO; 6], doubtful: 0 };

    /// The normal of a side or corner.
    #[inline(always)]
    pub fn of(&self, feature: Feature) -> DVec3 {
        self.normals[feature - SIDE]
    }

    /// Whether a feature does not tell on which side of the surface a point is.
    #[inline(always)]
    pub fn is_doubtful(&self, feature: Feature) -> bool {
        self.doubtful >> feature & 1 == 1
    }

    fn set(&mut self, feature: Feature, normal: DVec3, doubtful: bool) {
        self.normals[feature - SIDE] = normal;
        self.doubtful |= u8::from(doubtful) << feature;
    }
}

/// The unit vector of a sum of normals with the sum of their weights; `None` where they cancel.
fn unit(sum: DVec3, weight: f64) -> Option<DVec3> {
    let length = sum.length();
    (length > CANCELLED * weight).then(|| sum / length)
}

/// The pseudonormals of each face.
///
/// In doubt are the boundaries of holes, edges at which more than two triangles meet, and triangles without a
/// normal, with all that touches one of these.
pub(super) fn pseudonormals(outline: &Outline) -> Vec<Pseudonormals> {
    let faces = &outline.faces;
    let mut found = vec![Pseudonormals::NONE; faces.len()];
    let mut corners = vec![(DVec3::ZERO, 0.0, false); outline.vertices];

    // corners: the normals around them, weighted by the angles that the faces have there
    for face in faces {
        let thin = is_thin(face);
        for (corner, angle) in angles(face).into_iter().enumerate() {
            let (sum, weight, doubtful) = &mut corners[face.corners[corner] as usize];
            *sum += face.frame.normal * angle;
            *weight += angle;
            *doubtful |= thin;
        }
    }

    // sides: the normals of both faces
    for edge in outline.edges() {
        let up = edge.iter().filter(|side| outline.goes_up(side)).count();
        let sum: DVec3 = edge.iter().map(|side| faces[side.face].frame.normal).sum();
        let unit = unit(sum, edge.len() as f64);
        let plain = edge.len() == 2 && up == 1;
        let thin = edge.iter().any(|side| is_thin(&faces[side.face]));
        for side in edge {
            let normal = unit.unwrap_or(faces[side.face].frame.normal);
            let doubtful = unit.is_none() || !plain || thin;
            found[side.face].set(SIDE + side.corner, normal, doubtful);
        }
        if !plain {
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
            found.set(CORNER + corner, normal, doubtful || unit.is_none());
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
