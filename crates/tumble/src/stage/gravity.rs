//! Line 2 of the basic system: gravity on every particle.

use crate::{Batch, Wrench};

/// Sets the weight of each body, Σ mᵢ g = M g. It acts at the centre of mass and has no torque.
pub fn gravity(batch: &mut Batch) {
    let model = batch.model;
    for (body, forces) in model.bodies[batch.first..].iter().zip(&mut *batch.forces) {
        forces.gravity = Wrench { force: model.gravity * body.mass, torque: glam::DVec3::ZERO };
    }
}
