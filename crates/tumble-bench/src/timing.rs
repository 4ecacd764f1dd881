//! Timing of several candidates in turns, so that other load on the machine affects all of them alike.

use rustix::time::{ClockId, clock_gettime};
use std::time::Duration;

/// Number of rounds of each measurement.
const ROUNDS: usize = 9;
/// Approximate processor time of one turn.
const TURN: Duration = Duration::from_millis(25);

/// Times several candidates in turns; returns the processor time per step of each (s), the median over the rounds.
///
/// Each candidate is a function that takes the given number of steps.
pub fn time_in_turns<const N: usize>(mut candidates: [&mut dyn FnMut(u64); N]) -> [f64; N] {
    let mut counts = [1; N];
    for (count, candidate) in counts.iter_mut().zip(&mut candidates) {
        *count = steps_per_turn(candidate);
    }
    let mut times = [const { Vec::new() }; N];
    for _ in 0..ROUNDS {
        for ((times, candidate), &count) in times.iter_mut().zip(&mut candidates).zip(&counts) {
            times.push(time_per_step(candidate, count));
        }
    }
    times.map(median)
}

/// The median, the upper one of an even number of values; NaN if there are none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The number of steps that take about [`TURN`]. The trial steps also serve as warm-up.
fn steps_per_turn(candidate: &mut dyn FnMut(u64)) -> u64 {
    let mut steps = 1;
    loop {
        let seconds = time_per_step(candidate, steps) * steps as f64;
        if seconds > 0.25 * TURN.as_secs_f64() {
            return ((steps as f64 * TURN.as_secs_f64() / seconds) as u64).max(1);
        }
        steps *= 2;
    }
}

/// Processor time per step (s), which excludes time given to other processes.
fn time_per_step(candidate: &mut dyn FnMut(u64), steps: u64) -> f64 {
    let start = processor_time();
    candidate(steps);
    (processor_time() - start) / steps as f64
}

/// Processor time used by this thread so far (s).
fn processor_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}
