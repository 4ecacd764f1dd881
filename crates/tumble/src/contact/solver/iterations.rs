//! The iterations: projected Gauss–Seidel, colour by colour, forwards and backwards in turn.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

use super::bodies::{LaneInertia, LaneMotion, Velocities};
use super::joints::IteratedJoints;
use super::law::relative_velocity;
use super::normal_impulse::normal_impulse;
use super::rows::{Block, Pack, Row, Rows};
use crate::SolverSettings;
use crate::lanes::{Vec3x8, sum};
use crate::parallel::Rounds;

/// Fewer blocks for each thread take less time than waiting for each other.
const BLOCKS_PER_THREAD: usize = 8;

/// How the iterations ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outcome {
    pub iterations: u32,
    pub has_converged: bool,
}

/// Squares of the changes of the impulses in an iteration, and of the impulses (N²·s²).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    change: f64,
    total: f64,
}

impl Change {
    fn is_below(self, tolerance: f64) -> bool {
        self.change <= tolerance * tolerance * self.total
    }
}

/// Applies the impulses that the rows begin with, and iterates until they change by less than the tolerance.
/// Joints act after each iteration, on one thread.
pub(super) fn iterate(
    rows: &Rows,
    bodies: &[Velocities],
    settings: SolverSettings,
    joints: Option<&Mutex<IteratedJoints>>,
) -> Outcome {
    let blocks = rows.shared();
    let visit_joints = || joints.map_or(0.0, |joints| lock(joints).visit(bodies));
    if blocks.is_empty() {
        visit_joints();
        return Outcome { iterations: 1, has_converged: true };
    }
    let has_converged = |joint_change: f64| {
        let mut all = Change { change: joint_change, total: 0.0 };
        for block in blocks {
            let Change { change, total } = lock(block).change;
            all.change += change;
            all.total += total;
        }
        all.is_below(settings.tolerance)
    };
    // round 0 applies, and the others iterate
    let (iterations, converged) = (AtomicU32::new(0), AtomicBool::new(false));
    let work = |round, block: usize| {
        let block = &mut *lock(&blocks[block]);
        dispatch!(Level::new(), simd => simd.vectorize(
            #[inline(always)]
            || if round == 0 { apply(simd, block, bodies) } else { visit(simd, block, bodies, round % 2 == 1) }
        ));
    };
    let after = |round: usize| {
        let joint_change = visit_joints();
        if round == 0 {
            return false;
        }
        let is_done = has_converged(joint_change);
        iterations.store(round as u32, Ordering::Relaxed);
        converged.store(is_done, Ordering::Relaxed);
        is_done || round >= settings.max_iterations as usize
    };
    Rounds::new(&rows.starts, work, after).run(blocks.len() / BLOCKS_PER_THREAD);
    Outcome { iterations: iterations.into_inner(), has_converged: converged.into_inner() }
}

/// A block is free when its phase begins, or another thread has panicked and its results will not be used.
fn lock<T>(block: &Mutex<T>) -> MutexGuard<'_, T> {
    block.lock().unwrap_or_else(PoisonError::into_inner)
}

#[inline(always)]
fn apply<S: Simd>(simd: S, block: &Block, bodies: &[Velocities]) {
    for pack in &block.packs {
        apply_pack(simd, pack, &block.rows[pack.start as usize..pack.end as usize], bodies);
    }
}

/// Visits each contact.
#[inline(always)]
fn visit<S: Simd>(simd: S, block: &mut Block, bodies: &[Velocities], is_backward: bool) {
    let mut all = Change::default();
    let Block { packs, rows, .. } = block;
    for number in 0..packs.len() {
        let pack = &packs[place(number, packs.len(), is_backward)];
        let rows = &mut rows[pack.start as usize..pack.end as usize];
        let Change { change, total } = visit_pack(simd, pack, rows, bodies, is_backward);
        all.change += change;
        all.total += total;
    }
    block.change = all;
}

/// The place of the `number`-th of `count` in either direction.
#[inline(always)]
fn place(number: usize, count: usize, is_backward: bool) -> usize {
    if is_backward { count - 1 - number } else { number }
}

#[inline(always)]
fn apply_pack<S: Simd>(simd: S, pack: &Pack, rows: &[Row], bodies: &[Velocities]) {
    let mut pair = PackBodies::gather(simd, pack, bodies);
    for row in rows {
        let normal = f64x8::simd_from(simd, row.impulse);
        pair.push(simd, row, normal, Vec3x8::load(simd, &row.tangential_impulse));
    }
    pair.scatter(pack, bodies);
}

#[inline(always)]
fn visit_pack<S: Simd>(
    simd: S,
    pack: &Pack,
    rows: &mut [Row],
    bodies: &[Velocities],
    is_backward: bool,
) -> Change {
    let mut pair = PackBodies::gather(simd, pack, bodies);
    let zero = f64x8::splat(simd, 0.0);
    let (mut change, mut total) = (zero, zero);
    let count = rows.len();
    for number in 0..count {
        let row = &mut rows[place(number, count, is_backward)];
        let [normal_change, square, impulse] = pair.visit(simd, row);
        change = change + normal_change * normal_change + square;
        total += impulse * impulse;
    }
    // back again: the contacts of two bodies depend on each other most of all, and their bodies are at hand
    for number in 1..count {
        let _ = pair.visit(simd, &mut rows[place(number, count, !is_backward)]);
    }
    pair.scatter(pack, bodies);
    Change { change: sum(change), total: sum(total) }
}

/// The bodies of a pack.
struct PackBodies<S: Simd> {
    inertia: [LaneInertia<S>; 2],
    motion: [LaneMotion<S>; 2],
}

impl<S: Simd> PackBodies<S> {
    #[inline(always)]
    fn gather(simd: S, pack: &Pack, bodies: &[Velocities]) -> Self {
        Self {
            inertia: [
                LaneInertia::load(simd, &pack.inertia[0]),
                LaneInertia::load(simd, &pack.inertia[1]),
            ],
            motion: [
                LaneMotion::gather(simd, bodies, &pack.first),
                LaneMotion::gather(simd, bodies, &pack.second),
            ],
        }
    }

    #[inline(always)]
    fn scatter(&self, pack: &Pack, bodies: &[Velocities]) {
        self.motion[0].scatter(bodies, &pack.first);
        self.motion[1].scatter(bodies, &pack.second);
    }

    /// Applies an impulse to the first bodies and the opposite one to the second.
    #[inline(always)]
    fn push(&mut self, simd: S, row: &Row, normal: f64x8<S>, tangential: Vec3x8<S>) {
        let impulse = Vec3x8::load(simd, &row.normal) * normal + tangential;
        let torque = Vec3x8::load(simd, &row.levers[0]) * normal
            + Vec3x8::load(simd, &row.arms[0]).cross(tangential);
        self.motion[0].add(&self.inertia[0], impulse, torque);
        let torque = Vec3x8::load(simd, &row.levers[1]) * normal
            + Vec3x8::load(simd, &row.arms[1]).cross(tangential);
        self.motion[1].subtract(&self.inertia[1], impulse, torque);
    }

    /// Gives the contacts the impulses that the law asks for; returns the change of the normal impulses, the square of the change of the
    /// tangential ones, and the normal impulses.
    #[inline(always)]
    fn visit(&mut self, simd: S, row: &mut Row) -> [f64x8<S>; 3] {
        let load = |values| f64x8::simd_from(simd, values);
        let (u, slip) = relative_velocity(simd, row, &self.motion);
        let old = load(row.impulse);
        let mobility = load(row.normal_mobility);
        let by_law = normal_impulse(simd, row, u - mobility * old);
        let by_rebound = old + (load(row.rebound) - u) / mobility;
        let normal = by_law.simd_gt(by_rebound).select(by_law, by_rebound);
        row.impulse = normal.into();

        let old_tangential = Vec3x8::load(simd, &row.tangential_impulse);
        let (slope, mobility) = (load(row.tangential_slope), load(row.tangential_mobility));
        let wanted = (Vec3x8::load(simd, &row.tangential_offset) - slip * slope
            + old_tangential * (slope * mobility))
            * load(row.tangential_factor);
        let limit = load(row.friction) * normal;
        let size = wanted.dot(wanted);
        let slips = size.simd_gt(limit * limit);
        let factor = slips.select(limit / size.sqrt(), f64x8::splat(simd, 1.0));
        let tangential = wanted * factor;
        row.tangential_impulse = tangential.store();

        let (change, tangential_change) = (normal - old, tangential - old_tangential);
        self.push(simd, row, change, tangential_change);
        [change, tangential_change.dot(tangential_change), normal]
    }
}
