//! Where the viewer stands, and how points of the world become pixels.

use super::{View, drawable};
use glam::{DQuat, DVec3};

/// Half of the vertical angle of view, as a tangent: a long lens, so that sizes can be compared.
const HALF_VIEW: f64 = 0.27;
/// Nothing nearer than this is drawn, in units of the scene's size.
const NEAR: f64 = 1e-3;

/// The part of the picture that the scene may fill, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewport {
    pub left: f64,
    pub top: f64,
    pub width: f64,
    pub height: f64,
}

/// A point in the picture: pixels from the upper left corner, and one over the distance.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Projected {
    pub x: f32,
    pub y: f32,
    /// One over the depth, in units of the scene's size: the larger, the nearer.
    pub nearness: f32,
}

/// A perspective view that frames a set of points.
#[derive(Clone, Debug)]
pub(super) struct Camera {
    /// Middle and size of the scene (m): all else is in this frame, so no scale is too large.
    centre: DVec3,
    scale: f64,
    eye: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    /// From the scene to the viewer.
    pub back: DVec3,
    focal: f64,
    principal: (f64, f64),
}

/// Two level directions and the one that points up: right and front of the scene's own frame.
fn level_frame(up: DVec3) -> (DVec3, DVec3, DVec3) {
    let up = if drawable(up) { up.try_normalize().unwrap_or(DVec3::Y) } else { DVec3::Y };
    let aside = if up.x.abs() < 0.9 { DVec3::X } else { DVec3::Z };
    let east = (aside - up * up.dot(aside)).normalize();
    (east, up, east.cross(up))
}

/// The smallest sphere-like bounds of points: the middle of their box and half of its diagonal.
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
    // a lone point has no size: any will do that its coordinates can resolve
    let least = 1e-9 * centre.length();
    let scale = (0.5 * (high - low).length()).max(least);
    (centre, if scale > 1e-90 { scale } else { 1.0 })
}

impl Camera {
    /// Looks at `points` in a direction, as near as they all fit the viewport; then zooms in.
    pub fn framing(points: &[DVec3], up: DVec3, direction: View, view: Viewport) -> Self {
        let (east, up, south) = level_frame(up);
        let turn = DQuat::from_axis_angle(up, direction.yaw)
            * DQuat::from_axis_angle(east, -direction.pitch);
        let (right, back) = (turn * east, turn * south);
        let (centre, scale) = bounds(points);
        let focal = 0.5 * view.height / HALF_VIEW;
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
        camera.stand_back(points, 0.5 * view.width / focal, HALF_VIEW);
        camera.focal *= direction.zoom;
        camera
    }

    /// Finds the nearest eye for which each point lies within the four planes of the view.
    fn stand_back(&mut self, points: &[DVec3], half_width: f64, half_height: f64) {
        // the largest of ±x + t·z over the points, for each side of the view
        let mut reach = [f64::MIN; 4];
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
            for (most, side) in reach.iter_mut().zip(sides) {
                *most = most.max(side);
            }
            front = front.max(z);
        }
        if points.is_empty() {
            (reach, front) = ([0.0; 4], 0.0);
        }
        let distance = (0.5 * (reach[0] + reach[1]) / half_width)
            .max(0.5 * (reach[2] + reach[3]) / half_height)
            .max(front + 0.2);
        self.eye = self.right * (0.5 * (reach[0] - reach[1]))
            + self.up * (0.5 * (reach[2] - reach[3]))
            + self.back * distance;
    }

    /// The same view with the picture moved by a part of a pixel.
    pub fn shifted(&self, x: f64, y: f64) -> Self {
        let principal = (self.principal.0 + x, self.principal.1 + y);
        Self { principal, ..self.clone() }
    }

    /// Where a point (m) lies in the picture; none behind the viewer or far off.
    pub fn project(&self, point: DVec3) -> Option<Projected> {
        let local = (point - self.centre) / self.scale - self.eye;
        let depth = -local.dot(self.back);
        if depth.is_nan() || depth < NEAR {
            return None;
        }
        let x = self.principal.0 + self.focal * local.dot(self.right) / depth;
        let y = self.principal.1 - self.focal * local.dot(self.up) / depth;
        (x.abs() < 1e5 && y.abs() < 1e5).then(|| Projected {
            x: x as f32,
            y: y as f32,
            nearness: (1.0 / depth) as f32,
        })
    }

    /// The way of sight through a pixel: the eye (m), and a direction (m) of depth one.
    pub fn sight(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let across = (x - self.principal.0) / self.focal;
        let down = (y - self.principal.1) / self.focal;
        let direction = self.right * across - self.up * down - self.back;
        (self.centre + self.eye * self.scale, direction * self.scale)
    }

    /// How many pixels a length (m) takes at a projected point.
    pub fn pixels(&self, length: f64, at: Projected) -> f32 {
        (length / self.scale * self.focal) as f32 * at.nearness
    }

    /// The length (m) that one pixel spans at the middle of the scene.
    pub fn pixel_length(&self) -> f64 {
        self.scale * self.eye.dot(self.back) / self.focal
    }

    /// A length (m) in units of the scene's size.
    pub fn relative(&self, length: f64) -> f32 {
        (length / self.scale) as f32
    }

    /// Middle of the scene (m).
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Size of the scene (m): half of its diagonal.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Where the viewer stands (m).
    pub fn eye(&self) -> DVec3 {
        self.centre + self.eye * self.scale
    }

    /// A direction of the world in the frame of the picture: right, up, to the viewer.
    pub fn turn(&self, direction: DVec3) -> DVec3 {
        DVec3::new(direction.dot(self.right), direction.dot(self.up), direction.dot(self.back))
    }
}
