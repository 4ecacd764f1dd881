//! The basic system as a single loop over all particles: once as scalar code that is left to the compiler, and once
//! with explicit vectors of eight particles in the widest registers of the processor, which is close to the limit of
//! such a loop.

use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};
use tumble::{BodyState, DMat3, DQuat, DVec3, Model, World};

const LANES: usize = 8;

/// How the loop is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopStyle {
    /// One particle at a time; vectorisation is left to the compiler.
    Compiled,
    /// Eight particles at a time, with explicit vectors.
    Vectors,
}

/// The basic system for one body and walls, as a plain loop over its particles.
#[derive(Clone, Debug)]
pub struct PlainLoop {
    style: LoopStyle,
    /// Positions of the particles in the body frame (m).
    positions: Vec<DVec3>,
    /// The same positions as one array per coordinate, padded to a multiple of eight.
    coordinates: [Vec<f64>; 3],
    particle_mass: f64,
    mass: f64,
    inverse_inertia: DMat3,
    gravity: DVec3,
    drag: f64,
    stiffness: f64,
    /// Normal and offset (m) of each wall.
    walls: Vec<(DVec3, f64)>,
    dt: f64,
    /// State of the body.
    pub state: BodyState,
}

impl PlainLoop {
    /// Creates the loop for the first body of a world, from its current state.
    pub fn from_world(world: &World, style: LoopStyle) -> Self {
        let model: &Model = world.model();
        let body = &model.bodies[0];
        let particles = body.shape.particles();
        let padded = particles.len().next_multiple_of(LANES);
        let coordinate = |axis: usize| {
            let mut values: Vec<f64> = particles.iter().map(|r| r[axis]).collect();
            values.resize(padded, 0.0);
            values
        };
        Self {
            style,
            positions: particles.iter().collect(),
            coordinates: [coordinate(0), coordinate(1), coordinate(2)],
            particle_mass: body.particle_mass(),
            mass: body.mass,
            inverse_inertia: body.inverse_inertia,
            gravity: model.gravity,
            drag: model.velocity_damping_stiffness,
            stiffness: body.contacts.first().map_or(0.0, |law| law.stiffness),
            walls: model.walls.iter().map(|wall| (wall.normal, wall.offset)).collect(),
            dt: model.dt,
            state: world.state().bodies[0],
        }
    }

    /// Takes one step.
    pub fn step(&mut self) {
        let rotation = DMat3::from_quat(self.state.orientation);
        let omega = self.angular_velocity(rotation);
        let (force, torque) = match self.style {
            LoopStyle::Compiled => self.forces(rotation, omega),
            LoopStyle::Vectors => {
                dispatch!(Level::new(), simd => self.forces_vectorised(simd, rotation, omega))
            }
        };
        let (state, h) = (&mut self.state, self.dt);
        state.velocity += force / self.mass * h;
        state.position += state.velocity * h;
        let spin = DQuat::from_xyzw(omega.x, omega.y, omega.z, 0.0);
        state.orientation = (state.orientation + spin * state.orientation * (0.5 * h)).normalize();
        state.angular_momentum += torque * h;
    }

    fn angular_velocity(&self, rotation: DMat3) -> DVec3 {
        rotation * (self.inverse_inertia * (rotation.transpose() * self.state.angular_momentum))
    }

    fn forces(&self, rotation: DMat3, omega: DVec3) -> (DVec3, DVec3) {
        let weight = self.gravity * self.particle_mass;
        let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        for &r in &self.positions {
            let arm = rotation * r;
            let position = self.state.position + arm;
            let mut f = weight;
            if self.drag > 0.0 {
                f -= (self.state.velocity + omega.cross(arm)) * self.drag;
            }
            for &(normal, offset) in &self.walls {
                let depth = offset - normal.dot(position);
                if depth > 0.0 {
                    f += normal * (self.stiffness * depth);
                }
            }
            force += f;
            torque += arm.cross(f);
        }
        (force, torque)
    }

    #[inline(always)]
    fn forces_vectorised<S: Simd>(&self, simd: S, rotation: DMat3, omega: DVec3) -> (DVec3, DVec3) {
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let rows = [rotation.row(0), rotation.row(1), rotation.row(2)];
                let omega = Vec3x8::splat(simd, omega);
                let centre = Vec3x8::splat(simd, self.state.position);
                let velocity = Vec3x8::splat(simd, self.state.velocity);
                let weight = Vec3x8::splat(simd, self.gravity * self.particle_mass);
                let mut force = Vec3x8::splat(simd, DVec3::ZERO);
                let mut torque = force;
                let [x, y, z] = &self.coordinates;
                let (x, y, z) = (x.as_chunks().0, y.as_chunks().0, z.as_chunks().0);
                for (first, ((x, y), z)) in (0..).step_by(LANES).zip(x.iter().zip(y).zip(z)) {
                    let r = Vec3x8::load(simd, x, y, z);
                    let arm = Vec3x8(r.dot(rows[0]), r.dot(rows[1]), r.dot(rows[2]));
                    let position = centre.plus(arm);
                    let mut f = weight;
                    if self.drag > 0.0 {
                        f = f.minus(velocity.plus(omega.cross(arm)).scale(self.drag));
                    }
                    for (normal, offset) in &self.walls {
                        let depth = f64x8::splat(simd, *offset) - position.dot(*normal);
                        let magnitude = depth.simd_gt(zero).select(depth, zero) * self.stiffness;
                        f = f.plus(Vec3x8(
                            magnitude * normal.x,
                            magnitude * normal.y,
                            magnitude * normal.z,
                        ));
                    }
                    if first + LANES > self.positions.len() {
                        f = f.first_lanes(simd, self.positions.len() - first);
                    }
                    force = force.plus(f);
                    torque = torque.plus(arm.cross(f));
                }
                (force.sum_lanes(), torque.sum_lanes())
            },
        )
    }
}

/// Eight vectors, one register per coordinate.
#[derive(Clone, Copy)]
struct Vec3x8<S: Simd>(f64x8<S>, f64x8<S>, f64x8<S>);

impl<S: Simd> Vec3x8<S> {
    #[inline(always)]
    fn splat(simd: S, v: DVec3) -> Self {
        Self(f64x8::splat(simd, v.x), f64x8::splat(simd, v.y), f64x8::splat(simd, v.z))
    }
    #[inline(always)]
    fn load(simd: S, x: &[f64; LANES], y: &[f64; LANES], z: &[f64; LANES]) -> Self {
        Self(f64x8::simd_from(simd, *x), f64x8::simd_from(simd, *y), f64x8::simd_from(simd, *z))
    }
    #[inline(always)]
    fn plus(self, o: Self) -> Self {
        Self(self.0 + o.0, self.1 + o.1, self.2 + o.2)
    }
    #[inline(always)]
    fn minus(self, o: Self) -> Self {
        Self(self.0 - o.0, self.1 - o.1, self.2 - o.2)
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        Self(self.0 * factor, self.1 * factor, self.2 * factor)
    }
    #[inline(always)]
    fn dot(self, v: DVec3) -> f64x8<S> {
        self.0 * v.x + self.1 * v.y + self.2 * v.z
    }
    #[inline(always)]
    fn cross(self, o: Self) -> Self {
        Self(self.1 * o.2 - self.2 * o.1, self.2 * o.0 - self.0 * o.2, self.0 * o.1 - self.1 * o.0)
    }
    /// Sets all lanes from `count` on to zero.
    #[inline(always)]
    fn first_lanes(self, simd: S, count: usize) -> Self {
        let mask = |lanes: f64x8<S>| {
            let mut lanes: [f64; LANES] = lanes.into();
            lanes[count..].fill(0.0);
            f64x8::simd_from(simd, lanes)
        };
        Self(mask(self.0), mask(self.1), mask(self.2))
    }
    #[inline(always)]
    fn sum_lanes(self) -> DVec3 {
        let sum = |lanes: [f64; LANES]| lanes.iter().sum::<f64>();
        DVec3::new(sum(self.0.into()), sum(self.1.into()), sum(self.2.into()))
    }
}
