//! Rows: contacts of eight groups side by side.

use std::ops::Range;
use std::sync::Mutex;

use glam::DVec3;

use super::super::chunk_contacts::ChunkContacts;
use super::super::contact_lanes::NO_SPRING;
use super::super::pose::BodyPose;
use super::bodies::{InertiaColumns, SolverBody, inertia_columns};
use super::colouring::Colouring;
use super::groups::{ContactPlace, Group};
use super::iterations::Change;
use super::losses::PackImpulses;
use crate::lanes::{Columns, LANES, set, vector};
use crate::{ContactImpulse, RunTotals, parallel};

/// Enough work for a thread to take at a time, and few enough that the colours of a heap of a thousand bodies have several blocks.
const PACKS_PER_BLOCK: usize = 8;

/// Eight groups that share no free body, one per lane.
#[derive(Clone, Debug)]
pub(super) struct Pack {
    /// Bodies; of lanes without a group the one that stands for walls.
    pub first: [u32; LANES],
    pub second: [u32; LANES],
    /// Their inverse masses and inertias.
    pub inertia: [InertiaColumns; 2],
    /// Its rows, as a range of all rows. The lanes that have fewer contacts end earlier.
    pub start: u32,
    pub end: u32,
    /// See [`Group`].
    pub damping_ratio: [f64; LANES],
    pub asked_damping_ratio: [f64; LANES],
    pub friction_damping_factor: [f64; LANES],
    /// Number of contacts of each lane.
    pub lengths: [u32; LANES],
}

/// One contact of each group of a pack: what the iterations use.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    /// Unit normal n, from the second body to the first.
    pub normal: Columns,
    /// From the centres of mass of both bodies to the point of contact (m).
    pub arms: [Columns; 2],
    /// Torques of a normal force of 1 N on the first body, and against the second (m).
    pub levers: [Columns; 2],
    /// Coefficients of the normal law: p = b − a u⁺ (kg, kg·m/s).
    pub slope: [f64; LANES],
    pub offset: [f64; LANES],
    /// 1/(1 + a w), and 1/m of the contact along n (1/kg).
    pub normal_factor: [f64; LANES],
    pub normal_mobility: [f64; LANES],
    /// What a contact that closes or opens within the step needs (see [`super::normal_impulse`]): the gap at the beginning of the step (m),
    /// NaN where the law is linear all the same; the gap at its end at u⁺ = 0; h/2, ½ k h, ½ c h, and the velocity u⁻ before the kick (m/s).
    pub start_gap: [f64; LANES],
    pub end_gap: [f64; LANES],
    pub half_step: [f64; LANES],
    pub half_stiffness: [f64; LANES],
    pub half_damping: [f64; LANES],
    pub approach: [f64; LANES],
    /// The velocity of rebound of an impact shorter than the step (m/s); else −∞.
    pub rebound: [f64; LANES],
    /// The same of friction.
    pub friction: [f64; LANES],
    pub tangential_slope: [f64; LANES],
    pub tangential_offset: Columns,
    pub tangential_factor: [f64; LANES],
    pub tangential_mobility: [f64; LANES],
    /// Impulse on the first body (N·s).
    pub impulse: [f64; LANES],
    pub tangential_impulse: Columns,
}

/// One contact of each group of a pack: what the law is computed from, and the account of its energy.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RowLaw {
    /// Gap, negative inside (m).
    pub gap: [f64; LANES],
    /// k, c, k_t, c_t.
    pub stiffness: [f64; LANES],
    pub damping: [f64; LANES],
    pub friction_spring: [f64; LANES],
    pub friction_damping: [f64; LANES],
    /// The part of the step in which a contact is closed that closes within it; 0 for others.
    pub closing: [f64; LANES],
    /// Stretch of the friction spring at the kick (m).
    pub stretch: Columns,
    /// Velocity of the surface of the first body along itself, less that of the second (m/s).
    pub surface_velocity: Columns,
    /// Velocity before the kick along the surfaces (m/s).
    pub sliding: Columns,
    /// 1 where the friction spring is there since the latest kick, and where it is kept for the next one.
    pub had_spring: [f64; LANES],
    pub keeps_spring: [f64; LANES],
    /// s: 0 for the middle of the step, 1 for its end.
    pub implicitness: [f64; LANES],
}

/// Packs of one colour, with their rows: what a thread solves at a time.
#[derive(Debug, Default)]
pub(super) struct Block {
    pub packs: Vec<Pack>,
    pub rows: Vec<Row>,
    pub laws: Vec<RowLaw>,
    /// The groups in the lanes of the packs.
    groups: Range<u32>,
    /// Of the latest iteration.
    pub change: Change,
    /// Of each pack, and of all of them.
    pub impulses: Vec<PackImpulses>,
    pub losses: RunTotals,
}

/// Where the row of a contact is.
#[derive(Clone, Copy, Debug, Default)]
struct RowPlace {
    block: u32,
    row: u32,
    lane: u32,
}

/// The rows of all packs.
#[derive(Debug, Default)]
pub(super) struct Rows {
    /// Those from `used` on are spare.
    blocks: Vec<Mutex<Block>>,
    used: usize,
    /// Where the blocks of each colour begin, and the end.
    pub starts: Vec<u32>,
    /// For each contact.
    places: Vec<RowPlace>,
}

/// What the rows are made from.
pub(super) struct Source<'a> {
    pub chunks: &'a [ChunkContacts],
    pub poses: &'a [BodyPose],
    /// As many as poses, and one that stands for walls.
    pub bodies: &'a [SolverBody],
    pub contacts: &'a [ContactPlace],
    pub groups: &'a [Group],
    /// Impulses of the latest kick, one for each spring of the state.
    pub impulses: &'a [ContactImpulse],
}

impl Rows {
    /// Assigns all groups to blocks, and their contacts to rows.
    pub fn assign(&mut self, groups: &[Group], colouring: &Colouring) {
        self.used = 0;
        self.starts.clear();
        self.starts.push(0);
        let count = groups.last().map_or(0, |group| group.end as usize);
        self.places.clear();
        self.places.resize(count, RowPlace::default());
        for range in colouring.starts.windows(2) {
            let of_block = (LANES * PACKS_PER_BLOCK) as u32;
            for start in (range[0]..range[1]).step_by(of_block as usize) {
                self.assign_block(groups, colouring, start..range[1].min(start + of_block));
            }
            self.starts.push(self.used as u32);
        }
    }

    fn assign_block(&mut self, groups: &[Group], colouring: &Colouring, range: Range<u32>) {
        let block = self.used as u32;
        let order = &colouring.order[range.start as usize..range.end as usize];
        let mut start = 0;
        for lanes in order.chunks(LANES) {
            let groups = lanes.iter().map(|&index| &groups[index as usize]);
            let mut end = start;
            for (lane, group) in (0..).zip(groups) {
                for (row, contact) in (start..).zip(group.start..group.end) {
                    self.places[contact as usize] = RowPlace { block, row, lane };
                }
                end = end.max(start + group.len());
            }
            start = end;
        }
        if self.used == self.blocks.len() {
            self.blocks.push(Mutex::default());
        }
        if let Ok(block) = self.blocks[self.used].get_mut() {
            block.groups = range;
        }
        self.used += 1;
    }

    /// The blocks, each of which a thread may lock.
    pub fn shared(&self) -> &[Mutex<Block>] {
        &self.blocks[..self.used]
    }

    /// Calls `work` for each block, in parallel.
    pub fn for_each(&mut self, work: impl Fn(&mut Block) + Sync) {
        parallel::for_each(&mut self.blocks[..self.used], |_, block| {
            if let Ok(block) = block.get_mut() {
                work(block);
            }
        });
    }

    /// The row of a contact and its lane.
    pub fn of_contact(&mut self, contact: usize) -> Option<(&Row, &RowLaw, usize)> {
        let RowPlace { block, row, lane } = self.places[contact];
        let Block { rows, laws, .. } = self.blocks[block as usize].get_mut().ok()?;
        Some((&rows[row as usize], &laws[row as usize], lane as usize))
    }

    /// The impulses of a contact on its first body, along and across the normal (N·s).
    pub fn impulses(&self, contact: usize) -> Option<(f64, DVec3)> {
        let RowPlace { block, row, lane } = self.places[contact];
        let block = self.blocks[block as usize].lock().ok()?;
        let (row, lane) = (block.rows.get(row as usize)?, lane as usize);
        Some((row.impulse[lane], vector(&row.tangential_impulse, lane)))
    }

    /// The blocks in order.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Block> {
        self.blocks[..self.used].iter_mut().filter_map(|block| block.get_mut().ok())
    }
}

impl Block {
    /// Puts its groups into packs, and their contacts into rows.
    pub fn fill(&mut self, source: &Source, colouring: &Colouring) {
        self.packs.clear();
        let range = self.groups.start as usize..self.groups.end as usize;
        let mut end = 0;
        for groups in colouring.order[range].chunks(LANES) {
            let pack = pack(source, groups, end);
            end = pack.end;
            // rows of earlier steps are overwritten
            if self.rows.len() < end as usize {
                self.rows.resize(end as usize, Row::default());
                self.laws.resize(end as usize, RowLaw::default());
            }
            for lane in 0..LANES {
                let contacts = groups.get(lane).map_or(0..0, |&group| {
                    let Group { start, end, .. } = source.groups[group as usize];
                    start as usize..end as usize
                });
                let mut contacts = source.contacts[contacts].iter();
                let range = pack.start as usize..end as usize;
                for (row, law) in self.rows[range.clone()].iter_mut().zip(&mut self.laws[range]) {
                    match contacts.next() {
                        Some(place) => source.fill(place, row, law, lane),
                        None => clear(row, law, lane),
                    }
                }
            }
            self.packs.push(pack);
        }
    }
}

fn pack(source: &Source, groups: &[u32], start: u32) -> Pack {
    let wall = source.poses.len() as u32;
    let zero = [0.0; LANES];
    let mut pack = Pack {
        first: [wall; LANES],
        second: [wall; LANES],
        inertia: [InertiaColumns::default(); 2],
        start,
        end: start,
        damping_ratio: zero,
        asked_damping_ratio: zero,
        friction_damping_factor: zero,
        lengths: [0; LANES],
    };
    for (lane, &group) in groups.iter().enumerate() {
        let group = &source.groups[group as usize];
        (pack.first[lane], pack.second[lane]) = (group.first, group.second);
        pack.damping_ratio[lane] = group.damping_ratio;
        pack.asked_damping_ratio[lane] = group.asked_damping_ratio;
        pack.friction_damping_factor[lane] = group.friction_damping_factor;
        pack.lengths[lane] = group.len();
        pack.end = pack.end.max(start + group.len());
    }
    pack.inertia =
        [&pack.first, &pack.second].map(|indices| inertia_columns(source.bodies, indices));
    pack
}

impl Source<'_> {
    /// Copies a contact into a lane of a row.
    #[inline(always)]
    fn fill(&self, place: &ContactPlace, row: &mut Row, law: &mut RowLaw, lane: usize) {
        let from = &self.chunks[place.chunk as usize].lanes[place.lanes as usize];
        let old = place.lane as usize;
        let normal = vector(&from.normal, old);
        let couple = vector(&from.couple, old);
        set(&mut row.normal, lane, normal);
        for (index, arm) in [&from.arm, &from.other_arm].into_iter().enumerate() {
            let arm = vector(arm, old);
            set(&mut row.arms[index], lane, arm);
            set(&mut row.levers[index], lane, arm.cross(normal) + couple);
        }
        row.friction[lane] = from.friction[old];
        law.gap[lane] = from.gap[old];
        law.stiffness[lane] = from.stiffness[old];
        law.damping[lane] = from.damping[old];
        let is_rough = from.friction[old] > 0.0;
        let if_rough = |value: f64| if is_rough { value } else { 0.0 };
        law.friction_spring[lane] = if_rough(from.friction_spring[old]);
        law.friction_damping[lane] = if_rough(from.friction_damping[old]);
        let stretch = if is_rough { vector(&from.stretch, old) } else { DVec3::ZERO };
        set(&mut law.stretch, lane, stretch);
        let surface = if from.has_surface_velocity {
            let of_body = |index: u32| {
                self.poses.get(index as usize).map_or(DVec3::ZERO, |pose| pose.surface_velocity)
            };
            of_body(from.first[old]) - of_body(from.second[old])
        } else {
            DVec3::ZERO
        };
        set(&mut law.surface_velocity, lane, surface - normal * surface.dot(normal));
        let spring = from.spring[old];
        let had_spring = spring != NO_SPRING;
        law.had_spring[lane] = f64::from(u8::from(had_spring));
        let impulse = if had_spring { self.impulses.get(spring as usize) } else { None };
        let impulse = impulse.copied().unwrap_or_default();
        row.impulse[lane] = impulse.normal;
        let along = impulse.tangential - normal * impulse.tangential.dot(normal);
        set(&mut row.tangential_impulse, lane, along);
    }
}

/// Empties a lane. [`super::law::prepare`] computes the rest of the row.
fn clear(row: &mut Row, law: &mut RowLaw, lane: usize) {
    let Row { normal, arms: [arm, other_arm], levers: [lever, other_lever], .. } = row;
    for columns in [normal, arm, other_arm, lever, other_lever, &mut row.tangential_impulse] {
        set(columns, lane, DVec3::ZERO);
    }
    (row.friction[lane], row.impulse[lane]) = (0.0, 0.0);
    let RowLaw { gap, stiffness, damping, friction_spring, friction_damping, had_spring, .. } = law;
    for column in [gap, stiffness, damping, friction_spring, friction_damping, had_spring] {
        column[lane] = 0.0;
    }
    set(&mut law.stretch, lane, DVec3::ZERO);
    set(&mut law.surface_velocity, lane, DVec3::ZERO);
}
