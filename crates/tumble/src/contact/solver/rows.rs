//! Rows: contacts of eight groups side by side.

use super::super::chunk_contacts::ChunkContacts;
use super::super::contact_lanes::NO_SPRING;
use super::super::pose::BodyPose;
use super::bodies::{InertiaColumns, SolverBody, inertia_columns};
use super::colouring::Colouring;
use super::groups::{ContactPlace, Group};
use crate::ContactImpulse;
use crate::lanes::{Columns, LANES, set, vector};

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

/// The rows of all packs.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    pub packs: Vec<Pack>,
    pub rows: Vec<Row>,
    pub laws: Vec<RowLaw>,
    /// For each contact, its row and lane.
    pub places: Vec<(u32, u32)>,
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
    /// Puts all groups into packs, and their contacts into rows.
    pub fn fill(&mut self, source: &Source, colouring: &Colouring) {
        self.packs.clear();
        self.places.clear();
        self.places.resize(source.contacts.len(), (0, 0));
        let mut row_count = 0;
        for range in colouring.starts.windows(2) {
            let groups = &colouring.order[range[0] as usize..range[1] as usize];
            for groups in groups.chunks(LANES) {
                let pack = self.pack(source, groups, row_count);
                row_count = pack.end;
                self.packs.push(pack);
            }
        }
        self.rows.clear();
        self.rows.resize(row_count as usize, Row::default());
        self.laws.clear();
        self.laws.resize(row_count as usize, RowLaw::default());
        let Self { rows, laws, places, .. } = self;
        for (place, &(row, lane)) in source.contacts.iter().zip(&*places) {
            source.fill(place, &mut rows[row as usize], &mut laws[row as usize], lane as usize);
        }
    }

    fn pack(&mut self, source: &Source, groups: &[u32], start: u32) -> Pack {
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
            for (row, contact) in (start..).zip(group.start..group.end) {
                self.places[contact as usize] = (row, lane as u32);
            }
        }
        pack.inertia =
            [&pack.first, &pack.second].map(|indices| inertia_columns(source.bodies, indices));
        pack
    }
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
        if from.friction[old] > 0.0 {
            law.friction_spring[lane] = from.friction_spring[old];
            law.friction_damping[lane] = from.friction_damping[old];
            set(&mut law.stretch, lane, vector(&from.stretch, old));
        }
        if from.has_surface_velocity {
            let of_body = |index: u32| {
                self.poses
                    .get(index as usize)
                    .map_or(glam::DVec3::ZERO, |pose| pose.surface_velocity)
            };
            let surface = of_body(from.first[old]) - of_body(from.second[old]);
            set(&mut law.surface_velocity, lane, surface - normal * surface.dot(normal));
        }
        if from.spring[old] != NO_SPRING {
            law.had_spring[lane] = 1.0;
        }
        if from.spring[old] != NO_SPRING
            && let Some(impulse) = self.impulses.get(from.spring[old] as usize)
        {
            row.impulse[lane] = impulse.normal;
            let along = impulse.tangential - normal * impulse.tangential.dot(normal);
            set(&mut row.tangential_impulse, lane, along);
        }
    }
}
