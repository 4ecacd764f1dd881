//! A ball, and a plate of four particles, on a horizontal plane.

use std::f64::consts::TAU;

use tumble::{
    Body, DMat3, DVec3, Damping, Material, Mesh, Motion as BodyMotion, Oscillation, Prescribed,
    Primitive, Shape, World,
};

use super::{AT_LIMIT, Motion, order_check};
use crate::check::{Case, Check, Error, Outcome};
use crate::runge_kutta::integrate;
use crate::setup::{FLOOR, G, ball, mesh_body, step_until};

pub(crate) const CASE: Case = Case {
    name: "order on a plane",
    description: "A ball, and a plate of four particles, stick, roll or slip on a plane: a wall, or the face of a mesh that is \
            fixed, oscillates or turns. The order of the error between dt/2 and dt/4, against the Runge–Kutta method for the motion along the plane, \
            where the normal force is constant. The mesh is the first or the second body.",
    run,
    slow: false,
};

/// Mass of the body (kg), its radius (m), and moments of inertia (kg·m²).
const MASS: f64 = 1.0;
const RADIUS: f64 = 0.1;

#[derive(Clone, Copy, PartialEq)]
enum Plane {
    Wall,
    Mesh { is_first: bool, motion: PlaneMotion },
}

#[derive(Clone, Copy, PartialEq)]
enum PlaneMotion {
    Fixed,
    Oscillating,
    Turning,
}

const AMPLITUDE: DVec3 = DVec3::new(0.01, 0.0, -0.02);
const FREQUENCY: f64 = 6.0;
const PHASE: f64 = 0.7;
const SPIN: DVec3 = DVec3::new(0.0, 4.0, 0.0);

/// One situation.
#[derive(Clone, Copy)]
struct Setting {
    is_plate: bool,
    plane: Plane,
    /// k (N/m) and c_t (N·s/m) of each contact.
    stiffness: f64,
    damping: f64,
    slips: bool,
}

impl Setting {
    fn friction(&self) -> f64 {
        if self.slips { 0.3 } else { 30.0 }
    }

    fn spring(&self) -> f64 {
        2.0 / 7.0 * self.stiffness
    }

    fn contact_count(&self) -> usize {
        if self.is_plate { 4 } else { 1 }
    }

    fn moments(&self) -> DVec3 {
        let ball = MASS * 0.4 * RADIUS * RADIUS;
        if self.is_plate { DVec3::new(0.01, 0.02, 0.01) } else { DVec3::splat(ball) }
    }

    /// Initial velocity and angular velocity.
    fn start(&self) -> (DVec3, DVec3) {
        match (self.is_plate, self.slips) {
            (true, true) => (DVec3::new(4.0, 0.0, 2.0), DVec3::Y * 20.0),
            (true, false) => (DVec3::new(0.04, 0.0, 0.03), DVec3::Y * 0.4),
            (false, true) => (DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.0, 5.0, 0.0)),
            (false, false) => (DVec3::new(0.24, 0.0, 0.1), DVec3::new(1.3, 5.0, -2.0)),
        }
    }

    fn world(&self, dt: f64) -> Result<(World, usize), Error> {
        let material = Material {
            collision_stiffness: self.stiffness,
            damping: Damping::Dashpot(0.0),
            friction_stiffness: self.friction(),
            friction_damping: Some(self.damping),
            ..Material::default()
        };
        let depth = MASS * G / (self.contact_count() as f64 * self.stiffness);
        let (velocity, omega) = self.start();
        let height = if self.is_plate { -depth } else { RADIUS - depth };
        let body = if self.is_plate { plate(self.moments())? } else { ball(RADIUS, MASS)? };
        let body = body.position(DVec3::Y * height).velocity(velocity).angular_velocity(omega);
        let world = World::builder().dt(dt).material(material);
        let (world, index) = match self.plane {
            Plane::Wall => (world.wall(FLOOR).body(body), 0),
            Plane::Mesh { is_first: true, motion } => (world.body(slab(motion)?).body(body), 1),
            Plane::Mesh { is_first: false, motion } => (world.body(body).body(slab(motion)?), 0),
        };
        let mut world = world.build()?;
        if self.slips {
            super::set_springs(&mut world, index, |particle| {
                self.first_stretch(particle as usize)
            })?;
        }
        Ok((world, index))
    }

    /// The motion at `time` (s) with the step `dt` (s).
    fn simulated(&self, dt: f64, time: f64) -> Result<Motion, Error> {
        let (mut world, index) = self.world(dt)?;
        step_until(&mut world, time)?;
        Ok(Motion::of(&world, index, RADIUS))
    }

    fn name(&self) -> String {
        let body = if self.is_plate { "plate" } else { "ball" };
        let plane = match self.plane {
            Plane::Wall => "wall".to_owned(),
            Plane::Mesh { is_first, motion } => {
                let motion = match motion {
                    PlaneMotion::Fixed => "fixed",
                    PlaneMotion::Oscillating => "oscillating",
                    PlaneMotion::Turning => "turning",
                };
                format!("{motion} mesh{}", if is_first { ", mesh first" } else { "" })
            }
        };
        let motion = match (self.slips, self.stiffness > 1e4) {
            (true, true) => "slips, stiff springs",
            (true, false) => "slips",
            (false, _) if self.is_plate => "sticks",
            (false, _) => "rolls",
        };
        let damped = if self.damping > 0.0 { ", damped" } else { "" };
        format!("{body} {motion}{damped}, {plane}")
    }
}

/// The corners of the plate: a square in its own plane.
fn corners() -> [DVec3; 4] {
    [DVec3::X, DVec3::Z, -DVec3::X, -DVec3::Z].map(|corner| corner * RADIUS)
}

/// A plate whose centre of mass lies in the plane of its particles, so that friction does not tilt it.
fn plate(moments: DVec3) -> Result<Body, Error> {
    let gyration = DMat3::from_diagonal(moments / MASS);
    let shape = Shape::from_distribution(&corners(), Mesh::default(), DVec3::ZERO, gyration)?;
    Ok(Body::new(shape).mass(MASS))
}

/// A box with its upper face at y = 0.
fn slab(motion: PlaneMotion) -> Result<Body, Error> {
    let cuboid = Primitive::Box { size: DVec3::new(6.0, 0.5, 6.0), divisions: 1 };
    let oscillation = Oscillation { amplitude: AMPLITUDE, frequency: FREQUENCY, phase: PHASE };
    let oscillates = motion == PlaneMotion::Oscillating;
    let prescribed =
        Prescribed { oscillation: oscillates.then_some(oscillation), ..Prescribed::default() };
    let spin = if motion == PlaneMotion::Turning { SPIN } else { DVec3::ZERO };
    let body = mesh_body(cuboid)?.position(DVec3::Y * -0.25).angular_velocity(spin);
    Ok(body.motion(BodyMotion::Prescribed(prescribed)).name("slab"))
}

/// The unknowns: position, velocity, angular velocity, angle about y, and the stretches of four springs.
const UNKNOWNS: usize = 3 + 3 + 3 + 1 + 12;

fn vector(y: &[f64], index: usize) -> DVec3 {
    DVec3::new(y[index], y[index + 1], y[index + 2])
}

fn set(y: &mut [f64], index: usize, v: DVec3) {
    y[index..index + 3].copy_from_slice(&v.to_array());
}

impl Setting {
    /// The stretch of a spring at the start: none where it sticks, else at its limit, along the velocity.
    fn first_stretch(&self, contact: usize) -> DVec3 {
        if !self.slips {
            return DVec3::ZERO;
        }
        let arm = if self.is_plate { corners()[contact] } else { DVec3::Y * -RADIUS };
        let (velocity, omega) = self.start();
        let u = velocity + omega.cross(arm) - self.plane_velocity(arm, 0.0).0;
        DVec3::new(u.x, 0.0, u.z).normalize() * self.limit()
    }

    /// The longest stretch of a spring: μ N/k_t.
    fn limit(&self) -> f64 {
        self.friction() * MASS * G / (self.contact_count() as f64 * self.spring())
    }

    /// Velocity and angular velocity of the plane at a point and a time.
    fn plane_velocity(&self, point: DVec3, time: f64) -> (DVec3, DVec3) {
        let Plane::Mesh { motion, .. } = self.plane else { return (DVec3::ZERO, DVec3::ZERO) };
        match motion {
            PlaneMotion::Fixed => (DVec3::ZERO, DVec3::ZERO),
            PlaneMotion::Oscillating => {
                let rate = TAU * FREQUENCY;
                (AMPLITUDE * (rate * libm::cos(rate * time + PHASE)), DVec3::ZERO)
            }
            PlaneMotion::Turning => (SPIN.cross(point), SPIN),
        }
    }

    fn rate(&self, time: f64, y: &[f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
        let (position, velocity, omega) = (vector(y, 0), vector(y, 3), vector(y, 6));
        let turn = DMat3::from_rotation_y(y[9]);
        let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        let mut rate = [0.0; UNKNOWNS];
        for (index, corner) in corners().iter().enumerate().take(self.contact_count()) {
            let arm = if self.is_plate { turn * *corner } else { DVec3::Y * -RADIUS };
            let (plane_velocity, plane_spin) = self.plane_velocity(position + arm, time);
            let mut u = velocity + omega.cross(arm) - plane_velocity;
            u.y = 0.0;
            let stretch = vector(y, 10 + 3 * index);
            let friction = self.friction_force(stretch, u);
            force += friction;
            torque += arm.cross(friction);
            let is_at_limit = stretch.length() >= self.limit() * AT_LIMIT;
            let slipping = if is_at_limit { stretch.dot(u).max(0.0) } else { 0.0 };
            let slip = stretch * (slipping / stretch.length_squared().max(1e-300));
            set(&mut rate, 10 + 3 * index, u + plane_spin.cross(stretch) - slip);
        }
        set(&mut rate, 0, velocity);
        set(&mut rate, 3, force / MASS);
        set(&mut rate, 6, torque / self.moments());
        rate[9] = omega.y;
        rate
    }

    /// Spring and dashpot, of which the friction limit lets pass what the spring leaves.
    fn friction_force(&self, stretch: DVec3, u: DVec3) -> DVec3 {
        let (spring, dashpot) = (stretch * -self.spring(), u * -self.damping);
        let limit = self.limit() * self.spring();
        let (a, b) = (dashpot.length_squared(), spring.dot(dashpot));
        let c = (limit * limit - spring.length_squared()).max(0.0);
        let part = if a > 0.0 { (((b * b + a * c).sqrt() - b) / a).clamp(0.0, 1.0) } else { 0.0 };
        spring + dashpot * part
    }

    fn exact(&self, time: f64, steps: usize) -> Motion {
        let mut y = [0.0; UNKNOWNS];
        let (velocity, omega) = self.start();
        set(&mut y, 3, velocity);
        set(&mut y, 6, omega);
        for contact in 0..self.contact_count() {
            set(&mut y, 10 + 3 * contact, self.first_stretch(contact));
        }
        let project = |y: &mut [f64; UNKNOWNS]| {
            for index in 0..4 {
                let stretch = vector(y, 10 + 3 * index);
                if stretch.length() >= self.limit() * AT_LIMIT {
                    set(y, 10 + 3 * index, stretch * (self.limit() / stretch.length()));
                }
            }
        };
        integrate(&mut y, (0.0, time), steps, |t, y| self.rate(t, y), project);
        Motion {
            position: vector(&y, 0),
            velocity: vector(&y, 3),
            rim_velocity: vector(&y, 6) * RADIUS,
        }
    }

    fn check(&self) -> Result<Check, Error> {
        let is_stiff = self.stiffness > 1e4;
        let (dt, time) = if is_stiff { (1e-4, 0.1) } else { (5e-4, 0.1) };
        let exact = self.exact(time, 200_000);
        let rate = (3.5 * self.spring() / MASS).sqrt();
        order_check(self.name(), dt, |dt| {
            let mut found = self.simulated(dt, time)?;
            found.position.y = exact.position.y;
            found.velocity.y = 0.0;
            let rate = if self.slips { 1.0 / time } else { rate };
            Ok(found.squared_difference(&exact, rate).sqrt())
        })
    }
}

fn run() -> Outcome {
    let mut planes = vec![Plane::Wall];
    for motion in [PlaneMotion::Fixed, PlaneMotion::Oscillating, PlaneMotion::Turning] {
        planes.extend([false, true].map(|is_first| Plane::Mesh { is_first, motion }));
    }
    let mut checks = Vec::new();
    for is_plate in [false, true] {
        for &plane in &planes {
            for (slips, damping, stiffness) in [
                (false, 0.0, 1e4),
                (false, 5.0, 1e4),
                (true, 0.0, 1e4),
                (true, 5.0, 1e4),
                (true, 0.0, 1e5),
            ] {
                let setting = Setting { is_plate, plane, stiffness, damping, slips };
                checks.push(setting.check()?);
            }
        }
    }
    Ok(checks)
}
