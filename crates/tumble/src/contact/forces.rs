//! Contact forces: the law, evaluated on eight contacts, and its sums over the contacts of each pair.

use fearless_simd::{Simd, f64x8, prelude::*};

use super::contact_lanes::{ContactLanes, LaneVelocities};
use super::law::coulomb::{dashpot_fraction, slip};
use super::law::{NormalForce, NormalLaw};
use super::pair_forces::{LaneWrenches, PairForces, PairLosses};
use super::patch_damping::touch_factors;
use super::pose::BodyPose;
use crate::lanes::{Columns, LANES, Vec3x8};

impl ContactLanes {
    /// Adds the forces of the contacts, at the velocities of the poses, to those of their pairs.
    ///
    /// Normal force: see [`law`](super::law). Tangential force: the spring −k_t ξ and the dashpot −c_t u_t, together at most μ
    /// times the normal force.
    ///
    /// With `PREDICT` only the forces are computed; losses and springs are left as they are. The velocities are then those in the
    /// middle of the flight since the latest kick, a time `h` (s) ago: over that time bodies at rest have no velocity, so that the
    /// prediction leaves them at rest.
    #[inline(always)]
    pub fn add_forces<S: Simd, const PREDICT: bool>(
        &mut self,
        simd: S,
        poses: &[BodyPose],
        pairs: &mut [PairForces],
        losses: &mut [PairLosses],
        h: f64,
    ) {
        let n = Vec3x8::load(simd, &self.normal);
        let (arm, other_arm) = (Vec3x8::load(simd, &self.arm), Vec3x8::load(simd, &self.other_arm));
        let u = self.relative_velocity::<S, PREDICT>(simd, poses, n);
        let zero = f64x8::splat(simd, 0.0);
        let depth = f64x8::simd_from(simd, self.depth);
        if PREDICT {
            let approach = u.dot(n) * f64x8::splat(simd, -h);
            let alone = f64x8::simd_from(simd, self.touches_alone);
            let factor = touch_factors(simd, depth, approach * alone);
            self.damping = (f64x8::simd_from(simd, self.damping) * factor).into();
            self.friction_damping = (f64x8::simd_from(simd, self.friction_damping) * factor).into();
        }
        let NormalForce { spring, total: normal } =
            self.normal_law(simd).force(simd, depth, u.dot(n));
        let mut force = n * normal;
        let mut dashpot_force = n * (normal - spring);
        let mut slip = [0.0; LANES];
        let mut surface_power = [[0.0; LANES]; 2];
        if self.has_friction {
            let limit = f64x8::simd_from(simd, self.friction) * normal;
            let tangential = u.perpendicular_to(n);
            let spring =
                self.friction_spring_force::<S, PREDICT>(simd, limit, tangential, &mut slip);
            let dashpot = tangential * (zero - f64x8::simd_from(simd, self.friction_damping));
            let dashpot = dashpot * dashpot_fraction(simd, spring, dashpot, limit);
            force += spring + dashpot;
            dashpot_force += dashpot;
            if !PREDICT && self.has_surface_velocity {
                // opposite sign: the power that the surface of the second body puts into the first
                let surface =
                    Vec3x8::load(simd, &self.surface_velocity(poses)) * f64x8::splat(simd, -1.0);
                surface_power =
                    [(spring + dashpot).dot(surface).into(), dashpot.dot(surface).into()];
            }
        }
        let total = LaneWrenches::new(force, arm, other_arm);
        if PREDICT {
            for lane in self.in_contact() {
                total.add_to(lane, &mut pairs[self.pair[lane] as usize].wrench);
            }
            return;
        }
        let dashpots = LaneWrenches::new(dashpot_force, arm, other_arm);
        for lane in self.in_contact() {
            let pair = self.pair[lane] as usize;
            total.add_to(lane, &mut pairs[pair].wrench);
            let losses = &mut losses[pair];
            dashpots.add_to(lane, &mut losses.dashpot);
            losses.slip += slip[lane];
            losses.max_depth = losses.max_depth.max(self.depth[lane]);
            losses.surface_power += surface_power[0][lane];
            losses.surface_dashpot_power += surface_power[1][lane];
        }
    }

    /// Force of the tangential springs, limited to μ F_n (N); `u` is the tangential velocity, and `slip_loss` gets the energy
    /// that slip dissipates (J).
    #[inline(always)]
    fn friction_spring_force<S: Simd, const PREDICT: bool>(
        &mut self,
        simd: S,
        limit: f64x8<S>,
        u: Vec3x8<S>,
        slip_loss: &mut [f64; LANES],
    ) -> Vec3x8<S> {
        let k = f64x8::simd_from(simd, self.friction_spring);
        let stretch = Vec3x8::load(simd, &self.stretch);
        let tension_squared = k * k * stretch.dot(stretch);
        let slips = tension_squared.simd_gt(limit * limit);
        let old = Vec3x8::load(simd, &self.old_stretch);
        let held = Vec3x8::select(slips, slip(simd, old, stretch, limit / k, u), stretch);
        if !PREDICT {
            self.held = held.store();
            // the work of friction from the old to the new stretch, less what the spring stores; the flight before the first
            // kick takes its work from that alone
            let before = if self.is_first_kick { held } else { old };
            let lost = (before + held).dot(stretch - held);
            let zero = f64x8::splat(simd, 0.0);
            *slip_loss = slips.select(k * 0.5 * lost, zero).into();
        }
        held * (f64x8::splat(simd, 0.0) - k)
    }

    /// Velocity of the first body relative to the second at the points of contact (m/s).
    #[inline(always)]
    fn relative_velocity<S: Simd, const DRIFT: bool>(
        &self,
        simd: S,
        poses: &[BodyPose],
        n: Vec3x8<S>,
    ) -> Vec3x8<S> {
        let LaneVelocities { velocity, angular_velocity } = self.velocities::<DRIFT>(poses);
        let u = point_velocity(simd, [&velocity[0], &angular_velocity[0], &self.arm])
            - point_velocity(simd, [&velocity[1], &angular_velocity[1], &self.other_arm]);
        if self.has_surface_velocity {
            u + Vec3x8::load(simd, &self.surface_velocity(poses)).perpendicular_to(n)
        } else {
            u
        }
    }
}

/// v + ω × a.
#[inline(always)]
fn point_velocity<S: Simd>(simd: S, [velocity, omega, arm]: [&Columns; 3]) -> Vec3x8<S> {
    Vec3x8::load(simd, velocity) + Vec3x8::load(simd, omega).cross(Vec3x8::load(simd, arm))
}
