//! Adaptive sub-steps: a step in contact is halved until its energy balance closes and its motion does not change.
//!
//! The contact force has kinks at touch and at release, and a step across a kink is only as accurate as it is short. A body in
//! contact therefore advances in sub-steps: one that is not accurate enough is repeated with half the length, one that is may be
//! followed by a longer one. The energy balance tells how accurate a sub-step is where springs alone act. Dashpots and slip are accounted
//! for whatever they take, so the balance closes even where they take too much. With them a sub-step is made twice,
//! with the kick in its middle and with half kicks at its ends, and the velocities must agree.
//!
//! Where contacts are undamped springs and drag is weak, large sub-steps are
//! composed of nine symmetric steps to order six (W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089, s9odr6a). Some of these go
//! backwards in time, which dashpots and slip do not allow; there a sub-step is one step of order two.
//!
//! What an accepted sub-step leaves unaccounted for is removed by scaling the contact impulse, as a discrete gradient
//! method does (O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449), so that small errors of one sign do not add up over thousands of
//! bounces. The tolerance still bounds how small they were.

use glam::DMat3;

use super::drift::drift_body;
use super::kick::kick_body;
use crate::contact::wall::{self, WallContactOutput, WallContacts, wall_contact_forces};
use crate::contact::{Kick, SinceKick};
use crate::kinematics::Kinematics;
use crate::{Batch, BodyForces, BodyModel, BodyState, FrictionSpring, Model, RunTotals, Wrench};

/// The shortest sub-step is 2^−MAX_HALVINGS of a step.
const MAX_HALVINGS: u32 = 24;
/// Sub-steps of at least 2^−MAX_COMPOSED_HALVINGS of a step are composed to order six.
const MAX_COMPOSED_HALVINGS: u32 = 4;
/// The impulse is scaled by at most this part of itself.
const MAX_CORRECTION: f64 = 0.5;
/// Lengths of the nine steps of the composition.
const WEIGHTS: [f64; 9] = [W1, W2, W3, W4, W5, W4, W3, W2, W1];
const W1: f64 = 0.392_161_444_007_314_1;
const W2: f64 = 0.332_599_136_789_359_43;
const W3: f64 = -0.706_246_172_557_639_3;
const W4: f64 = 0.082_213_596_293_550_8;
const W5: f64 = 0.798_543_990_934_83;

/// Advances every body that may touch a wall by one step, in sub-steps whose energy error is below `tolerance` times the
/// kinetic and elastic energy E, or that have the shortest length. With dashpots or friction the velocities after a kick
/// in the middle and after kicks at the ends differ by less than `tolerance` times √E, too, in the norm √(½ M v² + ½ ω·I ω).
pub fn substep(batch: &mut Batch, tolerance: f64) {
    let Batch {
        model,
        time,
        first,
        bodies,
        springs,
        may_touch,
        forces,
        next_springs,
        workspaces,
        ..
    } = batch;
    let workspace = &mut workspaces[0];
    for (index, body) in model.bodies[*first..].iter().take(bodies.len()).enumerate() {
        if !may_touch[index] {
            continue;
        }
        let mut stepper = BodyStepper {
            model,
            body,
            time: *time,
            state: &mut bodies[index],
            springs: &mut springs[index],
            forces: &mut forces[index],
            next_springs: &mut next_springs[index],
            contacts: &mut workspace.contacts,
            impulse: Wrench::default(),
        };
        workspace.totals += stepper.advance(&mut workspace.saved_springs, tolerance);
    }
}

/// One body, with the buffers to advance it.
struct BodyStepper<'a> {
    model: &'a Model,
    body: &'a BodyModel,
    /// Time at the beginning of the step (s).
    time: f64,
    state: &'a mut BodyState,
    springs: &'a mut Vec<FrictionSpring>,
    forces: &'a mut BodyForces,
    next_springs: &'a mut Vec<FrictionSpring>,
    contacts: &'a mut WallContacts,
    /// Contact impulse over the step so far (N·s, N·m·s).
    impulse: Wrench,
}

/// Mechanical energy of one body (J).
#[derive(Clone, Copy)]
struct MechanicalEnergy {
    kinetic: f64,
    gravitational: f64,
    elastic: f64,
}

impl MechanicalEnergy {
    fn total(self) -> f64 {
        self.kinetic + self.gravitational + self.elastic
    }

    /// A bound on the rounding error of the total.
    fn rounding(self) -> f64 {
        16.0 * f64::EPSILON * (self.kinetic + self.gravitational.abs() + self.elastic)
    }
}

impl BodyStepper<'_> {
    /// Advances the body by one step; returns what it adds to the totals.
    fn advance(
        &mut self,
        [saved_springs, springs_after]: &mut [Vec<FrictionSpring>; 2],
        tolerance: f64,
    ) -> RunTotals {
        let mut totals = RunTotals::default();
        let mut start = self.energy();
        let energy_at_start = start.kinetic + start.elastic;
        // position within the step and length of the sub-step, in units of the shortest sub-step
        let whole = 1u64 << MAX_HALVINGS;
        let (mut at, mut size) = (0, whole);
        while at < whole {
            let before = self.save(saved_springs);
            let part = self.sub_step(at, size);
            let end = self.energy();
            let touched = part.max_depth > 0.0 || start.elastic > 0.0 || end.elastic > 0.0;
            totals.evaluations += part.evaluations;
            let mut difference = 0.0;
            if touched && size > 1 && !self.is_elastic() {
                let after = self.save(springs_after);
                self.restore(before, saved_springs);
                totals.evaluations += self.kick_drift_kick(at, size).evaluations;
                difference = self.energy_of_difference(&after.0).sqrt();
                self.restore(after, springs_after);
            }
            let error = end.total() + part.lost() - start.total();
            let in_play = energy_at_start.max(end.kinetic + end.elastic);
            let bound = (tolerance * in_play).max(start.rounding() + end.rounding());
            let difference_bound = tolerance.max(16.0 * f64::EPSILON) * in_play.sqrt();
            let is_accurate = error.abs() <= bound && difference <= difference_bound;
            if touched && !is_accurate && size > 1 {
                self.restore(before, saved_springs);
                size /= 2;
                continue;
            }
            totals += RunTotals { evaluations: 0, ..part };
            self.state.energy_excess += error;
            if self.add_kinetic_energy(-self.state.energy_excess) {
                self.state.energy_excess = 0.0;
            }
            // the correction changes velocities only
            start = MechanicalEnergy { kinetic: self.kinetic_energy(), ..end };
            at += size;
            // double the length where the next sub-step would start and end on a multiple of it
            if at % (2 * size) == 0 && at + 2 * size <= whole {
                size *= 2;
            }
        }
        // report the contact wrench averaged over the step
        let (impulse, h) = (self.impulse, self.model.dt);
        self.forces.clear_contact();
        self.forces.spring = Wrench { force: impulse.force / h, torque: impulse.torque / h };
        self.forces.max_depth = totals.max_depth;
        totals
    }

    /// State and impulse now, with the friction springs in a buffer.
    fn save(&self, springs: &mut Vec<FrictionSpring>) -> (BodyState, Wrench) {
        springs.clone_from(self.springs);
        (*self.state, self.impulse)
    }

    /// Undoes all changes since [`Self::save`].
    fn restore(&mut self, saved: (BodyState, Wrench), springs: &Vec<FrictionSpring>) {
        (*self.state, self.impulse) = saved;
        self.springs.clone_from(springs);
    }

    /// Adds `energy` to the kinetic energy by scaling the contact impulse of the step by 1 + ε; returns whether that was
    /// possible.
    fn add_kinetic_energy(&mut self, energy: f64) -> bool {
        let Wrench { force: linear, torque: angular } = self.impulse;
        let rotation = DMat3::from_quat(self.state.orientation);
        let angular_velocity_change = self.body.angular_velocity(rotation, angular);
        // energy = ε (P·v + T·ω) + ε²/2 (P²/M + T·I⁻¹ T)
        let slope = linear.dot(self.state.velocity)
            + angular_velocity_change.dot(self.state.angular_momentum);
        let curvature =
            linear.length_squared() / self.body.mass + angular.dot(angular_velocity_change);
        let discriminant = slope * slope + 2.0 * curvature * energy;
        if discriminant <= 0.0 {
            return false;
        }
        let epsilon = 2.0 * energy / (slope + discriminant.sqrt().copysign(slope));
        if epsilon.is_nan() || epsilon.abs() > MAX_CORRECTION {
            return false;
        }
        self.state.velocity += linear * (epsilon / self.body.mass);
        self.state.angular_momentum += angular * epsilon;
        true
    }

    /// The kinetic energy of the difference between the velocities of this state and another one (J).
    fn energy_of_difference(&self, other: &BodyState) -> f64 {
        let difference = BodyState {
            velocity: self.state.velocity - other.velocity,
            angular_momentum: self.state.angular_momentum - other.angular_momentum,
            ..*self.state
        };
        Kinematics::new(self.body, &difference).kinetic_energy(difference.angular_momentum)
    }

    /// Whether all contacts are springs without losses.
    fn is_elastic(&self) -> bool {
        self.body.contacts.iter().all(|law| law.is_elastic())
    }

    /// Beginning and length (s) of a sub-step in units.
    fn start_and_length(&self, at: u64, size: u64) -> (f64, f64) {
        let unit = self.model.dt / (1u64 << MAX_HALVINGS) as f64;
        (self.time + at as f64 * unit, size as f64 * unit)
    }

    /// One sub-step of `size` units, which begins `at` units after the beginning of the step.
    fn sub_step(&mut self, at: u64, size: u64) -> RunTotals {
        let (start, h) = self.start_and_length(at, size);
        let is_weakly_damped =
            self.model.velocity_damping_stiffness / self.body.particle_mass() * h < 0.1;
        if !(self.is_elastic()
            && is_weakly_damped
            && size >> (MAX_HALVINGS - MAX_COMPOSED_HALVINGS) > 0)
        {
            return self.drift_kick_drift(start, h);
        }
        let mut totals = RunTotals::default();
        for weight in WEIGHTS {
            totals += self.drift_kick_drift(start, weight * h);
        }
        totals
    }

    /// A step of length `h` (s) at the time `start` (s).
    fn drift_kick_drift(&mut self, start: f64, h: f64) -> RunTotals {
        let mut totals = self.drift(0.5 * h);
        totals += self.kick(h, &SinceKick::at_sub_step(start + 0.5 * h, h));
        totals += self.drift(0.5 * h);
        totals
    }

    /// One sub-step of `size` units, with the kicks at its ends instead of its middle. It has an error of the same order but another sign,
    /// and sees contacts that begin after the middle.
    fn kick_drift_kick(&mut self, at: u64, size: u64) -> RunTotals {
        let (start, h) = self.start_and_length(at, size);
        let mut totals = self.kick(0.5 * h, &SinceKick::at_sub_step(start, h));
        totals += self.drift(h);
        totals += self.kick(0.5 * h, &SinceKick::at_sub_step(start + h, h));
        totals
    }

    /// A kick by the contact forces over the time `h` (s).
    fn kick(&mut self, h: f64, since_kick: &SinceKick) -> RunTotals {
        let output = WallContactOutput {
            forces: self.forces,
            next_springs: self.next_springs,
            contacts: self.contacts,
        };
        let (model, body) = (self.model, self.body);
        let kick = Kick { length: h, since_last: since_kick, start: None };
        wall_contact_forces(model, body, self.state, self.springs, output, kick);
        let totals = kick_body(self.body, self.state, self.forces, h);
        let contact = self.forces.contact();
        self.impulse += Wrench { force: contact.force * h, torque: contact.torque * h };
        std::mem::swap(self.springs, self.next_springs);
        totals
    }

    fn drift(&mut self, h: f64) -> RunTotals {
        let drag = drift_body(self.model, self.body, self.state, h);
        RunTotals { drag, ..RunTotals::default() }
    }

    fn kinetic_energy(&self) -> f64 {
        Kinematics::new(self.body, self.state).kinetic_energy(self.state.angular_momentum)
    }

    fn energy(&self) -> MechanicalEnergy {
        let kinematics = Kinematics::new(self.body, self.state);
        MechanicalEnergy {
            kinetic: kinematics.kinetic_energy(self.state.angular_momentum),
            gravitational: -self.body.mass * self.model.gravity.dot(self.state.position),
            elastic: wall::elastic_energy(self.model, &kinematics, self.springs),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use glam::DVec3;

    use crate::{Body, Damping, Material, Shape, WallPlane, World};

    /// Velocity and angular velocity after a bounce on a floor with dashpots, and the evaluations it took.
    fn bounce(points: &[DVec3], friction: f64, tolerance: f64) -> (DVec3, DVec3, u64) {
        let material = Material {
            collision_stiffness: 1e6,
            damping: Damping::Restitution(0.5),
            friction_stiffness: friction,
            ..Material::default()
        };
        let body = Body::new(Shape::from_particles(points).unwrap()).mass(1.0);
        let mut world = World::builder()
            .gravity(DVec3::ZERO)
            .dt(5e-4)
            .energy_tolerance(tolerance)
            .material(material)
            .wall(WallPlane { normal: DVec3::Y, offset: 0.0 })
            .body(body.position(DVec3::Y * 0.2503).velocity(DVec3::new(0.3, -1.0, 0.0)))
            .build()
            .unwrap();
        for _ in 0..800 {
            world.step().unwrap();
        }
        let body = world.body(0);
        (body.velocity(), body.angular_velocity(), world.state().totals.evaluations)
    }

    /// A particle leaves with the restitution that sets its dashpot. At a fixed step it is off by percents.
    #[test]
    fn the_tolerance_bounds_the_speed_after_a_bounce_with_dashpots() {
        for tolerance in [1e-3, 1e-4, 1e-5, 1e-6, 1e-8] {
            let (velocity, _, evaluations) = bounce(&[DVec3::ZERO], 0.0, tolerance);
            let error = (velocity.y - 0.5).abs();
            assert!(error < 50.0 * tolerance, "{tolerance}: {error}");
            assert!(evaluations < 20_000, "{tolerance}: {evaluations}");
        }
    }

    /// Three particles off the centre of mass slip, stick and turn; the reference is a far smaller tolerance.
    #[test]
    fn the_tolerance_bounds_the_motion_after_a_bounce_with_friction() {
        let points =
            [DVec3::new(0.1, 0.2, 0.03), DVec3::new(-0.1, 0.0, -0.05), DVec3::new(0.05, -0.1, 0.1)];
        let (velocity, omega, _) = bounce(&points, 0.3, 1e-9);
        assert!(velocity.y > 0.1 && omega.length() > 1.0, "{velocity} {omega}");
        for tolerance in [1e-3, 1e-5, 1e-7] {
            let found = bounce(&points, 0.3, tolerance);
            let error = (found.0 - velocity).length() + 0.1 * (found.1 - omega).length();
            assert!(error < 100.0 * tolerance, "{tolerance}: {error}");
        }
    }

    /// Sub-steps advance each body alone.
    #[test]
    fn a_tolerance_is_refused_where_bodies_collide() {
        let ball = Body::new(Shape::from_particles(&[DVec3::ZERO, DVec3::X]).unwrap())
            .surface(crate::Surface::Spheres { radius: 0.1 });
        let world = World::builder().energy_tolerance(1e-6).body(ball);
        let error = world.build().unwrap_err().to_string();
        let remedy = "`energy_tolerance` is 0.000001, but must be left out where bodies collide";
        assert!(error.contains(remedy) && error.contains("use a smaller `dt` instead"), "{error}");
    }
}
