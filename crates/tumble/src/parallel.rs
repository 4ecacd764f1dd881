//! Work on all bodies at once, in chunks that do not depend on how many threads there are: whatever is summed is summed by
//! chunk, and the chunks in their order, so that the bits of the result are always the same.

use rayon::prelude::*;

/// Bodies in a chunk.
pub(crate) const CHUNK: usize = 64;

/// Runs `work` on a thread of the pool, from where handing parts of it round is cheap, if there is anything to hand round.
pub(crate) fn run<T: Send>(body_count: usize, work: impl FnOnce() -> T + Send) -> T {
    if body_count <= CHUNK || is_single_threaded() { work() } else { rayon::scope(|_| work()) }
}

/// Whether there is but one thread: what it does by itself need not be handed to it.
pub(crate) fn is_single_threaded() -> bool {
    rayon::current_num_threads() == 1
}

/// Calls `work` with the number of each chunk and the chunk, on as many threads as there are.
pub(crate) fn for_each<T: Send>(chunks: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    if chunks.len() < 2 || is_single_threaded() {
        chunks.iter_mut().enumerate().for_each(|(index, chunk)| work(index, chunk));
    } else {
        chunks.par_iter_mut().enumerate().for_each(|(index, chunk)| work(index, chunk));
    }
}

/// As [`for_each`], with a chunk of two kinds each time.
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
