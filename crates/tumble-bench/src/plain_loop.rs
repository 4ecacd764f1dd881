//! The basic system as one loop over all particles, everything in one pass: as it is written down, with what
//! the compiler makes of it, and eight particles at a time in the processor's widest registers, which is about
//! as fast as such a loop gets.

use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};
use tumble::{BodyState, DMat3, DQuat, DVec3, Model, World};

const LANES: usize = 8;

/// How the loop runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// One particle after the other; vectors are up to the compiler.
    Compiled,
    /// Eight particles at a time.
    Vectors,
}

/// One body among walls, by the basic system.
#[derive(Clone, Debug)]
pub struct PlainLoop {
    /// How the loop runs.
    pub style: Style,
    places: Vec<DVec3>,
    /// Coordinates of the particles in the body frame (m), padded to groups of eight.
    columns: [Vec<f64>; 3],
    particle_mass: f64,
    mass: f64,
    inverse_inertia: DMat3,
    gravity: DVec3,
    drag: f64,
    stiffness: f64,
    /// (normal, offset) of each wall.
    walls: Vec<(DVec3, f64)>,
    dt: f64,
    /// Where the body is.
    pub state: BodyState,
}

impl PlainLoop {
    /// The first body of a world, as it is now.
    pub fn of(world: &World, style: Style) -> Self {
        let model: &Model = world.model();
        let body = &model.bodies[0];
        let particles = body.shape.particles();
        let padded = particles.len().next_multiple_of(LANES);
        let column = |axis: usize| {
            let mut column: Vec<f64> = particles.iter().map(|r| r[axis]).collect();
            column.resize(padded, 0.0);
            column
        };
        Self {
            style,
            places: particles.iter().collect(),
            columns: [column(0), column(1), column(2)],
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
            Style::Compiled => self.forces(rotation, omega),
            Style::Vectors => {
                dispatch!(Level::new(), simd => self.forces_by_eight(simd, rotation, omega))
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
        for &r in &self.places {
            let arm = rotation * r;
            let place = self.state.position + arm;
            let mut f = weight;
            if self.drag > 0.0 {
                f -= (self.state.velocity + omega.cross(arm)) * self.drag;
            }
            for &(normal, offset) in &self.walls {
                let depth = offset - normal.dot(place);
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
    fn forces_by_eight<S: Simd>(&self, simd: S, rotation: DMat3, omega: DVec3) -> (DVec3, DVec3) {
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let rows = [rotation.row(0), rotation.row(1), rotation.row(2)];
                let omega = Three::splat(simd, omega);
                let position = Three::splat(simd, self.state.position);
                let velocity = Three::splat(simd, self.state.velocity);
                let weight = Three::splat(simd, self.gravity * self.particle_mass);
                let mut force = Three::splat(simd, DVec3::ZERO);
                let mut torque = force;
                let [x, y, z] = &self.columns;
                let (x, y, z) = (x.as_chunks().0, y.as_chunks().0, z.as_chunks().0);
                for (first, ((x, y), z)) in (0..).step_by(LANES).zip(x.iter().zip(y).zip(z)) {
                    let r = Three::load(simd, x, y, z);
                    let arm = Three(r.dot(rows[0]), r.dot(rows[1]), r.dot(rows[2]));
                    let place = position.plus(arm);
                    let mut f = weight;
                    if self.drag > 0.0 {
                        f = f.minus(velocity.plus(omega.cross(arm)).times(self.drag));
                    }
                    for (normal, offset) in &self.walls {
                        let depth = f64x8::splat(simd, *offset) - place.dot(*normal);
                        let push = depth.simd_gt(zero).select(depth, zero) * self.stiffness;
                        f = f.plus(Three(push * normal.x, push * normal.y, push * normal.z));
                    }
                    if first + LANES > self.places.len() {
                        f = f.first(simd, self.places.len() - first);
                    }
                    force = force.plus(f);
                    torque = torque.plus(arm.cross(f));
                }
                (force.total(), torque.total())
            },
        )
    }
}

/// Eight vectors, by coordinate.
#[derive(Clone, Copy)]
struct Three<S: Simd>(f64x8<S>, f64x8<S>, f64x8<S>);

impl<S: Simd> Three<S> {
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
    fn times(self, factor: f64) -> Self {
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
    /// The first `count` lanes, and zero in the others.
    #[inline(always)]
    fn first(self, simd: S, count: usize) -> Self {
        let keep = |lanes: f64x8<S>| {
            let mut lanes: [f64; LANES] = lanes.into();
            lanes[count..].fill(0.0);
            f64x8::simd_from(simd, lanes)
        };
        Self(keep(self.0), keep(self.1), keep(self.2))
    }
    #[inline(always)]
    fn total(self) -> DVec3 {
        let sum = |lanes: [f64; LANES]| lanes.iter().sum::<f64>();
        DVec3::new(sum(self.0.into()), sum(self.1.into()), sum(self.2.into()))
    }
}
