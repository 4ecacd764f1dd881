//! The held gyroscope.

use tumble::{DQuat, DVec3, Joint, World};

use super::{G, rigid, world};
use crate::check::{Case, Check, Error, Outcome};
use crate::runge_kutta::integrate;
use crate::setup::step_until;

pub(crate) const GYROSCOPE: Case = Case {
    name: "gyroscope",
    description: "A symmetric body that is held at a point of its axis, 60° from the vertical. It precesses steadily at both roots of \
            A Ω² cos θ − C n Ω + m g l = 0, slow and fast. Let go without precession it nods, against the Runge–Kutta method for its Euler \
            angles.",
    run: gyroscope,
    slow: false,
};

/// Mass (kg), distance of the centre of mass from the point (m), and moments about the axis and across it at the centre of mass (kg·m²).
const MASS: f64 = 1.0;
const LENGTH: f64 = 0.2;
const AXIAL: f64 = 0.01;
const ACROSS: f64 = 0.006;
/// Angle from the vertical (rad), and rate n of the rotation about the axis (rad/s).
const TILT: f64 = std::f64::consts::FRAC_PI_3;
const SPIN: f64 = 100.0;

/// The axis begins in the plane z = 0, and precesses at `precession` (rad/s) about y.
fn gyroscope_world(dt: f64, precession: f64) -> Result<World, Error> {
    let axis = DVec3::new(libm::sin(TILT), libm::cos(TILT), 0.0);
    // the component along the axis is n
    let vertical = DVec3::Y * precession;
    let omega = axis * SPIN + (vertical - axis * vertical.dot(axis));
    let body = rigid("top", MASS, DVec3::new(ACROSS, AXIAL, ACROSS), axis * LENGTH)?;
    let turn = DQuat::from_rotation_arc(DVec3::Y, axis);
    Ok(world(dt)
        .body(body.orientation(turn).angular_velocity(omega))
        .joint(Joint::ball(["top", "world"], DVec3::ZERO))
        .build()?)
}

/// Angle from the vertical, and that of the precession about y, counted from x (rad).
fn angles(world: &World) -> [f64; 2] {
    let at = world.body(0).position() / LENGTH;
    [libm::acos(at.y.clamp(-1.0, 1.0)), libm::atan2(-at.z, at.x)]
}

fn gyroscope() -> Outcome {
    let across = ACROSS + MASS * LENGTH * LENGTH;
    let (a, b, c) = (across * libm::cos(TILT), -AXIAL * SPIN, MASS * G * LENGTH);
    let root = (b * b - 4.0 * a * c).sqrt();
    let mut checks = Vec::new();
    for (name, precession) in [("slow", (-b - root) / (2.0 * a)), ("fast", (-b + root) / (2.0 * a))]
    {
        let mut world = gyroscope_world(1e-4, precession)?;
        step_until(&mut world, 0.5)?;
        let [tilt, phase] = angles(&world);
        let turns = ((precession * 0.5 - phase) / std::f64::consts::TAU).round();
        let rate = (phase + turns * std::f64::consts::TAU) / 0.5;
        checks.push(Check::new(
            format!("rate of {name} precession"),
            precession,
            rate,
            1e-5 * precession,
            "rad/s",
        ));
        checks.push(Check::new(
            format!("angle from the vertical, {name}"),
            TILT,
            tilt,
            1e-5,
            "rad",
        ));
    }
    // conserved momenta about the vertical and the axis
    let along = AXIAL * SPIN;
    let vertical = along * libm::cos(TILT);
    let equation = |_: f64, y: &[f64; 3]| {
        let (sin, cos) = libm::sincos(y[0]);
        let precession = (vertical - along * cos) / (across * sin * sin);
        let torque = MASS * G * LENGTH * sin;
        let turning = precession * sin * (across * precession * cos - along);
        [y[1], (torque + turning) / across, precession]
    };
    let mut y = [TILT, 0.0, 0.0];
    integrate(&mut y, (0.0, 1.0), 100_000, equation, |_| {});
    let run = |dt: f64| -> Result<f64, Error> {
        let mut world = gyroscope_world(dt, 0.0)?;
        step_until(&mut world, 1.0)?;
        let [tilt, phase] = angles(&world);
        let turns = ((y[2] - phase) / std::f64::consts::TAU).round();
        Ok((tilt - y[0]).hypot(phase + turns * std::f64::consts::TAU - y[2]))
    };
    let [coarse, fine] = [run(4e-4)?, run(2e-4)?];
    checks.push(Check::error(
        "deviation of both angles with nutation after 1 s, dt = 0.2 ms",
        fine,
        1e-4,
        "rad",
    ));
    checks.push(Check::new("order of the deviation", 2.0, libm::log2(coarse / fine), 0.05, ""));
    Ok(checks)
}
