//! A hand that pulls a particle: a user drags a body about.

use glam::DVec3;

use super::Placed;
use crate::{BodyModel, BodyState, Model, State, Wrench};

/// How fast a pulled particle comes to where it is pulled, without overshooting (1/s), where the step allows.
const RATE: f64 = 25.0;
/// The largest part of its velocity that the dashpot may take from a particle in one step.
const PART: f64 = 0.5;

/// A spring and dashpot from one particle to a place that a user moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull {
    /// Which body.
    pub body: usize,
    /// Which of its particles.
    pub particle: usize,
    /// Where it is pulled to (m).
    pub target: DVec3,
}

/// Pulls for the time `h` (s): v ← v + F h/M, L ← L + R r × F h with F = k (target − xᵢ) − c vᵢ. Returns the work of
/// the hand (J), which is exactly the kinetic energy that the body gains.
///
/// k = M λ² and c = 2 M λ: critical damping at the rate λ, whatever the body weighs. A particle at the end of an
/// arm resists with less than M, at least with μ, 1/μ = 1/M + r²/I, so that c h is kept below a part of μ.
///
/// # Panics
/// When there is no such body or particle; [`World::pull`](crate::World::pull) checks that.
pub fn pull(model: &Model, state: &mut State, pull: &Pull, h: f64) -> f64 {
    let (body, state) = (&model.bodies[pull.body], &mut state.bodies[pull.body]);
    let wrench = spring(body, state, pull, model.dt);
    let mean = Placed::new(body, state).half_kicked(&wrench, h);
    state.velocity += wrench.force * (h / body.mass);
    state.angular_momentum += wrench.torque * h;
    -h * mean.power_lost(&wrench)
}

fn spring(body: &BodyModel, state: &BodyState, pull: &Pull, dt: f64) -> Wrench {
    let (place, velocity) = body.particle(state, pull.particle);
    let arm = place - state.position;
    let turning = arm.length_squared() * body.inverse_moments.max_element();
    // M/μ
    let lightness = 1.0 + body.mass * turning;
    let rate = RATE.min(0.5 * PART / (lightness * dt));
    let force = ((pull.target - place) * rate - velocity * 2.0) * (body.mass * rate);
    Wrench { force, torque: arm.cross(force) }
}
