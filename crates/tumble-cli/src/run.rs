//! `tumble run`: simulates a scene and writes its results.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use tumble_io::run::{Finished, Progress, RunError, RunFolder, Summary};
use tumble_io::scene::{LoadOptions, Loaded, SceneError, load_builtin, load_file};

use crate::scenes::unknown_scene;
use crate::table::{count, short, table};
use crate::{Failure, colour, complain, print};

#[derive(Args)]
pub struct RunArgs {
    /// A scene file, or the name of a built-in scene
    #[arg(default_value = "task2")]
    scene: String,
    /// Folder for the results [default: out/SCENE, or the next free out/SCENE-2, …]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Change one key of the scene, e.g. dt=1e-4, collision.collision_stiffness=1e5, body.0.scale=0.5
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Simulated seconds, instead of the scene's
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    duration: Option<String>,
    /// Write over the results of another run in --out, and accept a dt above the critical one
    #[arg(long)]
    force: bool,
}

pub fn run(args: &RunArgs) -> Result<(), Failure> {
    let loaded = load(args)?;
    let name = loaded.scene.name.clone();
    let folder = match &args.out {
        Some(path) => RunFolder::create(path, args.force),
        None => RunFolder::create_next(Path::new("out"), &name),
    }
    .map_err(|error| failure(&error))?;
    carry_out(&folder, |watch| tumble_io::run::run(loaded, &folder, watch))
}

/// Runs with a progress bar until the end or Ctrl-C, and reports.
pub fn carry_out(
    folder: &RunFolder,
    run: impl FnOnce(&mut dyn FnMut(Progress) -> bool) -> Result<Finished, RunError>,
) -> Result<(), Failure> {
    let stop = stop_on_ctrl_c();
    let bar = progress_bar();
    let finished = run(&mut |progress| {
        show(&bar, progress);
        !stop.load(Ordering::Relaxed)
    });
    bar.finish_and_clear();
    let finished = finished.map_err(|error| failure(&error))?;
    print(&report(&finished, folder))?;
    if finished.summary.interrupted { Err(Failure::Interrupted) } else { Ok(()) }
}

fn load(args: &RunArgs) -> Result<Loaded, Failure> {
    let mut sets = args.set.clone();
    sets.extend(args.duration.iter().map(|seconds| format!("duration={seconds}")));
    load_scene(&args.scene, &LoadOptions { sets, force: args.force })
}

/// The scene in a file, or the built-in one of that name.
pub fn load_scene(scene: &str, options: &LoadOptions) -> Result<Loaded, Failure> {
    let path = Path::new(scene);
    let loaded = match load_builtin(scene, options) {
        // a file of that very name in the folder is still reached as ./NAME
        Some(loaded) => loaded,
        None if path.exists() => load_file(path, options),
        None => return Err(Failure::Call(unknown_scene(scene))),
    };
    loaded.map_err(|error| bad_scene(&error))
}

/// All that is wrong with a scene.
pub fn bad_scene(error: &SceneError) -> Failure {
    let count = error.problem_count();
    let total =
        if count > 1 { format!("\n\n{count} problems; nothing was run") } else { String::new() };
    Failure::Call(format!("{}{total}", error.render(colour())))
}

/// What a failed run ends the command with.
pub fn failure(error: &RunError) -> Failure {
    let message = format!("error: {error}");
    match error {
        RunError::Taken(_) | RunError::NotARun(_) => Failure::Call(message),
        _ => Failure::Run(message),
    }
}

/// A flag that the first Ctrl-C (or a request to terminate) raises; a second one ends at once.
/// A hang-up is left alone, so that `nohup` and closed terminals do what they always do.
pub fn stop_on_ctrl_c() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = [SIGINT, SIGTERM].into_iter().try_for_each(|signal| {
        // in this order: the flag of the first signal is what the second one finds
        flag::register_conditional_shutdown(signal, 130, Arc::clone(&stop))?;
        flag::register(signal, Arc::clone(&stop)).map(|_| ())
    });
    if set.is_err() {
        complain("warning: Ctrl-C will stop at once, with things left undone");
    }
    stop
}

pub fn progress_bar() -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(0);
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}  {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

fn show(bar: &ProgressBar, progress: Progress) {
    bar.set_length(progress.steps);
    bar.set_position(progress.step);
    bar.set_message(format!("t = {:.3} s", progress.time));
}

fn report(finished: &Finished, folder: &RunFolder) -> String {
    let (s, e) = (&finished.summary, &finished.energy);
    let lost = e.drag + e.dashpot + e.slip;
    // gravitational energy has an arbitrary zero: only what moves, is stored or is lost can be a measure
    let in_play = e.kinetic + e.elastic + lost;
    let relative = s.energy_residual / in_play;
    let share = if relative.is_finite() {
        format!(" ({relative:+.2e} of the energy in play)")
    } else {
        String::new()
    };
    let steps = if finished.steps_here == s.steps {
        count(s.steps)
    } else {
        format!("{}, the last {}", count(s.steps), count(finished.steps_here))
    };
    let critical = s.critical_dt.map_or(String::new(), |critical| {
        format!(", {} of the critical {} s", short(s.dt / critical), short(critical))
    });
    let mut rows = vec![
        (
            "scene",
            format!(
                "{}, {} {}, {} particles",
                s.scene,
                s.bodies,
                if s.bodies == 1 { "body" } else { "bodies" },
                count(s.particles)
            ),
        ),
        ("integrator", format!("{}, dt = {} s{critical}", s.integrator, short(s.dt))),
        ("steps", format!("{steps} in {} s", short(s.wall_seconds))),
        ("speed", format!("{} steps/s", count(s.steps_per_second as u64))),
        (
            "time",
            format!("{} s{}", short(s.time), if s.interrupted { " (stopped early)" } else { "" }),
        ),
        ("energy", format!("{} J at the start", short(s.energy_start))),
        (
            "",
            format!(
                "{} J kinetic, {} J gravitational, {} J elastic at the end",
                short(e.kinetic),
                short(e.gravitational),
                short(e.elastic)
            ),
        ),
        ("", format!("{} J lost on the way", short(lost))),
        ("residual", format!("{} J{share}", short(s.energy_residual))),
        ("deepest contact", format!("{} m on the way", short(s.max_depth))),
        ("", depths_at_the_end(s)),
        ("results", folder.path().display().to_string()),
        ("look at it", folder.path().join("motion.html").display().to_string()),
    ];
    rows.extend(finished.notes.iter().map(|note| ("note", (*note).to_owned())));
    let advice = advice(s, relative);
    rows.extend(advice.into_iter().map(|advice| ("beware", advice)));
    table(&rows)
}

fn depths_at_the_end(s: &Summary) -> String {
    let walls = format!("{} m with a wall", short(s.wall_depth_end));
    if s.bodies == 1 {
        return format!("{walls} at the end");
    }
    format!("{} m between bodies, {walls} at the end", short(s.body_depth_end))
}

/// What a user should know before trusting the numbers.
fn advice(s: &Summary, relative: f64) -> Vec<String> {
    let mut advice = Vec::new();
    if let Some(critical) = s.critical_dt.filter(|&critical| s.dt > critical) {
        let critical = short(critical);
        advice.push(format!("dt is above the critical {critical} s: contact is unstable"));
    }
    if relative.abs() > 0.01 {
        let remedy = if s.integrator == "euler" {
            "integrator = \"splitting\" or a smaller dt does better"
        } else {
            "a smaller dt or an energy_tolerance does better"
        };
        let percent = 100.0 * relative;
        advice.push(format!("the integrator is off by {percent:+.2} % of the energy: {remedy}"));
    }
    advice
}
