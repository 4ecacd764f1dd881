//! The files that grow while a run goes on, and its checkpoints.

use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::time::{Duration, Instant};

use tumble::{State, World};

use super::drawing::motion_picture;
use super::folder::{CHECKPOINT, CONTACTS, LEDGER, RunError, RunFolder, TRAJECTORY};
use super::history::History;
use super::ledger::{LEDGER_HEADER, ledger_row, line};
use super::recorder::Recorder;
use super::trajectory::{CONTACTS_HEADER, TRAJECTORY_HEADER, write_contacts, write_frame};
use crate::checkpoint;
use crate::page::{self, BodyFrame, Film};
use crate::plot::{EnergyRow, energy_svg};
use crate::scene::Scene;

/// A checkpoint comes about every ten seconds, but takes no more than a tenth of all time.
const LEAST_WAIT: Duration = Duration::from_secs(10);

/// The files that grow.
struct Files {
    trajectory: BufWriter<File>,
    ledger: BufWriter<File>,
    contacts: BufWriter<File>,
}

/// The files that grow while a run goes on, and its checkpoints.
pub(super) struct Recording<'a> {
    folder: &'a RunFolder,
    files: Files,
    recorder: Recorder,
    film: Film,
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
            ledger: begin(LEDGER, LEDGER_HEADER)?,
            contacts: begin(CONTACTS, CONTACTS_HEADER)?,
        };
        let memory = (Recorder::new(world.body_count()), Film::new(world.body_count()));
        Ok(Self::of(folder, files, memory, scene, start))
    }

    /// Goes on after the rows of `history`, in its own folder or in another one.
    pub fn go_on(
        source: &RunFolder,
        folder: &'a RunFolder,
        history: History,
        scene: &Scene,
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
        };
        Ok(Self::of(folder, files, (recorder, film), scene, start))
    }

    fn of(
        folder: &'a RunFolder,
        files: Files,
        (recorder, film): (Recorder, Film),
        scene: &Scene,
        start: f64,
    ) -> Self {
        let (toml, due) = (scene.to_toml(), Instant::now() + LEAST_WAIT);
        Self { folder, files, recorder, film, start, toml, due }
    }

    /// One more frame.
    pub fn frame(&mut self, world: &World) -> Result<(), RunError> {
        let row = self.row(world)?;
        let Files { trajectory, ledger, contacts } = &mut self.files;
        write_frame(trajectory, world).map_err(|e| failed(self.folder, TRAJECTORY, e))?;
        writeln!(ledger, "{}", line(&row)).map_err(|e| failed(self.folder, LEDGER, e))?;
        write_contacts(contacts, world).map_err(|e| failed(self.folder, CONTACTS, e))?;
        self.recorder.record(world, row);
        self.film.record(world.state().step, &row, BodyFrame::all(world));
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
        let Files { trajectory, ledger, contacts } = &mut self.files;
        for (name, file) in [(TRAJECTORY, trajectory), (LEDGER, ledger), (CONTACTS, contacts)] {
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
        // of a run that went on without its first rows there may be no frame yet
        if self.film.is_empty() {
            self.film.record(world.state().step, &row, BodyFrame::all(world));
        }
        let html = page::motion_html(&page::Head::of(scene, world), &self.film);
        self.folder.write("motion.html", html.as_bytes())?;
        Ok(row)
    }
}

fn failed(folder: &RunFolder, name: &str, error: io::Error) -> RunError {
    RunError::Write(folder.file(name), error)
}
