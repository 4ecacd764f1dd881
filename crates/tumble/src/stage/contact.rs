//! Line 9 and beyond: walls push back every particle that is behind them.
//!
//! Normal: a spring k δ and a dashpot c_n, whose sum never pulls. Tangential: a spring k_t between the
//! particle and the point of the wall where it arrived, its anchor, and a dashpot c_t, together at most μ
//! times the normal force (P. A. Cundall & O. D. L. Strack, Géotechnique 29 (1979) 47). Where the spring alone
//! would pull harder, its anchor slips after the particle.

use std::cmp::Ordering;

use glam::{DMat3, DVec3};

use crate::{
    BodyForces, BodyModel, BodyState, ContactLaw, FrictionSpring, Model, Particles, Scratch, State,
    WallPlane, Wrench,
};

/// Contact forces on every body that act over the time `h` (s): dashpots feel the mean of the
/// velocities before and after. With h = 0 they feel the velocities as they are.
pub fn contact(model: &Model, state: &State, scratch: &mut Scratch, h: f64) {
    for (index, body) in model.bodies.iter().enumerate() {
        if !scratch.near[index] {
            continue;
        }
        let room = (&mut scratch.forces[index], &mut scratch.springs[index]);
        contact_body(model, body, &state.bodies[index], &state.springs[index], room, h);
    }
}

/// Contact forces on one body; its forces, and the friction springs that go on, go to `room`.
pub(crate) fn contact_body(
    model: &Model,
    body: &BodyModel,
    state: &BodyState,
    springs: &[FrictionSpring],
    (forces, next): (&mut BodyForces, &mut Vec<FrictionSpring>),
    h: f64,
) {
    forces.clear_contact();
    next.clear();
    let far = |wall: &WallPlane| wall.depth(state.position) < -body.reach();
    if springs.is_empty() && model.walls.iter().all(far) {
        return;
    }
    let place = Placed::new(body, state);
    place.contact(model, springs, forces, next);
    if h != 0.0 && forces.max_depth > 0.0 && body.is_damped {
        // a second look with the mean velocity of the first makes the dashpots second order
        let mean = place.half_kicked(&forces.contact(), h);
        mean.contact(model, springs, forces, next);
    }
}

/// A body at one place, with the velocities that its contacts are to feel.
pub(crate) struct Placed<'a> {
    body: &'a BodyModel,
    position: DVec3,
    rotation: DMat3,
    velocity: DVec3,
    angular_velocity: DVec3,
}

impl<'a> Placed<'a> {
    /// With the velocities of `state`.
    pub fn new(body: &'a BodyModel, state: &BodyState) -> Self {
        let rotation = DMat3::from_quat(state.orientation);
        Self {
            body,
            position: state.position,
            rotation,
            velocity: state.velocity,
            angular_velocity: body.angular_velocity(rotation, state.angular_momentum),
        }
    }

    /// At the same place, half a kick of `wrench` over the time `h` later.
    pub fn half_kicked(&self, wrench: &Wrench, h: f64) -> Self {
        let spin = self.body.angular_velocity(self.rotation, wrench.torque);
        Self {
            velocity: self.velocity + wrench.force * (0.5 * h / self.body.mass),
            angular_velocity: self.angular_velocity + spin * (0.5 * h),
            ..*self
        }
    }

    /// What takes energy along this motion: −(F·v + τ·ω) (W).
    pub fn power_lost(&self, wrench: &Wrench) -> f64 {
        -(wrench.force.dot(self.velocity) + wrench.torque.dot(self.angular_velocity))
    }

    /// ½ M v² + ½ L·ω (J).
    pub fn kinetic_energy(&self, angular_momentum: DVec3) -> f64 {
        0.5 * self.body.mass * self.velocity.length_squared()
            + 0.5 * angular_momentum.dot(self.angular_velocity)
    }

    /// Contact with all walls; `next` becomes the friction springs that go on from `old`.
    pub fn contact(
        &self,
        model: &Model,
        old: &[FrictionSpring],
        forces: &mut BodyForces,
        next: &mut Vec<FrictionSpring>,
    ) {
        next.clear();
        forces.clear_contact();
        let mut touch = Touch { place: self, model, old, forces, next };
        for (index, (wall, law)) in model.walls.iter().zip(&self.body.contacts).enumerate() {
            let Some(carried) = CarriedWall::near(wall, self) else {
                continue;
            };
            if law.is_elastic() {
                touch.springs_only(&carried, law);
            } else {
                touch.every_particle(&carried, law, index as u32);
            }
        }
        touch.release_all();
    }

    /// Energy in the contact springs, normal and tangential (J).
    pub fn elastic_energy(&self, model: &Model, springs: &[FrictionSpring]) -> f64 {
        let mut energy = 0.0;
        for (wall, law) in model.walls.iter().zip(&self.body.contacts) {
            if let Some(carried) = CarriedWall::near(wall, self) {
                let depths = carried.depths(self.body.shape.particles());
                energy += 0.5 * law.stiffness * depths.sum_of_squares;
            }
        }
        energy + springs.iter().map(|spring| self.stored(model, spring)).sum::<f64>()
    }

    /// Energy in one friction spring (J).
    fn stored(&self, model: &Model, spring: &FrictionSpring) -> f64 {
        let wall = spring.wall as usize;
        let arm = self.rotation * self.body.shape.particles().get(spring.particle as usize);
        let stretch = tangential(self.position + arm - spring.anchor, model.walls[wall].normal);
        0.5 * self.body.contacts[wall].friction_spring * stretch.length_squared()
    }
}

/// The part of `v` along the wall.
fn tangential(v: DVec3, normal: DVec3) -> DVec3 {
    v - normal * v.dot(normal)
}

/// One evaluation of a body's contacts.
struct Touch<'a> {
    place: &'a Placed<'a>,
    model: &'a Model,
    /// The springs of before, sorted by wall and particle, those already met taken off the front.
    old: &'a [FrictionSpring],
    forces: &'a mut BodyForces,
    next: &'a mut Vec<FrictionSpring>,
}

impl Touch<'_> {
    /// F = k Σ δᵢ n and τ = R (k Σ δᵢ rᵢ × n_b).
    fn springs_only(&mut self, wall: &CarriedWall, law: &ContactLaw) {
        let depths = wall.depths(self.place.body.shape.particles());
        let k = law.stiffness;
        self.forces.spring += Wrench {
            force: k * depths.sum * wall.world_normal,
            torque: self.place.rotation * (k * depths.moment.cross(wall.normal)),
        };
        self.forces.max_depth = self.forces.max_depth.max(depths.deepest);
    }

    fn every_particle(&mut self, wall: &CarriedWall, law: &ContactLaw, index: u32) {
        let particles = self.place.body.shape.particles();
        let (x, y, z) = particles.coordinates();
        for i in 0..x.len() {
            let behind = wall.normal.x * x[i] + wall.normal.y * y[i] + wall.normal.z * z[i];
            let depth = wall.offset - behind;
            if depth > 0.0 {
                self.particle(wall, law, (index, i as u32), depth);
            }
        }
    }

    fn particle(&mut self, wall: &CarriedWall, law: &ContactLaw, key: (u32, u32), depth: f64) {
        let place = self.place;
        let n = wall.world_normal;
        let arm = place.rotation * place.body.shape.particles().get(key.1 as usize);
        let u = place.velocity + place.angular_velocity.cross(arm);
        let spring = law.stiffness * depth;
        let normal = (spring - law.damping * u.dot(n)).max(0.0);
        self.forces.spring += at(arm, n * spring);
        self.forces.dashpot += at(arm, n * (normal - spring));
        self.forces.max_depth = self.forces.max_depth.max(depth);
        if law.friction == 0.0 {
            return;
        }
        let here = place.position + arm;
        let mut anchor = self.anchor(key).unwrap_or(here);
        let mut stretch = tangential(here - anchor, n);
        let limit = law.friction * normal;
        let pull = law.friction_spring * stretch.length();
        if pull > limit {
            // the work of the force that slips, along the way that the anchor slips
            self.forces.slip += limit * (pull - limit) / law.friction_spring;
            stretch *= limit / pull;
            anchor = here - stretch;
        }
        let hold = stretch * -law.friction_spring;
        let brake = within(hold, tangential(u, n) * -law.friction_damping, limit);
        self.forces.friction += at(arm, hold);
        self.forces.dashpot += at(arm, brake);
        self.next.push(FrictionSpring { wall: key.0, particle: key.1, anchor });
    }

    /// The anchor that this contact had before; springs passed over on the way have come free.
    fn anchor(&mut self, key: (u32, u32)) -> Option<DVec3> {
        while let Some((first, rest)) = self.old.split_first() {
            match (first.wall, first.particle).cmp(&key) {
                Ordering::Less => self.release(first),
                Ordering::Equal => {
                    self.old = rest;
                    return Some(first.anchor);
                }
                Ordering::Greater => return None,
            }
            self.old = rest;
        }
        None
    }

    /// The springs that no contact has asked for have come free.
    fn release_all(&mut self) {
        for spring in std::mem::take(&mut self.old) {
            self.release(spring);
        }
    }

    /// A spring whose particle has left is gone, and its energy is lost to slip.
    fn release(&mut self, spring: &FrictionSpring) {
        self.forces.slip += self.place.stored(self.model, spring);
    }
}

/// A force on the particle at `arm`, as a wrench about the centre of mass.
fn at(arm: DVec3, force: DVec3) -> Wrench {
    Wrench { force, torque: arm.cross(force) }
}

/// As much of `brake` as can be added to `hold` without the sum being longer than `limit`.
fn within(hold: DVec3, brake: DVec3, limit: f64) -> DVec3 {
    // the larger root of |hold + β brake|² = limit²
    let a = brake.length_squared();
    let b = hold.dot(brake);
    let c = (hold.length_squared() - limit * limit).min(0.0);
    if a == 0.0 {
        return DVec3::ZERO;
    }
    let beta = ((b * b - a * c).max(0.0).sqrt() - b) / a;
    brake * beta.clamp(0.0, 1.0)
}

/// A wall seen from the body frame: δᵢ = d_b − n_b·rᵢ, and no particle is rotated.
struct CarriedWall {
    /// n_b = Rᵀ n.
    normal: DVec3,
    /// d_b = d − n·x (m).
    offset: f64,
    /// n.
    world_normal: DVec3,
}

/// Sums over the particles behind a wall.
struct Depths {
    /// Σ δᵢ (m).
    sum: f64,
    /// Σ δᵢ rᵢ (m²).
    moment: DVec3,
    /// Σ δᵢ² (m²).
    sum_of_squares: f64,
    /// max δᵢ (m).
    deepest: f64,
}

impl CarriedWall {
    /// `None` where the wall is out of reach of the whole body.
    fn near(wall: &WallPlane, place: &Placed) -> Option<Self> {
        let offset = wall.depth(place.position);
        // the farthest particle is not behind the wall: none is
        if offset < -place.body.reach() {
            return None;
        }
        let normal = place.rotation.transpose() * wall.normal;
        Some(Self { normal, offset, world_normal: wall.normal })
    }

    /// The depths of all particles, summed in a fixed order: eight lanes, then their sum.
    fn depths(&self, particles: &Particles) -> Depths {
        const LANES: usize = 8;
        let (x, y, z) = particles.coordinates();
        let mut lanes = [[0.0f64; LANES]; 6];
        let mut at = 0;
        while at < x.len() {
            let end = (at + LANES).min(x.len());
            for (lane, i) in (at..end).enumerate() {
                let behind = self.normal.x * x[i] + self.normal.y * y[i] + self.normal.z * z[i];
                let depth = (self.offset - behind).max(0.0);
                lanes[0][lane] += depth;
                lanes[1][lane] += depth * x[i];
                lanes[2][lane] += depth * y[i];
                lanes[3][lane] += depth * z[i];
                lanes[4][lane] += depth * depth;
                lanes[5][lane] = lanes[5][lane].max(depth);
            }
            at = end;
        }
        let sum = |lane: [f64; LANES]| lane.iter().sum::<f64>();
        Depths {
            sum: sum(lanes[0]),
            moment: DVec3::new(sum(lanes[1]), sum(lanes[2]), sum(lanes[3])),
            sum_of_squares: sum(lanes[4]),
            deepest: lanes[5].iter().fold(0.0, |m, &d| m.max(d)),
        }
    }
}
