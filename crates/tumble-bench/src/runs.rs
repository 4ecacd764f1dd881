//! Whole runs, and the machine they run on.

use std::error::Error;
use std::time::Instant;

use tumble_io::run::{RunFolder, run};
use tumble_io::scene::{LoadOptions, load_builtin};

/// How long a run took.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// Steps taken.
    pub steps: u64,
    /// Frames written.
    pub frames: u64,
    /// Stepping alone (s).
    pub stepping: f64,
    /// From the start to the last file (s).
    pub everything: f64,
}

/// Runs a built-in scene for `duration` (s) of simulated time.
///
/// # Errors
/// Whatever ends the run.
pub fn wall_seconds(scene: &str, duration: f64) -> Result<Run, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let start = Instant::now();
    let options = LoadOptions { sets: vec![format!("duration={duration}")], force: false };
    let loaded = load_builtin(scene, &options).ok_or("there is no such scene")??;
    let folder = RunFolder::create(&folder.path().join("run"), false)?;
    let finished = run(loaded, &folder, &mut |_| true)?;
    let everything = start.elapsed().as_secs_f64();
    let rows = std::fs::read_to_string(folder.file("energy.csv"))?;
    Ok(Run {
        steps: finished.summary.steps,
        frames: rows.lines().count() as u64 - 1,
        stepping: finished.summary.wall_seconds,
        everything,
    })
}

/// The processor, in a sentence.
pub fn machine() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let model = model.map_or("unknown processor", |(_, model)| model);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("Machine: {model}, {cores} cores, {} {}.", std::env::consts::OS, std::env::consts::ARCH)
}
