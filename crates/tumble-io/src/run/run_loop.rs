//! The loop of a run: step to the next frame, record it, and repeat to the end.

use std::time::{Duration, Instant};

use tumble::{State, World};

use super::error::RunError;
use super::folder::{RunFolder, SUMMARY_FILE};
use super::kept_meshes::kept_toml;
use super::progress::{FinishedRun, Progress};
use super::recorder::Recorder;
use super::summary::Summary;
use crate::scene::{Loaded, Scene};

/// Wall-clock time between two reports of progress.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(50);

/// Runs a scene to its end and writes the results into `folder`.
///
/// `watch` receives the progress about twenty times a second and returns whether to continue. If it
/// returns `false`, the run stops and writes its results so far. Checkpoints are written at the
/// start, at intervals and at the end.
///
/// # Errors
/// [`RunError`] when a time step fails or a file cannot be written. There is no `summary.json` then.
pub fn run(
    loaded: Loaded,
    folder: &RunFolder,
    watch: &mut dyn FnMut(Progress) -> bool,
) -> Result<FinishedRun, RunError> {
    let Loaded { scene, world } = loaded;
    let scene_toml = folder.write_scene(kept_toml(&scene, folder))?;
    let energy_start = world.energy().total();
    let mut recorder = Recorder::start(folder, (&scene, &world), scene_toml, energy_start)?;
    recorder.record_frame(&world)?;
    // from here on the run can always be resumed
    recorder.write_checkpoint(&scene, world.state())?;
    RunLoop::new(scene, world, recorder).finish(folder, watch)
}

/// A run in progress.
pub(super) struct RunLoop<'a> {
    scene: Scene,
    world: World,
    recorder: Recorder<'a>,
    /// Step at which this part of the run began.
    first_step: u64,
    /// Wall-clock time of the time steps alone.
    stepping_time: Duration,
    /// A valid state from before the latest batch of steps.
    last_valid: State,
}

impl<'a> RunLoop<'a> {
    /// Prepares the loop. The caller has already recorded the current state if it is a frame.
    pub fn new(scene: Scene, mut world: World, recorder: Recorder<'a>) -> Self {
        world.keep_contacts(scene.output.contact_points);
        let first_step = world.state().step;
        let (stepping_time, last_valid) = (Duration::ZERO, State::default());
        Self { scene, world, recorder, first_step, stepping_time, last_valid }
    }

    /// Steps to the end, or until `watch` returns `false`, and writes the results.
    pub fn finish(
        mut self,
        folder: &RunFolder,
        watch: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<FinishedRun, RunError> {
        if let Err(error) = self.step_to_end(watch) {
            self.checkpoint_last_valid(&error);
            return Err(error);
        }
        self.recorder.write_checkpoint(&self.scene, self.world.state())?;
        let energy = self.recorder.finish(&self.scene, &self.world)?;
        let steps_here = self.world.state().step - self.first_step;
        let summary =
            Summary::new(&self.scene, &self.world, (steps_here, self.stepping_time), &energy);
        let mut json = serde_json::to_string_pretty(&summary).unwrap_or_default();
        json.push('\n');
        folder.write_file(SUMMARY_FILE, json.as_bytes())?;
        let warnings = self.world.deepest_body_contact().map(|deepest| deepest.warning());
        let warnings = warnings.into_iter().collect();
        let notes = notes(&self.scene, self.world.redundant_constraints());
        Ok(FinishedRun { summary, energy, steps_here, notes, warnings })
    }

    fn step_to_end(&mut self, watch: &mut dyn FnMut(Progress) -> bool) -> Result<(), RunError> {
        let steps = self.scene.step_count();
        while self.world.state().step < steps {
            let frame = self.scene.next_frame(self.world.state().step);
            let checkpoint = self.scene.next_checkpoint(self.world.state().step);
            let target = frame.min(steps).min(checkpoint.unwrap_or(steps));
            self.advance(target)?;
            let (step, time) = (self.world.state().step, self.world.time());
            if step == frame {
                self.recorder.record_frame(&self.world)?;
            }
            if !watch(Progress { step, steps, time }) {
                break;
            }
            if Some(step) == checkpoint || self.recorder.is_checkpoint_due() {
                self.recorder.write_checkpoint(&self.scene, self.world.state())?;
            }
        }
        Ok(())
    }

    /// Steps to step number `target`, or until progress is to be reported.
    fn advance(&mut self, target: u64) -> Result<(), RunError> {
        self.last_valid.copy_from(self.world.state());
        let batch = steps_per_clock_read(&self.world);
        let start = Instant::now();
        let mut elapsed = Duration::ZERO;
        while self.world.state().step < target && elapsed < PROGRESS_INTERVAL {
            // reading the clock costs more than a step without contact
            let count = (target - self.world.state().step).min(batch);
            self.world.steps(count).map_err(RunError::Step)?;
            elapsed = start.elapsed();
        }
        self.stepping_time += elapsed;
        Ok(())
    }

    /// After a failed step, writes a checkpoint of the last valid state before it.
    ///
    /// A failure to do so is ignored: the caller reports the failed step.
    fn checkpoint_last_valid(&mut self, error: &RunError) {
        let last = match error {
            RunError::Step(error) => error.step.saturating_sub(1),
            RunError::NonFiniteEnergy(_) => self.last_valid.step,
            _ => return,
        };
        let mut valid = std::mem::take(&mut self.last_valid);
        if self.world.restore(valid.clone()).is_err() {
            return;
        }
        // repeat the steps since then one by one
        while self.world.state().step < last {
            let stepped = self.world.step();
            if stepped.is_err() || self.world.state().check_fits(self.world.model()).is_err() {
                break;
            }
            valid.copy_from(self.world.state());
        }
        let _ = self.recorder.write_checkpoint(&self.scene, &valid);
    }
}

/// Notes on properties of the scene that the user may not expect; `redundant` constraints of its joints follow from others.
fn notes(scene: &Scene, redundant: usize) -> Vec<String> {
    let mut notes = scene.mesh_notes();
    notes.extend(surface_note(scene));
    if redundant > 0 {
        let plural = if redundant == 1 { " follows" } else { "s follow" };
        notes.push(format!(
            "{redundant} constraint{plural} from the others, as in a plane linkage of hinges: the motion is right, but how these share forces \
             is not determined, and joints.csv shows them as 0"
        ));
    }
    notes
}

/// Says which bodies have no contact surface, if others are there.
fn surface_note(scene: &Scene) -> Option<String> {
    let without = scene.without_surface();
    let first = without.first()?;
    if without.len() == scene.bodies.len() {
        return Some("the bodies do not touch each other: none has a `surface`".to_owned());
    }
    let others = match without.len() - 1 {
        0 => String::new(),
        count => format!(" and {count} more"),
    };
    let name = &first.name;
    Some(format!(
        "body \"{name}\"{others} touches other bodies with its particles alone, which may pass beside them: \
         give it a `surface`"
    ))
}

/// Steps between two reads of the clock: about 100,000 particle updates.
fn steps_per_clock_read(world: &World) -> u64 {
    let particles: u64 = world.bodies().map(|body| body.particle_count() as u64).sum();
    (100_000 / (particles + 1)).clamp(1, 1000)
}
