//! Bodies so fast that one could pass through another within a step.

use super::pair::{ListedContact, Pair};
use crate::{ContactKind, Model};

/// Two bodies that could pass through each other within a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TunnellingRisk {
    /// Index of the pair in the neighbour list.
    pub(super) pair: u32,
    /// The body that the particle belongs to.
    pub body: u32,
    /// Index of the particle.
    pub particle: u32,
    pub other: u32,
    /// How far the bodies may move relative to each other in a step (m).
    pub displacement: f64,
    /// The largest displacement that is accepted (m).
    pub limit: f64,
}

impl TunnellingRisk {
    /// The risk at one point of the pair with index `index` in its list.
    #[cold]
    pub(super) fn new(
        model: &Model,
        index: usize,
        pair: &Pair,
        point: &ListedContact,
        displacement: f64,
    ) -> Self {
        let (body, other) = match pair.kind {
            ContactKind::MeshPoint => (pair.second, pair.first),
            _ => (pair.first, pair.second),
        };
        let particle = model.bodies[body as usize].points().index_of_slot(point.particle);
        let limit = pair.tunnelling_limit;
        Self { pair: index as u32, body, particle, other, displacement, limit }
    }
}
