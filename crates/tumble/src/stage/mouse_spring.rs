//! The mouse spring: pulls a particle to a point that the user moves.

use glam::DVec3;

use crate::kinematics::Kinematics;
use crate::{BodyModel, BodyState, Model, Scratch, State, Wrench};

/// Rate λ (1/s) at which the particle approaches the target, critically damped, where the step allows it.
const RATE: f64 = 25.0;
/// The largest part of the particle's velocity that the dashpot may remove in one step.
const MAX_DAMPED_PART: f64 = 0.5;

/// A spring and dashpot between one particle and a point that the user moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MouseSpring {
    /// Index of the body.
    pub body: usize,
    /// Index of the particle in the body.
    pub particle: usize,
    /// The point that the particle is pulled to (m, world axes).
    pub target: DVec3,
}

/// Applies the spring for the time `h` (s): v ← v + F h/M, L ← L + R r × F h with F = k (target − xᵢ) − c vᵢ. Returns the
/// work that it does (J), which is exactly the kinetic energy that the body gains.
///
/// k = M λ² and c = 2 M λ: critical damping at the rate λ for any mass. A particle at the end of an arm has an effective mass
/// below M, at least μ with 1/μ = 1/M + r²/I, so c h is kept below a part of μ.
///
/// # Panics
/// When there is no such body or particle; [`World::set_mouse_spring`](crate::World::set_mouse_spring) checks that.
pub fn apply_mouse_spring(
    model: &Model,
    (state, scratch): (&mut State, &mut Scratch),
    spring: &MouseSpring,
    h: f64,
) -> f64 {
    let body = &model.bodies[spring.body];
    let wrench = spring_wrench(body, &state.bodies[spring.body], spring, model.dt);
    if model.joints.acts_on(spring.body) {
        let impulse = Wrench { force: wrench.force * h, torque: wrench.torque * h };
        return scratch.joints.push(model, state, spring.body, impulse);
    }
    let state = &mut state.bodies[spring.body];
    let mean = Kinematics::new(body, state).at_mid_kick(&wrench, h);
    state.velocity += wrench.force * (h / body.mass);
    state.angular_momentum += wrench.torque * h;
    -h * mean.dissipated_power(&wrench)
}

fn spring_wrench(body: &BodyModel, state: &BodyState, spring: &MouseSpring, dt: f64) -> Wrench {
    let (position, velocity) = body.particle(state, spring.particle);
    let arm = position - state.position;
    let inverse_inertia = arm.length_squared() * body.inverse_moments.max_element();
    // M/μ
    let mass_ratio = 1.0 + body.mass * inverse_inertia;
    let rate = RATE.min(0.5 * MAX_DAMPED_PART / (mass_ratio * dt));
    let force = ((spring.target - position) * rate - velocity * 2.0) * (body.mass * rate);
    Wrench { force, torque: arm.cross(force) }
}
