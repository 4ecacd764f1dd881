//! Meshes of bodies, welded and decimated to the resolution of the picture.

use super::camera::{Camera, ProjectedPoint};
use super::input::{PictureBody, Pose, is_drawable};
use super::layer::Layer;
use super::normals::corner_normals;
use super::shading::{Lighting, Material};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// Meshes with more vertices than this are decimated.
const MAX_VERTICES: usize = 120_000;
/// Smallest radius of a body in pixels. Smaller bodies are drawn as spheres of this radius.
pub(super) const MIN_PIXEL_RADIUS: f32 = 6.0;

/// Geometry of a body for drawing, in the body frame.
pub(super) struct BodyMesh {
    /// Vertices (m).
    pub vertices: Vec<DVec3>,
    /// Triangles as indices into `vertices`; empty for a point cloud.
    pub triangles: Vec<[u32; 3]>,
    /// Normals at the three corners of each triangle.
    normals: Vec<[Vec3; 3]>,
    /// Largest distance of a vertex from the centre of mass (m).
    pub bounding_radius: f64,
    /// Root mean square distance of the vertices from the centre of mass (m).
    pub rms_radius: f64,
    /// Radius of the sphere drawn for each vertex of a point cloud (m).
    pub vertex_radius: f64,
}

/// The largest distance of a drawable vertex from the origin of the body frame (m).
pub(super) fn bounding_radius(body: &PictureBody) -> f64 {
    let farthest = |r: f64, v: &DVec3| r.max(v.length_squared());
    body.vertices.iter().filter(|v| is_drawable(**v)).fold(0.0, farthest).sqrt()
}

impl BodyMesh {
    /// Prepares a body with the given bounding radius (m) for pictures with the given pixel size (m).
    pub fn new(body: &PictureBody, bounding_radius: f64, pixel_size: f64) -> Self {
        let (vertices, triangles) = decimate(body, bounding_radius, pixel_size);
        let normals = corner_normals(&vertices, &triangles, bounding_radius);
        // the spheres nearly touch if the vertices are spread over a surface
        let vertex_radius =
            bounding_radius * (1.1 / (vertices.len().max(1) as f64).sqrt()).clamp(0.012, 0.16);
        let squares: f64 = vertices.iter().map(|p| p.length_squared()).sum();
        let rms_radius = (squares / vertices.len().max(1) as f64).sqrt();
        Self { vertices, triangles, normals, bounding_radius, rms_radius, vertex_radius }
    }

    /// Approximate rectangle of pixels that the body covers, for placing labels: left, top, right, bottom.
    pub fn approximate_extent(&self, pose: &Pose, camera: &Camera) -> Option<[i32; 4]> {
        let centre = camera.project(pose.position)?;
        let stride = (self.vertices.len() / 400).max(1);
        let vertices = self.vertices.iter().step_by(stride);
        let projected =
            vertices.filter_map(|p| camera.project(pose.position + pose.orientation * *p));
        let mut low = (centre.x - MIN_PIXEL_RADIUS, centre.y - MIN_PIXEL_RADIUS);
        let mut high = (centre.x + MIN_PIXEL_RADIUS, centre.y + MIN_PIXEL_RADIUS);
        for point in projected {
            low = (low.0.min(point.x), low.1.min(point.y));
            high = (high.0.max(point.x), high.1.max(point.y));
        }
        Some([low.0 as i32, low.1 as i32, high.0 as i32, high.1 as i32])
    }

    /// Square of pixels that contains the body in any orientation: left, top, right, bottom.
    pub fn bounding_square(&self, pose: &Pose, camera: &Camera) -> Option<[i32; 4]> {
        let centre = camera.project(pose.position)?;
        let size = camera.length_in_pixels(self.bounding_radius + self.vertex_radius, centre);
        // in perspective a sphere appears larger than its radius at the depth of its centre
        let depth_ratio = camera.relative_to_scene(self.bounding_radius + self.vertex_radius)
            * centre.inverse_depth;
        let size = size / (1.0 - depth_ratio).max(0.05) * 1.2 + MIN_PIXEL_RADIUS + 3.0;
        let (x, y) = (centre.x, centre.y);
        Some([(x - size) as i32, (y - size) as i32, (x + size) as i32, (y + size) as i32])
    }

    /// Draws the body into a layer.
    pub fn draw(
        &self,
        pose: &Pose,
        camera: &Camera,
        lighting: &Lighting,
        material: Material,
        layer: &mut Layer,
    ) {
        let Some(centre) = camera.project(pose.position) else { return };
        if camera.length_in_pixels(self.bounding_radius, centre) < MIN_PIXEL_RADIUS {
            let radius = self.bounding_radius + self.vertex_radius;
            let size = MIN_PIXEL_RADIUS.max(camera.length_in_pixels(radius, centre));
            layer.draw_sphere(centre, size, 0.0, |n| material.shade(lighting, Vec3::from(n)));
            return;
        }
        let project = |v: &DVec3| camera.project(pose.position + pose.orientation * *v);
        if self.triangles.is_empty() {
            let relative_radius = camera.relative_to_scene(self.vertex_radius);
            for at in self.vertices.iter().filter_map(project) {
                let size = camera.length_in_pixels(self.vertex_radius, at).max(1.2);
                layer.draw_sphere(at, size, relative_radius, |n| {
                    material.shade(lighting, Vec3::from(n))
                });
            }
            return;
        }
        let projected: Vec<Option<ProjectedPoint>> = self.vertices.iter().map(project).collect();
        let rotate = |axis: DVec3| camera.rotate_to_view(pose.orientation * axis).as_vec3();
        let (x, y, z) = (rotate(DVec3::X), rotate(DVec3::Y), rotate(DVec3::Z));
        for (triangle, normals) in self.triangles.iter().zip(&self.normals) {
            let corners = triangle.map(|i| projected[i as usize]);
            let [Some(a), Some(b), Some(c)] = corners else { continue };
            layer.draw_triangle([a, b, c], |[u, v, w]| {
                let n = normals[0] * u + normals[1] * v + normals[2] * w;
                let normal = x * n.x + y * n.y + z * n.z;
                // open surfaces are lit on both sides
                material.shade(lighting, if normal.z < 0.0 { -normal } else { normal })
            });
        }
    }
}

/// Welds vertices that share a grid cell, which connects separate triangles into a surface and
/// limits the resolution of large meshes to what is visible.
fn decimate(
    body: &PictureBody,
    bounding_radius: f64,
    pixel_size: f64,
) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut cell_size = 1e-6 * bounding_radius;
    if body.vertices.len() > MAX_VERTICES {
        cell_size = cell_size.max(1.5 * pixel_size).max(bounding_radius / 500.0);
    }
    let (mut vertices, mut remap) = weld(body.vertices, cell_size);
    // a solid point cloud occupies more cells than a surface
    while vertices.len() > MAX_VERTICES {
        cell_size *= 1.5;
        (vertices, remap) = weld(body.vertices, cell_size);
    }
    let welded = |i: u32| remap.get(i as usize).copied().flatten();
    let mut triangles = Vec::with_capacity(body.triangles.len());
    for &[a, b, c] in body.triangles {
        let (Some(a), Some(b), Some(c)) = (welded(a), welded(b), welded(c)) else { continue };
        if a != b && b != c && c != a {
            triangles.push([a, b, c]);
        }
    }
    (vertices, triangles)
}

/// The first vertex in each grid cell, and for each input vertex the index of the vertex that
/// replaces it (`None` if it cannot be drawn).
fn weld(vertices: &[DVec3], cell_size: f64) -> (Vec<DVec3>, Vec<Option<u32>>) {
    let scale = if cell_size > 0.0 { 1.0 / cell_size } else { 0.0 };
    let mut index_of_cell = HashMap::new();
    let mut welded = Vec::new();
    let insert = |vertex: &DVec3| {
        if !is_drawable(*vertex) {
            return None;
        }
        let cell = (*vertex * scale).round().to_array().map(|c| c as i64);
        Some(*index_of_cell.entry(cell).or_insert_with(|| {
            welded.push(*vertex);
            (welded.len() - 1) as u32
        }))
    };
    let remap = vertices.iter().map(insert).collect();
    (welded, remap)
}
