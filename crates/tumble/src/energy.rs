//! The account of every joule.

use crate::contact::BodyContacts;
use crate::kinematics::Kinematics;
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
        Self::with(model, state, BodyContacts::default())
    }

    /// As [`Energy::of`]; reuses the neighbour lists of `contacts`.
    pub(crate) fn with(model: &Model, state: &State, mut contacts: BodyContacts) -> Self {
        let mut energy = Self {
            drag: state.totals.drag,
            dashpot: state.totals.dashpot,
            slip: state.totals.slip,
            work: state.totals.work,
            ..Self::default()
        };
        for (index, body) in model.bodies.iter().enumerate() {
            let s = &state.bodies[index];
            let kinematics = Kinematics::new(body, s);
            if !body.is_free() {
                continue;
            }
            energy.kinetic += kinematics.kinetic_energy(s.angular_momentum);
            energy.gravitational -= body.mass * model.gravity.dot(s.position);
            energy.elastic +=
                crate::contact::wall::elastic_energy(model, &kinematics, &state.springs[index]);
        }
        energy.elastic += contacts.elastic_energy(model, state);
        energy
    }

    /// The sum of all columns, less the work put in. It keeps its first value, but for the integrator's error.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravitational + self.elastic + self.drag + self.dashpot + self.slip
            - self.work
    }
}
