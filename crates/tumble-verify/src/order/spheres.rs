//! Two balls pressed together.

use std::f64::consts::TAU;

use tumble::{
    Body, DVec3, Damping, Material, Motion as BodyMotion, Oscillation, Overlaps, Prescribed, World,
};

use super::{AT_LIMIT, Motion, order_check};
use crate::check::{Case, Check, Error, Outcome};
use crate::runge_kutta::integrate;
use crate::setup::{ball, step_until};

pub(crate) const CASE: Case = Case {
    name: "order of spheres",
    description: "Two spinning balls in contact stick or slip while the line between them turns. The second is free, fixed, oscillates or \
            turns. The order of the error between dt/2 and dt/4, against the Runge–Kutta method.",
    run,
    slow: false,
};

/// Masses (kg) and radii (m).
const MASS: [f64; 2] = [1.0, 2.0];
const RADIUS: [f64; 2] = [0.1, 0.14];
const STIFFNESS: f64 = 1e3;
const SPRING: f64 = 2.0 / 7.0 * STIFFNESS;
/// Depth at the start (m), along this normal.
const DEPTH: f64 = 2e-3;
const NORMAL: DVec3 = DVec3::new(0.6, 0.64, 0.48);
const VELOCITY: DVec3 = DVec3::new(0.4, -1.9, 0.3);
const OMEGA: DVec3 = DVec3::new(4.0, -7.0, 12.0);
const OTHER_OMEGA: DVec3 = DVec3::new(-6.0, 9.0, 5.0);
const TIME: f64 = 0.04;
const AMPLITUDE: DVec3 = DVec3::new(0.01, 0.004, -0.008);
const FREQUENCY: f64 = 8.0;
const PHASE: f64 = 0.4;

#[derive(Clone, Copy, PartialEq)]
enum Partner {
    Free,
    Fixed,
    Oscillating,
    Turning,
}

#[derive(Clone, Copy)]
struct Setting {
    partner: Partner,
    /// c_n and c_t (N·s/m).
    damping: [f64; 2],
    friction: f64,
}

/// The unknowns: of each ball position, velocity and angular velocity, then the stretch of the spring.
const UNKNOWNS: usize = 21;

fn vector(y: &[f64], index: usize) -> DVec3 {
    DVec3::new(y[3 * index], y[3 * index + 1], y[3 * index + 2])
}

fn set(y: &mut [f64], index: usize, v: DVec3) {
    y[3 * index..3 * index + 3].copy_from_slice(&v.to_array());
}

impl Setting {
    fn other_omega(&self) -> DVec3 {
        if matches!(self.partner, Partner::Free | Partner::Turning) {
            OTHER_OMEGA
        } else {
            DVec3::ZERO
        }
    }

    fn simulated(&self, dt: f64) -> Result<[Motion; 2], Error> {
        let material = Material {
            collision_stiffness: STIFFNESS,
            damping: Damping::Dashpot(self.damping[0]),
            friction_stiffness: self.friction,
            friction_damping: Some(self.damping[1]),
            ..Material::default()
        };
        let first = ball(RADIUS[0], MASS[0])?
            .position(NORMAL.normalize() * (RADIUS[0] + RADIUS[1] - DEPTH))
            .velocity(VELOCITY)
            .angular_velocity(OMEGA);
        let second = ball(RADIUS[1], MASS[1])?.angular_velocity(self.other_omega());
        let world = World::builder().gravity(DVec3::ZERO).dt(dt).material(material).force(true);
        let world = world.body(first).body(self.moved(second)).overlaps(Overlaps::Refuse);
        let mut world = world.build()?;
        super::set_springs(&mut world, 0, |_| self.first_stretch())?;
        step_until(&mut world, TIME)?;
        Ok([0, 1].map(|body| Motion::of(&world, body, RADIUS[body])))
    }

    /// The stretch of the spring at the start: none where it sticks, else at its limit, along the velocity.
    fn first_stretch(&self) -> DVec3 {
        if self.sticks() {
            return DVec3::ZERO;
        }
        let n = NORMAL.normalize();
        let arms = [n * (0.5 * DEPTH - RADIUS[0]), n * (RADIUS[1] - 0.5 * DEPTH)];
        let other_velocity = self.other_velocity(0.0, &[0.0; UNKNOWNS]);
        let u =
            VELOCITY - other_velocity + OMEGA.cross(arms[0]) - self.other_omega().cross(arms[1]);
        (u - n * u.dot(n)).normalize() * (self.friction * STIFFNESS * DEPTH / SPRING)
    }

    fn sticks(&self) -> bool {
        self.friction > 1.0
    }

    fn moved(&self, body: Body) -> Body {
        let oscillation = Oscillation { amplitude: AMPLITUDE, frequency: FREQUENCY, phase: PHASE };
        let oscillation = (self.partner == Partner::Oscillating).then_some(oscillation);
        let prescribed = Prescribed { oscillation, ..Prescribed::default() };
        if self.partner == Partner::Free {
            body
        } else {
            body.motion(BodyMotion::Prescribed(prescribed))
        }
    }

    /// Velocity of the second ball.
    fn other_velocity(&self, time: f64, y: &[f64]) -> DVec3 {
        match self.partner {
            Partner::Free => vector(y, 4),
            Partner::Oscillating => {
                let rate = TAU * FREQUENCY;
                AMPLITUDE * (rate * libm::cos(rate * time + PHASE))
            }
            Partner::Fixed | Partner::Turning => DVec3::ZERO,
        }
    }

    fn rate(&self, time: f64, y: &[f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
        let (velocity, omega, other_omega) = (vector(y, 1), vector(y, 2), vector(y, 5));
        let other_velocity = self.other_velocity(time, y);
        let line = vector(y, 0) - vector(y, 3);
        let n = line.normalize();
        let depth = RADIUS[0] + RADIUS[1] - line.length();
        let approach = velocity - other_velocity;
        let (arm, other_arm) = (n * (0.5 * depth - RADIUS[0]), n * (RADIUS[1] - 0.5 * depth));
        let u = approach + omega.cross(arm) - other_omega.cross(other_arm);
        let tangential = u - n * u.dot(n);
        let stretch = vector(y, 6);
        // the spring turns with the line between the centres, and about it with the mean of both spins
        let turn = n.cross(approach) / line.length() + n * (0.5 * (omega + other_omega).dot(n));
        let normal_force = STIFFNESS * depth - self.damping[0] * u.dot(n);
        // without a normal dashpot the limit changes with the depth alone
        let limit_rate = -self.friction * STIFFNESS / SPRING * approach.dot(n);
        let limit = self.friction * normal_force / SPRING;
        let along = tangential.dot(stretch.normalize_or_zero()) - limit_rate;
        let slips = stretch.length() >= limit * AT_LIMIT && along > 0.0;
        let slip = if slips { stretch.normalize_or_zero() * along } else { DVec3::ZERO };
        let mut force = n * normal_force - stretch * SPRING;
        if !slips {
            force -= tangential * self.damping[1];
        }
        let mut rate = [0.0; UNKNOWNS];
        set(&mut rate, 0, velocity);
        set(&mut rate, 1, force / MASS[0]);
        set(&mut rate, 2, arm.cross(force) / inertia(0));
        set(&mut rate, 3, other_velocity);
        if self.partner == Partner::Free {
            set(&mut rate, 4, -force / MASS[1]);
            set(&mut rate, 5, -other_arm.cross(force) / inertia(1));
        }
        set(&mut rate, 6, tangential + turn.cross(stretch) - slip);
        rate
    }

    fn exact(&self) -> [Motion; 2] {
        let mut y = [0.0; UNKNOWNS];
        set(&mut y, 0, NORMAL.normalize() * (RADIUS[0] + RADIUS[1] - DEPTH));
        set(&mut y, 1, VELOCITY);
        set(&mut y, 2, OMEGA);
        set(&mut y, 5, self.other_omega());
        set(&mut y, 6, self.first_stretch());
        let project = |y: &mut [f64; UNKNOWNS]| {
            let depth = RADIUS[0] + RADIUS[1] - (vector(y, 0) - vector(y, 3)).length();
            let longest = self.friction * STIFFNESS * depth / SPRING;
            let stretch = vector(y, 6);
            if self.damping[0] == 0.0 && stretch.length() >= longest * AT_LIMIT {
                set(y, 6, stretch * (longest / stretch.length()));
            }
        };
        integrate(&mut y, (0.0, TIME), 100_000, |t, y| self.rate(t, y), project);
        [0, 1].map(|body| Motion {
            position: vector(&y, 3 * body),
            velocity: if body == 0 { vector(&y, 1) } else { self.other_velocity(TIME, &y) },
            rim_velocity: vector(&y, 3 * body + 2) * RADIUS[body],
        })
    }

    fn check(&self) -> Result<Check, Error> {
        let partner = match self.partner {
            Partner::Free => "free",
            Partner::Fixed => "fixed",
            Partner::Oscillating => "oscillating",
            Partner::Turning => "turning",
        };
        let motion = if self.sticks() { "stick" } else { "slip" };
        let damped = if self.damping[1] > 0.0 { ", damped" } else { "" };
        let exact = self.exact();
        order_check(format!("balls {motion}{damped}, the second {partner}"), 4e-4, |dt| {
            let found = self.simulated(dt)?;
            let rate = (STIFFNESS / MASS[0]).sqrt();
            let squares = found.iter().zip(&exact).map(|(a, b)| a.squared_difference(b, rate));
            Ok(squares.sum::<f64>().sqrt())
        })
    }
}

/// Moment of inertia of a solid ball (kg·m²).
fn inertia(body: usize) -> f64 {
    0.4 * MASS[body] * RADIUS[body] * RADIUS[body]
}

fn run() -> Outcome {
    let mut checks = Vec::new();
    for partner in [Partner::Free, Partner::Fixed, Partner::Oscillating, Partner::Turning] {
        for (friction, damping) in
            [(1e6, [0.0, 0.0]), (1e6, [2.0, 1.0]), (0.3, [0.0, 0.0]), (0.3, [0.0, 1.0])]
        {
            checks.push(Setting { partner, damping, friction }.check()?);
        }
    }
    Ok(checks)
}
