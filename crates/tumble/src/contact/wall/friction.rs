//! Wall contacts with friction: each particle has a tangential spring of its own, held at an anchor.
//!
//! [`FrictionContacts::detect`] lists the particles behind walls and the springs they had; [`FrictionContacts::add_forces`]
//! computes their forces, eight contacts at a time, once for each set of velocities; [`FrictionContacts::store_springs`] writes the
//! springs that persist.

use std::cmp::Ordering;

use fearless_simd::{Simd, dispatch, f64x8, prelude::*};
use glam::DVec3;

use super::listing::WallParticle;
use super::near_wall::{NearWall, WallPatch};
use crate::contact::Kick;
use crate::contact::law::coulomb::{dashpot_fraction, slip};
use crate::contact::law::linear::LinearSpringDashpot;
use crate::contact::law::{NormalForce, NormalLaw};
use crate::contact::patch_damping::touch_factors;
use crate::kinematics::Kinematics;
use crate::lanes::{Columns, LANES, Vec3x8, largest, set, sum, vector};
use crate::{BodyForces, ContactLaw, FrictionSpring, Model, Particles, Wrench};

/// The contacts of one body with walls that have friction.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrictionContacts {
    /// Buffer for the slots of the particles behind one wall.
    slots: Vec<u32>,
    /// The contacts, wall by wall, each wall's in the order of the slots.
    contacts: Vec<WallContactLanes>,
    /// The law of the particles at each of these walls.
    laws: Vec<ContactLaw>,
    /// Energy (J) of the springs whose particles have left the wall.
    released: f64,
    /// Energy (J) that the latest evaluation loses to slip.
    slip_loss: f64,
    /// Whether no kick comes before this one.
    is_first_kick: bool,
}

/// Up to eight contacts with one wall, one per lane. Lanes without a contact have depth zero.
#[derive(Clone, Debug, Default)]
struct WallContactLanes {
    wall: u32,
    count: u32,
    particle: [u32; LANES],
    /// Depth δ (m).
    depth: [f64; LANES],
    /// The part of its dashpots that acts in this kick, see [`touch_factors`].
    touch: [f64; LANES],
    /// From the centre of mass to the particle, R r (m).
    arm: Columns,
    /// Anchor of the spring before this step (m).
    anchor: Columns,
    /// Stretch of the spring at the latest kick (m).
    old_stretch: Columns,
    /// Stretch that the friction limit allows (m).
    stretch: Columns,
    /// Whether the contact slips, one bit per lane.
    slips: u64,
}

impl FrictionContacts {
    /// Lists the contacts of a body with walls that have friction. `old` are its springs so far. The velocities, together with the
    /// time since the latest kick, tell which particles have touched since then.
    pub fn detect(
        &mut self,
        model: &Model,
        kinematics: &Kinematics,
        old: &[FrictionSpring],
        kick: Kick,
    ) {
        self.contacts.clear();
        self.laws.clear();
        (self.released, self.is_first_kick) = (0.0, kick.since_last.is_first);
        if !kinematics.body.has_friction && old.is_empty() {
            return;
        }
        let mut springs = OldSprings { kinematics, model, old, kick, released: 0.0 };
        let particles = kinematics.body.shape.particles();
        for (index, (wall, law)) in model.walls.iter().zip(&kinematics.body.contacts).enumerate() {
            let near = NearWall::new(wall, kinematics).filter(|_| law.friction > 0.0);
            let Some(near) = near else { continue };
            self.slots.clear();
            particles.collect_positive_slots(kinematics.level, &near.depth, &mut self.slots);
            let (slots, contacts) = (&self.slots, &mut self.contacts);
            let start = contacts.len();
            if slots.is_empty() {
                continue;
            }
            let patch = dispatch!(kinematics.level, simd => springs.load(simd, index as u32, &near, slots, contacts));
            if law.depends_on_patch() && patch.depth > 0.0 {
                let factor = patch.touch_factor(kinematics, near.normal, kick.length);
                contacts[start..].iter_mut().for_each(|lanes| lanes.touch = [factor; LANES]);
            }
            self.laws.push(near.law_in_patch(law, &patch, kinematics));
        }
        springs.release_all();
        self.released = springs.released;
    }

    /// Adds the forces of all contacts at the velocities of `kinematics`.
    pub fn add_forces(&mut self, model: &Model, kinematics: &Kinematics, forces: &mut BodyForces) {
        self.slip_loss = 0.0;
        let walls = self.contacts.chunk_by_mut(|a, b| a.wall == b.wall);
        let is_first_kick = self.is_first_kick;
        for (lanes, &law) in walls.zip(&self.laws) {
            let normal = model.walls[lanes[0].wall as usize].normal;
            let evaluation = WallEvaluation { kinematics, normal, law, is_first_kick };
            dispatch!(kinematics.level, simd => evaluation.add_all(simd, lanes, forces, &mut self.slip_loss));
        }
        forces.slip_loss = self.released + self.slip_loss;
    }

    /// Calls `add` with each particle behind these walls, at the velocities of `kinematics`: each is evaluated as in
    /// [`Self::add_forces`], with no other beside it.
    pub fn list(&self, model: &Model, kinematics: &Kinematics, add: &mut impl FnMut(WallParticle)) {
        let is_first_kick = self.is_first_kick;
        for (contacts, &law) in self.contacts.chunk_by(|a, b| a.wall == b.wall).zip(&self.laws) {
            let wall = contacts[0].wall as usize;
            let normal = model.walls[wall].normal;
            let evaluation = WallEvaluation { kinematics, normal, law, is_first_kick };
            for lanes in contacts {
                for lane in 0..lanes.count as usize {
                    let mut alone = [lanes.clone()];
                    alone[0].depth = [0.0; LANES];
                    alone[0].depth[lane] = lanes.depth[lane];
                    let (mut forces, mut slip_loss) = (BodyForces::default(), 0.0);
                    dispatch!(kinematics.level, simd => evaluation.add_all(simd, &mut alone, &mut forces, &mut slip_loss));
                    let (arm, depth) = (vector(&lanes.arm, lane), lanes.depth[lane]);
                    add(WallParticle { wall, arm, depth, wrench: forces.contact() });
                }
            }
        }
    }

    /// Appends the springs after the latest evaluation.
    pub fn store_springs(&self, kinematics: &Kinematics, springs: &mut Vec<FrictionSpring>) {
        for lanes in &self.contacts {
            for lane in 0..lanes.count as usize {
                let stretch = vector(&lanes.stretch, lane);
                // the anchor of a sticking contact keeps its bits
                let anchor = if lanes.slips >> lane & 1 == 1 {
                    kinematics.position + vector(&lanes.arm, lane) - stretch
                } else {
                    vector(&lanes.anchor, lane)
                };
                let particle = lanes.particle[lane];
                springs.push(FrictionSpring { wall: lanes.wall, particle, anchor, stretch });
            }
        }
    }
}

/// Vector from the anchor of a friction spring to its particle, along the wall (m).
fn stretch(model: &Model, kinematics: &Kinematics, spring: &FrictionSpring) -> DVec3 {
    let particles = kinematics.body.shape.particles();
    let arm = kinematics.rotation * particles.get(spring.particle as usize);
    let normal = model.walls[spring.wall as usize].normal;
    let stretch = kinematics.position + arm - spring.anchor;
    stretch - normal * stretch.dot(normal)
}

/// Energy in one friction spring (J).
pub(super) fn energy(model: &Model, kinematics: &Kinematics, spring: &FrictionSpring) -> f64 {
    let stiffness = kinematics.body.contacts[spring.wall as usize].friction_spring;
    let weight = kinematics.body.shape.particles().weight(spring.particle as usize);
    0.5 * stiffness * stretch(model, kinematics, spring).length_squared() * weight
}

impl WallContactLanes {
    /// Weights of the particles; lanes without a contact have no force to weight.
    fn weights(&self, particles: &Particles) -> [f64; LANES] {
        let mut weights = [0.0; LANES];
        for (weight, &particle) in weights.iter_mut().zip(&self.particle[..self.count as usize]) {
            *weight = particles.weight(particle as usize);
        }
        weights
    }
}

/// The springs of the previous step, sorted by wall and slot, those already matched taken off the front.
struct OldSprings<'a> {
    kinematics: &'a Kinematics<'a>,
    model: &'a Model,
    old: &'a [FrictionSpring],
    kick: Kick<'a>,
    released: f64,
}

impl OldSprings<'_> {
    /// Appends the contacts of the particles in `slots` with one wall, with the springs that they had; returns their sums.
    #[inline(always)]
    fn load<S: Simd>(
        &mut self,
        simd: S,
        wall: u32,
        near: &NearWall,
        slots: &[u32],
        contacts: &mut Vec<WallContactLanes>,
    ) -> WallPatch {
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let (mut weight, mut depths, mut deepest) = (zero, zero, zero);
                let mut moment = Vec3x8::splat(simd, DVec3::ZERO);
                for slots in slots.chunks(LANES) {
                    let count = slots.len() as u32;
                    let mut lanes = WallContactLanes { wall, count, ..WallContactLanes::default() };
                    self.compute_geometry(simd, near, slots, &mut lanes);
                    for (lane, &slot) in slots.iter().enumerate() {
                        if let Some(old) = self.take(wall, slot, lanes.particle[lane]) {
                            set(&mut lanes.anchor, lane, old.anchor);
                            set(&mut lanes.old_stretch, lane, old.stretch);
                        } else {
                            self.set_anchor_at_touch(near.normal, lane, &mut lanes);
                        }
                    }
                    let particles = self.kinematics.body.shape.particles();
                    let weights = f64x8::simd_from(simd, lanes.weights(particles));
                    let depth = f64x8::simd_from(simd, lanes.depth);
                    weight += weights;
                    depths += weights * depth;
                    moment += Vec3x8::load(simd, &lanes.arm) * (weights * depth);
                    deepest = deepest.simd_gt(depth).select(deepest, depth);
                    contacts.push(lanes);
                }
                WallPatch {
                    count: sum(weight),
                    depth: sum(depths),
                    moment: moment.sum(),
                    max_depth: largest(deepest),
                }
            },
        )
    }

    /// Arms, depths and touch factors of the particles, and an anchor at each of them.
    #[inline(always)]
    fn compute_geometry<S: Simd>(
        &self,
        simd: S,
        near: &NearWall,
        slots: &[u32],
        lanes: &mut WallContactLanes,
    ) {
        let (kinematics, particles) = (self.kinematics, self.kinematics.body.shape.particles());
        for (lane, &slot) in slots.iter().enumerate() {
            set(&mut lanes.arm, lane, particles.at(slot));
            lanes.particle[lane] = particles.index_of_slot(slot);
        }
        let r = Vec3x8::load(simd, &lanes.arm);
        let slope = Vec3x8::splat(simd, near.depth.slope);
        lanes.depth = (f64x8::splat(simd, near.depth.offset) - slope.dot(r)).into();
        lanes.depth[slots.len()..].fill(0.0);
        let arm = r.rotated(simd, kinematics.rotation);
        lanes.arm = arm.store();
        let u = Vec3x8::splat(simd, kinematics.velocity)
            + Vec3x8::splat(simd, kinematics.angular_velocity).cross(arm);
        let approach =
            u.dot(Vec3x8::splat(simd, near.normal)) * f64x8::splat(simd, -self.kick.length);
        let depth = f64x8::simd_from(simd, lanes.depth);
        lanes.touch = touch_factors(simd, depth, approach).into();
        lanes.anchor = (Vec3x8::splat(simd, kinematics.position) + arm).store();
    }

    /// Puts the anchor of a new contact to where the particle touched the wall, within the latest flight.
    fn set_anchor_at_touch(&self, normal: DVec3, lane: usize, lanes: &mut WallContactLanes) {
        let kinematics = self.kinematics;
        let arm = vector(&lanes.arm, lane);
        let u = kinematics.velocity + kinematics.angular_velocity.cross(arm);
        let closing = -u.dot(normal);
        let duration = self.kick.since_last.new_contact_duration(lanes.depth[lane], closing);
        let anchor = vector(&lanes.anchor, lane) - (u + normal * closing) * duration;
        set(&mut lanes.anchor, lane, anchor);
    }

    /// The spring that this contact had; springs that sort before it are released.
    fn take(&mut self, wall: u32, slot: u32, particle: u32) -> Option<FrictionSpring> {
        while let Some((first, rest)) = self.old.split_first() {
            if (first.wall, first.particle) == (wall, particle) {
                self.old = rest;
                return Some(*first);
            }
            let first_slot = self.kinematics.body.shape.particles().slot_of_index(first.particle);
            if (first.wall, first_slot).cmp(&(wall, slot)) == Ordering::Greater {
                return None;
            }
            self.release(first);
            self.old = rest;
        }
        None
    }

    /// Releases all springs that no contact has taken.
    fn release_all(&mut self) {
        for spring in std::mem::take(&mut self.old) {
            self.release(spring);
        }
    }

    /// Counts the energy of a spring whose particle has left the wall as lost to slip.
    fn release(&mut self, spring: &FrictionSpring) {
        let law = &self.kinematics.body.contacts[spring.wall as usize];
        let stretch = stretch(self.model, self.kinematics, spring);
        let weight = self.kinematics.body.shape.particles().weight(spring.particle as usize);
        self.released += 0.5 * law.friction_spring * spring.stretch.dot(stretch) * weight;
    }
}

/// Evaluation of the contacts of a body with one wall.
struct WallEvaluation<'a> {
    kinematics: &'a Kinematics<'a>,
    normal: DVec3,
    law: ContactLaw,
    is_first_kick: bool,
}

/// Weights of the particles of eight contacts; no multiplication where all particles weigh the same.
struct Weights<S: Simd, const WEIGHTED: bool>(f64x8<S>);

impl<S: Simd, const WEIGHTED: bool> Weights<S, WEIGHTED> {
    #[inline(always)]
    fn scale(&self, lanes: f64x8<S>) -> f64x8<S> {
        if WEIGHTED { lanes * self.0 } else { lanes }
    }

    #[inline(always)]
    fn scale_vector(&self, lanes: Vec3x8<S>) -> Vec3x8<S> {
        if WEIGHTED { lanes * self.0 } else { lanes }
    }
}

/// Sums over the contacts, lane by lane.
struct LaneSums<S: Simd> {
    spring: f64x8<S>,
    spring_arm: Vec3x8<S>,
    normal: f64x8<S>,
    normal_arm: Vec3x8<S>,
    friction: Vec3x8<S>,
    friction_torque: Vec3x8<S>,
    dashpot: Vec3x8<S>,
    dashpot_torque: Vec3x8<S>,
    slip_loss: f64x8<S>,
    max_depth: f64x8<S>,
}

impl WallEvaluation<'_> {
    #[inline(always)]
    fn add_all<S: Simd>(
        &self,
        simd: S,
        contacts: &mut [WallContactLanes],
        forces: &mut BodyForces,
        slip_loss: &mut f64,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut sums = LaneSums::zero(simd);
                let particles = self.kinematics.body.shape.particles();
                if particles.is_weighted() {
                    for lanes in contacts {
                        let weights = lanes.weights(particles);
                        self.add_lanes::<S, true>(simd, lanes, weights, &mut sums);
                    }
                } else {
                    for lanes in contacts {
                        self.add_lanes::<S, false>(simd, lanes, [1.0; LANES], &mut sums);
                    }
                }
                *slip_loss += sum(sums.slip_loss);
                sums.add_to(self.normal, forces);
            },
        );
    }

    /// Every force of a particle of weight w is w times that of a particle of weight 1, and so is the friction limit:
    /// whether a contact slips does not depend on w.
    #[inline(always)]
    fn add_lanes<S: Simd, const WEIGHTED: bool>(
        &self,
        simd: S,
        lanes: &mut WallContactLanes,
        weights: [f64; LANES],
        sums: &mut LaneSums<S>,
    ) {
        let (kinematics, law) = (self.kinematics, &self.law);
        let weights = Weights::<S, WEIGHTED>(f64x8::simd_from(simd, weights));
        let n = Vec3x8::splat(simd, self.normal);
        let arm = Vec3x8::load(simd, &lanes.arm);
        let depth = f64x8::simd_from(simd, lanes.depth);
        let u = Vec3x8::splat(simd, kinematics.velocity)
            + Vec3x8::splat(simd, kinematics.angular_velocity).cross(arm);

        // normal force
        let touch = f64x8::simd_from(simd, lanes.touch);
        let normal_law = LinearSpringDashpot {
            stiffness: f64x8::splat(simd, law.stiffness),
            damping: touch * law.damping,
        };
        let NormalForce { spring, total: normal } = normal_law.force(simd, depth, u.dot(n));
        let (weighted_spring, weighted_normal) = (weights.scale(spring), weights.scale(normal));
        sums.spring += weighted_spring;
        sums.spring_arm += arm * weighted_spring;
        sums.normal += weighted_normal;
        sums.normal_arm += arm * weighted_normal;
        sums.max_depth = sums.max_depth.simd_gt(depth).select(sums.max_depth, depth);

        // tangential spring to the anchor, limited to the friction limit
        let limit = normal * law.friction;
        let position = Vec3x8::splat(simd, kinematics.position) + arm;
        let stretch = (position - Vec3x8::load(simd, &lanes.anchor)).perpendicular_to(n);
        let tension = stretch.dot(stretch).sqrt() * law.friction_spring;
        let slips = tension.simd_gt(limit);
        let (old, tangential) = (Vec3x8::load(simd, &lanes.old_stretch), u.perpendicular_to(n));
        let longest = limit * (1.0 / law.friction_spring);
        let held = Vec3x8::select(slips, slip(simd, old, stretch, longest, tangential), stretch);
        // the flight before the first kick takes its work from that alone
        let before = if self.is_first_kick { held } else { old };
        let lost = (before + held).dot(stretch - held);
        sums.slip_loss += weights.scale(lost * (0.5 * law.friction_spring));
        let friction = held * f64x8::splat(simd, -law.friction_spring);
        let weighted_friction = weights.scale_vector(friction);
        sums.friction += weighted_friction;
        sums.friction_torque += arm.cross(weighted_friction);
        lanes.stretch = held.store();
        lanes.slips = slips.to_bitmask();

        // tangential dashpot, within what the spring leaves of the limit
        let dashpot = tangential * (touch * -law.friction_damping);
        let dashpot =
            weights.scale_vector(dashpot * dashpot_fraction(simd, friction, dashpot, limit));
        sums.dashpot += dashpot;
        sums.dashpot_torque += arm.cross(dashpot);
    }
}

impl<S: Simd> LaneSums<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let zeros = Vec3x8::splat(simd, DVec3::ZERO);
        Self {
            spring: zero,
            spring_arm: zeros,
            normal: zero,
            normal_arm: zeros,
            friction: zeros,
            friction_torque: zeros,
            dashpot: zeros,
            dashpot_torque: zeros,
            slip_loss: zero,
            max_depth: zero,
        }
    }

    /// Adds the sums over all lanes to the forces of a body.
    #[inline(always)]
    fn add_to(&self, normal: DVec3, forces: &mut BodyForces) {
        let spring = normal_wrench(normal, sum(self.spring), self.spring_arm.sum());
        let total = normal_wrench(normal, sum(self.normal), self.normal_arm.sum());
        forces.spring += spring;
        forces.dashpot += total - spring;
        forces.dashpot += Wrench { force: self.dashpot.sum(), torque: self.dashpot_torque.sum() };
        forces.friction +=
            Wrench { force: self.friction.sum(), torque: self.friction_torque.sum() };
        forces.max_depth = forces.max_depth.max(largest(self.max_depth));
    }
}

/// Wrench of forces f n at arms a, from Σ f and Σ f a.
fn normal_wrench(normal: DVec3, sum: f64, arm: DVec3) -> Wrench {
    Wrench { force: normal * sum, torque: arm.cross(normal) }
}
