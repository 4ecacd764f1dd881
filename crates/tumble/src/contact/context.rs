//! Inputs of one evaluation of the contacts.

use super::pose::BodyPose;
use super::since_kick::SinceKick;
use crate::{Model, PairSpring};

/// The inputs of one evaluation of the contacts.
#[derive(Clone, Copy)]
pub(super) struct ContactContext<'a> {
    pub model: &'a Model,
    pub poses: &'a [BodyPose],
    /// All friction springs after the latest kick.
    pub springs: &'a [PairSpring],
    /// The flight since the latest kick.
    pub since_kick: SinceKick,
    /// Whether the contacts are found for the implicit solver, within reach and without forces.
    pub is_solved: bool,
}
