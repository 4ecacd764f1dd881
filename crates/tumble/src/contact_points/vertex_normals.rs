//! The normals of the faces around each vertex of a surface.

use glam::DVec3;

use super::MOST_NORMALS;
use crate::distance::OrientedSurface;

/// Cosine of the angle to their mean up to which the faces around a vertex count as flat.
const FLAT: f64 = 0.9;
/// Cosine of the angle between normals up to which they count as one.
const SAME: f64 = 0.95;

/// What is around a vertex.
#[derive(Clone, Debug, Default)]
pub(super) struct VertexNormals {
    /// Distinct normals; only the mean where the surface is flat.
    pub normals: Vec<DVec3>,
    /// Mean length of the edges (m).
    pub spacing: f64,
    /// Normal and angle (rad) of each face.
    faces: Vec<(DVec3, f64)>,
}

impl VertexNormals {
    /// Whether the surface is nearly flat there.
    pub fn is_flat(&self) -> bool {
        self.normals.len() == 1
    }

    /// The sum of the angles of the faces that face a direction, as parts of one flat side do (rad).
    pub fn angle_facing(&self, direction: DVec3) -> f64 {
        let facing = self.faces.iter().filter(|(normal, _)| normal.dot(direction) > FLAT);
        facing.map(|(_, angle)| angle).sum()
    }
}

/// The normals around each welded vertex; empty for vertices of no face.
pub(super) fn vertex_normals(surface: &OrientedSurface, vertices: &[DVec3]) -> Vec<VertexNormals> {
    let mut found = vec![VertexNormals::default(); vertices.len()];
    for face in &surface.faces {
        for corner in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|k| face.corners[(corner + k) % 3] as usize);
            let (to_b, to_c) = (vertices[b] - vertices[a], vertices[c] - vertices[a]);
            found[a].faces.push((face.normal(), to_b.angle_between(to_c)));
            found[a].spacing += 0.5 * (to_b.length() + to_c.length());
        }
    }
    for vertex in &mut found {
        vertex.spacing /= vertex.faces.len().max(1) as f64;
        vertex.normals = distinct(&vertex.faces);
    }
    found
}

/// Reduces normals with their weights to distinct ones.
fn distinct(all: &[(DVec3, f64)]) -> Vec<DVec3> {
    let mean: DVec3 = all.iter().map(|(normal, angle)| *normal * *angle).sum();
    let Some(mean) = mean.try_normalize() else {
        return all.iter().map(|(normal, _)| *normal).take(MOST_NORMALS).collect();
    };
    if all.iter().all(|(normal, _)| normal.dot(mean) > FLAT) {
        return vec![mean];
    }
    let mut kept: Vec<DVec3> = Vec::new();
    for (normal, _) in all {
        if kept.len() < MOST_NORMALS && kept.iter().all(|other| other.dot(*normal) < SAME) {
            kept.push(*normal);
        }
    }
    kept
}
