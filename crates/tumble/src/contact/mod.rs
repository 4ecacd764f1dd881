//! Contact: particles and spheres with walls, and bodies with each other.
//!
//! Particles of bodies without spheres meet walls one body at a time ([`wall`]). Everything else goes through a pipeline
//! that works on chunks of bodies:
//!
//! | step | file | from | to |
//! |---|---|---|---|
//! | poses | `pose` | body states | poses, bounds on displacement |
//! | broad phase | `broad_phase` | bounding balls | pairs of bodies |
//! | neighbour lists | `neighbour_list` | pairs of bodies | points that may touch soon |
//! | narrow phase | `narrow_phase` | points | contacts, in lanes of eight |
//! | geometry, friction | `geometry`, `friction` | contacts | depths, normals, stretches |
//! | damping | `patch_damping` | all contacts of two bodies | dashpots that give a restitution |
//! | law | `law`, `forces` | depths, velocities, stretches | forces of pairs |
//! | gather | `gather` | forces of pairs | forces of bodies |
//!
//! `body_contacts` runs it. Chunks do not depend on the number of threads, and every sum runs in the order of bodies and
//! particles, whatever else the lists hold. So neighbour lists can be rebuilt at any time, and a run that resumes from a
//! checkpoint continues with the same bits.

mod body_contacts;
mod broad_phase;
mod chunk_contacts;
mod contact_lanes;
mod context;
pub(crate) mod deep_contact;
mod forces;
mod friction;
mod friction_history;
pub(crate) mod gather;
mod geometry;
pub(crate) mod initial_overlap;
mod law;
mod listing;
mod mesh_cache;
mod narrow_phase;
mod neighbour_list;
mod pair;
mod pair_forces;
mod patch_damping;
pub(crate) mod pose;
mod since_kick;
mod solver;
pub(crate) mod tunnelling;
pub(crate) mod wall;

pub(crate) use self::body_contacts::BodyContacts;
pub(crate) use self::pair::{
    can_touch, contact_kinds, contact_law, contact_particles, sphere_radius, tunnelling_limit,
};
pub(crate) use self::since_kick::{Kick, SinceKick};
pub(crate) use self::solver::{Outcome, Solver};
