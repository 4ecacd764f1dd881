//! Line 2: gravity on every particle.

use crate::{Model, Scratch, Wrench};

/// Σ mᵢ g = M g, at the centre of mass: no torque.
pub fn gravity(model: &Model, scratch: &mut Scratch) {
    for (body, forces) in model.bodies.iter().zip(&mut scratch.forces) {
        forces.gravity = Wrench { force: model.gravity * body.mass, torque: glam::DVec3::ZERO };
    }
}
