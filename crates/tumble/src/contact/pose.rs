//! Poses of bodies for contact between bodies, with bounds on how far they have moved.

use glam::{DMat3, DQuat, DVec3};

use super::pair::feature_size;
use super::since_kick::SinceKick;
use crate::kinematics::Kinematics;
use crate::{BodyModel, BodyState, Integrator, Model, Motion};

/// Pose of a body, the velocities that its contact forces see, and how far it has moved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyPose {
    pub position: DVec3,
    /// Orientation as a matrix.
    pub rotation: DMat3,
    pub velocity: DVec3,
    pub angular_velocity: DVec3,
    /// Velocity in the middle of the flight since the latest kick.
    pub drift_velocity: DVec3,
    /// Angular velocity in the middle of the flight since the latest kick.
    pub drift_angular_velocity: DVec3,
    /// Velocity of the surface along itself, as of a conveyor belt (m/s, world axes).
    pub surface_velocity: DVec3,
    orientation: DQuat,
    /// Path length: an upper bound on how far any point of the body has moved since its pose was first known (m).
    pub path: f64,
    /// How far the body may move before the neighbour lists are rebuilt (m).
    pub skin: f64,
    /// Path length up to which the neighbour lists hold (m).
    pub list_valid_until: f64,
    /// An upper bound on how far any point of the body moves in one step (m).
    pub step_displacement: f64,
    /// Contacts are found up to a gap of the reaches of both bodies together: the implicit solver needs those that may close within
    /// the step. Else 0 (m).
    pub reach: f64,
}

/// Gaps that a kick may close, where bodies that do not move are near each other, as a share of the size of a body. The whole path
/// would add contacts to every falling heap.
const KICKED_GAP: f64 = 0.01;

/// Stands for a wall as the second body of a pair.
static WALL: BodyPose = BodyPose {
    position: DVec3::ZERO,
    rotation: DMat3::ZERO,
    velocity: DVec3::ZERO,
    angular_velocity: DVec3::ZERO,
    drift_velocity: DVec3::ZERO,
    drift_angular_velocity: DVec3::ZERO,
    surface_velocity: DVec3::ZERO,
    orientation: DQuat::IDENTITY,
    path: 0.0,
    skin: 0.0,
    list_valid_until: 0.0,
    step_displacement: 0.0,
    reach: 0.0,
};

/// The pose of a body, or that of a wall where `index` is no body.
#[inline(always)]
pub(super) fn pose_or_wall(poses: &[BodyPose], index: u32) -> &BodyPose {
    poses.get(index as usize).unwrap_or(&WALL)
}

impl BodyPose {
    /// The pose of a state; its path length begins here.
    pub fn new(model: &Model, index: usize, state: &BodyState, since_kick: &SinceKick) -> Self {
        let body = &model.bodies[index];
        let kinematics = Kinematics::new(body, state);
        let Kinematics { rotation, angular_velocity: omega, .. } = kinematics;
        let surface_velocity = match &body.motion {
            Motion::Prescribed(prescribed) => rotation * prescribed.surface_velocity,
            Motion::Free => DVec3::ZERO,
        };
        let [drift_velocity, drift_angular_velocity] =
            mid_flight(model, index, (&kinematics, state), since_kick);
        let step_displacement =
            since_kick.step * (length(state.velocity) + length(omega) * body.extent);
        Self {
            drift_velocity,
            drift_angular_velocity,
            position: state.position,
            rotation,
            velocity: state.velocity,
            angular_velocity: omega,
            surface_velocity,
            orientation: state.orientation,
            path: rounding_bound(body, state),
            skin: 0.0,
            list_valid_until: 0.0,
            step_displacement,
            reach: if model.integrator == Integrator::Implicit {
                {
                    let fall = since_kick.step * since_kick.step * length(model.gravity);
                    // a kick may also close a gap that is small beside the body
                    let kicked = since_kick.reach.min(KICKED_GAP * feature_size(body));
                    step_displacement + fall + kicked
                }
            } else {
                0.0
            },
        }
    }

    /// The pose of a later state; the path length grows by the displacement.
    pub fn moved(
        &self,
        model: &Model,
        index: usize,
        state: &BodyState,
        since_kick: &SinceKick,
    ) -> Self {
        let body = &model.bodies[index];
        let turn = state.orientation * self.orientation.conjugate();
        // a rotation by θ moves a point at distance r by 2 r sin(θ/2)
        let displacement = length(state.position - self.position)
            + 2.0 * body.extent * length(DVec3::new(turn.x, turn.y, turn.z));
        // rounding may hide a part of the displacement, and of the distances that it is compared with
        let path = self.path + displacement * (1.0 + 1e-9) + rounding_bound(body, state);
        let path = path * (1.0 + 4.0 * f64::EPSILON);
        let (skin, list_valid_until) = (self.skin, self.list_valid_until);
        Self { path, skin, list_valid_until, ..Self::new(model, index, state, since_kick) }
    }

    /// Position of a contact point (m, world axes).
    #[inline(always)]
    pub fn particle_position(&self, body: &BodyModel, slot: u32) -> DVec3 {
        self.position + self.rotation * body.points().at(slot)
    }
}

/// Velocity and angular velocity in the middle of the flight since the latest kick. Displacements computed from them are of
/// second order; those from the velocities at its end would be of first order.
fn mid_flight(
    model: &Model,
    index: usize,
    (kinematics, state): (&Kinematics, &BodyState),
    since_kick: &SinceKick,
) -> [DVec3; 2] {
    let Kinematics { velocity, angular_velocity, .. } = *kinematics;
    let half = 0.5 * since_kick.duration;
    // a body with joints has no flight of its own: see `use_start_velocities`
    if !model.integrator.kicks() || model.joints.acts_on(index) && kinematics.body.is_free() {
        return [velocity, angular_velocity];
    }
    if let Motion::Prescribed(prescribed) = &kinematics.body.motion {
        let change = prescribed.oscillation.as_ref().map_or(DVec3::ZERO, |oscillation| {
            oscillation.at(since_kick.time).1 - oscillation.at(since_kick.time - half).1
        });
        return [velocity - change, angular_velocity];
    }
    let Kinematics { velocity, angular_velocity, .. } = kinematics.earlier(model, state, half);
    [velocity, angular_velocity]
}

/// A bound on the rounding error of the position of a point of a body (m).
fn rounding_bound(body: &BodyModel, state: &BodyState) -> f64 {
    16.0 * f64::EPSILON * (state.position.length() + body.extent)
}

/// |v|, with the square root inlined.
#[inline(always)]
fn length(v: DVec3) -> f64 {
    v.length_squared().sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::{Body, MassModel, Oscillation, Prescribed, Primitive, Sampling, Shape, World};

    /// The largest error of the velocities in the middle of a flight of `h` (s), against the state after half of it.
    fn mid_flight_error(body: &Body, h: f64) -> f64 {
        let world = World::builder().dt(0.5 * h).velocity_damping_stiffness(0.05);
        let mut world = world.body(body.clone()).build().unwrap();
        let start = 64;
        while world.time() < f64::from(start) * 1e-3 - 0.25 * h {
            world.step().unwrap();
        }
        world.step().unwrap();
        let (velocity, omega) = (world.body(0).velocity(), world.body(0).angular_velocity());
        world.step().unwrap();
        let since_kick = SinceKick::at_sub_step(world.time(), h);
        let pose = BodyPose::new(world.model(), 0, &world.state().bodies[0], &since_kick);
        (pose.drift_velocity - velocity)
            .length()
            .max((pose.drift_angular_velocity - omega).length())
    }

    #[test]
    fn velocities_in_the_middle_of_a_flight_are_of_second_order() {
        let cuboid = Primitive::Box { size: DVec3::new(0.3, 0.5, 0.8), divisions: 1 };
        let oscillation = Oscillation { amplitude: DVec3::X, frequency: 3.0, phase: 0.3 };
        for (mass_model, oscillation) in [
            (MassModel::Particles, None),
            (MassModel::Solid, None),
            (MassModel::Solid, Some(oscillation)),
        ] {
            let mesh = cuboid.mesh().unwrap();
            let shape = Shape::from_mesh(&mesh, Sampling::Vertices, mass_model).unwrap();
            let mut body = Body::new(shape).mass(0.1).velocity(DVec3::new(1.0, 2.0, 3.0));
            body = body.angular_velocity(DVec3::new(4.0, 5.0, -6.0));
            if oscillation.is_some() {
                let prescribed = Prescribed { oscillation, ..Prescribed::default() };
                body = body.motion(Motion::Prescribed(prescribed)).angular_velocity(DVec3::ZERO);
            }
            let (coarse, fine) = (mid_flight_error(&body, 2e-3), mid_flight_error(&body, 1e-3));
            // exact for an oscillation
            assert!(fine < 1e-12 || (coarse / fine - 4.0).abs() < 0.2, "{coarse} {fine}");
        }
    }
}
