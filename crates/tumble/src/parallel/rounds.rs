//! Rounds of jobs whose phases follow each other faster than forks and joins would.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::{is_single_threaded, wait};

/// Rounds of the same jobs, which are numbered from 0. A phase is a range of jobs that may run side by side. Even rounds go through the phases
/// in order, odd ones in the opposite order; each phase begins when the one before it has ended.
pub(crate) struct Rounds<'a, Work, After> {
    /// Where the phases begin, and the end.
    starts: &'a [u32],
    /// Called with the round and the job.
    work: Work,
    /// Called by one thread after each round; returns whether it was the last.
    after: After,
    /// The next job to be taken, and the number of those that are done, counted through all rounds. `after` is the last job of a round.
    next: AtomicUsize,
    done: AtomicUsize,
    stopped: AtomicBool,
}

/// Stops the other threads where this one panics, so that none waits for it.
struct StopOnPanic<'a>(&'a AtomicBool);

impl Drop for StopOnPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.store(true, Ordering::Release);
        }
    }
}

impl<'a, Work, After> Rounds<'a, Work, After>
where
    Work: Fn(usize, usize) + Sync,
    After: Fn(usize) -> bool + Sync,
{
    pub fn new(starts: &'a [u32], work: Work, after: After) -> Self {
        let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Self { starts, work, after, next, done, stopped: AtomicBool::new(false) }
    }

    /// Runs the rounds on `threads` threads at most. The results are the same for any number of them if the jobs of a phase do not depend
    /// on each other.
    pub fn run(&self, threads: usize) {
        if threads < 2 || is_single_threaded() {
            return self.take_jobs();
        }
        rayon::scope(|scope| {
            for _ in 1..threads.min(rayon::current_num_threads()) {
                scope.spawn(|_| self.take_jobs());
            }
            self.take_jobs();
        });
    }

    /// Takes jobs in order until the last round is over. A job waits only for jobs before it, each of which some thread has taken. So any number
    /// of threads comes to the end, and a thread that comes late is not missed.
    fn take_jobs(&self) {
        let _guard = StopOnPanic(&self.stopped);
        let count = self.starts.last().map_or(0, |&end| end as usize);
        loop {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let (round, place) = (number / (count + 1), number % (count + 1));
            let first = round * (count + 1);
            if place == count {
                if !self.wait_for(first + count) {
                    return;
                }
                if (self.after)(round) {
                    self.stopped.store(true, Ordering::Release);
                }
            } else {
                let is_backward = round % 2 == 1;
                let job = if is_backward { count - 1 - place } else { place };
                let phase = self.phase(job);
                let before = if is_backward { count - phase.end } else { phase.start };
                if !self.wait_for(first + before) {
                    return;
                }
                (self.work)(round, job);
            }
            self.done.fetch_add(1, Ordering::Release);
        }
    }

    fn phase(&self, job: usize) -> Range<usize> {
        let next = self.starts.partition_point(|&start| start as usize <= job);
        self.starts[next - 1] as usize..self.starts[next] as usize
    }

    /// Waits until so many jobs are done; returns false if the rounds have ended before.
    fn wait_for(&self, count: usize) -> bool {
        let mut waits = 0;
        loop {
            if self.stopped.load(Ordering::Acquire) {
                return false;
            }
            if self.done.load(Ordering::Acquire) >= count {
                // the end may have come together with the last of them
                return !self.stopped.load(Ordering::Acquire);
            }
            wait(&mut waits);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;
    use std::sync::atomic::AtomicU64;

    use super::*;

    /// Each job mixes the values of the phase before it.
    fn result(threads: usize) -> (Vec<u64>, usize) {
        let starts = [0, 3, 3, 10, 11, 30];
        let values: Vec<AtomicU64> = (0..30).map(AtomicU64::new).collect();
        let last = Mutex::new(0);
        let sum = |range: Range<usize>| {
            values[range]
                .iter()
                .map(|value| value.load(Ordering::Relaxed))
                .fold(0, u64::wrapping_add)
        };
        let work = |round: usize, job: usize| {
            let all = [0..3, 3..10, 10..11, 11..30];
            let own = all.iter().position(|range| range.contains(&job)).unwrap();
            let other = if round.is_multiple_of(2) { own.checked_sub(1) } else { Some(own + 1) };
            let input =
                other.and_then(|other| all.get(other)).map_or(1, |range| sum(range.clone()));
            let own = values[job].load(Ordering::Relaxed);
            values[job].store(own.wrapping_mul(31).wrapping_add(input), Ordering::Relaxed);
        };
        let after = |round| {
            *last.lock().unwrap() = round;
            round == 200
        };
        let rounds = Rounds::new(&starts, work, after);
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
            .install(|| rounds.run(threads));
        (values.into_iter().map(AtomicU64::into_inner).collect(), last.into_inner().unwrap())
    }

    #[test]
    fn any_number_of_threads_has_the_same_result() {
        let alone = result(1);
        assert_eq!(alone.1, 200);
        for threads in [2, 3, 8] {
            assert_eq!(result(threads), alone);
        }
    }

    #[test]
    fn rounds_without_jobs_end() {
        Rounds::new(&[0], |_, _| unreachable!(), |round| round == 3).run(2);
    }

    #[test]
    #[should_panic(expected = "a job fails")]
    fn a_job_that_panics_stops_all_threads() {
        let work = |_, job| assert_ne!(job, 5, "a job fails");
        let rounds = Rounds::new(&[0, 4, 8], work, |_| false);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        pool.install(|| rounds.run(3));
    }
}
