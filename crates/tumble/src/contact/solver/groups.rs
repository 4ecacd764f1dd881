//! The contacts within reach, in groups: those between two bodies, or of a body and a wall.

use super::super::chunk_contacts::ChunkContacts;
use super::super::neighbour_list::NeighbourLists;
use crate::ContactKind;

/// Where a contact is in the results of the narrow phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactPlace {
    pub chunk: u32,
    /// Which eight lanes, and which of them.
    pub lanes: u32,
    pub lane: u32,
}

/// Contacts of two bodies, or of a body and a wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub first: u32,
    /// The second body; for a wall the number of bodies.
    pub second: u32,
    /// Its contacts, as a range of all places.
    pub start: u32,
    pub end: u32,
    /// Damping ratio of its patch, that of the restitution that is asked for, and the factor of its friction dashpots.
    pub damping_ratio: f64,
    pub asked_damping_ratio: f64,
    pub friction_damping_factor: f64,
}

impl Group {
    pub fn len(&self) -> u32 {
        self.end - self.start
    }
}

/// Lists the contacts within reach in the order of pairs, and their groups.
pub(super) fn collect(
    chunks: &[ChunkContacts],
    lists: &NeighbourLists,
    body_count: u32,
    places: &mut Vec<ContactPlace>,
    groups: &mut Vec<Group>,
) {
    places.clear();
    groups.clear();
    for (chunk, (contacts, neighbours)) in chunks.iter().zip(&lists.chunks).enumerate() {
        // first and second body, or wall
        let mut latest = None;
        let mut latest_pair = u32::MAX;
        for (lanes_index, lanes) in contacts.lanes[..contacts.lanes_used].iter().enumerate() {
            for lane in lanes.within_reach() {
                let start = places.len() as u32;
                if lanes.pair[lane] != latest_pair {
                    latest_pair = lanes.pair[lane];
                    let list_index = contacts.pairs[latest_pair as usize].list_index;
                    let pair = &neighbours.pairs[list_index as usize];
                    let is_wall = pair.kind == ContactKind::SphereWall;
                    let key = (pair.first, is_wall, pair.second);
                    if latest != Some(key) {
                        latest = Some(key);
                        groups.push(Group {
                            first: pair.first,
                            second: if is_wall { body_count } else { pair.second },
                            start,
                            end: start,
                            damping_ratio: pair.law.damping_ratio,
                            asked_damping_ratio: pair.law.asked_damping_ratio,
                            friction_damping_factor: pair.law.friction_damping_factor,
                        });
                    }
                }
                let (chunk, lanes) = (chunk as u32, lanes_index as u32);
                places.push(ContactPlace { chunk, lanes, lane: lane as u32 });
                if let Some(group) = groups.last_mut() {
                    group.end += 1;
                }
            }
        }
    }
}
