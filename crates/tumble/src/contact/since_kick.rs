//! The time since the latest kick, over which friction springs turn and stretch.

use fearless_simd::{Simd, f64x8, prelude::*};

use crate::{BodyState, Integrator, Model, State};

/// A kick by wall contacts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kick<'a> {
    /// The time over which it acts (s).
    pub length: f64,
    /// The flight before it.
    pub since_last: &'a SinceKick,
    /// The body at the beginning of the step, if joints act on it.
    pub start: Option<&'a BodyState>,
}

/// The flight of all bodies since the latest kick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SinceKick {
    /// The time now (s).
    pub time: f64,
    /// How long the flight took (s).
    pub duration: f64,
    /// The length of the step that the kick is in the middle of, or after (s).
    pub step: f64,
    /// How far a kick may move a body within the rest of the step (m): known to implicit steps, which need the contacts that it may close.
    pub reach: f64,
    /// How long a contact may have lasted that was not there at the latest kick (s).
    new_contact_limit: f64,
    /// Whether the flight began with the run: a contact may be older than it, and no kick comes before it.
    pub is_first: bool,
}

impl SinceKick {
    /// At the kick of an implicit step of length `h` (s), where no body is faster than `fastest` (m/s). Such steps may differ in length, so
    /// the state knows the time since the latest kick.
    pub fn at_implicit_kick(state: &State, h: f64, fastest: f64) -> Self {
        let is_first = state.time == 0.0;
        let duration = if is_first { 0.5 * h } else { state.since_kick + 0.5 * h };
        let time = state.time + 0.5 * h;
        // a kick may pass on the velocity of another body
        let reach = 0.5 * h * fastest;
        Self { time, duration, step: h, reach, new_contact_limit: duration, is_first }
    }

    /// At the kick of the step that begins at `start` (s).
    pub fn at_kick(model: &Model, start: f64) -> Self {
        let (h, is_first) = (model.dt, start == 0.0);
        match model.integrator {
            Integrator::Splitting | Integrator::Implicit => {
                let duration = if is_first { 0.5 * h } else { h };
                let time = start + 0.5 * h;
                Self { time, duration, step: h, reach: 0.0, new_contact_limit: duration, is_first }
            }
            Integrator::Euler => Self {
                time: start,
                duration: h,
                step: h,
                reach: 0.0,
                new_contact_limit: 0.0,
                is_first,
            },
        }
    }

    /// At the end of a step.
    pub fn at_end_of_step(model: &Model, state: &State) -> Self {
        let (h, time) = (model.dt, state.time);
        let is_first = time == 0.0;
        match model.integrator {
            Integrator::Splitting | Integrator::Implicit => {
                let is_implicit = model.integrator == Integrator::Implicit;
                let since_kick = if is_implicit { state.since_kick } else { 0.5 * h };
                let duration = if is_first { 0.0 } else { since_kick };
                Self {
                    time,
                    duration,
                    step: h,
                    reach: 0.0,
                    new_contact_limit: duration,
                    is_first: false,
                }
            }
            Integrator::Euler => {
                Self { time, duration: h, step: h, reach: 0.0, new_contact_limit: 0.0, is_first }
            }
        }
    }

    /// At a kick at `time` (s), at most `duration` (s) after the latest one.
    pub fn at_sub_step(time: f64, duration: f64) -> Self {
        let is_first = duration >= time;
        let duration = duration.min(time);
        Self { time, duration, step: duration, reach: 0.0, new_contact_limit: duration, is_first }
    }

    /// No time at all.
    pub fn none(time: f64) -> Self {
        Self { time, duration: 0.0, step: 0.0, reach: 0.0, new_contact_limit: 0.0, is_first: false }
    }

    /// How long a contact without a spring has lasted (s): the time to get to its `depth` (m) at the speed `closing` (m/s), at
    /// which its bodies approach.
    pub fn new_contact_duration(&self, depth: f64, closing: f64) -> f64 {
        if closing > 0.0 {
            (depth / closing).min(self.new_contact_limit)
        } else {
            self.duration_without_approach()
        }
    }

    /// The same for eight contacts.
    #[inline(always)]
    pub fn new_contact_durations<S: Simd>(
        &self,
        simd: S,
        depth: f64x8<S>,
        closing: f64x8<S>,
    ) -> f64x8<S> {
        let limit = f64x8::splat(simd, self.new_contact_limit);
        let duration = depth / closing;
        let duration = duration.simd_lt(limit).select(duration, limit);
        let without = f64x8::splat(simd, self.duration_without_approach());
        closing.simd_gt(f64x8::splat(simd, 0.0)).select(duration, without)
    }

    /// A contact whose bodies do not approach began before the flight, if it is not one that another surface took over.
    fn duration_without_approach(&self) -> f64 {
        if self.is_first { self.new_contact_limit } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::lanes::LANES;

    #[test]
    fn a_new_contact_has_lasted_since_its_bodies_touched() {
        let later = SinceKick::at_sub_step(1.0, 0.1);
        let first = SinceKick::at_sub_step(0.05, 0.1);
        for (since_kick, depth, closing, expected) in [
            (&later, 0.02, 0.5, 0.04),
            (&later, 0.2, 0.5, 0.1),
            (&later, 0.02, -0.5, 0.0),
            // a contact that does not close may be there from the start of the run
            (&first, 0.2, 0.5, 0.05),
            (&first, 0.02, -0.5, 0.05),
            (&first, 0.02, 0.0, 0.05),
            (&SinceKick::none(1.0), 0.02, 0.5, 0.0),
        ] {
            assert_eq!(since_kick.new_contact_duration(depth, closing), expected);
            let lanes: [f64; LANES] = dispatch!(Level::new(), simd => {
                let splat = |value| f64x8::splat(simd, value);
                since_kick.new_contact_durations(simd, splat(depth), splat(closing)).into()
            });
            assert_eq!(lanes, [expected; LANES]);
        }
    }
}
