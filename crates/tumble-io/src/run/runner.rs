//! The loop of a run: step to the next frame, write it, until the end or until told to stop.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::time::{Duration, Instant};

use tumble::{DVec3, World, critical_dt};

use super::folder::{RunError, RunFolder};
use super::ledger::{LEDGER_HEADER, ledger_row, line};
use super::recorder::Recorder;
use super::summary::Summary;
use super::trajectory::{TRAJECTORY_HEADER, write_frame};
use crate::picture::{self, Boundary, MotionPicture, PictureBody, encode_png, render};
use crate::plot::{EnergyRow, energy_svg};
use crate::scene::{Loaded, Scene};

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
}

/// Runs a scene to its end and writes everything into `folder`.
///
/// `watch` hears of the progress some twenty times a second and returns whether to go on; when it
/// says no, what is done until then is written as for a finished run.
///
/// # Errors
/// [`RunError`]: the simulation failed, or a file cannot be written. No `summary.json` is left then.
pub fn run(
    loaded: Loaded,
    folder: &RunFolder,
    watch: &mut dyn FnMut(Progress) -> bool,
) -> Result<Finished, RunError> {
    let Loaded { scene, mut world } = loaded;
    folder.claim(&scene)?;
    let mut recording = Recording::start(folder, &world)?;
    let steps = scene.step_count();
    let mut clock = Duration::ZERO;
    let mut going = true;
    recording.frame(&world)?;
    while going && world.state().step < steps {
        let next = scene.next_frame(world.state().step);
        going = advance(&mut world, next.min(steps), steps, &mut clock, watch)?;
        if world.state().step == next {
            recording.frame(&world)?;
        }
    }
    let energy = recording.finish(&scene, &world)?;
    let summary = summarise(&scene, &world, clock, &energy);
    let mut json = serde_json::to_string_pretty(&summary).unwrap_or_default();
    json.push('\n');
    folder.write("summary.json", json.as_bytes())?;
    Ok(Finished { summary, energy })
}

/// Steps to step number `target`; returns whether to go on.
fn advance(
    world: &mut World,
    target: u64,
    steps: u64,
    clock: &mut Duration,
    watch: &mut dyn FnMut(Progress) -> bool,
) -> Result<bool, RunError> {
    while world.state().step < target {
        let start = Instant::now();
        // looking at the clock after every step would cost more than a step in flight
        let mut elapsed = Duration::ZERO;
        while world.state().step < target && elapsed < Duration::from_millis(50) {
            for _ in 0..(target - world.state().step).min(batch(world)) {
                world.step().map_err(RunError::Step)?;
            }
            elapsed = start.elapsed();
        }
        *clock += elapsed;
        let progress = Progress { step: world.state().step, steps, time: world.time() };
        if !watch(progress) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Steps between two looks at the clock: some hundred thousand particles' worth.
fn batch(world: &World) -> u64 {
    let particles: u64 = world.bodies().map(|body| body.particle_count() as u64).sum();
    (100_000 / (particles + 1)).clamp(1, 1000)
}

/// The files that grow while a run goes on.
struct Recording<'a> {
    folder: &'a RunFolder,
    trajectory: BufWriter<File>,
    ledger: BufWriter<File>,
    recorder: Recorder,
    start: f64,
}

impl<'a> Recording<'a> {
    fn start(folder: &'a RunFolder, world: &World) -> Result<Self, RunError> {
        let mut trajectory = folder.open("trajectory.csv")?;
        let mut ledger = folder.open("energy.csv")?;
        writeln!(trajectory, "{TRAJECTORY_HEADER}")
            .map_err(|e| failed(folder, "trajectory.csv", e))?;
        writeln!(ledger, "{LEDGER_HEADER}").map_err(|e| failed(folder, "energy.csv", e))?;
        let recorder = Recorder::new(world.body_count());
        Ok(Self { folder, trajectory, ledger, recorder, start: world.energy().total() })
    }

    fn frame(&mut self, world: &World) -> Result<(), RunError> {
        let row = self.row(world)?;
        write_frame(&mut self.trajectory, world)
            .map_err(|e| failed(self.folder, "trajectory.csv", e))?;
        writeln!(self.ledger, "{}", line(&row))
            .map_err(|e| failed(self.folder, "energy.csv", e))?;
        self.recorder.record(world, row);
        Ok(())
    }

    /// The ledger now; one that cannot be drawn up is the end of the run.
    fn row(&self, world: &World) -> Result<EnergyRow, RunError> {
        let row = ledger_row(world.time(), &world.energy(), self.start);
        let finite = row.total.is_finite() && row.residual.is_finite();
        if finite { Ok(row) } else { Err(RunError::Energy(world.time())) }
    }

    /// Closes the files and draws the pictures; returns the ledger of the last state.
    fn finish(mut self, scene: &Scene, world: &World) -> Result<EnergyRow, RunError> {
        self.trajectory.flush().map_err(|e| failed(self.folder, "trajectory.csv", e))?;
        self.ledger.flush().map_err(|e| failed(self.folder, "energy.csv", e))?;
        let row = self.row(world)?;
        self.recorder.record(world, row);
        let (frames, rows) = self.recorder.finish();
        let svg = energy_svg(&format!("{}: energy", scene.name), &rows)
            .map_err(|e| RunError::Draw(self.folder.file("energy.svg"), e.to_string()))?;
        self.folder.write("energy.svg", svg.as_bytes())?;
        let png = motion_picture(scene, world, &frames)
            .map_err(|e| RunError::Draw(self.folder.file("motion.png"), e.to_string()))?;
        self.folder.write("motion.png", &png)?;
        Ok(row)
    }
}

fn failed(folder: &RunFolder, name: &str, error: std::io::Error) -> RunError {
    RunError::Write(folder.file(name), error)
}

/// The motion in one picture, as PNG.
fn motion_picture(
    scene: &Scene,
    world: &World,
    frames: &[picture::Frame],
) -> Result<Vec<u8>, picture::PictureError> {
    // bodies without a surface are drawn by their particles
    let points: Vec<Vec<DVec3>> = world
        .bodies()
        .map(|body| {
            let shape = &body.model().shape;
            let bare = shape.surface().triangles.is_empty();
            if bare { shape.particles().iter().collect() } else { Vec::new() }
        })
        .collect();
    let bodies: Vec<_> = world
        .bodies()
        .zip(&points)
        .map(|(body, points)| {
            let surface = body.model().shape.surface();
            let vertices = if points.is_empty() { &surface.vertices } else { points };
            PictureBody { name: body.name(), vertices, triangles: &surface.triangles }
        })
        .collect();
    let of_box = scene.walls_of_box.iter().map(|own| Boundary::Box {
        min: own.walls.min,
        max: own.walls.max,
        orientation: own.walls.orientation,
        open: own.walls.open,
    });
    let single = scene
        .walls
        .iter()
        .map(|wall| Boundary::Plane { normal: wall.plane.normal, offset: wall.plane.offset });
    encode_png(&render(&MotionPicture {
        title: &scene.name,
        up: -scene.gravity,
        bodies: &bodies,
        boundary: &of_box.chain(single).collect::<Vec<_>>(),
        frames,
        size: picture::DEFAULT_SIZE,
    }))
}

fn summarise(scene: &Scene, world: &World, clock: Duration, energy: &EnergyRow) -> Summary {
    let steps = world.state().step;
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
        steps_per_second: if seconds > 0.0 { steps as f64 / seconds } else { 0.0 },
        energy_start: energy.total - energy.residual,
        energy_end: energy.total,
        energy_residual: energy.residual,
        critical_dt: critical_dt(world.model()).map(|critical| critical.dt),
        force_evaluations: world.state().tally.evaluations,
        max_depth: world.state().tally.max_depth,
        state_hash: world.state().hash(),
    }
}
