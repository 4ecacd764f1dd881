//! Buffers of the joints.

use super::kick::JointKick;
use super::rows::RowValues;
use super::system::{System, Twist};
use crate::{BodyModel, BodyState, Model, State, Wrench};

/// A joint whose constraints could not be kept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointFailure {
    /// The joint.
    pub joint: usize,
    /// How far its constraints are from holding (m).
    pub error: f64,
}

/// Buffers, and what joints did in the latest step. Dropping it between steps changes no result.
#[derive(Clone, Debug, Default)]
pub(crate) struct JointWork {
    /// All bodies at the beginning of a flight.
    pub start: Vec<BodyState>,
    /// The coordinates of all joints there.
    pub start_coordinates: Vec<f64>,
    /// The rates of all coordinates at the beginning of the latest flight; 0 without a coordinate.
    pub start_rates: Vec<f64>,
    /// Rows at the beginning of a flight, and at its middle or end.
    pub start_system: System,
    pub system: System,
    /// Velocities of the bodies.
    pub start_twists: Vec<Twist>,
    pub twists: Vec<Twist>,
    pub impulses: Vec<RowValues>,
    pub residuals: Vec<RowValues>,
    pub softness: Vec<RowValues>,
    /// The kick.
    pub kick: JointKick,
    /// Sum of the impulses of each joint in the step so far, on the first body, torques about the joint (N·s, N·m·s).
    pub step_impulses: Vec<Wrench>,
    /// The same at the beginning of the present part of the step.
    before_part: Vec<Wrench>,
    /// The first joint that failed in the step.
    pub failure: Option<JointFailure>,
}

impl JointWork {
    /// Begins a step.
    pub fn begin_step(&mut self, model: &Model) {
        self.failure = None;
        self.step_impulses.clear();
        self.step_impulses.resize(model.joints.list.len(), Wrench::default());
    }

    /// Begins a part of a step, which may have to be repeated.
    pub fn begin_part(&mut self) {
        self.before_part.clone_from(&self.step_impulses);
    }

    /// Goes back to the beginning of the part.
    pub fn undo_part(&mut self) {
        self.step_impulses.clone_from(&self.before_part);
        self.failure = None;
    }

    /// Begins a flight: remembers where the bodies are.
    pub fn begin_flight(&mut self, state: &State) {
        self.start.clone_from(&state.bodies);
        self.start_coordinates.clear();
        self.start_coordinates.extend(state.joints.iter().map(|joint| joint.coordinate));
    }

    /// Applies an impulse to a joined body at fixed poses, with the impulses of the joints that it leads to. Returns its work (J).
    pub fn push(&mut self, model: &Model, state: &mut State, body: usize, impulse: Wrench) -> f64 {
        self.start_coordinates.clear();
        self.start_coordinates.extend(state.joints.iter().map(|joint| joint.coordinate));
        // forces have no time to act, but limits hold
        self.kick.begin(model, state, [&self.start_coordinates, &[]], 0.0);
        self.kick.push(model, body, impulse);
        self.kick.solve(model);
        let (v, omega) = self.kick.mean_twist(body);
        let mut apply = |body: usize, Wrench { force, torque }: Wrench| {
            if model.bodies[body].is_free() {
                state.bodies[body].velocity += force / model.bodies[body].mass;
                state.bodies[body].angular_momentum += torque;
            }
        };
        apply(body, impulse);
        self.kick.account(model, &mut [], apply);
        impulse.force.dot(v) + impulse.torque.dot(omega)
    }

    /// Calls `set` with the mean acceleration (m/s²) of each joined free body in the flight before the kick of a step of length `h` (s).
    pub fn set_accelerations(
        &self,
        model: &Model,
        (states, h): (&[BodyState], f64),
        mut set: impl FnMut(usize, glam::DVec3),
    ) {
        for &body in &model.joints.bodies {
            let body = body as usize;
            if model.bodies[body].is_free() {
                let change = states[body].velocity - self.start[body].velocity;
                set(body, change / (0.5 * h));
            }
        }
    }

    /// Adds impulses to the sums of the step.
    pub fn record(&mut self, is_start: bool, impulses: &[RowValues]) {
        let system = if is_start { &self.start_system } else { &self.system };
        for (joint, (sum, impulses)) in self.step_impulses.iter_mut().zip(impulses).enumerate() {
            *sum += system.wrench_at_joint(joint, impulses);
        }
    }
}

/// Velocities of joined bodies.
pub(crate) fn set_twists(model: &Model, states: &[BodyState], twists: &mut Vec<Twist>) {
    twists.resize(states.len(), Twist::default());
    for &index in &model.joints.bodies {
        twists[index as usize] = twist(&model.bodies[index as usize], &states[index as usize]);
    }
}

/// Velocity and angular velocity of a body.
pub(crate) fn twist(body: &BodyModel, state: &BodyState) -> Twist {
    let rotation = glam::DMat3::from_quat(state.orientation);
    (state.velocity, body.angular_velocity(rotation, state.angular_momentum))
}
