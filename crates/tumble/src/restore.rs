//! Checks whether a state, such as one from a checkpoint, fits a model.

use crate::contact::contact_particles;
use crate::state::{PairOrder, pair_order};
use crate::{
    BodyModel, ContactImpulse, ContactKind, FrictionSpring, Integrator, Model, PairSpring, State,
};

/// Why a state does not fit a model.
#[derive(Clone, Debug, PartialEq)]
pub enum StateError {
    /// The numbers of bodies differ.
    BodyCount {
        /// Bodies of the model.
        model: usize,
        /// Bodies of the state.
        state: usize,
        /// Lists of friction springs, one per body.
        springs: usize,
    },
    /// Its time is not that of its step.
    Time {
        /// The time of the state (s).
        time: f64,
        /// The number of steps times dt (s).
        expected: f64,
    },
    /// A quantity is NaN or infinite, or an orientation is not normalised.
    Value {
        /// Name of the body; empty for a quantity of the whole world.
        body: String,
        /// The quantity: a field of [`BodyState`](crate::BodyState),
        /// [`FrictionSpring`] or [`RunTotals`](crate::RunTotals).
        quantity: &'static str,
    },
    /// A friction spring between bodies refers to bodies, walls or particles that do not exist or cannot be in contact,
    /// or is out of order.
    PairSpring {
        /// Index of the first body.
        first: u32,
        /// Index of the second body, or of the wall.
        second: u32,
    },
    /// A friction spring refers to a wall or a particle that does not exist, or is out of order.
    Spring {
        /// Name of the body.
        body: String,
        /// Index of the wall.
        wall: u32,
        /// Index of the particle.
        particle: u32,
    },
}

fn bodies(count: usize) -> &'static str {
    if count == 1 { "body" } else { "bodies" }
}

impl std::fmt::Display for StateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BodyCount { model, state, springs } if state == springs => {
                let noun = bodies(*state);
                write!(f, "the state is of {state} {noun}, the scene has {model}")
            }
            Self::BodyCount { state, springs, .. } => {
                let noun = bodies(*state);
                write!(f, "the state has {state} {noun}, but friction springs of {springs}")
            }
            Self::Time { time, expected } => {
                write!(f, "the state's time is {time} s, but its steps take {expected} s")
            }
            Self::Value { body, quantity } if body.is_empty() => {
                write!(f, "`{quantity}` of the state is not a valid number")
            }
            Self::Value { body, quantity } => {
                write!(f, "`{quantity}` of body \"{body}\" is not a valid number")
            }
            Self::PairSpring { first, second } => write!(
                f,
                "the state has a friction spring between bodies {first} and {second} (counted from 0) that is not possible"
            ),
            Self::Spring { body, wall, particle } => write!(
                f,
                "body \"{body}\" cannot have a friction spring of particle {particle} at wall {wall}"
            ),
        }
    }
}

impl std::error::Error for StateError {}

impl State {
    /// Checks that counts, indices and numbers of this state are valid for `model`.
    ///
    /// # Errors
    /// [`StateError`] describes the first mismatch.
    pub fn check_fits(&self, model: &Model) -> Result<(), StateError> {
        let (bodies, springs) = (self.bodies.len(), self.springs.len());
        if bodies != model.bodies.len() || springs != bodies {
            return Err(StateError::BodyCount {
                model: model.bodies.len(),
                state: bodies,
                springs,
            });
        }
        let expected = self.step as f64 * model.dt;
        if self.time != expected {
            return Err(StateError::Time { time: self.time, expected });
        }
        for (name, state) in model.names.iter().zip(&self.bodies) {
            let q = state.orientation;
            let values = [
                ("position", state.position.is_finite()),
                ("position_compensation", state.position_compensation.is_finite()),
                ("velocity", state.velocity.is_finite()),
                ("orientation", (q.length() - 1.0).abs() <= 1e-6),
                ("orientation_compensation", state.orientation_compensation.is_finite()),
                ("angular_momentum", state.angular_momentum.is_finite()),
                ("energy_excess", state.energy_excess.is_finite()),
            ];
            check_values(name, &values)?;
        }
        for ((body, name), springs) in model.bodies.iter().zip(&model.names).zip(&self.springs) {
            check_springs(body, name, springs)?;
        }
        check_pair_springs(model, &self.pair_springs)?;
        let joints_ok = self.joints.len() == model.joints.list.len()
            && self.joints.iter().all(|joint| {
                joint.coordinate.is_finite() && joint.force.iter().all(|force| force.is_finite())
            });
        check_values("", &[("joints", joints_ok)])?;
        self.check_impulses(model)?;
        let is_valid = (0.0..=model.dt).contains(&self.since_kick);
        let divisions_ok = self.step_divisions <= crate::stage::MOST_DIVISIONS;
        check_values("", &[("since_kick", is_valid), ("step_divisions", divisions_ok)])?;
        let totals = &self.totals;
        let values = [
            ("drag", totals.drag.is_finite()),
            ("dashpot", totals.dashpot.is_finite()),
            ("slip", totals.slip.is_finite()),
            ("work", totals.work.is_finite()),
            ("numerical", totals.numerical.is_finite()),
            ("motor", totals.motor.is_finite()),
            ("joint_friction", totals.joint_friction.is_finite()),
            ("max_depth", totals.max_depth.is_finite()),
        ];
        check_values("", &values)
    }
}

impl State {
    /// Checks that there is one finite impulse for each spring if the model has impulses, and none otherwise.
    fn check_impulses(&self, model: &Model) -> Result<(), StateError> {
        let expected =
            if model.integrator == Integrator::Implicit { self.pair_springs.len() } else { 0 };
        let is_finite =
            |p: &ContactImpulse| p.normal >= 0.0 && (p.tangential * p.normal).is_finite();
        let impulses = &self.pair_impulses;
        let ok = impulses.len() == expected && impulses.iter().all(is_finite);
        check_values("", &[("pair_impulses", ok)])
    }
}

/// Refuses the first quantity that is not valid; `values` are names with whether they are.
fn check_values(body: &str, values: &[(&'static str, bool)]) -> Result<(), StateError> {
    match values.iter().find(|(_, ok)| !ok) {
        Some((quantity, _)) => Err(StateError::Value { body: body.to_owned(), quantity }),
        None => Ok(()),
    }
}

/// Checks that the walls and particles of springs exist, and that the springs are unique and in order.
fn check_springs(
    body: &BodyModel,
    name: &str,
    springs: &[FrictionSpring],
) -> Result<(), StateError> {
    let (walls, particles) = (body.contacts.len(), body.shape.particles());
    let mut before = None;
    for spring in springs {
        let exists = (spring.wall as usize) < walls && (spring.particle as usize) < particles.len();
        let key = exists.then(|| (spring.wall, particles.slot_of_index(spring.particle)));
        if key.is_none() || before >= key {
            return Err(StateError::Spring {
                body: name.to_owned(),
                wall: spring.wall,
                particle: spring.particle,
            });
        }
        let springs =
            [("anchor", spring.anchor.is_finite()), ("stretch", spring.stretch.is_finite())];
        check_values(name, &springs)?;
        before = key;
    }
    Ok(())
}

/// Checks that the contacts of springs between bodies are possible, and that the springs are unique and in order.
fn check_pair_springs(model: &Model, springs: &[PairSpring]) -> Result<(), StateError> {
    let mut before = None;
    for spring in springs {
        let key = pair_key(model, spring);
        if key.is_none() || before >= key || !spring.stretch.is_finite() {
            return Err(StateError::PairSpring { first: spring.first, second: spring.second });
        }
        before = key;
    }
    Ok(())
}

/// The sort key of a spring between bodies; `None` if its contact is not possible.
fn pair_key(model: &Model, spring: &PairSpring) -> Option<(PairOrder, u32, u32)> {
    let PairSpring { first, second, kind, particle, other, .. } = *spring;
    let body = |index: u32| model.bodies.get(index as usize);
    let solves = model.integrator == Integrator::Implicit;
    let slot = |index: u32, particle: u32| {
        let particles = contact_particles(body(index)?, kind);
        ((particle as usize) < particles.len()).then(|| particles.slot_of_index(particle))
    };
    let a = body(first)?;
    let has_valid_other = kind == ContactKind::SphereSphere || other == 0;
    let (particle, other) = match kind {
        ContactKind::SphereWall => {
            let is_possible =
                (a.has_spheres() || solves) && a.is_free() && (second as usize) < a.contacts.len();
            (slot(first, particle).filter(|_| is_possible)?, 0)
        }
        _ => {
            let b = body(second).filter(|_| first < second)?;
            if !crate::contact::can_touch(a, b, kind) {
                return None;
            }
            match kind {
                ContactKind::SphereSphere => (slot(first, particle)?, slot(second, other)?),
                ContactKind::MeshPoint => (slot(second, particle)?, 0),
                _ => (slot(first, particle)?, 0),
            }
        }
    };
    has_valid_other.then_some((pair_order(first, second, kind), particle, other))
}
