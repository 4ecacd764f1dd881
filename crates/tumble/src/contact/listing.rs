//! Contacts between bodies, and of spheres with walls, one by one. The step itself needs only their sums.

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::body_contacts::BodyContacts;
use super::chunk_contacts::ChunkContacts;
use super::contact_lanes::ContactLanes;
use super::gather;
use super::pair::{Pair, WALL_BODY};
use super::pair_forces::{PairForces, PairLosses, PairWrench};
use super::patch_damping::NO_PATCH;
use super::solver::Solver;
use crate::lanes::{LANES, vector};
use crate::parallel::CHUNK;
use crate::{BodyForces, Contact, ContactKind, ContactPartner, Model};

impl BodyContacts {
    /// Sets the velocities of the poses to those in the middle of a kick by the forces of the latest evaluation over the time `h` (s).
    /// `forces` are those of contact with walls.
    pub fn predict_velocities(&mut self, model: &Model, forces: &[BodyForces], h: f64) {
        let (poses, results) = self.poses_and_results();
        let chunks = poses.chunks_mut(CHUNK).zip(forces.chunks(CHUNK));
        for (chunk, (poses, forces)) in chunks.enumerate() {
            gather::predict_velocities(model, chunk * CHUNK, poses, forces, results, h);
        }
    }

    /// Appends the contacts of the latest evaluation, with the forces at the velocities that the poses have.
    pub fn list(&self, listed: &mut Vec<Contact>) {
        for chunk in 0..self.chunks().len() {
            let contacts = &self.chunks()[chunk];
            for lanes in &contacts.lanes[..contacts.lanes_used] {
                let wrenches = lanes.wrench_of_each(self);
                for lane in lanes.in_contact() {
                    let couple = vector(&lanes.couple, lane);
                    let (first, second) = (wrenches[lane].on_first(), wrenches[lane].on_second());
                    listed.push(Contact {
                        force: first.force,
                        torque: first.torque + couple,
                        other_torque: if_body(lanes, lane, second.torque - couple),
                        depth: lanes.depth[lane],
                        ..self.place((chunk, contacts), lanes, lane)
                    });
                }
            }
        }
    }

    /// Appends the contacts of the latest solution of their law in a kick of length `h` (s), with their mean forces in it.
    pub fn list_solved(&self, solver: &Solver, h: f64, listed: &mut Vec<Contact>) {
        for ([chunk, lanes, lane], normal, tangential) in solver.impulses() {
            let contacts = &self.chunks()[chunk];
            let lanes = &contacts.lanes[lanes];
            if normal == 0.0 && tangential == DVec3::ZERO && lanes.gap[lane] >= 0.0 {
                continue;
            }
            let place = self.place((chunk, contacts), lanes, lane);
            let force = (place.normal * normal + tangential) * (1.0 / h);
            let couple = vector(&lanes.couple, lane) * (normal / h);
            let [arm, other_arm] = [&lanes.arm, &lanes.other_arm].map(|arm| vector(arm, lane));
            listed.push(Contact {
                force,
                torque: arm.cross(force) + couple,
                other_torque: if_body(lanes, lane, -(other_arm.cross(force) + couple)),
                depth: (-lanes.gap[lane]).max(0.0),
                ..place
            });
        }
    }

    /// A contact without its force.
    fn place(
        &self,
        (chunk, contacts): (usize, &ChunkContacts),
        lanes: &ContactLanes,
        lane: usize,
    ) -> Contact {
        let pair = contacts.pairs[lanes.pair[lane] as usize].list_index as usize;
        let Pair { first, second, kind, .. } = self.neighbours(chunk).pairs[pair];
        let other = match kind {
            ContactKind::SphereWall => ContactPartner::Wall(second as usize),
            _ => ContactPartner::Body(second as usize),
        };
        Contact {
            body: first as usize,
            other,
            point: self.poses()[first as usize].position + vector(&lanes.arm, lane),
            normal: vector(&lanes.normal, lane),
            depth: 0.0,
            force: DVec3::ZERO,
            torque: DVec3::ZERO,
            other_torque: DVec3::ZERO,
        }
    }
}

/// The torque on the second body; none where that is a wall.
fn if_body(lanes: &ContactLanes, lane: usize, torque: DVec3) -> DVec3 {
    if lanes.second[lane] == WALL_BODY { DVec3::ZERO } else { torque }
}

impl ContactLanes {
    /// The wrench of each contact alone, without couples: the same evaluation as that of the step, with a pair for each lane.
    fn wrench_of_each(&self, contacts: &BodyContacts) -> [PairWrench; LANES] {
        let mut alone = self.clone();
        alone.pair = std::array::from_fn(|lane| lane as u32);
        let mut losses = [PairLosses::default(); LANES];
        let mut pairs: [PairForces; LANES] = std::array::from_fn(|lane| PairForces {
            list_index: 0,
            first: self.first[lane],
            patch: NO_PATCH,
            wrench: PairWrench::default(),
            couple: DVec3::ZERO,
        });
        dispatch!(Level::new(), simd => simd.vectorize(
            #[inline(always)]
            || alone.add_forces::<_, false>(simd, contacts.poses(), &mut pairs, &mut losses, 0.0)
        ));
        pairs.map(|pair| pair.wrench)
    }
}
