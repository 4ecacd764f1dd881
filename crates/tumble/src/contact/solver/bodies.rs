//! The bodies, as the solver sees them.

use std::f64::consts::TAU;
use std::sync::atomic::{AtomicU64, Ordering};

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::{DMat3, DVec3};

use crate::contact::pose::BodyPose;
use crate::lanes::{Columns, LANES, Vec3x8, set, vector};
use crate::{BodyModel, Model, Motion};

/// A body before the kick.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SolverBody {
    /// Velocity v (m/s) and angular velocity ω (rad/s).
    pub velocity: DVec3,
    pub angular_velocity: DVec3,
    /// 1/M (1/kg); 0 for a wall or a prescribed motion.
    pub inverse_mass: f64,
    /// xx, yy, zz, yz, xz, xy of I⁻¹ in world axes (1/(kg·m²)); 0 likewise.
    pub inverse_inertia: [f64; 6],
    /// Acceleration without contact (m/s²).
    pub acceleration: DVec3,
}

impl SolverBody {
    /// A body at the kick, at `time` (s).
    pub fn new(model: &Model, body: &BodyModel, pose: &BodyPose, time: f64) -> Self {
        let (velocity, angular_velocity) = (pose.velocity, pose.angular_velocity);
        let at_rest = Self { velocity, angular_velocity, ..Self::default() };
        if let Motion::Prescribed(prescribed) = &body.motion {
            let oscillation = prescribed.oscillation.as_ref();
            let acceleration = oscillation.map_or(DVec3::ZERO, |oscillation| {
                // a sine, so the acceleration is −ω² times the displacement from its middle
                let middle = oscillation.amplitude * libm::sin(oscillation.phase);
                let rate = TAU * oscillation.frequency;
                (oscillation.at(time).0 + middle) * -(rate * rate)
            });
            return Self { acceleration, ..at_rest };
        }
        Self {
            inverse_mass: 1.0 / body.mass,
            inverse_inertia: symmetric(
                pose.rotation * body.inverse_inertia * pose.rotation.transpose(),
            ),
            acceleration: model.gravity,
            ..at_rest
        }
    }
}

/// v and ω of a body during the iterations, as the bits of six numbers.
///
/// Threads solve groups that share no free body, which the borrow checker cannot see. Of a body that is not free all threads store the same
/// velocities. On the processors in use, relaxed loads and stores are ordinary ones.
#[derive(Debug, Default)]
pub(super) struct Velocities([AtomicU64; 6]);

impl Velocities {
    pub fn new(body: &SolverBody) -> Self {
        let velocities = Self::default();
        velocities.store(body.velocity, body.angular_velocity);
        velocities
    }

    #[inline(always)]
    pub fn load(&self) -> (DVec3, DVec3) {
        let load = |index: usize| f64::from_bits(self.0[index].load(Ordering::Relaxed));
        (DVec3::new(load(0), load(1), load(2)), DVec3::new(load(3), load(4), load(5)))
    }

    #[inline(always)]
    pub fn store(&self, velocity: DVec3, angular_velocity: DVec3) {
        let values = [velocity, angular_velocity].map(|v| v.to_array());
        for (cell, value) in self.0.iter().zip(values.as_flattened()) {
            cell.store(value.to_bits(), Ordering::Relaxed);
        }
    }
}

fn symmetric(m: DMat3) -> [f64; 6] {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    [x.x, y.y, z.z, y.z, x.z, x.y]
}

/// Inverse masses and inertias of eight bodies in memory: 1/M, then xx, yy, zz, yz, xz, xy of I⁻¹.
pub(super) type InertiaColumns = [[f64; LANES]; 7];

/// Those of the bodies with these indices.
pub(super) fn inertia_columns(bodies: &[SolverBody], indices: &[u32; LANES]) -> InertiaColumns {
    let mut columns = [[0.0; LANES]; 7];
    for (lane, &index) in indices.iter().enumerate() {
        let body = &bodies[index as usize];
        let values = [body.inverse_mass].into_iter().chain(body.inverse_inertia);
        columns.iter_mut().zip(values).for_each(|(column, value)| column[lane] = value);
    }
    columns
}

/// One body in each lane: what stays constant.
#[derive(Clone, Copy)]
pub(super) struct LaneInertia<S: Simd> {
    pub inverse_mass: f64x8<S>,
    inverse_inertia: [f64x8<S>; 6],
}

/// One body in each lane: its velocities.
#[derive(Clone, Copy)]
pub(super) struct LaneMotion<S: Simd> {
    pub velocity: Vec3x8<S>,
    pub angular_velocity: Vec3x8<S>,
}

impl<S: Simd> LaneInertia<S> {
    #[inline(always)]
    pub fn load(simd: S, columns: &InertiaColumns) -> Self {
        let load = |index: usize| f64x8::simd_from(simd, columns[index]);
        Self {
            inverse_mass: load(0),
            inverse_inertia: [load(1), load(2), load(3), load(4), load(5), load(6)],
        }
    }

    /// I⁻¹ τ.
    #[inline(always)]
    pub fn turned(&self, torque: Vec3x8<S>) -> Vec3x8<S> {
        let [xx, yy, zz, yz, xz, xy] = self.inverse_inertia;
        let Vec3x8 { x, y, z } = torque;
        Vec3x8 {
            x: xx * x + xy * y + xz * z,
            y: xy * x + yy * y + yz * z,
            z: xz * x + yz * y + zz * z,
        }
    }

    /// 1/m of an impulse of size 1 along a unit vector with the torques `torque` about the centre of mass: 1/M + τ·I⁻¹ τ.
    #[inline(always)]
    pub fn mobility(&self, torque: Vec3x8<S>) -> f64x8<S> {
        self.inverse_mass + torque.dot(self.turned(torque))
    }
}

impl<S: Simd> LaneMotion<S> {
    #[inline(always)]
    pub fn gather(simd: S, bodies: &[Velocities], indices: &[u32; LANES]) -> Self {
        let (mut velocity, mut angular_velocity) = (Columns::default(), Columns::default());
        for (lane, &index) in indices.iter().enumerate() {
            let (v, omega) = bodies[index as usize].load();
            set(&mut velocity, lane, v);
            set(&mut angular_velocity, lane, omega);
        }
        Self {
            velocity: Vec3x8::load(simd, &velocity),
            angular_velocity: Vec3x8::load(simd, &angular_velocity),
        }
    }

    /// Stores the velocities. Bodies that are not free may be in several lanes, all with the same velocities.
    #[inline(always)]
    pub fn scatter(&self, bodies: &[Velocities], indices: &[u32; LANES]) {
        let (velocity, angular_velocity) = (self.velocity.store(), self.angular_velocity.store());
        for (lane, &index) in indices.iter().enumerate() {
            let (v, omega) = (vector(&velocity, lane), vector(&angular_velocity, lane));
            bodies[index as usize].store(v, omega);
        }
    }

    /// Adds the opposite of an impulse (N·s) and its torque impulse (N·m·s).
    #[inline(always)]
    pub fn subtract(&mut self, inertia: &LaneInertia<S>, impulse: Vec3x8<S>, torque: Vec3x8<S>) {
        self.velocity = self.velocity - impulse * inertia.inverse_mass;
        self.angular_velocity = self.angular_velocity - inertia.turned(torque);
    }

    /// Adds an impulse (N·s) and its torque impulse (N·m·s).
    #[inline(always)]
    pub fn add(&mut self, inertia: &LaneInertia<S>, impulse: Vec3x8<S>, torque: Vec3x8<S>) {
        self.velocity += impulse * inertia.inverse_mass;
        self.angular_velocity += inertia.turned(torque);
    }
}
