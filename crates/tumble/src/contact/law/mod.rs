//! Contact laws: the force of a contact as a function of penetration depth and velocity, eight contacts at a time.
//!
//! One file a law. Contacts with walls ([`wall`](super::wall)) and between bodies ([`forces`](super::forces)) evaluate the same
//! code. To add a law for the normal force (Hertz, say): implement [`NormalLaw`] in a new file here, and choose it where
//! [`ContactLanes::normal_law`](super::contact_lanes::ContactLanes::normal_law) and the wall contacts build theirs. Its parameters come from
//! [`ContactLaw`](crate::ContactLaw), which [`Material`](crate::Material) fills.

pub(in crate::contact) mod coulomb;
pub(in crate::contact) mod linear;

use fearless_simd::{Simd, f64x8};

/// Normal forces of eight contacts (N), positive in repulsion.
pub(in crate::contact) struct NormalForce<S: Simd> {
    /// The conservative part alone.
    pub spring: f64x8<S>,
    /// Spring and dashpot together; never negative.
    pub total: f64x8<S>,
}

/// A law for the normal force.
pub(in crate::contact) trait NormalLaw<S: Simd> {
    /// Forces at penetration depths δ (m) and normal velocities u·n (m/s), which are negative while bodies approach. The
    /// total is zero in lanes without contact (δ ≤ 0).
    fn force(&self, simd: S, depth: f64x8<S>, normal_velocity: f64x8<S>) -> NormalForce<S>;
}
