//! The planes of the faces of a convex polyhedron.

use glam::DVec3;

use super::oriented_surface::OrientedSurface;

/// The largest number of planes.
const MOST_PLANES: usize = 64;
/// Faces belong to one plane, and vertices are on its inner side, within this distance, in units of the size of the mesh; and
/// within this angle (rad). Coordinates may have been rounded to single precision.
const TOLERANCE: f64 = 1e-6;

/// A plane with the solid on its inner side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// Unit vector, outwards.
    pub normal: DVec3,
    /// Distance from the origin along the normal (m).
    pub offset: f64,
}

impl Plane {
    /// How far a point is on the inner side (m).
    #[inline(always)]
    pub fn depth(&self, point: DVec3) -> f64 {
        self.offset - self.normal.dot(point)
    }
}

/// The planes of the faces, each once. None if the surface is not convex, or has too many planes for them to be of use.
pub(super) fn convex_planes(surface: &OrientedSurface, vertices: &[DVec3]) -> Vec<Plane> {
    let (low, high) = surface.box_corners();
    let tolerance = TOLERANCE * (high - low).length();
    let mut planes: Vec<Plane> = Vec::new();
    for face in &surface.faces {
        let normal = face.normal();
        let corners = face.corners.map(|corner| normal.dot(vertices[corner as usize]));
        let offset = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let known = planes.iter_mut().find(|plane| {
            plane.normal.distance_squared(normal) < TOLERANCE * TOLERANCE
                && (plane.offset - offset).abs() < tolerance
        });
        if let Some(known) = known {
            known.offset = known.offset.max(offset);
        } else if planes.len() < MOST_PLANES {
            planes.push(Plane { normal, offset });
        } else {
            return Vec::new();
        }
    }
    let corners = || surface.faces.iter().flat_map(|face| face.corners);
    let contain = |corner: u32| {
        planes.iter().all(|plane| plane.depth(vertices[corner as usize]) >= -tolerance)
    };
    if corners().all(contain) { planes } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::{Mesh, Primitive};

    fn planes(mesh: &Mesh) -> Vec<Plane> {
        convex_planes(&OrientedSurface::new(mesh).unwrap(), &mesh.vertices)
    }

    #[test]
    fn a_box_has_six_planes_however_fine_its_mesh() {
        let size = DVec3::new(1.0, 2.0, 3.0);
        for divisions in [1, 5] {
            let planes = planes(&Primitive::Box { size, divisions }.mesh().unwrap());
            assert_eq!(planes.len(), 6);
            for plane in planes {
                assert_eq!(plane.depth(DVec3::ZERO), (plane.normal * size).length() / 2.0);
            }
        }
    }

    #[test]
    fn concave_meshes_several_parts_and_fine_balls_have_none() {
        let torus = Primitive::Torus { radius: 1.0, tube_radius: 0.4, segments: 6 };
        assert_eq!(planes(&torus.mesh().unwrap()), []);
        let ball = Primitive::Sphere { radius: 1.0, subdivisions: 3 };
        assert_eq!(planes(&ball.mesh().unwrap()), []);
        let one = Primitive::Box { size: DVec3::ONE, divisions: 1 }.mesh().unwrap();
        let mut two = one.clone();
        two.vertices.extend(one.vertices.iter().map(|vertex| *vertex + DVec3::X * 1.5));
        two.triangles.extend(one.triangles.iter().map(|triangle| triangle.map(|i| i + 8)));
        assert_eq!(planes(&two), []);
    }

    #[test]
    fn coordinates_in_single_precision_keep_their_planes() {
        let mut mesh = Primitive::Box { size: DVec3::splat(0.1), divisions: 4 }.mesh().unwrap();
        let turn = glam::DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.4);
        for vertex in &mut mesh.vertices {
            *vertex = (turn * *vertex).as_vec3().as_dvec3();
        }
        assert_eq!(planes(&mesh).len(), 6);
    }
}
