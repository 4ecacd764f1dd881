//! Velocities at the start of a run that fit the joints.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::elimination::Pivots;
use super::rows::{MAX_ROWS, RowValues};
use super::system::{System, Twist};
use super::work::set_twists;
use crate::{Joints, Model, Motion, Prescribed, State};

/// Rates of constraints below this part of the largest speed fit.
const FITS: f64 = 1e-9;

/// Velocities of all bodies, and the joints that they are to fit.
pub(crate) struct JointVelocities<'a> {
    model: &'a Model,
    system: System,
    twists: Vec<Twist>,
}

impl<'a> JointVelocities<'a> {
    pub fn new(model: &'a Model, state: &State) -> Self {
        let mut velocities = Self { model, system: System::default(), twists: Vec::new() };
        velocities.system.set_states(model, &state.bodies);
        set_twists(model, &state.bodies, &mut velocities.twists);
        velocities
    }

    /// Gives each body whose velocity is not given that of the joint which connects it with a body, or the world, whose velocity is known.
    pub fn follow(&mut self, is_given: impl Fn(usize) -> bool) {
        let bodies = self.model.bodies.iter().enumerate();
        let mut known: Vec<bool> =
            bodies.map(|(index, body)| is_given(index) || !body.is_free()).collect();
        let mut has_changed = true;
        while has_changed {
            has_changed = false;
            for index in 0..self.model.joints.list.len() {
                has_changed |= self.follow_joint(index, &mut known);
            }
        }
    }

    fn follow_joint(&mut self, index: usize, known: &mut [bool]) -> bool {
        let joint = &self.model.joints.list[index];
        if joint.kind.has_length() {
            return false;
        }
        let is_known = |body: Option<u32>| body.is_none_or(|body| known[body as usize]);
        let (from, to) = match joint.bodies.map(is_known) {
            [true, false] => (0, 1),
            [false, true] => (1, 0),
            _ => return false,
        };
        let Some(body) = joint.bodies[to].map(|body| body as usize) else { return false };
        let place = &self.system.places[body];
        let point = place.position + place.rotation * joint.anchors[to];
        let velocity_at = |body: Option<u32>| {
            body.map_or(DVec3::ZERO, |body| {
                let (v, omega) = self.twists[body as usize];
                v + omega.cross(point - self.system.places[body as usize].position)
            })
        };
        let velocity = velocity_at(joint.bodies[from]);
        let (v, omega) = &mut self.twists[body];
        *v = velocity - omega.cross(point - place.position);
        known[body] = true;
        true
    }

    /// Adjusts the velocities of bodies of which none is given, to those with the least kinetic energy that fit.
    pub fn fit(&mut self, is_given: impl Fn(usize) -> bool) {
        let mut model = self.model.clone();
        for (index, body) in model.bodies.iter_mut().enumerate() {
            if is_given(index) {
                Arc::make_mut(body).motion = Motion::Prescribed(Prescribed::default());
            }
        }
        model.joints = Joints::new(std::mem::take(&mut model.joints.list), &model.bodies);
        for &body in &model.joints.bodies {
            if model.bodies[body as usize].is_free() {
                self.twists[body as usize] = Twist::default();
            }
        }
        self.system.factor(&model, &softness(&model));
        for _ in 0..2 {
            let rates = (0..model.joints.list.len())
                .map(|joint| self.system.rates(&model, joint, &self.twists).map(|rate| -rate));
            let mut impulses: Vec<RowValues> = rates.collect();
            self.system.solve(&model, &mut impulses);
            self.system.add_to_twists(&model, &impulses, &mut self.twists);
        }
    }

    /// A joint that the velocities do not fit, and the rate at which its constraint is broken (m/s or rad/s).
    pub fn misfit(&self) -> Option<(usize, f64)> {
        let joints = self.model.joints.list.iter().enumerate();
        joints
            .filter_map(|(index, joint)| {
                let rates = self.system.rates(self.model, index, &self.twists);
                let rates = rates[..joint.constraint_count()].iter().map(|rate| rate.abs());
                let worst = rates.fold(0.0, f64::max);
                let speeds = joint.bodies.iter().flatten().map(|body| {
                    let (v, omega) = self.twists[*body as usize];
                    v.length() + omega.length() * (1.0 + self.system.rows[index].arm.length())
                });
                let speed = speeds.fold(0.0, f64::max);
                (worst > FITS * speed || worst.is_nan()).then_some((index, worst))
            })
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Sets the velocities of the joined free bodies.
    pub fn apply(&self, state: &mut State) {
        for &index in &self.model.joints.bodies {
            let (body, state) =
                (&self.model.bodies[index as usize], &mut state.bodies[index as usize]);
            let (v, omega) = self.twists[index as usize];
            let rotation = DMat3::from_quat(state.orientation);
            let before = body.angular_velocity(rotation, state.angular_momentum);
            if body.is_free() {
                state.velocity = v;
            }
            if body.is_free() && omega != before {
                let momentum = body.inertia * (rotation.transpose() * omega);
                state.angular_momentum = rotation * momentum;
            }
        }
    }
}

/// Only the constraints take part.
fn softness(model: &Model) -> Vec<RowValues> {
    let of_joint = |joint: &super::model::JointModel| {
        let mut softness = [f64::NAN; MAX_ROWS];
        softness[..joint.constraint_count()].fill(0.0);
        softness
    };
    model.joints.list.iter().map(of_joint).collect()
}

/// The number of constraints that follow from others with the bodies in these states.
pub(crate) fn redundant_constraints(model: &Model, state: &State) -> usize {
    if model.joints.is_empty() {
        return 0;
    }
    let mut system = System::default();
    system.set_states(model, &state.bodies);
    let softness = softness(model);
    system.factor(model, &softness);
    let places = model.joints.elimination.order.iter().zip(&system.matrix.pivots);
    let of_joint = |(joint, pivots): (&u32, &Pivots)| {
        let count = model.joints.list[*joint as usize].constraint_count();
        pivots.diagonal[..count].iter().filter(|pivot| **pivot == 0.0).count()
    };
    places.map(of_joint).sum()
}
