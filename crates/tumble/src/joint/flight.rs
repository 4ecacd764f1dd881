//! The flight of joined bodies, by RATTLE around the exact flight of each.
//!
//! Impulses λ at the beginning, along the gradients there, are such that all constraints hold at the end; they are found by Newton's
//! method with the gradients in the middle, which needs two or three flights. Impulses at the end, along the gradients there, let the
//! rates of the constraints vanish. The whole is symmetric in time, and symplectic without drag, since the flight is.
//!
//! A limit pushes only: it takes part where the coordinate would pass it, and no longer when it would have to pull. A limit that is
//! met stops the motion, and takes its energy.

use glam::DQuat;

use super::model::Place;
use super::rows::{MAX_ROWS, RowValues};
use super::system::Twist;
use super::work::{JointFailure, JointWork, set_twists};
use crate::stage::drift_body;
use crate::{BodyState, Model, State};

/// Flights of Newton's method. Two or three are enough unless a body turns by half a radian or more in a flight.
const MAX_FLIGHTS: usize = 100;
/// Constraints hold to this, relative to the distances that they are computed from.
const TOLERANCE: f64 = 2e-15;
/// What is accepted where rounding errors allow no less.
const ACCEPTED: f64 = 1e-12;
/// Changes of the set of limits that act in a flight.
const MAX_CHANGES: usize = 32;

/// Which limit of a coordinate acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Limit {
    None,
    Lower,
    Upper,
}

/// One flight.
struct Flight<'a> {
    model: &'a Model,
    work: &'a mut JointWork,
    /// Its duration (s).
    time: f64,
    /// For each joint, now and in the flight before.
    limits: Vec<Limit>,
    limits_before: Vec<Limit>,
    /// How often each joint's limit changed.
    changes: Vec<usize>,
    /// What drag took in the latest trial (J).
    drag: f64,
}

/// Flies all joined bodies for the time `h` (s) from where [`JointWork::begin_flight`] found them. Prescribed motions have advanced.
pub(crate) fn fly(model: &Model, state: &mut State, work: &mut JointWork, h: f64) {
    let count = model.joints.list.len();
    work.start_system.set_states(model, &work.start);
    set_twists(model, &work.start, &mut work.start_twists);
    let JointWork { start_rates, start_system, start_twists, .. } = &mut *work;
    start_rates.clear();
    start_rates.extend(model.joints.list.iter().enumerate().map(|(index, joint)| {
        let rates = start_system.rates(model, index, start_twists);
        joint.coordinate_row().map_or(0.0, |row| rates[row])
    }));
    work.impulses.clear();
    let joints = state.joints.iter_mut().zip(&model.joints.list);
    for (joint_state, _) in joints.filter(|(_, joint)| !joint.acts_at(state.time)) {
        joint_state.force = RowValues::default();
    }
    work.impulses.extend(state.joints.iter().map(|joint| joint.force.map(|force| force * h)));
    let limits = state.joints.iter().zip(&model.joints.list).map(|(state, joint)| {
        match joint.coordinate_row().map(|row| state.force[row]) {
            Some(force) if force > 0.0 => Limit::Lower,
            Some(force) if force < 0.0 => Limit::Upper,
            _ => Limit::None,
        }
    });
    let limits: Vec<_> = limits.collect();
    let limits_before = limits.clone();
    let changes = vec![0; count];
    let mut flight = Flight { model, work, time: h, limits, limits_before, changes, drag: 0.0 };
    flight.solve(state);
    flight.finish(state);
}

impl Flight<'_> {
    /// Finds the impulses at the beginning, and the limits that act.
    fn solve(&mut self, state: &mut State) {
        for _ in 0..MAX_CHANGES {
            if let Some(failure) = self.newton(state) {
                self.work.failure.get_or_insert(failure);
                return;
            }
            if !self.change_limits(state) {
                return;
            }
        }
    }

    /// Newton's method for the constraints and the limits that act. Returns the joint that failed.
    fn newton(&mut self, state: &mut State) -> Option<JointFailure> {
        let mut before = f64::INFINITY;
        let mut worst = JointFailure { joint: 0, error: f64::INFINITY };
        for number in 0..MAX_FLIGHTS {
            self.fly_with_impulses(state);
            let (error, joint) = self.residuals(state);
            worst = JointFailure { joint, error };
            if error <= TOLERANCE || (error >= 0.25 * before && error <= ACCEPTED) {
                return None;
            }
            if error.is_nan() {
                break;
            }
            if number == 0 {
                self.factor_in_the_middle(state);
            }
            before = error;
            let JointWork { system, residuals, impulses, .. } = &mut *self.work;
            system.solve(self.model, residuals);
            let per_time = 1.0 / self.time;
            for (impulses, residuals) in impulses.iter_mut().zip(&*residuals) {
                for (impulse, residual) in impulses.iter_mut().zip(residuals) {
                    *impulse -= residual * per_time;
                }
            }
        }
        Some(worst)
    }

    /// Flies all joined free bodies with the present impulses at the beginning.
    fn fly_with_impulses(&mut self, state: &mut State) {
        let Self { model, work, time, .. } = self;
        for &body in &model.joints.bodies {
            if model.bodies[body as usize].is_free() {
                state.bodies[body as usize] = work.start[body as usize];
            }
        }
        work.start_system.add_to_states(model, &work.impulses, &mut state.bodies);
        self.drag = 0.0;
        for &index in &model.joints.bodies {
            let body = &model.bodies[index as usize];
            if body.is_free() {
                self.drag += drift_body(model, body, &mut state.bodies[index as usize], *time);
            }
        }
    }

    /// Sets the residuals; returns the largest one, relative to the distances that it is computed from, and its joint.
    fn residuals(&mut self, state: &State) -> (f64, usize) {
        let Self { model, work, limits, time, .. } = self;
        let fall = model.gravity.length() * *time * *time;
        work.system.set_states(model, &state.bodies);
        work.residuals.resize(limits.len(), RowValues::default());
        let mut worst = (0.0, 0);
        let joints = model.joints.list.iter().zip(&*limits).zip(&state.joints).enumerate();
        for (index, ((joint, limit), joint_state)) in joints {
            let constraint_count = joint.constraint_count_at(state.time);
            let rows = &work.system.rows[index];
            let residuals = &mut work.residuals[index];
            *residuals = RowValues::default();
            for (residual, row) in residuals[..constraint_count].iter_mut().zip(&rows.rows) {
                *residual = row.value;
            }
            if let (Some(row), true) = (joint.coordinate_row(), *limit != Limit::None) {
                let bound = joint.limits[usize::from(*limit == Limit::Upper)];
                residuals[row] = joint.near(rows.rows[row].value, joint_state.coordinate) - bound;
            }
            // the distances that values are computed from: a joint in the centre of a body at the origin has none but its size
            let sizes = joint.bodies.iter().flatten().map(|&body| {
                let start = &work.start[body as usize];
                let position = work.system.places[body as usize].position;
                let path = start.velocity.length() * *time + fall;
                position.length().max(model.bodies[body as usize].extent).max(path)
            });
            let arms = joint.anchors.iter().map(|anchor| anchor.length());
            let size = sizes.chain(arms).fold(0.0, f64::max);
            let size = if size > 0.0 { size } else { 1.0 };
            for (residual, row) in residuals.iter().zip(&rows.rows) {
                let size = if row.linear == glam::DVec3::ZERO { 1.0 } else { size };
                let relative = residual.abs() / size;
                // NaN is the worst
                if relative > worst.0 || relative.is_nan() {
                    worst = (relative, index);
                }
            }
        }
        worst
    }

    /// Sets which rows take part.
    fn set_softness(&mut self, time: f64) {
        let Self { model, work, limits, .. } = self;
        work.softness.clear();
        work.softness.extend(model.joints.list.iter().zip(&*limits).map(|(joint, limit)| {
            let mut softness = [f64::NAN; MAX_ROWS];
            softness[..joint.constraint_count_at(time)].fill(0.0);
            if let (Some(row), true) = (joint.coordinate_row(), *limit != Limit::None) {
                softness[row] = 0.0;
            }
            softness
        }));
    }

    /// The matrix of Newton's method. Its error is of second order in the rotation during the flight.
    fn factor_in_the_middle(&mut self, state: &State) {
        self.set_softness(state.time);
        let JointWork { start, system, start_system, softness, .. } = &mut *self.work;
        if self.model.joints.has_redundant {
            // half way the constraints do not hold, so that rows which depend on others at the beginning seem to be almost independent
            start_system.factor(self.model, softness);
            start_system.leave_out_dependent(self.model, softness);
        }
        system.set_places(self.model, |body| middle(&start[body], &state.bodies[body]));
        system.factor(self.model, softness);
    }

    /// Adds a limit that is passed, or removes one that pulls; returns whether any has changed.
    fn change_limits(&mut self, state: &State) -> bool {
        let Self { model, work, limits, changes, .. } = self;
        let mut has_changed = false;
        for (index, joint) in model.joints.list.iter().enumerate() {
            let is_limited = joint.is_limited() && joint.acts_at(state.time);
            let Some(row) = joint.coordinate_row().filter(|_| is_limited) else { continue };
            let coordinate =
                joint.near(work.system.rows[index].rows[row].value, state.joints[index].coordinate);
            let impulse = &mut work.impulses[index][row];
            let wanted = match limits[index] {
                Limit::Lower if *impulse < 0.0 => Limit::None,
                Limit::Upper if *impulse > 0.0 => Limit::None,
                Limit::None if coordinate < joint.limits[0] => Limit::Lower,
                Limit::None if coordinate > joint.limits[1] => Limit::Upper,
                same => same,
            };
            // a limit that goes back and forth acts
            let is_settled = changes[index] > 3 && wanted == Limit::None;
            if wanted != limits[index] && !is_settled {
                limits[index] = wanted;
                changes[index] += 1;
                has_changed = true;
                if wanted == Limit::None {
                    *impulse = 0.0;
                }
            }
        }
        has_changed
    }

    /// Lets the rates of the constraints vanish at the end, and keeps account.
    fn finish(mut self, state: &mut State) {
        state.totals.drag += self.drag;
        self.store(state);
        let impulses = std::mem::take(&mut self.work.impulses);
        let JointWork { start_system, start_twists, twists, .. } = &mut *self.work;
        state.totals.work += start_system.work(self.model, &impulses, start_twists);
        twists.clone_from(start_twists);
        start_system.add_to_twists(self.model, &impulses, twists);
        state.totals.joint_friction += self.limit_loss(true, &impulses);
        self.work.record(true, &impulses);
        self.work.impulses = impulses;
        self.project(state);
    }

    /// Removes the rates of the constraints at the end.
    fn project(&mut self, state: &mut State) {
        let model = self.model;
        set_twists(model, &state.bodies, &mut self.work.start_twists);
        self.set_softness(state.time);
        let mut impulses = Vec::new();
        loop {
            let JointWork { system, softness, start_twists, twists, residuals, .. } =
                &mut *self.work;
            system.factor(model, softness);
            twists.clone_from(start_twists);
            impulses.clear();
            impulses.resize(softness.len(), RowValues::default());
            // the second time for the digits that the first one lacks
            for _ in 0..2 {
                for (joint, residual) in residuals.iter_mut().enumerate() {
                    *residual = system.rates(model, joint, twists).map(|rate| -rate);
                }
                system.solve(model, residuals);
                system.add_to_twists(model, residuals, twists);
                for (impulses, more) in impulses.iter_mut().zip(&*residuals) {
                    impulses.iter_mut().zip(more).for_each(|(impulse, more)| *impulse += more);
                }
            }
            if !self.release_limits(&impulses) {
                break;
            }
        }
        let loss = self.limit_loss(false, &impulses);
        state.totals.joint_friction += loss;
        let JointWork { system, start_twists, .. } = &mut *self.work;
        state.totals.work += system.work(model, &impulses, start_twists);
        system.add_to_states(model, &impulses, &mut state.bodies);
        self.work.record(false, &impulses);
    }

    /// Lets go of limits that would pull; returns whether there are any.
    fn release_limits(&mut self, impulses: &[RowValues]) -> bool {
        let mut has_released = false;
        for (index, joint) in self.model.joints.list.iter().enumerate() {
            let Some(row) = joint.coordinate_row() else { continue };
            let pulls = match self.limits[index] {
                Limit::None => false,
                Limit::Lower => impulses[index][row] < 0.0,
                Limit::Upper => impulses[index][row] > 0.0,
            };
            let softness = &mut self.work.softness[index][row];
            if pulls && !softness.is_nan() {
                *softness = f64::NAN;
                has_released = true;
            }
        }
        has_released
    }

    /// Whether the coordinate of a joint was away from its limits at the beginning.
    fn was_away(&self, index: usize, row: usize) -> bool {
        let (joint, value) =
            (&self.model.joints.list[index], self.work.start_system.rows[index].rows[row].value);
        let size = 1.0 + joint.start_length + value.abs();
        // the same in every turn of a hinge
        let is_at = |limit: &f64| (joint.near(value, *limit) - limit).abs() <= ACCEPTED * size;
        !joint.limits.iter().filter(|limit| limit.is_finite()).any(is_at)
    }

    /// What limits that were met in this flight take (J): less the work of their impulses, at the mean of the rates before and after
    /// them, in `start_twists` and `twists`.
    fn limit_loss(&self, is_start: bool, impulses: &[RowValues]) -> f64 {
        let JointWork { start_system, system, start_twists, twists, .. } = &*self.work;
        let system = if is_start { start_system } else { system };
        let mut loss = 0.0;
        for (index, joint) in self.model.joints.list.iter().enumerate() {
            let Some(row) = joint.coordinate_row() else { continue };
            let acts = self.limits[index] != self.limits_before[index];
            if acts && self.was_away(index, row) {
                let rate = |twists: &[Twist]| system.rates(self.model, index, twists)[row];
                loss -= impulses[index][row] * 0.5 * (rate(start_twists) + rate(twists));
            }
        }
        loss
    }

    /// Stores coordinates and forces.
    fn store(&self, state: &mut State) {
        let per_time = 1.0 / self.time;
        for (index, joint) in self.model.joints.list.iter().enumerate() {
            let joint_state = &mut state.joints[index];
            joint_state.force = self.work.impulses[index].map(|impulse| impulse * per_time);
            if joint.has_coordinate() {
                let row = joint.coordinate_row().unwrap_or(0);
                let value = self.work.system.rows[index].rows[row].value;
                joint_state.coordinate = joint.near(value, joint_state.coordinate);
            }
        }
    }
}

/// Half way between two places.
fn middle(start: &BodyState, end: &BodyState) -> Place {
    let (a, b) = (start.orientation, end.orientation);
    let b = if a.dot(b) < 0.0 { -b } else { b };
    let sum: DQuat = a + b;
    Place {
        position: 0.5 * (start.position + end.position),
        compensation: glam::DVec3::ZERO,
        rotation: glam::DMat3::from_quat(sum.normalize()),
    }
}
