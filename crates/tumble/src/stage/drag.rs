//! Line 8 of the basic system: drag on every particle.

use glam::DMat3;

use crate::{Batch, BodyModel, BodyState, Wrench};

/// Sets the drag of each body: the sum of fᵢ = −c vᵢ over its particles, in closed form.
pub fn drag(batch: &mut Batch) {
    let c = batch.model.velocity_damping_stiffness;
    let bodies = batch.model.bodies[batch.first..].iter().zip(&*batch.bodies);
    for ((body, state), forces) in bodies.zip(&mut *batch.forces) {
        forces.drag = if c > 0.0 { body_drag(body, state, c) } else { Wrench::default() };
    }
}

/// Where equal particles carry the mass, Σ rᵢ = 0 and Σ rᵢ × (ω × rᵢ) = L/m, so F = −(c/m) M v and τ = −(c/m) L.
/// Otherwise F = −c (N v + ω × S) and τ = −c (S × v + G ω), with S = Σ R rᵢ and G = R Σ (rᵢ·rᵢ 1 − rᵢ rᵢᵀ) Rᵀ.
fn body_drag(body: &BodyModel, state: &BodyState, c: f64) -> Wrench {
    let moments = body.shape.moments();
    if moments.carries_mass {
        let rate = c / body.particle_mass();
        return Wrench {
            force: -rate * body.mass * state.velocity,
            torque: -rate * state.angular_momentum,
        };
    }
    let rotation = DMat3::from_quat(state.orientation);
    let omega = body.angular_velocity(rotation, state.angular_momentum);
    let s = rotation * moments.first;
    let g_omega = rotation * (moments.second * (rotation.transpose() * omega));
    Wrench {
        force: -c * (moments.count * state.velocity + omega.cross(s)),
        torque: -c * (s.cross(state.velocity) + g_omega),
    }
}
