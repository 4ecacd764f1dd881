//! Buffers that a step reuses.

use crate::contact::{BodyContacts, Solver};
use crate::joint::JointWork;
use crate::parallel::CHUNK;
use crate::workspace::Workspace;
use crate::{BodyForces, FrictionSpring, State};

/// Values that are computed within a step, and the buffers that hold them. Dropping it between steps changes no result.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Whether each body may touch a wall or another body within the step.
    pub may_touch: Vec<bool>,
    /// Forces and torques of the latest evaluation, one entry per body.
    pub forces: Vec<BodyForces>,
    /// The friction springs at walls after the latest evaluation, one list per body.
    pub springs: Vec<Vec<FrictionSpring>>,
    /// Buffers, one entry per batch of bodies.
    pub(crate) workspaces: Vec<Workspace>,
    /// Contacts between bodies, and of spheres with walls.
    pub(crate) body_contacts: BodyContacts,
    /// The state before a part of an implicit step, which may have to be repeated, or before a step with joints.
    pub(crate) before: State,
    /// The implicit solver.
    pub(crate) solver: Solver,
    /// The joints.
    pub(crate) joints: JointWork,
}

impl Scratch {
    /// Sizes the buffers for `body_count` bodies. It allocates only when the count changes, and does not clear: each stage
    /// writes its values before another stage reads them.
    pub(crate) fn resize(&mut self, body_count: usize) {
        if self.forces.len() != body_count {
            self.forces.resize(body_count, BodyForces::default());
            self.springs.resize_with(body_count, Vec::new);
            self.may_touch.resize(body_count, true);
            self.workspaces.resize_with(body_count.div_ceil(CHUNK), Workspace::default);
        }
    }
}
