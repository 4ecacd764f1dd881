//! Narrow phase: which of the listed points touch. One file per kind of pair.
//!
//! Points that may touch are collected in the order of the lists and put into lanes of eight ([`lane_filler`]), whatever the
//! kinds of their pairs. Full lanes go through geometry and friction at once, and through forces as soon as all contacts of their
//! patches are known ([`patch_damping`](super::patch_damping)), while their data is in the cache. Forces are added contact by contact in the order of the lists, so the lanes do not change any result.

mod exits;
mod lane_filler;
mod opposing_planes;
mod pair_poses;
mod point_mesh;
mod point_view;
mod segment;
mod sphere_sphere;
mod sphere_wall;
mod surface_point;

use fearless_simd::Simd;

use self::lane_filler::LaneFiller;
use self::pair_poses::PairPoses;
use self::point_mesh::Neighbours;
use super::chunk_contacts::{Candidate, ChunkContacts};
use super::context::ContactContext;
use super::friction_history::FrictionHistory;
use super::neighbour_list::ChunkNeighbours;
use super::pair::{ListedContact, Pair};
use crate::ContactKind;

/// Finds the contacts of the chunk whose first body is `first_body`, and computes their forces. With `PREDICT` the forces serve
/// only to predict velocities: losses and springs are left out.
#[inline(always)]
pub(super) fn detect<S: Simd, const PREDICT: bool>(
    simd: S,
    contacts: &mut ChunkContacts,
    neighbours: &mut ChunkNeighbours,
    context: &ContactContext,
    first_body: usize,
) {
    contacts.clear(neighbours.pairs.len());
    let released = std::mem::take(&mut contacts.released);
    let history = FrictionHistory::new(context, first_body, released);
    let mut filler = LaneFiller::new(contacts, context, history);
    let ChunkNeighbours { pairs, points, mesh_cache, .. } = neighbours;
    for index in 0..pairs.len() {
        let pair = &pairs[index];
        let poses = PairPoses::new(context, pair);
        if poses.path + poses.reach < pair.clear_until
            && poses.step_displacement <= pair.tunnelling_limit
        {
            continue;
        }
        if pair.is_point_mesh() {
            // friction springs are matched in the order of pairs, so earlier candidates are examined first
            examine_candidates::<S, PREDICT>(simd, &mut filler, pairs, points);
            let neighbours = Neighbours { pairs, points, mesh_cache };
            let clear_until =
                point_mesh::detect::<S, PREDICT>(simd, &mut filler, &poses, index, neighbours);
            pairs[index].clear_until = clear_until;
            continue;
        }
        let contact_pair = filler.begin_pair::<PREDICT>(index, pair);
        let candidates = &mut filler.contacts.candidates;
        pairs[index].clear_until = add_candidates(candidates, contact_pair, pair, &poses, points);
    }
    examine_candidates::<S, PREDICT>(simd, &mut filler, pairs, points);
    filler.flush::<S, PREDICT>(simd, pairs, points);
    if !context.is_solved {
        filler.evaluate::<S, PREDICT>(simd, pairs, true);
    }
    filler.history.release_all();
    let released = filler.history.released;
    contacts.released = released;
    if !PREDICT {
        contacts.find_deep_contacts(pairs);
    }
}

/// Adds the points of a pair of spheres, or of spheres and a wall, that may touch; returns the smallest path length at
/// which one of the others could touch (m). There is no branch for each point, since it could not be predicted.
#[inline(always)]
fn add_candidates(
    candidates: &mut Vec<Candidate>,
    contact_pair: u32,
    pair: &Pair,
    poses: &PairPoses,
    points: &[ListedContact],
) -> f64 {
    let mut count = candidates.len();
    let range = pair.start as usize..pair.end as usize;
    candidates.resize(count + range.len(), Candidate::default());
    let mut clear_until = f64::INFINITY;
    for (index, point) in (pair.start..).zip(&points[range]) {
        let is_clear = poses.path + poses.reach < point.clear_until
            && !poses.may_tunnel(pair, poses.path, point.clear_until);
        candidates[count] = Candidate { pair: contact_pair, point: index };
        count += usize::from(!is_clear);
        clear_until = clear_until.min(if is_clear { point.clear_until } else { f64::INFINITY });
    }
    candidates.truncate(count);
    clear_until
}

/// Puts all candidates into lanes.
#[inline(always)]
fn examine_candidates<S: Simd, const PREDICT: bool>(
    simd: S,
    filler: &mut LaneFiller,
    pairs: &mut [Pair],
    points: &mut [ListedContact],
) {
    let mut candidates = std::mem::take(&mut filler.contacts.candidates);
    for &candidate in &candidates {
        let index = filler.contacts.pairs[candidate.pair as usize].list_index as usize;
        let (pair, point) = (&pairs[index], &points[candidate.point as usize]);
        let poses = PairPoses::new(filler.context, pair);
        let geometry = if pair.kind == ContactKind::SphereWall {
            sphere_wall::geometry(&poses, pair, point)
        } else {
            sphere_sphere::geometry(&poses, pair, point)
        };
        if filler.push(&poses, pair, candidate, geometry, point) {
            filler.flush::<S, PREDICT>(simd, pairs, points);
        }
    }
    candidates.clear();
    filler.contacts.candidates = candidates;
}
