//! Loads: given forces and torques on bodies.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::kinematics::Kinematics;
use crate::{BodyView, Model, State, Wrench};

/// The axes in which a load is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LoadAxes {
    /// Fixed in the world.
    #[default]
    World,
    /// Fixed in the body: the load turns with it, as that of a thruster.
    Body,
}

/// How a load changes in time.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum LoadCourse {
    /// Not at all.
    #[default]
    Constant,
    /// Times sin(2π f t + φ).
    Periodic {
        /// f (Hz).
        frequency: f64,
        /// φ (rad).
        phase: f64,
    },
    /// The force is given at times (s, N), linear in between and constant outside. Times rise.
    Table(Vec<(f64, DVec3)>),
}

/// The description of a load on a body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Load {
    /// The name of the body.
    pub body: String,
    /// The force (N).
    pub force: DVec3,
    /// The torque, in addition to that of the force (N·m).
    pub torque: DVec3,
    /// Where the force acts (m, body axes, from the centre of mass).
    pub at: DVec3,
    /// The axes of force and torque.
    pub axes: LoadAxes,
    /// How it changes in time.
    pub course: LoadCourse,
}

impl Load {
    /// A constant force (N, world axes) at the centre of mass of a body.
    pub fn force(body: impl Into<String>, force: DVec3) -> Self {
        Self { body: body.into(), force, ..Self::default() }
    }

    /// A constant torque (N·m, world axes) on a body.
    pub fn torque(body: impl Into<String>, torque: DVec3) -> Self {
        Self { body: body.into(), torque, ..Self::default() }
    }

    /// Lets the force act at a point (m, body axes, from the centre of mass).
    pub fn at(mut self, at: DVec3) -> Self {
        self.at = at;
        self
    }

    /// Lets the load turn with the body.
    pub fn in_body_axes(mut self) -> Self {
        self.axes = LoadAxes::Body;
        self
    }

    /// Lets the load change in time.
    pub fn course(mut self, course: LoadCourse) -> Self {
        self.course = course;
        self
    }

    /// The same load, with time counted from `time` (s) on.
    pub fn from_time(mut self, time: f64) -> Self {
        let turn = std::f64::consts::TAU;
        match &mut self.course {
            LoadCourse::Constant => {}
            LoadCourse::Periodic { frequency, phase } => {
                *phase = (*phase + turn * (*frequency * time).fract()) % turn;
            }
            LoadCourse::Table(rows) => rows.iter_mut().for_each(|row| row.0 -= time),
        }
        self
    }

    /// The wrench at a time (s), on a body with this orientation.
    pub fn wrench(&self, time: f64, rotation: DMat3) -> Wrench {
        let (mut force, mut torque) = (self.force, self.torque);
        match &self.course {
            LoadCourse::Constant => {}
            LoadCourse::Periodic { frequency, phase } => {
                let factor = libm::sin(std::f64::consts::TAU * frequency * time + phase);
                (force, torque) = (force * factor, torque * factor);
            }
            LoadCourse::Table(rows) => force = interpolate(rows, time),
        }
        if self.axes == LoadAxes::Body {
            (force, torque) = (rotation * force, rotation * torque);
        }
        Wrench { force, torque: torque + (rotation * self.at).cross(force) }
    }
}

fn interpolate(rows: &[(f64, DVec3)], time: f64) -> DVec3 {
    let next = rows.partition_point(|row| row.0 <= time);
    match (next.checked_sub(1).and_then(|index| rows.get(index)), rows.get(next)) {
        (Some(&(from, a)), Some(&(until, b))) => a + (b - a) * ((time - from) / (until - from)),
        (Some(&(_, force)), None) | (None, Some(&(_, force))) => force,
        (None, None) => DVec3::ZERO,
    }
}

/// From time (s) and body to force and torque about the centre of mass (N, N·m, world axes).
type Function = dyn Fn(f64, &BodyView) -> Wrench + Send + Sync;

/// A force that a program computes.
///
/// It is called with the time (s) and the body in the middle of each step, possibly several times for one step, and on any thread. The wrench
/// must depend on nothing else: then runs can be repeated and resumed.
#[derive(Clone)]
pub struct ForceFunction {
    /// The name of the body.
    pub body: String,
    /// From time and body to force and torque about the centre of mass (N, N·m, world axes).
    pub function: Arc<Function>,
}

impl std::fmt::Debug for ForceFunction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ForceFunction").field("body", &self.body).finish_non_exhaustive()
    }
}

/// Gravity of a mass at a fixed place, as of a planet.
///
/// It acts on the mass of each body and on its inertia, which gives the torque of the tides: the potential is that of MacCullagh,
///
/// U = −GM M/r − GM (tr I − 3 x̂·I x̂)/(2 r³),
///
/// whose error is of third order in the size of the body over r (C. D. Murray & S. F. Dermott, *Solar System Dynamics* (1999), 5.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentralGravity {
    /// Gravitational constant times mass (m³/s²).
    pub gm: f64,
    /// The place (m).
    pub at: DVec3,
}

impl CentralGravity {
    /// The wrench on a body (N, N·m).
    pub(crate) fn wrench(&self, kinematics: &Kinematics) -> Wrench {
        let (x, turned, q, trace) = self.terms(kinematics);
        let r = x.length();
        let r5 = r * r * r * r * r;
        let point = x * (kinematics.body.mass / (r * r * r));
        let extended = (x * (15.0 * q / (r * r) - 3.0 * trace) - turned * 6.0) / r5;
        Wrench {
            force: (extended * 0.5 - point) * self.gm,
            torque: x.cross(turned) * (3.0 * self.gm / r5),
        }
    }

    /// The potential energy of a body (J), 0 at infinity.
    pub(crate) fn energy(&self, kinematics: &Kinematics) -> f64 {
        let (x, _, q, trace) = self.terms(kinematics);
        let r = x.length();
        -self.gm * (kinematics.body.mass / r + 0.5 * (trace - 3.0 * q / (r * r)) / (r * r * r))
    }

    /// x from the place, I x, x·I x and tr I.
    fn terms(&self, kinematics: &Kinematics) -> (DVec3, DVec3, f64, f64) {
        let x = kinematics.position - self.at;
        let rotation = kinematics.rotation;
        let inertia = &kinematics.body.inertia;
        let turned = rotation * (*inertia * (rotation.transpose() * x));
        let trace = inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z;
        (x, turned, x.dot(turned), trace)
    }
}

/// All loads of a model, by body.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    /// Gravity of a mass at a fixed place.
    pub central_gravity: Option<CentralGravity>,
    /// Loads, with the index of their body, sorted by it.
    pub list: Vec<(u32, Load)>,
    /// Functions, likewise.
    pub functions: Vec<(u32, ForceFunction)>,
}

impl Loads {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.central_gravity.is_none() && self.list.is_empty() && self.functions.is_empty()
    }

    /// The wrench of all loads on a body at a time (s), with central gravity, and that of central gravity alone.
    pub(crate) fn wrenches(&self, index: usize, view: &BodyView, time: f64) -> [Wrench; 2] {
        let kinematics = Kinematics::new(view.model(), view.state());
        let gravity = self.central_gravity.map(|gravity| gravity.wrench(&kinematics));
        let gravity = gravity.unwrap_or_default();
        let mut wrench = gravity;
        for (_, load) in of_body(&self.list, index) {
            wrench += load.wrench(time, kinematics.rotation);
        }
        for (_, function) in of_body(&self.functions, index) {
            wrench += (function.function)(time, view);
        }
        [wrench, gravity]
    }

    /// The potential energy of all bodies (J).
    pub(crate) fn energy(&self, model: &Model, state: &State) -> f64 {
        let Some(gravity) = &self.central_gravity else { return 0.0 };
        let bodies = model.bodies.iter().zip(&state.bodies).filter(|(body, _)| body.is_free());
        bodies.map(|(body, state)| gravity.energy(&Kinematics::new(body, state))).sum()
    }
}

fn of_body<T>(list: &[(u32, T)], index: usize) -> &[(u32, T)] {
    let start = list.partition_point(|(body, _)| (*body as usize) < index);
    let end = list.partition_point(|(body, _)| (*body as usize) <= index);
    &list[start..end]
}
