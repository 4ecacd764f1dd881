//! Timing of complete runs, output files included.

use std::error::Error;
use std::time::Instant;

use tumble_io::run::{RunFolder, run};
use tumble_io::scene::{LoadOptions, load_builtin};

/// Wall-clock times of a run.
#[derive(Clone, Copy, Debug)]
pub struct RunTime {
    /// Number of steps.
    pub steps: u64,
    /// Number of frames written.
    pub frames: u64,
    /// Time spent in the steps alone (s).
    pub stepping: f64,
    /// Time from the start until the last file is written (s).
    pub total: f64,
}

/// Runs a built-in scene for `duration` seconds of simulated time and times it.
///
/// # Errors
/// If there is no such scene, if the run fails, or if its files cannot be written or read.
pub fn time_run(scene: &str, duration: f64) -> Result<RunTime, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let start = Instant::now();
    let options = LoadOptions { sets: vec![format!("duration={duration}")], force: false };
    let loaded = load_builtin(scene, &options).ok_or("there is no such scene")??;
    let folder = RunFolder::create(&folder.path().join("run"), false)?;
    let finished = run(loaded, &folder, &mut |_| true)?;
    let total = start.elapsed().as_secs_f64();
    let rows = std::fs::read_to_string(folder.file_path("energy.csv"))?;
    Ok(RunTime {
        steps: finished.summary.steps,
        frames: rows.lines().count() as u64 - 1,
        stepping: finished.summary.wall_seconds,
        total,
    })
}
