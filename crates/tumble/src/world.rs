//! The simulated world: a model, its state, and the means to advance it.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use crate::stage::{self, MouseSpring};
use crate::{
    BodyDepth, BodyForces, BodyModel, BodyState, Contact, Energy, Integrator, Model,
    PenetrationDepths, Scratch, State, StateError, StepError, Wrench, contact_list, parallel,
    step::step,
};

/// A simulation: a model and its state, advanced step by step.
#[derive(Clone, Debug)]
pub struct World {
    model: Model,
    state: State,
    scratch: Scratch,
    /// The mouse spring. It is an external input and not part of the state.
    mouse_spring: Option<MouseSpring>,
    /// The work of the mouse spring (J).
    mouse_spring_work: f64,
    /// Whether [`World::contacts`] is to know the contacts of the next steps.
    keeps_contacts: bool,
    /// The state before the latest step, if it is kept.
    before: Option<Box<State>>,
}

impl World {
    pub(crate) fn new(model: Model, state: State) -> Self {
        Self {
            model,
            state,
            scratch: Scratch::default(),
            mouse_spring: None,
            mouse_spring_work: 0.0,
            keeps_contacts: false,
            before: None,
        }
    }

    /// Advances time by one step of [`World::dt`].
    ///
    /// # Errors
    /// [`StepError`] if the new state is not valid. The world keeps that state for inspection.
    pub fn step(&mut self) -> Result<(), StepError> {
        self.step_and_keep(self.keeps_contacts)
    }

    /// One step, after which [`World::contacts`] knows its contacts if `keeps` says so.
    fn step_and_keep(&mut self, keeps: bool) -> Result<(), StepError> {
        let Some(spring) = self.mouse_spring else {
            return self.advance(keeps);
        };
        // half of the impulse before the step and half after
        let h = 0.5 * self.model.dt;
        self.mouse_spring_work += self.apply_mouse_spring(&spring, h);
        self.advance(keeps)?;
        self.mouse_spring_work += self.apply_mouse_spring(&spring, h);
        Ok(())
    }

    /// One step without the mouse spring.
    fn advance(&mut self, keeps: bool) -> Result<(), StepError> {
        match &mut self.before {
            Some(before) if keeps => before.copy_from(&self.state),
            before => *before = keeps.then(|| Box::new(self.state.clone())),
        }
        step(&self.model, &mut self.state, &mut self.scratch)
    }

    fn apply_mouse_spring(&mut self, spring: &MouseSpring, h: f64) -> f64 {
        let all = (&mut self.state, &mut self.scratch);
        stage::apply_mouse_spring(&self.model, all, spring, h)
    }

    /// Advances time by `count` steps: as many calls of [`World::step`], but threads stay awake between them, so that it is faster.
    ///
    /// # Errors
    /// [`StepError`] of the first step whose state is not valid, which is the last one.
    pub fn steps(&mut self, count: u64) -> Result<(), StepError> {
        parallel::run(self.model.bodies.len(), || {
            // only those of the last step can be asked for
            let keeps = self.keeps_contacts;
            (1..=count).try_for_each(|number| self.step_and_keep(keeps && number == count))
        })
    }

    /// Attaches a mouse spring from the next step on, or removes it with `None`.
    ///
    /// Returns false, and changes nothing, if the body does not exist or is not free, the particle does not exist,
    /// or the target is not finite.
    pub fn set_mouse_spring(&mut self, spring: Option<MouseSpring>) -> bool {
        let is_valid = spring.is_none_or(|MouseSpring { body, particle, target }| {
            let body = self.model.bodies.get(body);
            let has_particle =
                |body: &Arc<BodyModel>| body.is_free() && particle < body.shape.particles().len();
            body.is_some_and(has_particle) && target.is_finite()
        });
        if is_valid {
            self.mouse_spring = spring;
        }
        is_valid
    }

    /// The total work of the mouse spring (J), which [`World::energy`] has gained.
    pub fn mouse_spring_work(&self) -> f64 {
        self.mouse_spring_work
    }

    /// Replaces the state, for example by one from a checkpoint. Later steps are the same, bit for bit, as in the
    /// run from which the state was taken. The mouse spring is removed, and [`World::mouse_spring_work`] is reset to zero.
    ///
    /// # Errors
    /// [`StateError`] if the state does not fit the model. The world then keeps its own state.
    pub fn restore(&mut self, state: State) -> Result<(), StateError> {
        state.check_fits(&self.model)?;
        (self.state, self.scratch) = (state, Scratch::default());
        (self.mouse_spring, self.mouse_spring_work) = (None, 0.0);
        self.before = None;
        Ok(())
    }

    /// Drops all cached data. No result changes.
    pub fn clear_scratch(&mut self) {
        self.scratch = Scratch::default();
        self.before = None;
    }

    /// Time t (s).
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Time step h (s).
    pub fn dt(&self) -> f64 {
        self.model.dt
    }

    /// The model: everything that is constant during the run.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The state: everything that evolves.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The number of bodies.
    pub fn body_count(&self) -> usize {
        self.model.bodies.len()
    }

    /// One body, by its index in the order in which bodies were added.
    ///
    /// # Panics
    /// If `index` is not below [`World::body_count`].
    pub fn body(&self, index: usize) -> BodyView<'_> {
        BodyView {
            name: &self.model.names[index],
            model: &self.model.bodies[index],
            state: &self.state.bodies[index],
        }
    }

    /// All bodies, in the order in which they were added.
    pub fn bodies(&self) -> impl ExactSizeIterator<Item = BodyView<'_>> {
        (0..self.body_count()).map(|index| self.body(index))
    }

    /// The total contact wrench on one body in the latest step: springs, dashpots and friction of contacts with walls
    /// and other bodies. Zero before the first step and without contact.
    pub fn contact_wrench(&self, index: usize) -> Wrench {
        self.scratch.forces.get(index).map_or_else(Wrench::default, BodyForces::contact)
    }

    /// The number of joints.
    pub fn joint_count(&self) -> usize {
        self.model.joints.list.len()
    }

    /// One joint, by its index in the order in which joints were added.
    ///
    /// # Panics
    /// If `index` is not below [`World::joint_count`].
    pub fn joint(&self, index: usize) -> JointView {
        let scale = 1.0 / self.model.dt;
        let impulse = self.scratch.joints.step_impulses.get(index).copied().unwrap_or_default();
        let [coordinate, rate] = crate::joint::coordinate_and_rate(&self.model, &self.state, index);
        let wrench = Wrench { force: impulse.force * scale, torque: impulse.torque * scale };
        JointView { wrench, coordinate, rate }
    }

    /// The number of constraints of joints that follow from others, in the present pose. How they share forces is not determined; those of
    /// the later ones are 0.
    pub fn redundant_constraints(&self) -> usize {
        crate::joint::redundant_constraints(&self.model, &self.state)
    }

    /// The largest error of the constraints of all joints now (m, or rad for directions).
    pub fn constraint_error(&self) -> f64 {
        crate::joint::constraint_error(&self.model, &self.state)
    }

    /// Whether [`World::contacts`] is to know the contacts of steps from the next one on; false at first. A step then copies its state.
    pub fn keep_contacts(&mut self, keep: bool) {
        self.keeps_contacts = keep;
    }

    /// The contacts of the latest step, one by one: by body, then by what it touches, walls first. Every contact is there once; its
    /// [`wrench_on`](Contact::wrench_on) a body, summed over all contacts, is the [`World::contact_wrench`] of the body.
    ///
    /// Places and forces are those at the kick of the step, which is in its middle (at its start under [`Integrator::Euler`]). Under
    /// [`Integrator::Implicit`] forces are means over the kick, and where a step was divided, those of its last part. With
    /// [`Model::energy_tolerance`] they are those of an undivided kick.
    ///
    /// Empty without [`World::keep_contacts`], and before the first step with it.
    pub fn contacts(&self) -> Vec<Contact> {
        let Some(before) = &self.before else { return Vec::new() };
        if self.model.integrator == Integrator::Implicit {
            return contact_list::solved_contacts(&self.state, &self.scratch);
        }
        parallel::run(self.model.bodies.len(), || {
            contact_list::contacts_of_step(&self.model, before)
        })
    }

    /// The largest penetration depths now.
    pub fn penetration_depths(&self) -> PenetrationDepths {
        PenetrationDepths::from_contacts(
            &self.model,
            &self.state,
            self.scratch.body_contacts.for_query(),
        )
    }

    /// The contact between two bodies that was deepest so far, relative to what they would have to pass through, if they
    /// were deep in each other. [`World::restore`] and [`World::clear_scratch`] forget it.
    pub fn deepest_body_contact(&self) -> Option<BodyDepth> {
        let deepest = self.scratch.body_contacts.deepest_contact()?;
        Some(BodyDepth::new(&self.model, &self.state, deepest))
    }

    /// The energy ledger now.
    pub fn energy(&self) -> Energy {
        Energy::from_contacts(&self.model, &self.state, self.scratch.body_contacts.for_query())
    }
}

/// What a joint did in the latest step, and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointView {
    /// The force on the first body (N) and the torque about the point of the joint (N·m), world axes: means over the step. They are those of
    /// constraints, springs, dampers, motors, friction and limits together.
    pub wrench: Wrench,
    /// The angle of a hinge from the start, counted beyond a turn (rad), the displacement of a slider from the start (m), the distance of
    /// the points of a rod, rope or spring (m), the angle of rotation of a ball joint from the start (rad, at most π), 0 of a weld.
    pub coordinate: f64,
    /// Its rate (rad/s or m/s).
    pub rate: f64,
}

/// Read access to one body.
#[derive(Clone, Copy, Debug)]
pub struct BodyView<'a> {
    name: &'a str,
    model: &'a BodyModel,
    state: &'a BodyState,
}

impl<'a> BodyView<'a> {
    pub(crate) fn new(name: &'a str, model: &'a BodyModel, state: &'a BodyState) -> Self {
        Self { name, model, state }
    }

    pub(crate) fn state(&self) -> &'a BodyState {
        self.state
    }

    /// The name.
    pub fn name(&self) -> &'a str {
        self.name
    }

    /// The constant data: mass, inertia, shape and so on.
    pub fn model(&self) -> &'a BodyModel {
        self.model
    }

    /// Centre of mass x (m).
    pub fn position(&self) -> DVec3 {
        self.state.position
    }

    /// Velocity v of the centre of mass (m/s).
    pub fn velocity(&self) -> DVec3 {
        self.state.velocity
    }

    /// Orientation q, from body axes to world axes.
    pub fn orientation(&self) -> DQuat {
        self.state.orientation
    }

    /// Angular momentum L about the centre of mass, world axes (kg·m²/s).
    pub fn angular_momentum(&self) -> DVec3 {
        self.state.angular_momentum
    }

    /// Angular velocity ω, world axes (rad/s).
    pub fn angular_velocity(&self) -> DVec3 {
        let rotation = DMat3::from_quat(self.state.orientation);
        self.model.angular_velocity(rotation, self.state.angular_momentum)
    }

    /// The number of particles.
    pub fn particle_count(&self) -> usize {
        self.model.shape.particles().len()
    }

    /// Position (m) and velocity (m/s) of one particle, world axes.
    ///
    /// # Panics
    /// If `index` is not below [`BodyView::particle_count`].
    pub fn particle(&self, index: usize) -> (DVec3, DVec3) {
        self.model.particle(self.state, index)
    }
}
