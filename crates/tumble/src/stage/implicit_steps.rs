//! How a long implicit step is divided.
//!
//! Two things divide it: bodies so fast that one could pass another, and contacts that depend on each other so much that the
//! iterations do not converge (tall stacks, large ratios of mass): shorter steps need fewer of them, and the part is repeated. Parts are
//! the step over a power of 2.
//! The state holds the exponent, so that a run that resumes takes the same steps.

use crate::contact::{Outcome, sphere_radius};
use crate::kinematics::Kinematics;
use crate::{Model, State, Surface};

/// The largest exponent.
pub(crate) const MOST_DIVISIONS: u32 = 6;
/// The exponent of the first step, which has no impulses to begin with.
pub(crate) const DIVISIONS_AT_START: u32 = 2;
/// What is added to the exponent where the iterations do not converge.
const AFTER_FAILURE: u32 = 2;
/// The exponent shrinks after a part with less than this share of the largest number of iterations.
const EASY: u32 = 8;

/// It shrinks at most once in so many steps, after as many at the start: bodies at rest between kicks of another distance have to come to
/// rest again.
const STEPS_BETWEEN: u64 = 32;

/// The parts of one step.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitSteps {
    /// Time at the start of the step (s).
    start: f64,
    /// The part of the step that is done, and the size of the present part, in units of the smallest part.
    done: u32,
    size: u32,
}

/// One part of a step.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitStep {
    /// Its length (s).
    pub length: f64,
    /// A bound on the speed of any point of a body that others touch, at its start (m/s).
    pub fastest: f64,
}

impl ImplicitSteps {
    /// The parts of the step that begins with `state`.
    pub fn new(state: &State) -> Self {
        Self { start: state.time, done: 0, size: 0 }
    }

    /// The next part; sets the time of the state to its start.
    pub fn next(&mut self, model: &Model, state: &mut State) -> Option<ImplicitStep> {
        let whole = 1 << MOST_DIVISIONS;
        if self.done == whole {
            return None;
        }
        let fastest = fastest(model, state);
        let divisions = state.step_divisions.max(divisions_for_speed(model, fastest));
        self.size = whole >> divisions.min(MOST_DIVISIONS);
        while !self.done.is_multiple_of(self.size) {
            self.size /= 2;
        }
        let part = |size: u32| model.dt * (f64::from(size) / f64::from(whole));
        state.time = self.start + part(self.done);
        Some(ImplicitStep { length: part(self.size), fastest })
    }

    /// Ends a part of length `h` (s), whose iterations ended with `outcome`; if they have not converged, the part
    /// begins anew from the state `before`, and is smaller. Returns whether it does.
    pub(crate) fn finish(
        &mut self,
        model: &Model,
        (state, before): (&mut State, &mut State),
        outcome: Option<Outcome>,
        h: f64,
    ) -> bool {
        let divisions = MOST_DIVISIONS - self.size.trailing_zeros();
        if outcome.is_some_and(|outcome| !outcome.has_converged) && divisions < MOST_DIVISIONS {
            let iterations = state.totals.iterations;
            std::mem::swap(state, before);
            state.totals.iterations = iterations;
            state.step_divisions = (divisions + AFTER_FAILURE).min(MOST_DIVISIONS);
            return true;
        }
        state.since_kick = 0.5 * h;
        self.done += self.size;
        let Some(Outcome { iterations, has_converged }) = outcome else { return false };
        if has_converged
            && iterations <= model.solver.max_iterations / EASY
            && self.done == self.size
            && (state.step.is_multiple_of(STEPS_BETWEEN) || state.step < STEPS_BETWEEN)
        {
            state.step_divisions = state.step_divisions.saturating_sub(1);
        }
        false
    }
}

/// The exponent for which no body moves farther in a part than the smallest radius of a sphere, or a quarter of the smallest thickness
/// of a mesh.
fn divisions_for_speed(model: &Model, fastest: f64) -> u32 {
    let reaches = model.bodies.iter().filter(|body| body.surface != Surface::None);
    let reaches = reaches.map(|body| match &body.signed_distance {
        Some(distance) => 0.25 * distance.thickness(),
        None => sphere_radius(body),
    });
    let reach = reaches.filter(|&reach| reach > 0.0).fold(f64::INFINITY, f64::min);
    if reach == f64::INFINITY {
        return 0;
    }
    let path = model.dt * (fastest + model.gravity.length() * model.dt);
    (0..MOST_DIVISIONS).find(|&n| path <= reach * f64::from(1u32 << n)).unwrap_or(MOST_DIVISIONS)
}

/// A bound on the speed (m/s) of any point of a body that others touch.
fn fastest(model: &Model, state: &State) -> f64 {
    let bodies = model.bodies.iter().zip(&state.bodies);
    let speeds = bodies.filter(|(body, _)| body.surface != Surface::None).map(|(body, state)| {
        let omega = Kinematics::new(body, state).angular_velocity;
        state.velocity.length() + omega.length() * body.extent
    });
    speeds.fold(0.0, f64::max)
}
