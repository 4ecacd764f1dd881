//! Joints: the stages that see all joined bodies at once.

use crate::{Model, RunTotals, Scratch, State, Wrench};

/// Remembers where the bodies are at the beginning of a step or a part of one.
pub(crate) fn begin_joints(model: &Model, state: &State, scratch: &mut Scratch) {
    if model.joints.is_empty() {
        return;
    }
    scratch.before.bodies.clone_from(&state.bodies);
    scratch.joints.begin_flight(state);
}

/// Remembers where the bodies are at the beginning of the second flight of a step.
pub(crate) fn begin_flight(model: &Model, state: &State, scratch: &mut Scratch) {
    if !model.joints.is_empty() {
        scratch.joints.begin_flight(state);
    }
}

/// Flies all bodies with joints for the time `h` (s). Prescribed motions have advanced.
pub(crate) fn fly_joined(model: &Model, state: &mut State, scratch: &mut Scratch, h: f64) {
    if !model.joints.is_empty() {
        crate::joint::fly(model, state, &mut scratch.joints, h);
    }
}

/// Finds the impulses of the joints that act with the contact forces and loads in a kick over the time `h` (s).
pub(crate) fn kick_joined(model: &Model, state: &mut State, scratch: &mut Scratch, h: f64) {
    if model.joints.is_empty() {
        return;
    }
    let Scratch { joints, forces, .. } = scratch;
    let start = [joints.start_coordinates.as_slice(), &joints.start_rates];
    joints.kick.begin(model, state, start, h);
    for &body in &model.joints.bodies {
        let forces = &mut forces[body as usize];
        forces.joint = Wrench::default();
        let Wrench { force, torque } = forces.kick();
        let impulse = Wrench { force: force * h, torque: torque * h };
        joints.kick.push(model, body as usize, impulse);
    }
    joints.kick.solve(model);
    state.totals += account(model, joints, forces, h);
}

/// Adds the mean forces of the joints in a kick over the time `h` (s) to the forces; returns what they take and add.
pub(crate) fn account(
    model: &Model,
    joints: &mut crate::joint::JointWork,
    forces: &mut [crate::BodyForces],
    h: f64,
) -> RunTotals {
    let per_time = 1.0 / h;
    joints.kick.account(model, &mut joints.step_impulses, |body, Wrench { force, torque }| {
        forces[body].joint += Wrench { force: force * per_time, torque: torque * per_time };
    })
}
