//! Dashpots that depend on all contacts between two bodies, or of a body and a wall, at one instant: a *patch*.
//!
//! `restitution` is a property of the patch. Its springs have the stiffness K = Σ k, the force F = Σ k δ and the largest depth δ_max;
//! near a force that grows as δⁿ, K δ_max = n F, with n = 1 for a face and n = 2 for a ball. The bodies resist it with the effective
//! mass m, 1/m = W·M⁻¹ W/F², where W = Σ k δ (n, a × n) is the wrench of the springs. The dashpot of the patch is
//! C = 2 ζ √((n + 1)/(2 n)) √(K m), for which the rebound does not depend on stiffness, mass, speed or mesh. The points share it as
//! they share K, so that each has c = k C/K. A single particle has c = 2 ζ √(k m).
//!
//! That C is exact where the whole patch stops to push at one instant. Points at different depths do so one after the other, since none
//! of them pulls; the patch then loses less, and C is larger by a factor of its own.
//!
//! A dashpot acts from the instant of touch, which is within a step. [`touch_factor`] corrects the first kick after it.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DMat3;

use super::contact_lanes::ContactLanes;
use super::context::ContactContext;
use super::pair::Pair;
use super::pair_forces::{LaneWrenches, PairForces, PairWrench};
use super::pose::BodyPose;
use crate::lanes::Vec3x8;
use crate::{BodyModel, ContactKind, ContactLaw, Wrench};

/// Marks a pair whose dashpots do not depend on a patch.
pub(super) const NO_PATCH: u32 = u32::MAX;

/// Sums over the contacts of a patch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Patch {
    /// K = Σ k (N/m).
    pub stiffness: f64,
    /// Σ k_t (N/m).
    pub friction_spring: f64,
    /// F = Σ k δ (N).
    pub force: f64,
    /// The largest depth (m).
    pub max_depth: f64,
    /// 1/m (1/kg).
    pub inverse_mass: f64,
}

/// Damping over stiffness of the contacts of a patch (s): c = k `normal` and c_t = k_t `tangential`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DampingTimes {
    pub normal: f64,
    pub tangential: f64,
}

impl Patch {
    /// The dashpots that `law` gives to the contacts of this patch.
    pub fn damping_times(&self, law: &ContactLaw) -> DampingTimes {
        let root = |stiffness: f64| {
            let square = stiffness * self.inverse_mass;
            if square > 0.0 && self.force > 0.0 { 1.0 / square.sqrt() } else { 0.0 }
        };
        // at least 1, except for rounding and the tolerance of the largest depth
        let n = (self.stiffness * self.max_depth / self.force).max(1.0);
        let shape = ((n + 1.0) / (2.0 * n)).sqrt() * release_factor(law.damping_ratio, n);
        DampingTimes {
            normal: 2.0 * law.damping_ratio * shape * root(self.stiffness),
            tangential: law.friction_damping_factor * root(self.friction_spring),
        }
    }
}

/// The factor of C for points that stop to push one after the other.
///
/// A fit to the rebound of smooth bodies with the force ∫ max(0, δ − h + τ δ') dA over their points at the height h, with dA/dh
/// constant (ball, n = 2) and proportional to 1/√h (cylinder, n = 3/2): for 0.05 ≤ e ≤ 0.95 it is within 0.01 of the factor that makes the
/// rebound exact.
fn release_factor(damping_ratio: f64, n: f64) -> f64 {
    // ζ^(3/4)
    let root = damping_ratio.sqrt();
    let x = root * root.sqrt();
    1.0 + 0.78 * (1.0 - 1.0 / n) * (x / (1.0 + x))
}

/// W·M⁻¹ W: the power that a wrench on a body gains as it accelerates the body (N²/kg); 0 for a prescribed motion.
pub(super) fn mobility(body: &BodyModel, rotation: DMat3, wrench: &Wrench) -> f64 {
    if !body.is_free() {
        return 0.0;
    }
    let turning = body.angular_velocity(rotation, wrench.torque);
    wrench.force.length_squared() / body.mass + wrench.torque.dot(turning)
}

/// A contact that begins at a kick, up to this part of the approach in a step, begins after it: rounding must not decide whether
/// it counts at this kick, at the next, or at both.
const ROUNDING: f64 = 1e-9;

/// The factor by which the dashpots of a contact at `depth` (m) are multiplied in a kick over a time in which it approaches by
/// `approach` (m).
///
/// A contact that is no deeper than that has touched since the kick before. Its dashpot is due for the part of the time between the
/// kicks in which it touched, and for half of the time to the next kick, which this kick stands for: together ½ + δ/(u h) of the time h.
pub(super) fn touch_factor(depth: f64, approach: f64) -> f64 {
    let rounding = ROUNDING * approach;
    if approach <= 0.0 || depth - approach > rounding {
        1.0
    } else if depth > rounding {
        0.5 + depth / approach
    } else {
        0.0
    }
}

/// [`touch_factor`] of eight contacts.
#[inline(always)]
pub(super) fn touch_factors<S: Simd>(simd: S, depth: f64x8<S>, approach: f64x8<S>) -> f64x8<S> {
    let factor = f64x8::splat(simd, 0.5) + depth / approach;
    let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
    let rounding = approach * f64x8::splat(simd, ROUNDING);
    let factor = depth.simd_gt(rounding).select(factor, zero);
    let is_older = (depth - approach).simd_gt(rounding) | approach.simd_le(zero);
    is_older.select(one, factor)
}

/// The patch of two bodies, or of a body of spheres and a wall.
#[derive(Clone, Debug)]
pub(super) struct PairPatch {
    first: u32,
    second: u32,
    is_wall: bool,
    law: ContactLaw,
    sums: Patch,
    /// W.
    wrench: PairWrench,
    /// The result, once all contacts are known.
    times: Option<(DampingTimes, f64)>,
}

impl PairPatch {
    /// The patch of a pair, without contacts.
    pub fn new(pair: &Pair) -> Self {
        Self {
            first: pair.first,
            second: pair.second,
            is_wall: pair.kind == ContactKind::SphereWall,
            law: pair.law,
            sums: Patch::default(),
            wrench: PairWrench::default(),
            times: None,
        }
    }

    /// Whether a pair belongs to this patch: points of one body on the mesh of the other do, and vice versa.
    pub fn includes(&self, pair: &Pair) -> bool {
        (self.first, self.second, self.is_wall)
            == (pair.first, pair.second, pair.kind == ContactKind::SphereWall)
    }

    /// The dashpots, after all contacts have been added, and the touch factor of the patch.
    fn times(&mut self, context: &ContactContext) -> (DampingTimes, f64) {
        if let Some(times) = self.times {
            return times;
        }
        let ContactContext { model, poses, .. } = context;
        let of_body = |index: u32, wrench: Wrench| {
            let (body, pose) = (&model.bodies[index as usize], &poses[index as usize]);
            let inverse_mass = if body.is_free() { 1.0 / body.mass } else { 0.0 };
            (mobility(body, pose.rotation, &wrench), inverse_mass)
        };
        let (of_first, of_second) = (
            of_body(self.first, self.wrench.on_first()),
            if self.is_wall { (0.0, 0.0) } else { of_body(self.second, self.wrench.on_second()) },
        );
        let force = self.sums.force;
        // where normals diverge, part of F cancels
        let reduced = of_first.1 + of_second.1;
        self.sums.inverse_mass = ((of_first.0 + of_second.0) / (force * force)).max(reduced);
        let times = (self.sums.damping_times(&self.law), self.touch_factor(context));
        self.times = Some(times);
        times
    }

    /// The touch factor of the patch, at the mean velocity of its points, weighted by their springs.
    fn touch_factor(&self, context: &ContactContext) -> f64 {
        let power = |pose: &BodyPose, wrench: Wrench| {
            wrench.force.dot(pose.drift_velocity) + wrench.torque.dot(pose.drift_angular_velocity)
        };
        let first = power(&context.poses[self.first as usize], self.wrench.on_first());
        let second = if self.is_wall {
            0.0
        } else {
            power(&context.poses[self.second as usize], self.wrench.on_second())
        };
        let approach = -(first + second) / self.sums.force * context.model.dt;
        touch_factor(self.sums.max_depth, approach)
    }
}

impl ContactLanes {
    /// Adds the contacts to their patches.
    #[inline(always)]
    pub fn add_to_patches<S: Simd>(
        &self,
        simd: S,
        pairs: &[PairForces],
        patches: &mut [PairPatch],
    ) {
        let (arm, other_arm) = (Vec3x8::load(simd, &self.arm), Vec3x8::load(simd, &self.other_arm));
        let force = f64x8::simd_from(simd, self.stiffness) * f64x8::simd_from(simd, self.depth);
        let wrenches = LaneWrenches::new(Vec3x8::load(simd, &self.normal) * force, arm, other_arm);
        for lane in self.in_contact() {
            let patch = pairs[self.pair[lane] as usize].patch;
            let Some(PairPatch { sums, wrench, .. }) = patches.get_mut(patch as usize) else {
                continue;
            };
            sums.stiffness += self.stiffness[lane];
            sums.friction_spring += self.friction_spring[lane];
            sums.force += self.stiffness[lane] * self.depth[lane];
            sums.max_depth = sums.max_depth.max(self.depth[lane]);
            wrenches.add_to(lane, wrench);
        }
    }

    /// Adds the dashpots that come from the patches, all of whose contacts are known.
    pub fn add_patch_damping<const PREDICT: bool>(
        &mut self,
        context: &ContactContext,
        pairs: &[PairForces],
        patches: &mut [PairPatch],
    ) {
        for lane in 0..self.count {
            let patch = pairs[self.pair[lane] as usize].patch;
            if self.depth[lane] > 0.0
                && let Some(patch) = patches.get_mut(patch as usize)
            {
                let (times, touch) = patch.times(context);
                let touch = if PREDICT { touch } else { 1.0 };
                let damping = &mut self.damping[lane];
                *damping = touch * (*damping + self.stiffness[lane] * times.normal);
                let damping = &mut self.friction_damping[lane];
                *damping = touch * (*damping + self.friction_spring[lane] * times.tangential);
            }
        }
    }
}

#[cfg(test)]
#[path = "patch_damping_tests.rs"]
mod tests;
