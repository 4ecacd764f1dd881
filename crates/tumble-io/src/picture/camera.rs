//! Perspective projection from world coordinates to pixels.

use super::input::{View, is_drawable};
use glam::{DQuat, DVec3};

/// Tangent of half the vertical field of view. It is narrow, so that near and far bodies can be compared in size.
const TAN_HALF_FOV: f64 = 0.27;
/// Depth of the near clipping plane, in units of the scene size.
const NEAR_PLANE: f64 = 1e-3;

/// Rectangle of the picture that the scene may fill, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewport {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

/// A point projected into the picture: pixels from the upper left corner, and inverse depth.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ProjectedPoint {
    pub x: f32,
    pub y: f32,
    /// Inverse of the depth in units of the scene size. Larger values are nearer.
    pub inverse_depth: f32,
}

/// A perspective camera.
#[derive(Clone, Debug)]
pub(super) struct Camera {
    /// Centre and size of the scene (m). All other lengths are relative to them, so that scenes of any scale work.
    centre: DVec3,
    scale: f64,
    eye: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    /// Unit vector from the scene towards the viewer.
    pub back: DVec3,
    focal: f64,
    principal: (f64, f64),
}

/// Orthonormal axes of the scene: a horizontal one, up, and the other horizontal one.
fn horizontal_frame(up: DVec3) -> (DVec3, DVec3, DVec3) {
    let up = if is_drawable(up) { up.try_normalize().unwrap_or(DVec3::Y) } else { DVec3::Y };
    let axis = if up.x.abs() < 0.9 { DVec3::X } else { DVec3::Z };
    let east = (axis - up * up.dot(axis)).normalize();
    (east, up, east.cross(up))
}

/// Centre and half diagonal of the bounding box of points (m).
fn bounds(points: &[DVec3]) -> (DVec3, f64) {
    let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
    for &point in points {
        low = low.min(point);
        high = high.max(point);
    }
    if points.is_empty() {
        return (DVec3::ZERO, 1.0);
    }
    let centre = 0.5 * (low + high);
    // a single point has no size; use one that its coordinates can resolve
    let min_scale = 1e-9 * centre.length();
    let scale = (0.5 * (high - low).length()).max(min_scale);
    (centre, if scale > 1e-90 { scale } else { 1.0 })
}

impl Camera {
    /// A camera with the given view direction, as close as all `points` (m) fit the viewport, then zoomed.
    pub fn fit(points: &[DVec3], up: DVec3, direction: View, view: Viewport) -> Self {
        let (east, up, south) = horizontal_frame(up);
        let rotation = DQuat::from_axis_angle(up, direction.yaw)
            * DQuat::from_axis_angle(east, -direction.pitch);
        let (right, back) = (rotation * east, rotation * south);
        let (centre, scale) = bounds(points);
        let focal = 0.5 * view.height / TAN_HALF_FOV;
        let mut camera = Self {
            centre,
            scale,
            eye: DVec3::ZERO,
            right,
            up: back.cross(right),
            back,
            focal,
            principal: (view.left + 0.5 * view.width, view.top + 0.5 * view.height),
        };
        camera.move_back_to_fit(points, 0.5 * view.width / focal, TAN_HALF_FOV);
        camera.focal *= direction.zoom;
        camera
    }

    /// Sets the nearest eye position for which every point lies within the view frustum.
    fn move_back_to_fit(&mut self, points: &[DVec3], half_width: f64, half_height: f64) {
        // support of the points along the normal of each side of the frustum: the largest ±x + t·z
        let mut support = [f64::MIN; 4];
        let mut front = f64::MIN;
        for &point in points {
            let local = (point - self.centre) / self.scale;
            let (x, y, z) = (local.dot(self.right), local.dot(self.up), local.dot(self.back));
            let sides = [
                x + half_width * z,
                -x + half_width * z,
                y + half_height * z,
                -y + half_height * z,
            ];
            for (extent, side) in support.iter_mut().zip(sides) {
                *extent = extent.max(side);
            }
            front = front.max(z);
        }
        if points.is_empty() {
            (support, front) = ([0.0; 4], 0.0);
        }
        let distance = (0.5 * (support[0] + support[1]) / half_width)
            .max(0.5 * (support[2] + support[3]) / half_height)
            .max(front + 0.2);
        self.eye = self.right * (0.5 * (support[0] - support[1]))
            + self.up * (0.5 * (support[2] - support[3]))
            + self.back * distance;
    }

    /// The same camera with the image shifted by a subpixel offset.
    pub fn with_offset(&self, x: f64, y: f64) -> Self {
        let principal = (self.principal.0 + x, self.principal.1 + y);
        Self { principal, ..self.clone() }
    }

    /// Projects a point (m). `None` if it lies behind the viewer or far outside the picture.
    pub fn project(&self, point: DVec3) -> Option<ProjectedPoint> {
        let local = (point - self.centre) / self.scale - self.eye;
        let depth = -local.dot(self.back);
        if depth.is_nan() || depth < NEAR_PLANE {
            return None;
        }
        let x = self.principal.0 + self.focal * local.dot(self.right) / depth;
        let y = self.principal.1 - self.focal * local.dot(self.up) / depth;
        (x.abs() < 1e5 && y.abs() < 1e5).then(|| ProjectedPoint {
            x: x as f32,
            y: y as f32,
            inverse_depth: (1.0 / depth) as f32,
        })
    }

    /// The ray through a point of the picture (pixels): the eye (m), and the direction (m) scaled to unit depth.
    pub fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let across = (x - self.principal.0) / self.focal;
        let down = (y - self.principal.1) / self.focal;
        let direction = self.right * across - self.up * down - self.back;
        (self.centre + self.eye * self.scale, direction * self.scale)
    }

    /// Size in pixels of a length (m) at the depth of a projected point.
    pub fn length_in_pixels(&self, length: f64, at: ProjectedPoint) -> f32 {
        (length / self.scale * self.focal) as f32 * at.inverse_depth
    }

    /// Size of a pixel (m) at the centre of the scene.
    pub fn pixel_size(&self) -> f64 {
        self.scale * self.eye.dot(self.back) / self.focal
    }

    /// A length (m) in units of the scene size.
    pub fn relative_to_scene(&self, length: f64) -> f32 {
        (length / self.scale) as f32
    }

    /// Centre of the scene (m).
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Size of the scene (m): half the diagonal of its bounding box.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Position of the viewer (m).
    pub fn eye(&self) -> DVec3 {
        self.centre + self.eye * self.scale
    }

    /// Rotates a vector from the world frame to the view frame: right, up, towards the viewer.
    pub fn rotate_to_view(&self, direction: DVec3) -> DVec3 {
        DVec3::new(direction.dot(self.right), direction.dot(self.up), direction.dot(self.back))
    }
}
