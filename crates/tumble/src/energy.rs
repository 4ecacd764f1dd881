//! The account of every joule.

use crate::stage::Placed;
use crate::{Model, State};

/// Where the energy of a run is, or went, at one moment (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// ½ M v² + ½ L·ω, over all bodies.
    pub kinetic: f64,
    /// −M g·x, zero at the origin.
    pub gravitational: f64,
    /// Stored in the springs of contacts.
    pub elastic: f64,
    /// Lost so far to the drag of the medium.
    pub drag: f64,
    /// Lost so far to the dashpots of contacts.
    pub dashpot: f64,
    /// Lost so far to slip against friction.
    pub slip: f64,
    /// What bodies whose motion is prescribed have put in so far.
    pub work: f64,
}

impl Energy {
    /// The ledger of a state.
    pub fn of(model: &Model, state: &State) -> Self {
        let mut energy = Self {
            drag: state.tally.drag,
            dashpot: state.tally.dashpot,
            slip: state.tally.slip,
            work: state.tally.work,
            ..Self::default()
        };
        for (index, body) in model.bodies.iter().enumerate() {
            let s = &state.bodies[index];
            let place = Placed::new(body, s);
            if !body.is_free() {
                continue;
            }
            energy.kinetic += place.kinetic_energy(s.angular_momentum);
            energy.gravitational -= body.mass * model.gravity.dot(s.position);
            energy.elastic += place.elastic_energy(model, &state.springs[index]);
        }
        energy
    }

    /// The sum of all columns, less the work put in. It keeps its first value, but for the integrator's error.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravitational + self.elastic + self.drag + self.dashpot + self.slip
            - self.work
    }
}
