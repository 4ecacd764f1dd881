//! The time since the latest kick, over which friction springs turn and stretch.

use fearless_simd::{Simd, f64x8, prelude::*};

use crate::{Integrator, Model};

/// The flight of all bodies since the latest kick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SinceKick {
    /// The time now (s).
    pub time: f64,
    /// How long the flight took (s).
    pub duration: f64,
    /// How long a contact may have lasted that was not there at the latest kick (s).
    new_contact_limit: f64,
    /// Whether the flight began with the run: a contact may be older than it.
    is_first: bool,
}

impl SinceKick {
    /// At the kick of the step that begins at `start` (s).
    pub fn at_kick(model: &Model, start: f64) -> Self {
        let (h, is_first) = (model.dt, start == 0.0);
        match model.integrator {
            Integrator::Splitting => {
                let duration = if is_first { 0.5 * h } else { h };
                let time = start + 0.5 * h;
                Self { time, duration, new_contact_limit: duration, is_first }
            }
            Integrator::Euler => {
                Self { time: start, duration: h, new_contact_limit: 0.0, is_first }
            }
        }
    }

    /// At the end of a step, at `time` (s).
    pub fn at_end_of_step(model: &Model, time: f64) -> Self {
        let (h, is_first) = (model.dt, time == 0.0);
        match model.integrator {
            Integrator::Splitting => {
                let duration = if is_first { 0.0 } else { 0.5 * h };
                Self { time, duration, new_contact_limit: duration, is_first: false }
            }
            Integrator::Euler => Self { time, duration: h, new_contact_limit: 0.0, is_first },
        }
    }

    /// At a kick at `time` (s), at most `duration` (s) after the latest one.
    pub fn at_sub_step(time: f64, duration: f64) -> Self {
        let is_first = duration >= time;
        let duration = duration.min(time);
        Self { time, duration, new_contact_limit: duration, is_first }
    }

    /// No time at all.
    pub fn none(time: f64) -> Self {
        Self { time, duration: 0.0, new_contact_limit: 0.0, is_first: false }
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
