//! Lighting of bodies.

use super::camera::Camera;
use super::colour::BACKGROUND;
use glam::{DVec3, Vec3};

/// Light directions in the view frame: right, up, towards the viewer.
pub(super) struct Lighting {
    key: Vec3,
    /// Halfway vector between the key light and the viewer (Blinn 1977).
    half: Vec3,
    sky: Vec3,
}

impl Lighting {
    /// A key light from the upper left behind the viewer, and light from the sky.
    pub fn new(camera: &Camera, up: DVec3) -> Self {
        let key = Vec3::new(-0.5, 0.75, 0.62).normalize();
        let sky = camera.rotate_to_view(up).as_vec3().normalize_or(Vec3::Y);
        Self { key, half: (key + Vec3::Z).normalize(), sky }
    }

    /// The shaded colour of a surface with this normal.
    fn shade(&self, colour: [f32; 3], normal: Vec3) -> [f32; 3] {
        let lambert = normal.dot(self.key).max(0.0);
        let level = 0.60 + 0.13 * normal.dot(self.sky) + 0.40 * lambert;
        let specular = normal.dot(self.half).max(0.0).powi(28) * 34.0;
        // darker silhouettes separate a body from the background and from bodies of the same colour
        let edge = 1.0 - normal.z.clamp(0.0, 1.0);
        let rim = 1.0 - 0.42 * edge * edge * edge;
        colour.map(|c| (c * level * rim + specular).min(255.0))
    }
}

/// Colour and opacity of a body in one snapshot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Material {
    pub colour: [f32; 3],
    /// Blend towards the background, from 0 (full colour) to 1 (background).
    pub fade: f32,
    pub alpha: u8,
}

impl Material {
    /// The colour of a point with this normal: red, green, blue, alpha.
    pub fn shade(&self, lighting: &Lighting, normal: Vec3) -> [u8; 4] {
        let normal = normal.normalize_or(Vec3::Z);
        let shaded = lighting.shade(self.colour, normal);
        let mix = |c: usize| shaded[c] + (BACKGROUND[c] - shaded[c]) * self.fade;
        [mix(0) as u8, mix(1) as u8, mix(2) as u8, self.alpha]
    }
}
