//! The account of every joule.

use glam::DMat3;

use crate::{Model, State, stage};

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
}

impl Energy {
    /// The ledger of a state.
    pub fn of(model: &Model, state: &State) -> Self {
        let mut energy = Self {
            drag: state.tally.drag,
            dashpot: state.tally.dashpot,
            slip: state.tally.slip,
            ..Self::default()
        };
        for (body, s) in model.bodies.iter().zip(&state.bodies) {
            let rotation = DMat3::from_quat(s.orientation);
            let omega = body.angular_velocity(rotation, s.angular_momentum);
            energy.kinetic += 0.5 * body.mass * s.velocity.length_squared();
            energy.kinetic += 0.5 * s.angular_momentum.dot(omega);
            energy.gravitational -= body.mass * model.gravity.dot(s.position);
            energy.elastic += stage::elastic_energy(model, body, s);
        }
        energy
    }

    /// The sum of all columns. It keeps its first value, but for the integrator's error.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravitational + self.elastic + self.drag + self.dashpot + self.slip
    }
}
