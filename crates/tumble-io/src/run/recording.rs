//! The files that grow while a run goes on, and its checkpoints.

use std::fs::File;
use std::io::{self, Read, Write};
use std::time::{Duration, Instant};

use tumble::{State, World};

use super::drawing::motion_picture;
use super::folder::{CHECKPOINT, CONTACTS, LEDGER, RunError, RunFolder, TRAJECTORY};
use super::history::History;
use super::ledger::{ledger_header, ledger_row};
use super::recorder::Recorder;
use super::scribe::{Files, Memory, Moment, Scribe, still};
use super::trajectory::{CONTACTS_HEADER, TRAJECTORY_HEADER};
use crate::checkpoint;
use crate::page::{self, BodyFrame};
use crate::plot::{EnergyRow, energy_svg};
use crate::scene::Scene;

/// A checkpoint comes about every ten seconds, but takes no more than a tenth of all time.
const LEAST_WAIT: Duration = Duration::from_secs(10);

/// The files that grow while a run goes on, and its checkpoints.
pub(super) struct Recording<'a> {
    folder: &'a RunFolder,
    scribe: Scribe,
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
        let begin = |name, header| {
            let mut file = folder.open(name)?;
            writeln!(file, "{header}").map_err(|e| failed(folder, name, e))?;
            Ok(file)
        };
        let files = Files {
            trajectory: begin(TRAJECTORY, TRAJECTORY_HEADER)?,
            ledger: begin(LEDGER, ledger_header(scene.does_work()))?,
            contacts: begin(CONTACTS, CONTACTS_HEADER)?,
            has_work: scene.does_work(),
        };
        let bodies = world.body_count();
        let memory = Memory { recorder: Recorder::new(bodies), film: page::Recording::new(bodies) };
        let scribe = Scribe::start(folder, files, memory, names(world));
        Ok(Self::of(folder, scribe, scene, start))
    }

    /// Goes on after the rows of `history`, in its own folder or in another one.
    pub fn go_on(
        source: &RunFolder,
        folder: &'a RunFolder,
        history: History,
        (scene, world): (&Scene, &World),
        start: f64,
    ) -> Result<Self, RunError> {
        let History { trajectory, ledger, contacts, recorder, film } = history;
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
        let files = Files {
            trajectory: open(TRAJECTORY, trajectory)?,
            ledger: open(LEDGER, ledger)?,
            contacts: open(CONTACTS, contacts)?,
            has_work: scene.does_work(),
        };
        let scribe = Scribe::start(folder, files, Memory { recorder, film }, names(world));
        Ok(Self::of(folder, scribe, scene, start))
    }

    fn of(folder: &'a RunFolder, scribe: Scribe, scene: &Scene, start: f64) -> Self {
        let (toml, due) = (scene.to_toml(), Instant::now() + LEAST_WAIT);
        Self { folder, scribe, start, toml, due }
    }

    /// One more frame.
    pub fn frame(&mut self, world: &World) -> Result<(), RunError> {
        let row = self.row(world)?;
        let bodies = BodyFrame::all(world).collect();
        self.scribe.write(Moment { step: world.state().step, row, bodies })
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
        self.scribe.settle()?;
        let names = (scene.name.as_str(), self.toml.as_str());
        let bytes = checkpoint::encode(names, (scene.force, self.start), state);
        self.folder.write(CHECKPOINT, &bytes)?;
        self.due = Instant::now() + LEAST_WAIT.max(9 * begin.elapsed());
        Ok(())
    }

    /// Draws the pictures; returns the ledger of the last state.
    pub fn finish(self, scene: &Scene, world: &World) -> Result<EnergyRow, RunError> {
        let row = self.row(world)?;
        let Memory { mut recorder, mut film } = self.scribe.finish()?;
        // a run may end between two frames; of one that went on without its first rows there may be none yet
        let bodies: Vec<_> = BodyFrame::all(world).collect();
        recorder.record_frame(still(row.time, &bodies), row);
        if film.is_empty() {
            film.record(world.state().step, &row, bodies.into_iter());
        }
        let (frames, rows) = recorder.finish();
        let draw = |name: &str, error: String| RunError::Draw(self.folder.file(name), error);
        let svg = energy_svg(&format!("{}: energy", scene.name), &rows)
            .map_err(|error| draw("energy.svg", error.to_string()))?;
        self.folder.write("energy.svg", svg.as_bytes())?;
        let png = motion_picture(scene, world, &frames)
            .map_err(|error| draw("motion.png", error.to_string()))?;
        self.folder.write("motion.png", &png)?;
        let html = page::motion_html(&page::Header::new(scene, world), &film);
        self.folder.write("motion.html", html.as_bytes())?;
        Ok(row)
    }
}

fn names(world: &World) -> Vec<String> {
    world.bodies().map(|body| body.name().to_owned()).collect()
}

fn failed(folder: &RunFolder, name: &str, error: io::Error) -> RunError {
    RunError::Write(folder.file(name), error)
}
