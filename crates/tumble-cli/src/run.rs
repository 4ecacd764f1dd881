//! `tumble run`: runs a simulation and writes its results.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use clap::Args;
use indicatif::ProgressBar;
use tumble_io::run::{ContactSteps, FinishedRun, Progress, RunError, RunFolder};
use tumble_io::scene::{LoadOptions, Loaded};

use crate::console::{print_error, progress_bar};
use crate::failure::{Failure, print};
use crate::interrupt::stop_flag;
use crate::report::report;
use crate::scene_argument::load_scene;

#[derive(Args)]
#[command(
    after_help = "Ctrl-C stops the run and writes the results so far; `tumble resume` continues it."
)]
pub struct RunArgs {
    /// Scene file, or name of a built-in scene (see `tumble scenes`)
    #[arg(default_value = "task2")]
    scene: String,
    /// Folder for the results [default: out/SCENE, or the next free out/SCENE-2, …]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Set a key of the scene, e.g. dt=1e-4 or body.0.scale=0.5; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Simulated time (s) [default: the duration of the scene]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    duration: Option<String>,
    /// Overwrite another run in --out; accept a dt above the stability limit
    #[arg(long)]
    force: bool,
}

pub fn run(args: &RunArgs) -> Result<(), Failure> {
    let loaded = load(args)?;
    for load in tumble::static_loads(loaded.world.model(), loaded.world.state()) {
        print_error(&format!("warning: {load}"));
    }
    let name = loaded.scene.name.clone();
    let folder = match &args.out {
        Some(path) => RunFolder::create(path, args.force),
        None => RunFolder::create_next(Path::new("out"), &name),
    }
    .map_err(|error| Failure::from(&error))?;
    let contacts = ContactSteps::new(&loaded.world);
    if let Some(warning) = contacts.and_then(|contacts| contacts.warning(loaded.scene.dt)) {
        print_error(&format!("warning: {warning}"));
    }
    execute(&folder, |watch| tumble_io::run::run(loaded, &folder, watch))
}

fn load(args: &RunArgs) -> Result<Loaded, Failure> {
    let mut sets = args.set.clone();
    sets.extend(args.duration.iter().map(|seconds| format!("duration={seconds}")));
    load_scene(&args.scene, &LoadOptions { sets, force: args.force })
}

/// Executes a run with a progress bar until it ends or Ctrl-C is pressed, and prints the report.
pub fn execute(
    folder: &RunFolder,
    run: impl FnOnce(&mut dyn FnMut(Progress) -> bool) -> Result<FinishedRun, RunError>,
) -> Result<(), Failure> {
    let stop = stop_flag();
    let bar = progress_bar();
    let finished = run(&mut |progress| {
        update(&bar, progress);
        !stop.load(Ordering::Relaxed)
    });
    bar.finish_and_clear();
    let finished = finished.map_err(|error| Failure::from(&error))?;
    print(&report(&finished, folder))?;
    if finished.summary.interrupted { Err(Failure::Interrupted) } else { Ok(()) }
}

fn update(bar: &ProgressBar, progress: Progress) {
    bar.set_length(progress.steps);
    bar.set_position(progress.step);
    bar.set_message(format!("t = {:.3} s", progress.time));
}
