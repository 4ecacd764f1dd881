//! Whether a state that comes from outside is one that a model can go on from.

use crate::{BodyModel, FrictionSpring, Model, State};

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
        /// [`FrictionSpring`] or [`Tally`](crate::Tally).
        quantity: &'static str,
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
        for (body, state) in model.bodies.iter().zip(&self.bodies) {
            let q = state.orientation;
            let values = [
                ("position", state.position.is_finite()),
                ("velocity", state.velocity.is_finite()),
                ("orientation", (q.length() - 1.0).abs() <= 1e-6),
                ("orientation_rest", state.orientation_rest.is_finite()),
                ("angular_momentum", state.angular_momentum.is_finite()),
                ("energy_owed", state.energy_owed.is_finite()),
            ];
            possible(&body.name, &values)?;
        }
        for (body, springs) in model.bodies.iter().zip(&self.springs) {
            fitting_springs(body, springs)?;
        }
        let tally = &self.tally;
        let values = [
            ("drag", tally.drag.is_finite()),
            ("dashpot", tally.dashpot.is_finite()),
            ("slip", tally.slip.is_finite()),
            ("max_depth", tally.max_depth.is_finite()),
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
fn fitting_springs(body: &BodyModel, springs: &[FrictionSpring]) -> Result<(), StateError> {
    let (walls, particles) = (body.contacts.len(), body.shape.particles());
    let mut before = None;
    for spring in springs {
        let there = (spring.wall as usize) < walls && (spring.particle as usize) < particles.len();
        let key = there.then(|| (spring.wall, particles.slot_of(spring.particle)));
        if key.is_none() || before >= key {
            return Err(StateError::Spring {
                body: body.name.clone(),
                wall: spring.wall,
                particle: spring.particle,
            });
        }
        let springs =
            [("anchor", spring.anchor.is_finite()), ("stretch", spring.stretch.is_finite())];
        possible(&body.name, &springs)?;
        before = key;
    }
    Ok(())
}
