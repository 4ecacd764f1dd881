//! The linear spring-dashpot law.

use fearless_simd::{Simd, f64x8, prelude::*};

use super::{NormalForce, NormalLaw};
use crate::lanes::positive;

/// F = max(0, k δ − c_n u·n).
pub(in crate::contact) struct LinearSpringDashpot<S: Simd> {
    /// k (N/m).
    pub stiffness: f64x8<S>,
    /// c_n (N·s/m).
    pub damping: f64x8<S>,
}

impl<S: Simd> NormalLaw<S> for LinearSpringDashpot<S> {
    #[inline(always)]
    fn force(&self, simd: S, depth: f64x8<S>, normal_velocity: f64x8<S>) -> NormalForce<S> {
        let zero = f64x8::splat(simd, 0.0);
        let spring = self.stiffness * depth;
        let total = positive(simd, spring - self.damping * normal_velocity);
        NormalForce { spring, total: depth.simd_gt(zero).select(total, zero) }
    }
}
