//! How long contacts last: what a time step must resolve for the rebound to have its restitution.

use std::collections::HashMap;
use std::sync::Arc;

use fearless_simd::Level;
use glam::DVec3;

use crate::shape::AffineFunction;
use crate::{BodyModel, ContactLaw, Model, Surface, restitution};

/// The duration of the shortest damped contact, and the body that has it.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactTime {
    /// The duration of the contact (s).
    pub seconds: f64,
    /// The name of the body.
    pub body: String,
}

impl ContactTime {
    /// Steps for which the error of e, averaged over the phases of the touch within a step, is about 0.01; it falls with the square of dt.
    pub const STEPS: f64 = 8.0;

    /// The largest time step (s) that resolves the contact.
    pub fn dt_for_restitution(&self) -> f64 {
        self.seconds / Self::STEPS
    }
}

/// The triangles of a mesh whose planes are examined; further ones are most likely parts of curved surfaces.
const MAX_TRIANGLES: usize = 4096;
/// Particles at most this far below a plane lie in it, as a fraction of the radius of the body.
const IN_PLANE: f64 = 1e-3;

/// An estimate of the duration of the shortest damped contact; `None` if no contact has a dashpot.
///
/// It is the time after which the force of an impact on one face is zero again, −ln e/(ζ ω) with ω² = K/m. K counts the
/// particles that touch a plane at once: those of the largest face, or of the largest side in the direction of a principal axis. m is the mass
/// of the body, or half of it where spheres may meet their like; that sides of meshes meet flat is rare enough. Contacts of curved bodies last less long the faster these are.
pub fn contact_time(model: &Model) -> Option<ContactTime> {
    let mut known: HashMap<*const BodyModel, f64> = HashMap::new();
    let bodies = model.bodies.iter().zip(&model.names).filter(|(body, _)| body.is_free());
    let times = bodies.map(|(body, name)| {
        let time = known.entry(Arc::as_ptr(body)).or_insert_with(|| shortest(model, body));
        (*time, name)
    });
    let (seconds, body) = times.min_by(|a, b| a.0.total_cmp(&b.0))?;
    seconds.is_finite().then(|| ContactTime { seconds, body: body.clone() })
}

/// The duration of the shortest damped contact of a body (s).
fn shortest(model: &Model, body: &BodyModel) -> f64 {
    let meets = model.has_body_contact && body.surface != Surface::None;
    let meets_its_like =
        body.has_spheres() && model.bodies.iter().filter(|body| body.is_free()).count() > 1;
    let pair = meets.then(|| body.pair_material.law(&body.pair_material));
    let pair_mass = if meets_its_like { 0.5 * body.mass } else { body.mass };
    if !body.contacts.iter().chain(&pair).any(is_damped) {
        return f64::INFINITY;
    }
    let particles = largest_side(body);
    let at_walls = body.contacts.iter().map(|law| duration(law, particles, body.mass));
    let between = pair.iter().map(|law| duration(law, particles, pair_mass));
    at_walls.chain(between).fold(f64::INFINITY, f64::min)
}

fn is_damped(law: &ContactLaw) -> bool {
    law.stiffness > 0.0 && (law.damping > 0.0 || law.damping_ratio > 0.0)
}

/// The duration of an impact of so many particles with this mass (s); infinite without a dashpot.
fn duration(law: &ContactLaw, particles: f64, mass: f64) -> f64 {
    if !is_damped(law) {
        return f64::INFINITY;
    }
    let k = law.stiffness * particles;
    let ratio = law.damping_ratio + 0.5 * law.damping * particles / (k * mass).sqrt();
    -libm::log(restitution(ratio)) / (ratio * (k / mass).sqrt())
}

/// The largest number of particles, or sum of their weights, that touch a plane at once.
fn largest_side(body: &BodyModel) -> f64 {
    let (shape, level) = (&body.shape, Level::new());
    let (particles, radius) = (shape.particles(), shape.radius());
    if particles.len() < 2 || radius == 0.0 {
        return 1.0;
    }
    let axes = shape.principal().axes;
    let axes = [axes.x_axis, axes.y_axis, axes.z_axis];
    let surface = shape.surface();
    let normals = surface.triangles.iter().take(MAX_TRIANGLES).filter_map(|triangle| {
        let [a, b, c] = triangle.map(|vertex| surface.vertices[vertex as usize]);
        (b - a).cross(c - a).try_normalize()
    });
    let count = |outward: DVec3| {
        // heights above a plane that no particle is below
        let height = |offset| AffineFunction { offset, slope: -outward };
        let top = particles.largest(level, &height(2.0 * radius));
        let side = height(2.0 * radius - top + IN_PLANE * radius);
        particles.sums(level, &side, None).count
    };
    axes.into_iter().flat_map(|axis| [axis, -axis]).chain(normals).map(count).fold(1.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Damping, MassModel, Material, Primitive, Sampling, Shape, WallPlane, World};

    fn time(divisions: u32, damping: Damping) -> Option<f64> {
        let mesh = Primitive::Box { size: DVec3::new(0.3, 0.2, 0.1), divisions }.mesh().unwrap();
        let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap();
        let floor = WallPlane { normal: DVec3::Y, offset: 0.0 };
        let world = World::builder().material(Material { damping, ..Material::default() });
        let body = Body::new(shape).mass(2.0).position(DVec3::Y);
        let world = world.wall(floor).body(body).dt(1e-5).build().unwrap();
        contact_time(world.model()).map(|time| time.seconds)
    }

    #[test]
    fn the_contact_time_of_a_box_is_that_of_its_largest_face() {
        assert_eq!(time(2, Damping::Restitution(1.0)), None);
        let found = time(2, Damping::Restitution(0.999)).unwrap();
        let half_period = std::f64::consts::PI * f64::sqrt(2.0 / 9e4);
        assert!((found / half_period - 1.0).abs() < 1e-3, "{found} {half_period}");
        // a dashpot makes the force vanish earlier
        let (strong, weak) = (Damping::Dashpot(40.0), Damping::Dashpot(1.0));
        assert!(time(2, strong).unwrap() < time(2, weak).unwrap());
        // finer meshes have more springs in each face
        assert!(time(4, weak).unwrap() < 0.7 * time(2, weak).unwrap());
    }
}
