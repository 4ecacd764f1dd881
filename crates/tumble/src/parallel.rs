//! Work on all bodies at once, in chunks that do not depend on how many threads there are: whatever is summed is summed by
//! chunk, and the chunks in their order, so that the bits of the result are always the same.

use rayon::prelude::*;

/// Bodies in a chunk.
pub(crate) const CHUNK: usize = 64;

/// Calls `work` with the number of each chunk and the chunk, on as many threads as there are.
pub(crate) fn each<T: Send>(chunks: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    // what one thread does best alone is not handed round
    if chunks.len() < 2 {
        chunks.iter_mut().enumerate().for_each(|(index, chunk)| work(index, chunk));
    } else {
        chunks.par_iter_mut().enumerate().for_each(|(index, chunk)| work(index, chunk));
    }
}

/// As [`each`], with a chunk of two kinds each time.
pub(crate) fn each_of_two<T: Send, U: Send>(
    chunks: &mut [T],
    others: &mut [U],
    work: impl Fn(usize, &mut T, &mut U) + Sync,
) {
    if chunks.len() < 2 {
        let both = chunks.iter_mut().zip(others).enumerate();
        both.for_each(|(index, (chunk, other))| work(index, chunk, other));
    } else {
        let both = chunks.par_iter_mut().zip(others).enumerate();
        both.for_each(|(index, (chunk, other))| work(index, chunk, other));
    }
}

/// Calls `work` with the index of the first body of each chunk and the chunk of `items`, one of which belongs to each body.
pub(crate) fn each_body<T: Send>(items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    if items.len() <= CHUNK {
        work(0, items);
    } else {
        let chunks = items.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(index, chunk)| work(index * CHUNK, chunk));
    }
}
