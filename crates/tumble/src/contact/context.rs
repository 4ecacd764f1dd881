//! Inputs of one evaluation of the contacts.

use super::pose::BodyPose;
use crate::{Model, PairSpring};

/// The inputs of one evaluation of the contacts.
#[derive(Clone, Copy)]
pub(super) struct ContactContext<'a> {
    pub model: &'a Model,
    pub poses: &'a [BodyPose],
    /// All friction springs after the latest kick.
    pub springs: &'a [PairSpring],
    /// Time since the latest kick (s).
    pub time_since_kick: f64,
}
