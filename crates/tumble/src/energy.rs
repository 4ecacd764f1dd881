//! The energy ledger.

use crate::contact::BodyContacts;
use crate::kinematics::Kinematics;
use crate::{Integrator, Model, State};

/// The energy of a run at one time, and its losses up to that time (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy ½ M v² + ½ L·ω of all free bodies.
    pub kinetic: f64,
    /// Potential energy −M g·x, zero at the origin, and that of central gravity, zero at infinity.
    pub gravitational: f64,
    /// Stored in the springs of contacts.
    pub elastic: f64,
    /// Total loss to the drag of the medium.
    pub drag: f64,
    /// Total loss to the dashpots of contacts.
    pub dashpot: f64,
    /// Total loss to frictional slip.
    pub slip: f64,
    /// Total loss to the implicit solution of the contact law, beyond dashpots and slip; negative where it adds energy.
    pub numerical: f64,
    /// Total work done by bodies with prescribed motion, and by loads.
    pub work: f64,
    /// Stored in the springs of joints.
    pub spring: f64,
    /// Total work done by the motors of joints.
    pub motor: f64,
    /// Total loss to friction, dampers and limits of joints.
    pub joint_friction: f64,
}

impl Energy {
    /// The ledger of a state.
    pub fn new(model: &Model, state: &State) -> Self {
        Self::from_contacts(model, state, BodyContacts::default())
    }

    /// As [`Energy::new`], reusing the neighbour lists of `contacts`.
    pub(crate) fn from_contacts(model: &Model, state: &State, mut contacts: BodyContacts) -> Self {
        let mut energy = Self {
            drag: state.totals.drag,
            dashpot: state.totals.dashpot,
            slip: state.totals.slip,
            numerical: state.totals.numerical,
            work: state.totals.work,
            motor: state.totals.motor,
            joint_friction: state.totals.joint_friction,
            spring: crate::joint::spring_energy(model, state),
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
            // the implicit solver has the contacts with walls among the others
            if model.integrator != Integrator::Implicit {
                energy.elastic +=
                    crate::contact::wall::elastic_energy(model, &kinematics, &state.springs[index]);
            }
        }
        energy.elastic += contacts.elastic_energy(model, state);
        energy.gravitational += model.loads.energy(model, state);
        energy
    }

    /// The sum of all terms minus the work of prescribed motions, loads and motors. It is constant up to the error of the integrator.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravitational + self.elastic + self.drag + self.dashpot + self.slip
            - self.work
            + self.numerical
            + (self.spring + self.joint_friction - self.motor)
    }
}
