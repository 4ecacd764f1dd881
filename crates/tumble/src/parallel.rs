//! Parallel loops over chunks of bodies.
//!
//! Chunks do not depend on the number of threads. Sums are taken per chunk, and then over the chunks in order, so that
//! results are the same bit for bit.

use rayon::prelude::*;

/// Bodies per chunk.
pub(crate) const CHUNK: usize = 64;

/// Runs `work` on a thread of the pool, where forking is cheap, if there is more than one chunk and one thread.
pub(crate) fn run<T: Send>(body_count: usize, work: impl FnOnce() -> T + Send) -> T {
    if body_count <= CHUNK || is_single_threaded() { work() } else { rayon::scope(|_| work()) }
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
