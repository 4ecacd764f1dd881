//! Work on all bodies at once, in chunks that do not depend on how many threads there are: whatever is summed is summed by
//! chunk, and the chunks in their order, so that the bits of the result are always the same.

use rayon::prelude::*;

use crate::{BodyState, Tally};

/// Bodies in a chunk.
pub(crate) const CHUNK: usize = 64;

/// Runs `work` on a thread of the pool, from where handing parts of it round is cheap, if there is anything to hand round.
pub(crate) fn run<T: Send>(body_count: usize, work: impl FnOnce() -> T + Send) -> T {
    if body_count <= CHUNK || is_alone() { work() } else { rayon::scope(|_| work()) }
}

/// Whether there is but one thread: what it does by itself need not be handed to it.
fn is_alone() -> bool {
    rayon::current_num_threads() == 1
}

/// Calls `work` with the number of each chunk and the chunk, on as many threads as there are.
pub(crate) fn each<T: Send>(chunks: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    if chunks.len() < 2 || is_alone() {
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
    if chunks.len() < 2 || is_alone() {
        let both = chunks.iter_mut().zip(others).enumerate();
        both.for_each(|(index, (chunk, other))| work(index, chunk, other));
    } else {
        let both = chunks.par_iter_mut().zip(others).enumerate();
        both.for_each(|(index, (chunk, other))| work(index, chunk, other));
    }
}

/// Calls `work` with the index of the first body of each chunk, the chunk of two kinds of items, one of which belongs to
/// each body, and the room of the chunk.
pub(crate) fn each_body_of_two<T: Send, U: Send, R: Send>(
    items: &mut [T],
    others: &mut [U],
    rooms: &mut [R],
    work: impl Fn(usize, &mut [T], &mut [U], &mut R) + Sync,
) {
    if rooms.len() < 2 || is_alone() {
        let both = items.chunks_mut(CHUNK).zip(others.chunks_mut(CHUNK)).zip(rooms);
        both.enumerate().for_each(|(index, ((items, others), room))| {
            work(index * CHUNK, items, others, room);
        });
    } else {
        let both = items.par_chunks_mut(CHUNK).zip(others.par_chunks_mut(CHUNK)).zip(rooms);
        both.enumerate().for_each(|(index, ((items, others), room))| {
            work(index * CHUNK, items, others, room);
        });
    }
}

/// What `look` finds at the first body at which it finds anything.
pub(crate) fn first_body<T: Send>(
    body_count: usize,
    look: impl Fn(usize) -> Option<T> + Sync,
) -> Option<T> {
    if body_count <= CHUNK || is_alone() {
        return (0..body_count).find_map(look);
    }
    let chunks = (0..body_count.div_ceil(CHUNK)).into_par_iter();
    chunks.find_map_first(|index| {
        let first = index * CHUNK;
        (first..body_count.min(first + CHUNK)).find_map(&look)
    })
}

/// Calls `work` with every body and its index, and adds up what it returns. `sums` is room for the sums of chunks.
pub(crate) fn tally_bodies(
    tally: &mut Tally,
    bodies: &mut [BodyState],
    sums: &mut Vec<Tally>,
    work: impl Fn(usize, &mut BodyState) -> Tally + Sync,
) {
    let each = |tally: &mut Tally, first: usize, bodies: &mut [BodyState]| {
        for (index, body) in (first..).zip(bodies) {
            *tally += work(index, body);
        }
    };
    if bodies.len() <= CHUNK {
        return each(tally, 0, bodies);
    }
    let of_chunk = |(index, chunk): (usize, &mut [BodyState])| {
        let mut sum = Tally::default();
        each(&mut sum, index * CHUNK, chunk);
        sum
    };
    if is_alone() {
        return bodies.chunks_mut(CHUNK).enumerate().map(of_chunk).for_each(|sum| *tally += sum);
    }
    bodies.par_chunks_mut(CHUNK).enumerate().map(of_chunk).collect_into_vec(sums);
    sums.iter().for_each(|&sum| *tally += sum);
}

/// Calls `work` with the index of the first body of each chunk and the chunk of `items`, one of which belongs to each body.
pub(crate) fn each_body<T: Send>(items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    if items.len() <= CHUNK || is_alone() {
        items.chunks_mut(CHUNK).enumerate().for_each(|(i, chunk)| work(i * CHUNK, chunk));
    } else {
        let chunks = items.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(index, chunk)| work(index * CHUNK, chunk));
    }
}
