//! The files that grow while a run goes on, and its checkpoints.

use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::time::{Duration, Instant};

use tumble::{State, World};

use super::drawing::motion_picture;
use super::folder::{CHECKPOINT, LEDGER, RunError, RunFolder, TRAJECTORY};
use super::history::History;
use super::ledger::{LEDGER_HEADER, ledger_row, line};
use super::recorder::Recorder;
use super::trajectory::{TRAJECTORY_HEADER, write_frame};
use crate::checkpoint;
use crate::plot::{EnergyRow, energy_svg};
use crate::scene::Scene;

/// A checkpoint comes about every ten seconds, but takes no more than a tenth of all time.
const LEAST_WAIT: Duration = Duration::from_secs(10);

/// The files that grow while a run goes on, and its checkpoints.
pub(super) struct Recording<'a> {
    folder: &'a RunFolder,
    trajectory: BufWriter<File>,
    ledger: BufWriter<File>,
    recorder: Recorder,
    start: f64,
    toml: String,
    /// When the next checkpoint is due by the clock.
    due: Instant,
}

impl<'a> Recording<'a> {
    /// Files with headers alone; `start` is the energy at t = 0 (J).
    pub fn start(
        folder: &'a RunFolder,
        scene: &Scene,
        world: &World,
        start: f64,
    ) -> Result<Self, RunError> {
        let mut trajectory = folder.open(TRAJECTORY)?;
        let mut ledger = folder.open(LEDGER)?;
        writeln!(trajectory, "{TRAJECTORY_HEADER}").map_err(|e| failed(folder, TRAJECTORY, e))?;
        writeln!(ledger, "{LEDGER_HEADER}").map_err(|e| failed(folder, LEDGER, e))?;
        let recorder = Recorder::new(world.body_count());
        Ok(Self::of(folder, (trajectory, ledger), recorder, scene, start))
    }

    /// Goes on after the rows of `history`, in its own folder or in another one.
    pub fn go_on(
        source: &RunFolder,
        folder: &'a RunFolder,
        history: History,
        scene: &Scene,
        start: f64,
    ) -> Result<Self, RunError> {
        let History { trajectory, ledger, recorder } = history;
        let open = |name, length| {
            if source.is(folder.path()) {
                return folder.reopen(name, length);
            }
            let rows = File::open(source.file(name)).map(|file| file.take(length));
            let mut copy = folder.open(name)?;
            rows.and_then(|mut rows| io::copy(&mut rows, &mut copy))
                .map_err(|e| failed(folder, name, e))?;
            Ok(copy)
        };
        let files = (open(TRAJECTORY, trajectory)?, open(LEDGER, ledger)?);
        Ok(Self::of(folder, files, recorder, scene, start))
    }

    fn of(
        folder: &'a RunFolder,
        (trajectory, ledger): (BufWriter<File>, BufWriter<File>),
        recorder: Recorder,
        scene: &Scene,
        start: f64,
    ) -> Self {
        let (toml, due) = (scene.to_toml(), Instant::now() + LEAST_WAIT);
        Self { folder, trajectory, ledger, recorder, start, toml, due }
    }

    /// One more frame.
    pub fn frame(&mut self, world: &World) -> Result<(), RunError> {
        let row = self.row(world)?;
        write_frame(&mut self.trajectory, world).map_err(|e| failed(self.folder, TRAJECTORY, e))?;
        writeln!(self.ledger, "{}", line(&row)).map_err(|e| failed(self.folder, LEDGER, e))?;
        self.recorder.record(world, row);
        Ok(())
    }

    /// The world as it is now, for the pictures alone.
    pub fn look(&mut self, world: &World) -> Result<EnergyRow, RunError> {
        let row = self.row(world)?;
        self.recorder.record(world, row);
        Ok(row)
    }

    /// The ledger now; one that cannot be drawn up is the end of the run.
    fn row(&self, world: &World) -> Result<EnergyRow, RunError> {
        let row = ledger_row(world.time(), &world.energy(), self.start);
        let finite = row.total.is_finite() && row.residual.is_finite();
        if finite { Ok(row) } else { Err(RunError::Energy(world.time())) }
    }

    /// Whether the clock asks for a checkpoint.
    pub fn is_due(&self) -> bool {
        Instant::now() >= self.due
    }

    /// Writes a checkpoint; the rows of all frames until now reach the disk before it.
    pub fn checkpoint(&mut self, scene: &Scene, state: &State) -> Result<(), RunError> {
        let begin = Instant::now();
        for (name, file) in [(TRAJECTORY, &mut self.trajectory), (LEDGER, &mut self.ledger)] {
            file.flush()
                .and_then(|()| file.get_ref().sync_data())
                .map_err(|e| failed(self.folder, name, e))?;
        }
        let names = (scene.name.as_str(), self.toml.as_str());
        let bytes = checkpoint::encode(names, (scene.force, self.start), state);
        self.folder.write(CHECKPOINT, &bytes)?;
        self.due = Instant::now() + LEAST_WAIT.max(9 * begin.elapsed());
        Ok(())
    }

    /// Draws the pictures; returns the ledger of the last state.
    pub fn finish(mut self, scene: &Scene, world: &World) -> Result<EnergyRow, RunError> {
        let row = self.look(world)?;
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

fn failed(folder: &RunFolder, name: &str, error: io::Error) -> RunError {
    RunError::Write(folder.file(name), error)
}
