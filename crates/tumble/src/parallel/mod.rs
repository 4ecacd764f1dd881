//! Parallel loops over chunks of bodies.
//!
//! Chunks do not depend on the number of threads. Sums are taken per chunk, and then over the chunks in order, so that
//! results are the same bit for bit.

mod rounds;

use std::cell::Cell;
use std::hint::spin_loop;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

pub(crate) use self::rounds::Rounds;

/// Bodies per chunk.
pub(crate) const CHUNK: usize = 64;
/// How often a thread looks for work before it offers the processor to others.
const SPINS: u32 = 2000;

thread_local! {
    /// Whether this thread is within [`run`].
    static RUNS: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work` on a thread of the pool, where forking is cheap, if there is more than one chunk and one thread.
///
/// Meanwhile other threads stay awake. A step forks several times, with a few microseconds between; to wake a thread takes more than that.
pub(crate) fn run<T: Send>(body_count: usize, work: impl FnOnce() -> T + Send) -> T {
    if body_count <= CHUNK || is_single_threaded() || RUNS.get() {
        return work();
    }
    let helpers = rayon::current_num_threads().min(body_count.div_ceil(CHUNK)) - 1;
    let done = AtomicBool::new(false);
    rayon::scope(|scope| {
        // dropped on a panic too, so that no thread waits for ever
        let _runs = Running::new(&done);
        for _ in 0..helpers {
            scope.spawn(|_| help_until(&done));
        }
        work()
    })
}

/// Marks the thread until dropped; then the work is done.
struct Running<'a>(&'a AtomicBool);

impl<'a> Running<'a> {
    fn new(done: &'a AtomicBool) -> Self {
        RUNS.set(true);
        Self(done)
    }
}

impl Drop for Running<'_> {
    fn drop(&mut self) {
        RUNS.set(false);
        self.0.store(true, Ordering::Release);
    }
}

/// Takes jobs of the pool until `done`. A thread that is itself within [`run`] returns at once: it must go on with that.
fn help_until(done: &AtomicBool) {
    let mut waits = 0;
    while !RUNS.get() && !done.load(Ordering::Acquire) {
        if rayon::yield_now() == Some(rayon::Yield::Executed) {
            waits = 0;
        } else {
            wait(&mut waits);
        }
    }
}

/// Waits for a moment: first without giving the processor away, since what is waited for mostly takes less time than that.
fn wait(waits: &mut u32) {
    *waits = waits.saturating_add(1);
    if *waits < SPINS { spin_loop() } else { std::thread::yield_now() }
}

/// Whether there is only one thread.
pub(crate) fn is_single_threaded() -> bool {
    rayon::current_num_threads() == 1
}

/// Calls `work` with the index and contents of each chunk, in parallel.
pub(crate) fn for_each<T: Send>(chunks: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    if chunks.len() < 2 || is_single_threaded() {
        chunks.iter_mut().enumerate().for_each(|(index, chunk)| work(index, chunk));
    } else {
        chunks.par_iter_mut().enumerate().for_each(|(index, chunk)| work(index, chunk));
    }
}

/// As [`for_each`], over two slices of chunks together.
pub(crate) fn for_each_zipped<T: Send, U: Send>(
    chunks: &mut [T],
    others: &mut [U],
    work: impl Fn(usize, &mut T, &mut U) + Sync,
) {
    if chunks.len() < 2 || is_single_threaded() {
        let both = chunks.iter_mut().zip(others).enumerate();
        both.for_each(|(index, (chunk, other))| work(index, chunk, other));
    } else {
        let both = chunks.par_iter_mut().zip(others).enumerate();
        both.for_each(|(index, (chunk, other))| work(index, chunk, other));
    }
}
