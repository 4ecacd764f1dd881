//! What a user holds: build, step, read.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use crate::stage::{self, Pull};
use crate::{
    BodyForces, BodyModel, BodyState, Depths, Energy, Model, Scratch, State, StateError, StepError,
    Wrench, step::step,
};

/// A model and its state, and the means to advance it.
#[derive(Clone, Debug)]
pub struct World {
    model: Model,
    state: State,
    scratch: Scratch,
    /// A hand on a particle; not part of the state, since nothing in the world says where it goes.
    pull: Option<Pull>,
    pulled: f64,
}

impl World {
    pub(crate) fn of(model: Model, state: State) -> Self {
        Self { model, state, scratch: Scratch::default(), pull: None, pulled: 0.0 }
    }

    /// Advances time by one step of [`World::dt`].
    ///
    /// # Errors
    /// [`StepError`] when the new state cannot be trusted; the world then keeps it, for inspection.
    pub fn step(&mut self) -> Result<(), StepError> {
        let Some(hand) = self.pull else {
            return step(&self.model, &mut self.state, &mut self.scratch);
        };
        // half of the pull before and half after
        let h = 0.5 * self.model.dt;
        self.pulled += stage::pull(&self.model, &mut self.state, &hand, h);
        step(&self.model, &mut self.state, &mut self.scratch)?;
        self.pulled += stage::pull(&self.model, &mut self.state, &hand, h);
        Ok(())
    }

    /// Pulls a particle towards a place from the next step on, or lets go. Returns whether there is such a
    /// particle of a body that can be moved, and such a place; if not, nothing changes.
    pub fn pull(&mut self, hand: Option<Pull>) -> bool {
        let fits = hand.is_none_or(|Pull { body, particle, target }| {
            let body = self.model.bodies.get(body);
            let there =
                |body: &Arc<BodyModel>| body.is_free() && particle < body.shape.particles().len();
            body.is_some_and(there) && target.is_finite()
        });
        if fits {
            self.pull = hand;
        }
        fits
    }

    /// The work of all pulls so far (J): what [`World::energy`] has gained by them.
    pub fn pulled(&self) -> f64 {
        self.pulled
    }

    /// Goes on from `state`, as a checkpoint holds it: every step from here on gives the bits that it
    /// gave when the state was taken. A hand lets go, and [`World::pulled`] begins anew.
    ///
    /// # Errors
    /// [`StateError`] when the state is not one of this model; the world then keeps its own.
    pub fn restore(&mut self, state: State) -> Result<(), StateError> {
        state.fits(&self.model)?;
        (self.state, self.scratch) = (state, Scratch::default());
        (self.pull, self.pulled) = (None, 0.0);
        Ok(())
    }

    /// Drops everything that the next step would compute anew. No result changes.
    pub fn forget_scratch(&mut self) {
        self.scratch = Scratch::default();
    }

    /// Time t (s).
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Time step h (s).
    pub fn dt(&self) -> f64 {
        self.model.dt
    }

    /// What stays the same during the run.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// All that evolves.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// How many bodies there are.
    pub fn body_count(&self) -> usize {
        self.model.bodies.len()
    }

    /// One body, in the order in which they were added.
    ///
    /// # Panics
    /// When `index` is not below [`World::body_count`].
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

    /// What walls and other bodies did to one body in the latest step, by spring, dashpot and friction together.
    /// Zero before the first step, and for a body that touched nothing.
    pub fn contact_wrench(&self, index: usize) -> Wrench {
        self.scratch.forces.get(index).map_or_else(Wrench::default, BodyForces::contact)
    }

    /// How deep bodies are in each other and behind walls now.
    pub fn depths(&self) -> Depths {
        Depths::with(&self.model, &self.state, self.scratch.meeting.for_a_look())
    }

    /// Where the energy is, or went.
    pub fn energy(&self) -> Energy {
        Energy::with(&self.model, &self.state, self.scratch.meeting.for_a_look())
    }
}

/// Read access to one body.
#[derive(Clone, Copy, Debug)]
pub struct BodyView<'a> {
    name: &'a str,
    model: &'a BodyModel,
    state: &'a BodyState,
}

impl<'a> BodyView<'a> {
    /// Its name.
    pub fn name(&self) -> &'a str {
        self.name
    }

    /// Its mass, inertia, shape: all that is constant.
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

    /// Orientation q, body axes to world axes.
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

    /// How many particles it has.
    pub fn particle_count(&self) -> usize {
        self.model.shape.particles().len()
    }

    /// Place (m) and velocity (m/s) of one particle, world axes.
    ///
    /// # Panics
    /// When `index` is not below [`BodyView::particle_count`].
    pub fn particle(&self, index: usize) -> (DVec3, DVec3) {
        self.model.particle(self.state, index)
    }
}
