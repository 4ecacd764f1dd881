//! Contact laws: the force of a contact as a function of penetration depth and velocity, eight contacts at a time.
//!
//! One file per law. Contacts between bodies ([`forces`](super::forces)) and wall contacts with friction
//! ([`wall`](super::wall)) evaluate the same code. Wall contacts without friction are sums over the particle tree, which need a force that is
//! linear in depth.
//!
//! # How to add a law for the normal force (Hertz)
//!
//! 1. Implement [`NormalLaw`] in a new file here.
//! 2. Parameters: `ContactLaw` and `Material` in `material.rs`, `PairMaterial` in `pair_material.rs` (with the effective radius, if the law has
//!    one), and the keys in `crates/tumble-io/src/scene`.
//! 3. Between bodies: choose the law in `ContactLanes::normal_law` (`contact_lanes.rs`) from parameters that `PairPoses::write_law`
//!    (`narrow_phase/pair_poses.rs`) writes into the lanes; its energy in `ContactLanes::elastic_energy`.
//! 4. At walls: choose it in `WallEvaluation::add_lanes` (`wall/friction.rs`), and send every contact with a nonlinear law there instead of to
//!    `wall/frictionless.rs`; its energy in `wall::elastic_energy`.
//! 5. The critical step in `stability.rs`, the duration of an impact in `contact_time.rs`, and the damping that gives a restitution in
//!    `patch_damping.rs`.

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
