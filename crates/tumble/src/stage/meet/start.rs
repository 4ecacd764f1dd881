//! Bodies that start in each other: found, named, and moved apart when asked.

use glam::DVec3;

use super::list::{self, Pair};
use super::{Meeting, crowd};
use crate::stage::Placed;
use crate::{ContactKind, Model, State};

/// Bodies that start deeper in each other than this part of their grain were put there by mistake.
pub(super) const DEEP: f64 = 0.1;
/// Bodies are moved apart until they are no deeper in each other than this part of their grain.
const APART: f64 = 1e-3;
/// Rounds of moving apart after which bodies have no room.
const ROUNDS: usize = 2000;

/// Two bodies that are in each other: the first, the second, and how deep (m).
pub(crate) type Overlap = (u32, u32, f64);

/// Pairs of bodies that are deeper in each other than a tenth of the radius of their spheres, or than a hundredth of the
/// size of a body without: the first hundred.
pub(crate) fn overlaps(model: &Model, state: &State) -> Vec<Overlap> {
    if !model.meets {
        return Vec::new();
    }
    let mut overlaps = crowd::at_one_place(model, state);
    // of a crowd nothing more need be known
    if overlaps.len() < crowd::MOST {
        overlaps.extend(crowd::around_a_centre(model, state));
        overlaps.extend(by_contact(model, state));
    }
    overlaps.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(b.2.total_cmp(&a.2)));
    overlaps.dedup_by_key(|overlap| (overlap.0, overlap.1));
    overlaps.truncate(crowd::MOST);
    overlaps
}

/// Those that contact finds.
fn by_contact(model: &Model, state: &State) -> Vec<Overlap> {
    let mut overlaps: Vec<Overlap> = Vec::new();
    Meeting::default().each_contact(model, state, |pair, _, depth| {
        if pair.kind == ContactKind::Wall || depth <= DEEP * grain(model, pair) {
            return;
        }
        match overlaps.last_mut() {
            Some(last) if (last.0, last.1) == (pair.first, pair.second) => {
                last.2 = last.2.max(depth)
            }
            _ => overlaps.push((pair.first, pair.second, depth)),
        }
    });
    overlaps
}

/// Moves bodies that are in each other or behind walls apart, the lighter ones farther, without turning them; returns whether
/// they came free.
///
/// Each round every body gives way to the mean of its contacts, like a Jacobi iteration of position-based dynamics (M. Müller
/// et al., J. Vis. Commun. Image R. 18 (2007) 109).
pub(crate) fn push_apart(model: &Model, state: &mut State) -> bool {
    let mut meeting = Meeting::default();
    // a crowd at one place has no way to go apart
    if crowd::at_one_place(model, state).len() >= crowd::MOST {
        return false;
    }
    let mut ways = vec![(DVec3::ZERO, 0.0); model.bodies.len()];
    for _ in 0..ROUNDS {
        ways.fill((DVec3::ZERO, 0.0));
        let mut is_free = true;
        meeting.each_contact(model, state, |pair, normal, depth| {
            let (a, b) = (pair.first as usize, pair.second as usize);
            let weight = |body: usize| model.bodies[body].pair_material.inverse_mass;
            let of_second = if pair.kind == ContactKind::Wall { 0.0 } else { weight(b) };
            let sum = weight(a) + of_second;
            is_free &= depth <= APART * grain(model, pair);
            give_way(&mut ways[a], normal * (depth * weight(a) / sum));
            if of_second > 0.0 {
                give_way(&mut ways[b], normal * (-depth * of_second / sum));
            }
        });
        for ((body, body_state), way) in model.bodies.iter().zip(&mut state.bodies).zip(&mut ways) {
            let at_walls = body.is_free() && !body.has_spheres();
            for wall in model.walls.iter().filter(|_| at_walls) {
                let depth = Placed::new(body, body_state).depth_behind(wall);
                if depth > 0.0 {
                    is_free &= depth <= APART * list::grain(body);
                    give_way(way, wall.normal * depth);
                }
            }
            if way.1 > 0.0 {
                body_state.position += way.0 / way.1;
            }
        }
        if is_free {
            return true;
        }
    }
    false
}

fn give_way(sum: &mut (DVec3, f64), way: DVec3) {
    *sum = (sum.0 + way, sum.1 + 1.0);
}

/// The smaller grain of the two bodies of a pair (m).
fn grain(model: &Model, pair: &Pair) -> f64 {
    let first = list::grain(&model.bodies[pair.first as usize]);
    if pair.kind == ContactKind::Wall {
        return first;
    }
    first.min(list::grain(&model.bodies[pair.second as usize]))
}
