//! Going on from a checkpoint, to the bits of a run that never stopped.

use std::path::{Path, PathBuf};

use tumble::StateError;

use super::folder::{CHECKPOINT, FILES, RunError, RunFolder, SCENE};
use super::history::History;
use super::recording::Recording;
use super::rows::RowError;
use super::runner::{Finished, Progress, Run};
use crate::checkpoint::{Checkpoint, CheckpointError, read_checkpoint};
use crate::scene::{LoadOptions, Loaded, SceneError, Source, load_text};

/// Why a run cannot go on from a checkpoint. Nothing has been written then.
#[derive(Debug)]
pub enum ResumeError {
    /// The file is no checkpoint that can be used.
    Checkpoint(PathBuf, CheckpointError),
    /// The scene of the checkpoint cannot be run any more, or not for that long.
    Scene(SceneError),
    /// The state is not one of that scene.
    State(PathBuf, StateError),
    /// The run has come that far already.
    Done {
        /// Where the checkpoint stands (s).
        time: f64,
        /// How far it is to go (s).
        duration: f64,
    },
    /// The folder holds files of something else.
    OtherRun(PathBuf),
    /// The rows of a file are not those that the run wrote.
    Rows(RowError),
}

impl std::fmt::Display for ResumeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Checkpoint(path, error) => write!(f, "{} {error}", path.display()),
            Self::Scene(error) => error.fmt(f),
            Self::State(path, error) => {
                write!(f, "{} is no checkpoint of a run: {error}", path.display())
            }
            Self::Done { time, duration } => write!(
                f,
                "there is nothing left to do: the checkpoint is at t = {time} s, the run goes to \
                 {duration} s; say a later time with --duration"
            ),
            Self::OtherRun(path) => write!(
                f,
                "{} holds files that are not of the checkpoint's run; \
                 name another folder with --out",
                path.display()
            ),
            Self::Rows(error) => write!(
                f,
                "{} {}, so the run cannot go on after its rows; move the checkpoint to a \
                 folder of its own to go on without them",
                error.path.display(),
                error.what
            ),
        }
    }
}

impl std::error::Error for ResumeError {}

impl From<RowError> for ResumeError {
    fn from(error: RowError) -> Self {
        Self::Rows(error)
    }
}

/// A run that is ready to go on.
#[derive(Debug)]
pub struct Resumption {
    loaded: Loaded,
    energy_start: f64,
    own: RunFolder,
    history: Option<History>,
}

impl Resumption {
    /// Reads the checkpoint at `path` (or in the folder `path`), its scene and meshes, and the rows
    /// beside it. `duration` is the simulated time to reach (s), as the user wrote it, if it is to be
    /// another than the scene's; `in_place` says that the run is to go on in its own folder.
    ///
    /// # Errors
    /// [`ResumeError`]; nothing is changed by then.
    pub fn prepare(
        path: &Path,
        duration: Option<&str>,
        in_place: bool,
    ) -> Result<Self, ResumeError> {
        let path = if path.is_dir() { path.join(CHECKPOINT) } else { path.to_owned() };
        let checkpoint =
            read_checkpoint(&path).map_err(|error| ResumeError::Checkpoint(path.clone(), error))?;
        let own = RunFolder::existing(path.parent().unwrap_or(Path::new(".")));
        let scene_beside = std::fs::read_to_string(own.file(SCENE)).unwrap_or_default();
        let is_own = same_but_duration(&scene_beside, &checkpoint.scene);
        let is_there = |name: &str| own.file(name).symlink_metadata().is_ok();
        let foreign = FILES.iter().any(|&name| name != CHECKPOINT && is_there(name));
        if in_place && foreign && !is_own {
            return Err(ResumeError::OtherRun(own.path().to_owned()));
        }
        let energy_start = checkpoint.energy_start;
        let loaded = load(checkpoint, &path, duration)?;
        let (state, scene) = (loaded.world.state(), &loaded.scene);
        // a run that stopped short of its pictures may still finish them
        let unfinished = in_place && is_own && !is_there("summary.json");
        let steps = scene.step_count();
        if steps < state.step || (steps == state.step && !unfinished) {
            return Err(ResumeError::Done { time: state.time, duration: scene.duration });
        }
        let history = if is_own { History::read(&own, scene, &loaded.world)? } else { None };
        Ok(Self { loaded, energy_start, own, history })
    }

    /// The checkpoint's own folder.
    pub fn own_folder(&self) -> &RunFolder {
        &self.own
    }

    /// The simulated time at which the new rows begin, when those before are not there to be kept (s).
    pub fn begins_at(&self) -> Option<f64> {
        self.history.is_none().then(|| self.loaded.world.time())
    }

    /// Runs on to the end, in a new folder or in the checkpoint's own. See [`run`](super::run).
    ///
    /// # Errors
    /// [`RunError`], as for any run.
    pub fn run(
        self,
        out: Option<&RunFolder>,
        watch: &mut dyn FnMut(Progress) -> bool,
    ) -> Result<Finished, RunError> {
        let Self { loaded: Loaded { scene, world }, energy_start, own, history } = self;
        let folder = out.unwrap_or(&own);
        match out {
            Some(out) => out.claim(&scene)?,
            None => own.unfinish()?,
        }
        let mut recording = match history {
            Some(history) => {
                Recording::go_on(&own, folder, history, (&scene, &world), energy_start)?
            }
            None => {
                let mut recording = Recording::start(folder, &scene, &world, energy_start)?;
                if scene.is_frame(world.state().step) {
                    recording.frame(&world)?;
                }
                recording
            }
        };
        // stopped at any moment from here on, the run can be resumed as it is meant now
        recording.checkpoint(&scene, world.state())?;
        if out.is_none() {
            folder.write(SCENE, scene.to_toml().as_bytes())?;
        }
        Run::new(scene, world, recording).finish(folder, watch)
    }
}

/// The world at the checkpoint.
fn load(
    checkpoint: Checkpoint,
    path: &Path,
    duration: Option<&str>,
) -> Result<Loaded, ResumeError> {
    let source =
        Source { name: format!("the scene in {}", path.display()), text: checkpoint.scene };
    let sets = duration.iter().map(|seconds| format!("duration={seconds}")).collect();
    let options = LoadOptions { sets, force: checkpoint.force };
    let mut loaded = load_text(&checkpoint.name, source, Path::new("."), &options)
        .map_err(ResumeError::Scene)?;
    loaded
        .world
        .restore(checkpoint.state)
        .map_err(|error| ResumeError::State(path.to_owned(), error))?;
    Ok(loaded)
}

/// Whether both texts are one scene, run for different times perhaps.
fn same_but_duration(a: &str, b: &str) -> bool {
    let rest = |line: &&str| !line.starts_with("duration = ");
    !a.is_empty() && a.lines().filter(rest).eq(b.lines().filter(rest))
}
