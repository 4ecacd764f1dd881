//! The loop of a run: step to the next frame, write it, until the end or until told to stop.

use std::time::{Duration, Instant};

use tumble::{State, World, critical_dt};

use super::folder::{RunError, RunFolder};
use super::recording::Recording;
use super::summary::Summary;
use crate::plot::EnergyRow;
use crate::scene::{Loaded, Scene};

/// The clock is looked at after so much stepping, and somebody told of the progress.
const LOOK: Duration = Duration::from_millis(50);

/// How far a run has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Steps taken.
    pub step: u64,
    /// Steps to take.
    pub steps: u64,
    /// Simulated time (s).
    pub time: f64,
}

/// A run that is over.
#[derive(Debug)]
pub struct Finished {
    /// The run in a few numbers.
    pub summary: Summary,
    /// The ledger at its end.
    pub energy: EnergyRow,
    /// Steps taken since it was last resumed.
    pub steps_here: u64,
    /// What may surprise who wrote the scene.
    pub notes: Vec<&'static str>,
}

/// Runs a scene to its end and writes everything into `folder`.
///
/// `watch` hears of the progress some twenty times a second and returns whether to go on; when it
/// says no, what is done until then is written as for a finished run. Checkpoints are written at
/// the start, on the way and at the end, whichever end that is.
///
/// # Errors
/// [`RunError`]: the simulation failed, or a file cannot be written. No `summary.json` is left then.
pub fn run(
    loaded: Loaded,
    folder: &RunFolder,
    watch: &mut dyn FnMut(Progress) -> bool,
) -> Result<Finished, RunError> {
    let Loaded { scene, world } = loaded;
    folder.claim(&scene)?;
    let mut recording = Recording::start(folder, &scene, &world, world.energy().total())?;
    recording.frame(&world)?;
    // from now on there is always a state to go on from
    recording.checkpoint(&scene, world.state())?;
    Run::new(scene, world, recording).finish(folder, watch)
}

/// A run on its way.
pub(super) struct Run<'a> {
    scene: Scene,
    world: World,
    recording: Recording<'a>,
    /// Steps taken before.
    first: u64,
    /// Time spent in stepping alone.
    clock: Duration,
    /// A state that can be trusted, from before the latest steps.
    kept: State,
}

impl<'a> Run<'a> {
    /// With a frame of the world's state already written, if it has one.
    pub fn new(scene: Scene, world: World, recording: Recording<'a>) -> Self {
        let first = world.state().step;
        Self { scene, world, recording, first, clock: Duration::ZERO, kept: State::default() }
    }

    /// Steps to the end, or until `watch` says no, and writes everything.
    pub fn finish(
        mut self,
        folder: &RunFolder,
        watch: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Finished, RunError> {
        if let Err(error) = self.go(watch) {
            self.keep_last_good(&error);
            return Err(error);
        }
        self.recording.checkpoint(&self.scene, self.world.state())?;
        let energy = self.recording.finish(&self.scene, &self.world)?;
        let steps_here = self.world.state().step - self.first;
        let summary = summarise(&self.scene, &self.world, (steps_here, self.clock), &energy);
        let mut json = serde_json::to_string_pretty(&summary).unwrap_or_default();
        json.push('\n');
        folder.write("summary.json", json.as_bytes())?;
        Ok(Finished { summary, energy, steps_here, notes: notes(&self.scene) })
    }

    fn go(&mut self, watch: &mut dyn FnMut(Progress) -> bool) -> Result<(), RunError> {
        let steps = self.scene.step_count();
        while self.world.state().step < steps {
            let frame = self.scene.next_frame(self.world.state().step);
            let checkpoint = self.scene.next_checkpoint(self.world.state().step);
            let target = frame.min(steps).min(checkpoint.unwrap_or(steps));
            self.advance(target)?;
            let (step, time) = (self.world.state().step, self.world.time());
            if step == frame {
                self.recording.frame(&self.world)?;
            }
            if !watch(Progress { step, steps, time }) {
                break;
            }
            if Some(step) == checkpoint || self.recording.is_due() {
                self.recording.checkpoint(&self.scene, self.world.state())?;
            }
        }
        Ok(())
    }

    /// Steps to step number `target`, or until it is time to look at the clock.
    fn advance(&mut self, target: u64) -> Result<(), RunError> {
        keep(&mut self.kept, self.world.state());
        let batch = batch(&self.world);
        let start = Instant::now();
        let mut elapsed = Duration::ZERO;
        while self.world.state().step < target && elapsed < LOOK {
            // looking at the clock after every step would cost more than a step in flight
            for _ in 0..(target - self.world.state().step).min(batch) {
                self.world.step().map_err(RunError::Step)?;
            }
            elapsed = start.elapsed();
        }
        self.clock += elapsed;
        Ok(())
    }

    /// After a step that failed, a checkpoint of the last state before it that can be gone on from. The failure is what is to be
    /// told, whatever becomes of the checkpoint.
    fn keep_last_good(&mut self, error: &RunError) {
        let last = match error {
            RunError::Step(error) => error.step.saturating_sub(1),
            RunError::Energy(_) => self.kept.step,
            _ => return,
        };
        let mut good = std::mem::take(&mut self.kept);
        if self.world.restore(good.clone()).is_err() {
            return;
        }
        // the steps since then are taken once more, one by one
        while self.world.state().step < last {
            let stepped = self.world.step();
            if stepped.is_err() || self.world.state().check_fits(self.world.model()).is_err() {
                break;
            }
            keep(&mut good, self.world.state());
        }
        let _ = self.recording.checkpoint(&self.scene, &good);
    }
}

/// What is no error, but may not be what was meant.
fn notes(scene: &Scene) -> Vec<&'static str> {
    let apart = "the bodies do not touch each other: none has a `surface`";
    scene.bodies_pass_through().then_some(apart).into_iter().collect()
}

/// A copy, in the room of the one before.
fn keep(kept: &mut State, state: &State) {
    let State { step, time, bodies, springs, pair_springs, totals } = state;
    (kept.step, kept.time, kept.totals) = (*step, *time, *totals);
    kept.bodies.clone_from(bodies);
    kept.springs.clone_from(springs);
    kept.pair_springs.clone_from(pair_springs);
}

/// Steps between two looks at the clock: some hundred thousand particles' worth.
fn batch(world: &World) -> u64 {
    let particles: u64 = world.bodies().map(|body| body.particle_count() as u64).sum();
    (100_000 / (particles + 1)).clamp(1, 1000)
}

/// Steps and clock are those of this call; a run that was resumed has taken more before.
fn summarise(
    scene: &Scene,
    world: &World,
    (steps_here, clock): (u64, Duration),
    energy: &EnergyRow,
) -> Summary {
    let (steps, depths) = (world.state().step, world.penetration_depths());
    let seconds = clock.as_secs_f64();
    Summary {
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
        force_evaluations: world.state().totals.evaluations,
        max_depth: world.state().totals.max_depth.max(depths.bodies).max(depths.walls),
        body_depth_end: depths.bodies,
        wall_depth_end: depths.walls,
        state_hash: world.state().hash(),
    }
}
