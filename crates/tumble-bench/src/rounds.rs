//! Things timed in turns, so that whatever else the machine does meets all of them.

use rustix::time::{ClockId, clock_gettime};
use std::time::Duration;

/// Rounds of each measurement.
const ROUNDS: usize = 9;
/// One turn takes about so long.
const TURN: Duration = Duration::from_millis(25);

/// Times some subjects in turns: seconds a step, median over the rounds. Each is called with a number of steps
/// to take.
pub fn side_by_side<const N: usize>(mut subjects: [&mut dyn FnMut(u64); N]) -> [f64; N] {
    let mut counts = [1; N];
    for (count, subject) in counts.iter_mut().zip(&mut subjects) {
        *count = steps_per_turn(subject);
    }
    let mut times = [const { Vec::new() }; N];
    for _ in 0..ROUNDS {
        for ((times, subject), &count) in times.iter_mut().zip(&mut subjects).zip(&counts) {
            times.push(timed(subject, count));
        }
    }
    times.map(median)
}

/// The middle of some numbers, NaN of none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// How many steps take about [`TURN`]; warms up on the way.
fn steps_per_turn(subject: &mut dyn FnMut(u64)) -> u64 {
    let mut steps = 1;
    loop {
        let seconds = timed(subject, steps) * steps as f64;
        if seconds > 0.25 * TURN.as_secs_f64() {
            return ((steps as f64 * TURN.as_secs_f64() / seconds) as u64).max(1);
        }
        steps *= 2;
    }
}

/// Seconds of the processor a step: what else the machine runs does not count.
fn timed(subject: &mut dyn FnMut(u64), steps: u64) -> f64 {
    let start = processor_time();
    subject(steps);
    (processor_time() - start) / steps as f64
}

/// What this thread has used of the processor so far (s).
fn processor_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}
