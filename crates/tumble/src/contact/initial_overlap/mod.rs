//! Bodies that overlap at the start: found, named, and moved apart on request.

mod coincident;
mod overlap;

use glam::DVec3;

use self::overlap::{MAX_INTENDED_DEPTH, MAX_NAMED, Overlap};
use super::body_contacts::BodyContacts;
use super::pair::{Pair, feature_size};
use super::wall;
use crate::kinematics::Kinematics;
use crate::{ContactKind, Model, State};

/// Bodies are moved apart until their depth is below this part of their feature size.
const SEPARATED_DEPTH: f64 = 1e-3;
/// After this number of iterations the separation fails.
const MAX_ITERATIONS: usize = 2000;

/// Pairs of bodies that overlap by more than a tenth of the radius of their spheres, or a hundredth of the size of a body
/// without spheres: the first hundred.
pub(crate) fn overlaps(model: &Model, state: &State) -> Vec<Overlap> {
    if !model.has_body_contact {
        return Vec::new();
    }
    let mut overlaps = coincident::coincident_bodies(model, state);
    if overlaps.len() < MAX_NAMED {
        overlaps.extend(coincident::containing_centres(model, state));
        overlaps.extend(overlaps_by_contact(model, state));
    }
    overlaps.retain(|overlap| !model.joints.keeps_apart(overlap.first, overlap.second));
    overlaps.sort_by(|a, b| {
        (a.first, a.second).cmp(&(b.first, b.second)).then(b.depth.total_cmp(&a.depth))
    });
    overlaps.dedup_by_key(|overlap| (overlap.first, overlap.second));
    overlaps.truncate(MAX_NAMED);
    overlaps
}

/// The overlaps that contact finds.
fn overlaps_by_contact(model: &Model, state: &State) -> Vec<Overlap> {
    let mut overlaps: Vec<Overlap> = Vec::new();
    BodyContacts::default().for_each_contact(model, state, |pair, _, depth| {
        if pair.kind == ContactKind::SphereWall
            || depth <= MAX_INTENDED_DEPTH * min_feature_size(model, pair)
        {
            return;
        }
        match overlaps.last_mut() {
            Some(last) if (last.first, last.second) == (pair.first, pair.second) => {
                last.depth = last.depth.max(depth)
            }
            _ => overlaps.push(Overlap { first: pair.first, second: pair.second, depth }),
        }
    });
    overlaps
}

/// Moves apart bodies that overlap each other or walls, lighter ones farther, without rotating them. Returns whether all
/// overlaps were resolved.
///
/// In each iteration a body moves by the mean of the corrections of its contacts: a Jacobi iteration of position-based dynamics
/// (M. Müller et al., J. Vis. Commun. Image R. 18 (2007) 109).
pub(crate) fn separate(model: &Model, state: &mut State) -> bool {
    let mut contacts = BodyContacts::default();
    // bodies that coincide have no direction to separate along
    if coincident::coincident_bodies(model, state).len() >= MAX_NAMED {
        return false;
    }
    let mut corrections = vec![Corrections::default(); model.bodies.len()];
    for _ in 0..MAX_ITERATIONS {
        corrections.fill(Corrections::default());
        let mut is_separated = true;
        contacts.for_each_contact(model, state, |pair, normal, depth| {
            let (a, b) = (pair.first as usize, pair.second as usize);
            let inverse_mass = |body: usize| model.bodies[body].pair_material.inverse_mass;
            let of_second =
                if pair.kind == ContactKind::SphereWall { 0.0 } else { inverse_mass(b) };
            let sum = inverse_mass(a) + of_second;
            is_separated &= depth <= SEPARATED_DEPTH * min_feature_size(model, pair);
            corrections[a].add(normal * (depth * inverse_mass(a) / sum));
            if of_second > 0.0 {
                corrections[b].add(normal * (-depth * of_second / sum));
            }
        });
        let bodies = model.bodies.iter().zip(&mut state.bodies);
        for ((body, body_state), correction) in bodies.zip(&mut corrections) {
            let has_wall_particles = body.is_free() && !body.has_spheres();
            for wall in model.walls.iter().filter(|_| has_wall_particles) {
                let depth = wall::depth_behind(&Kinematics::new(body, body_state), wall);
                if depth > 0.0 {
                    is_separated &= depth <= SEPARATED_DEPTH * feature_size(body);
                    correction.add(wall.normal * depth);
                }
            }
            if correction.count > 0.0 {
                body_state.position += correction.sum / correction.count;
            }
        }
        if is_separated {
            return true;
        }
    }
    false
}

/// The displacements that the contacts of one body ask for.
#[derive(Clone, Copy, Default)]
struct Corrections {
    sum: DVec3,
    count: f64,
}

impl Corrections {
    fn add(&mut self, displacement: DVec3) {
        self.sum += displacement;
        self.count += 1.0;
    }
}

/// The smaller feature size of the two bodies of a pair (m).
fn min_feature_size(model: &Model, pair: &Pair) -> f64 {
    let first = feature_size(&model.bodies[pair.first as usize]);
    if pair.kind == ContactKind::SphereWall {
        return first;
    }
    first.min(feature_size(&model.bodies[pair.second as usize]))
}
