//! Resumes a run from a checkpoint. The results are bitwise those of an uninterrupted run.

use std::path::Path;

use super::error::RunError;
use super::folder::{CHECKPOINT_FILE, FILES, RunFolder, SCENE_FILE, SUMMARY_FILE};
use super::kept_meshes::kept_toml;
use super::progress::{FinishedRun, Progress};
use super::recorded_rows::RecordedRows;
use super::recorder::Recorder;
use super::resume_error::ResumeError;
use super::run_loop::RunLoop;
use crate::checkpoint::{Checkpoint, read_checkpoint};
use crate::scene::{LoadOptions, Loaded, Source, load_recorded, read_scene_text};

/// A run that is ready to be resumed.
#[derive(Debug)]
pub struct Resumption {
    loaded: Loaded,
    energy_start: f64,
    checkpoint_folder: RunFolder,
    recorded: Option<RecordedRows>,
}

impl Resumption {
    /// Reads a checkpoint, its scene and meshes, and the rows in its folder.
    ///
    /// `path` is the checkpoint or its folder. `duration`, if given, replaces the duration of the
    /// scene (s); it is the text that the user wrote. `in_place` states that the run continues in
    /// the folder of the checkpoint.
    ///
    /// # Errors
    /// [`ResumeError`]. No file has been changed.
    pub fn prepare(
        path: &Path,
        duration: Option<&str>,
        in_place: bool,
    ) -> Result<Self, ResumeError> {
        let path = if path.is_dir() { path.join(CHECKPOINT_FILE) } else { path.to_owned() };
        let mut folder = RunFolder::from_path(path.parent().unwrap_or(Path::new(".")));
        // before the checkpoint is read: a run that is still going would replace it
        if in_place && path.is_file() {
            folder = folder.locked().map_err(ResumeError::Folder)?;
        }
        let checkpoint =
            read_checkpoint(&path).map_err(|error| ResumeError::Checkpoint(path.clone(), error))?;
        let scene_beside = read_scene_text(&folder.file_path(SCENE_FILE)).unwrap_or_default();
        let is_same_run = are_same_run(&scene_beside, &checkpoint.scene);
        let exists = |name: &str| folder.file_path(name).symlink_metadata().is_ok();
        let has_run_files = FILES.iter().any(|&name| name != CHECKPOINT_FILE && exists(name));
        if in_place && has_run_files && !is_same_run {
            return Err(ResumeError::OtherRun(folder.path().to_owned()));
        }
        let energy_start = checkpoint.energy_start;
        let loaded = load(checkpoint, &path, duration)?;
        let (state, scene) = (loaded.world.state(), &loaded.scene);
        // a run at its end may still lack its pictures
        let unfinished = in_place && is_same_run && !exists(SUMMARY_FILE);
        let steps = scene.step_count();
        if steps < state.step || (steps == state.step && !unfinished) {
            return Err(ResumeError::Done { time: state.time, duration: scene.duration });
        }
        let recorded =
            if is_same_run { RecordedRows::read(&folder, scene, &loaded.world)? } else { None };
        Ok(Self { loaded, energy_start, checkpoint_folder: folder, recorded })
    }

    /// The folder of the checkpoint.
    pub fn checkpoint_folder(&self) -> &RunFolder {
        &self.checkpoint_folder
    }

    /// Simulated time at which the new rows begin (s), if the rows before it are missing.
    pub fn first_time_without_rows(&self) -> Option<f64> {
        self.recorded.is_none().then(|| self.loaded.world.time())
    }

    /// Runs to the end, in the folder `out` or, without it, in the folder of the checkpoint.
    ///
    /// `watch` is that of [`run`](crate::run::run).
    ///
    /// # Errors
    /// [`RunError`] when a time step fails or a file cannot be written.
    pub fn run(
        self,
        out: Option<&RunFolder>,
        watch: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<FinishedRun, RunError> {
        let Self { loaded: Loaded { scene, world }, energy_start, checkpoint_folder, recorded } =
            self;
        let folder = out.unwrap_or(&checkpoint_folder);
        let scene_toml = match out {
            Some(out) => out.write_scene(kept_toml(&scene, out))?,
            None => {
                let scene_toml = kept_toml(&scene, folder)?;
                folder.remove_summary()?;
                scene_toml
            }
        };
        let model = (&scene, &world);
        let mut recorder = match recorded {
            Some(recorded) => {
                let start = (scene_toml.clone(), energy_start);
                Recorder::resume(&checkpoint_folder, folder, recorded, model, start)?
            }
            None => {
                let mut recorder =
                    Recorder::start(folder, model, scene_toml.clone(), energy_start)?;
                if scene.is_frame(world.state().step) {
                    recorder.record_frame(&world)?;
                }
                recorder
            }
        };
        // from here on the run can be resumed with the new duration
        recorder.write_checkpoint(&scene, world.state())?;
        if out.is_none() {
            folder.write_file(SCENE_FILE, scene_toml.as_bytes())?;
        }
        RunLoop::new(scene, world, recorder).finish(folder, watch)
    }
}

/// Loads the scene of the checkpoint and restores its state.
fn load(
    checkpoint: Checkpoint,
    path: &Path,
    duration: Option<&str>,
) -> Result<Loaded, ResumeError> {
    let source =
        Source { name: format!("the scene in {}", path.display()), text: checkpoint.scene };
    let sets = duration.iter().map(|seconds| format!("duration={seconds}")).collect();
    let options = LoadOptions { sets, force: checkpoint.force };
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut loaded =
        load_recorded(&checkpoint.name, source, folder, &options).map_err(ResumeError::Scene)?;
    loaded
        .world
        .restore(checkpoint.state)
        .map_err(|error| ResumeError::State(path.to_owned(), error))?;
    Ok(loaded)
}

/// Whether both texts are the same scene, apart from its duration and from the paths of its meshes, which change when a
/// run is moved. Their hashes do not.
fn are_same_run(a: &str, b: &str) -> bool {
    let changing = ["duration = ", "mesh = ", "mesh_origin = "];
    let rest = |line: &&str| !changing.iter().any(|key| line.starts_with(key));
    !a.is_empty() && a.lines().filter(rest).eq(b.lines().filter(rest))
}
