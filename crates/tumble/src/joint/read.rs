//! What a user reads of joints.

use glam::DMat3;

use super::definition::JointKind;
use super::model::{JointModel, Place};
use super::rows::JointRows;
use super::system::{System, Twist};
use super::work::twist;
use crate::{Model, State};

/// The coordinate of a joint and its rate, as [`JointView`](crate::JointView) gives them.
pub(crate) fn coordinate_and_rate(model: &Model, state: &State, index: usize) -> [f64; 2] {
    let joint = &model.joints.list[index];
    let place = |body: Option<u32>| {
        body.map_or(Place::WORLD, |body| Place::new(&state.bodies[body as usize]))
    };
    let places = joint.bodies.map(place);
    let rows = JointRows::new(joint, places);
    let twist = |body: u32| twist(&model.bodies[body as usize], &state.bodies[body as usize]);
    let twists = joint.bodies.map(|body| body.map_or_else(Twist::default, twist));
    if joint.kind == JointKind::Ball {
        return ball_angle(joint, places, twists);
    }
    if !joint.has_coordinate() {
        return [0.0; 2];
    }
    let row = &rows.rows[joint.coordinate_row().unwrap_or(0)];
    let coordinate = joint.near(row.value, state.joints[index].coordinate) + joint.start_length;
    [coordinate, row.rate(twists)]
}

/// The angle of the relative rotation from the start, and its rate: the relative angular velocity along its axis.
fn ball_angle(joint: &JointModel, places: [Place; 2], twists: [Twist; 2]) -> [f64; 2] {
    let [first, second] = [0, 1].map(|side: usize| places[side].rotation * joint.axes[side]);
    let turn: DMat3 = first * second.transpose();
    let q = glam::DQuat::from_mat3(&turn);
    let vector = glam::DVec3::new(q.x, q.y, q.z);
    let sine = vector.length();
    let angle = 2.0 * libm::atan2(sine, q.w.abs());
    let omega = twists[0].1 - twists[1].1;
    let axis = if sine > 0.0 { vector * (q.w.signum() / sine) } else { omega.normalize_or_zero() };
    [angle, omega.dot(axis)]
}

/// The largest error of all constraints (m or rad).
pub(crate) fn constraint_error(model: &Model, state: &State) -> f64 {
    let mut system = System::default();
    system.set_states(model, &state.bodies);
    let joints = model.joints.list.iter().zip(&system.rows);
    let values =
        joints.flat_map(|(joint, rows)| &rows.rows[..joint.constraint_count_at(state.time)]);
    values.map(|row| row.value.abs()).fold(0.0, f64::max)
}
