//! `summary.json`: the run in a few numbers.

use std::time::Duration;

use serde::Serialize;
use tumble::{Integrator, World, contact_time, critical_dt};

use crate::plot::EnergyRow;
use crate::scene::Scene;

/// How well the time step resolves contacts with dashpots.
#[derive(Clone, Debug, Serialize)]
pub struct ContactSteps {
    /// The body with the shortest contacts.
    pub body: String,
    /// Estimated duration of its contacts (s).
    pub seconds: f64,
    /// Steps per contact.
    pub steps: f64,
    /// The largest time step for a rebound with the given restitution, to about 0.01 (s).
    pub dt_for_restitution: f64,
}

impl ContactSteps {
    /// `None` if no contact has a dashpot, and with the integrator `implicit`, which needs no resolution of contacts.
    pub fn new(world: &World) -> Option<Self> {
        if world.model().integrator == Integrator::Implicit {
            return None;
        }
        let time = contact_time(world.model())?;
        let dt_for_restitution = time.dt_for_restitution();
        let steps = time.seconds / world.dt();
        Some(Self { body: time.body, seconds: time.seconds, steps, dt_for_restitution })
    }

    /// A warning, if the time step is too long.
    pub fn warning(&self, dt: f64) -> Option<String> {
        let Self { body, seconds, steps, dt_for_restitution: enough } = self;
        (dt > *enough).then(|| {
            format!(
                "the contacts of \"{body}\" last about {seconds:.2e} s, {steps:.1} steps of dt = {dt} s: too few for its \
                 restitution; set dt to {enough:.2e} or less"
            )
        })
    }
}

/// What the implicit solver did.
#[derive(Clone, Debug, Serialize)]
pub struct SolverSummary {
    /// Iterations in all steps.
    pub iterations: u64,
    /// Steps in which they ended before the impulses had converged.
    pub steps_not_converged: u64,
    /// Energy lost to the implicit solution of the contact law (J).
    pub energy_numerical: f64,
}

impl SolverSummary {
    fn new(world: &World) -> Option<Self> {
        let totals = &world.state().totals;
        (world.model().integrator == Integrator::Implicit).then_some(Self {
            iterations: totals.iterations,
            steps_not_converged: totals.not_converged,
            energy_numerical: totals.numerical,
        })
    }
}

/// The contents of `summary.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Version of the program.
    pub version: String,
    /// Name of the scene.
    pub scene: String,
    /// Name of the integrator.
    pub integrator: String,
    /// Time step (s).
    pub dt: f64,
    /// Requested simulated time (s).
    pub duration: f64,
    /// Simulated time reached (s).
    pub time: f64,
    /// Whether the run was stopped before its duration.
    pub interrupted: bool,
    /// Steps taken.
    pub steps: u64,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of particles of all bodies.
    pub particles: u64,
    /// Wall-clock time of the time steps alone, since the run was last resumed (s).
    pub wall_seconds: f64,
    /// Steps per second of `wall_seconds`.
    pub steps_per_second: f64,
    /// Total energy at the start (J).
    pub energy_start: f64,
    /// Total energy at the end, including dissipated energy (J).
    pub energy_end: f64,
    /// End minus start: the error of the integrator (J).
    pub energy_residual: f64,
    /// Largest time step at which contacts are stable (s); absent if no contact is possible.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub critical_dt: Option<f64>,
    /// How well the time step resolves contacts with dashpots, if there are any.
    pub contact_time: Option<ContactSteps>,
    /// Of the integrator `implicit`: iterations of the solver, steps in which they did not converge, and the energy lost to the
    /// implicit solution (J).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solver: Option<SolverSummary>,
    /// Number of evaluations of the contact forces of a body.
    pub force_evaluations: u64,
    /// Largest penetration depth of the run (m), over all force evaluations and the last state.
    pub max_depth: f64,
    /// Largest penetration depth between two bodies at the end (m).
    pub body_depth_end: f64,
    /// Largest penetration depth into a wall at the end (m).
    pub wall_depth_end: f64,
    /// Hash of the last state, see [`State::hash`](tumble::State::hash).
    pub state_hash: String,
}

impl Summary {
    /// Summarises a run at its end. `steps_here` steps took `stepping_time` since it was last resumed.
    pub(super) fn new(
        scene: &Scene,
        world: &World,
        (steps_here, stepping_time): (u64, Duration),
        energy: &EnergyRow,
    ) -> Self {
        let (steps, depths) = (world.state().step, world.penetration_depths());
        let seconds = stepping_time.as_secs_f64();
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: scene.name.clone(),
            integrator: scene.integrator.name().to_owned(),
            dt: scene.dt,
            duration: scene.duration,
            time: world.time(),
            interrupted: steps < scene.step_count(),
            steps,
            bodies: world.body_count(),
            particles: world.bodies().map(|body| body.particle_count() as u64).sum(),
            wall_seconds: seconds,
            steps_per_second: if seconds > 0.0 { steps_here as f64 / seconds } else { 0.0 },
            energy_start: energy.total - energy.residual,
            energy_end: energy.total,
            energy_residual: energy.residual,
            critical_dt: critical_dt(world.model()).map(|critical| critical.dt),
            contact_time: ContactSteps::new(world),
            solver: SolverSummary::new(world),
            force_evaluations: world.state().totals.evaluations,
            max_depth: world.state().totals.max_depth.max(depths.bodies).max(depths.walls),
            body_depth_end: depths.bodies,
            wall_depth_end: depths.walls,
            state_hash: world.state().hash(),
        }
    }
}
