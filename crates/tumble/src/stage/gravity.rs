//! Line 2: gravity on every particle.

use crate::{Batch, Wrench};

/// Σ mᵢ g = M g, at the centre of mass: no torque.
pub fn gravity(batch: &mut Batch) {
    let model = batch.model;
    for (body, forces) in model.bodies[batch.first..].iter().zip(&mut *batch.forces) {
        forces.gravity = Wrench { force: model.gravity * body.mass, torque: glam::DVec3::ZERO };
    }
}
