//! Whether a state that comes from outside is one that a model can go on from.

use crate::state::{PairOrder, pair_order};
use crate::{BodyModel, ContactKind, FrictionSpring, Model, PairSpring, State};

/// Why a state does not fit a model.
#[derive(Clone, Debug, PartialEq)]
pub enum StateError {
    /// It is of another number of bodies.
    BodyCount {
        /// Bodies of the model.
        model: usize,
        /// Bodies of the state.
        state: usize,
        /// Lists of friction springs, one a body.
        springs: usize,
    },
    /// Its time is not that of its step.
    Time {
        /// Time (s).
        time: f64,
        /// Steps times dt (s).
        expected: f64,
    },
    /// A quantity is NaN, infinite, or an orientation without a length near 1.
    Value {
        /// Name of the body; empty for a sum over all of them.
        body: String,
        /// The quantity: a field of [`BodyState`](crate::BodyState),
        /// [`FrictionSpring`] or [`RunTotals`](crate::RunTotals).
        quantity: &'static str,
    },
    /// A friction spring between bodies is of bodies, walls or particles that are not there or cannot touch so, or out of
    /// order.
    PairSpring {
        /// Index of the first body.
        first: u32,
        /// Index of the second body, or of the wall.
        second: u32,
    },
    /// A friction spring is of a wall or a particle that is not there, or out of order.
    Spring {
        /// Name of the body.
        body: String,
        /// Which wall.
        wall: u32,
        /// Which particle.
        particle: u32,
    },
}

impl std::fmt::Display for StateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BodyCount { model, state, springs } if state == springs => {
                write!(f, "the state is of {state} bodies, the scene has {model}")
            }
            Self::BodyCount { state, springs, .. } => {
                write!(f, "the state has {state} bodies, but friction springs of {springs}")
            }
            Self::Time { time, expected } => {
                write!(f, "the state's time is {time} s, but its steps take {expected} s")
            }
            Self::Value { body, quantity } if body.is_empty() => {
                write!(f, "`{quantity}` of the state is not a possible number")
            }
            Self::Value { body, quantity } => {
                write!(f, "`{quantity}` of body \"{body}\" is not a possible number")
            }
            Self::PairSpring { first, second } => write!(
                f,
                "bodies {first} and {second} (counted from 0) cannot have the friction spring that the state says"
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
    /// Checks that a run of `model` could have come to this state, as far as shapes and numbers tell.
    ///
    /// # Errors
    /// [`StateError`] names the first thing that does not fit.
    pub fn fits(&self, model: &Model) -> Result<(), StateError> {
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
                ("velocity", state.velocity.is_finite()),
                ("orientation", (q.length() - 1.0).abs() <= 1e-6),
                ("orientation_rest", state.orientation_rest.is_finite()),
                ("angular_momentum", state.angular_momentum.is_finite()),
                ("energy_owed", state.energy_owed.is_finite()),
            ];
            possible(name, &values)?;
        }
        for ((body, name), springs) in model.bodies.iter().zip(&model.names).zip(&self.springs) {
            fitting_springs(body, name, springs)?;
        }
        fitting_pair_springs(model, &self.pair_springs)?;
        let totals = &self.totals;
        let values = [
            ("drag", totals.drag.is_finite()),
            ("dashpot", totals.dashpot.is_finite()),
            ("slip", totals.slip.is_finite()),
            ("work", totals.work.is_finite()),
            ("max_depth", totals.max_depth.is_finite()),
        ];
        possible("", &values)
    }
}

fn possible(body: &str, values: &[(&'static str, bool)]) -> Result<(), StateError> {
    match values.iter().find(|(_, ok)| !ok) {
        Some((quantity, _)) => Err(StateError::Value { body: body.to_owned(), quantity }),
        None => Ok(()),
    }
}

/// Springs of walls and particles that are there, each once, in order.
fn fitting_springs(
    body: &BodyModel,
    name: &str,
    springs: &[FrictionSpring],
) -> Result<(), StateError> {
    let (walls, particles) = (body.contacts.len(), body.shape.particles());
    let mut before = None;
    for spring in springs {
        let there = (spring.wall as usize) < walls && (spring.particle as usize) < particles.len();
        let key = there.then(|| (spring.wall, particles.slot_of(spring.particle)));
        if key.is_none() || before >= key {
            return Err(StateError::Spring {
                body: name.to_owned(),
                wall: spring.wall,
                particle: spring.particle,
            });
        }
        let springs =
            [("anchor", spring.anchor.is_finite()), ("stretch", spring.stretch.is_finite())];
        possible(name, &springs)?;
        before = key;
    }
    Ok(())
}

/// Springs between bodies that are there and can touch so, each once, in order.
fn fitting_pair_springs(model: &Model, springs: &[PairSpring]) -> Result<(), StateError> {
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

/// By what springs between bodies are sorted; `None` for one that cannot be.
fn pair_key(model: &Model, spring: &PairSpring) -> Option<(PairOrder, u32, u32)> {
    let PairSpring { first, second, kind, particle, other, .. } = *spring;
    let body = |index: u32| model.bodies.get(index as usize);
    let slot = |index: u32, particle: u32| {
        let particles = body(index)?.shape.particles();
        ((particle as usize) < particles.len()).then(|| particles.slot_of(particle))
    };
    let a = body(first)?;
    let is_other = kind == ContactKind::SphereSphere || other == 0;
    let (particle, other) = match kind {
        ContactKind::SphereWall => {
            let there = a.has_spheres() && a.is_free() && (second as usize) < a.contacts.len();
            (slot(first, particle).filter(|_| there)?, 0)
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
    is_other.then_some((pair_order(first, second, kind), particle, other))
}
