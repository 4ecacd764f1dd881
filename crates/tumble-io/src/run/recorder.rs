//! Records the frames and checkpoints of a run, and draws its pictures at the end.

use std::fs::File;
use std::io::{self, Read, Write};
use std::time::{Duration, Instant};

use tumble::{State, World};

use super::contact_points::{CONTACT_POINTS_HEADER, RowNames};
use super::energy_ledger::{EnergyColumns, energy_row};
use super::error::RunError;
use super::folder::{
    CHECKPOINT_FILE, CONTACT_POINTS_FILE, CONTACTS_FILE, ENERGY_FILE, ENERGY_PLOT_FILE,
    JOINTS_FILE, MOTION_PAGE_FILE, MOTION_PICTURE_FILE, RunFolder, TRAJECTORY_FILE,
};
use super::frame_buffers::{FrameBuffers, picture_frame};
use super::joint_rows::JOINTS_HEADER;
use super::picture_input::motion_picture;
use super::recorded_rows::RecordedRows;
use super::run_writer::{CsvFiles, RunFrame, RunWriter};
use super::trajectory::{CONTACTS_HEADER, TRAJECTORY_HEADER};
use crate::checkpoint;
use crate::page::{self, WorldFrame};
use crate::plot::{EnergyRow, energy_svg};
use crate::scene::Scene;

/// Least wall-clock time between two checkpoints. Writing them takes at most a tenth of all time.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(10);

/// Records a run into its folder: CSV rows while it runs, checkpoints, pictures at the end.
pub(super) struct Recorder<'a> {
    folder: &'a RunFolder,
    writer: RunWriter,
    energy_start: f64,
    scene_toml: String,
    next_checkpoint: Instant,
}

impl<'a> Recorder<'a> {
    /// Starts new files that hold only their headers. `scene_toml` is the scene as in the folder, `energy_start` the energy at
    /// t = 0 (J).
    pub fn start(
        folder: &'a RunFolder,
        (scene, world): (&Scene, &World),
        scene_toml: String,
        energy_start: f64,
    ) -> Result<Self, RunError> {
        let columns = EnergyColumns::new(scene);
        let create = |name, header: &str| {
            let mut file = folder.create_file(name)?;
            writeln!(file, "{header}").map_err(|e| write_error(folder, name, e))?;
            Ok(file)
        };
        let files = CsvFiles {
            trajectory: create(TRAJECTORY_FILE, TRAJECTORY_HEADER)?,
            energy: create(ENERGY_FILE, &columns.header())?,
            contacts: create(CONTACTS_FILE, CONTACTS_HEADER)?,
            joints: if scene.joints.is_empty() {
                None
            } else {
                Some(create(JOINTS_FILE, JOINTS_HEADER)?)
            },
            contact_points: if scene.output.contact_points {
                Some(create(CONTACT_POINTS_FILE, CONTACT_POINTS_HEADER)?)
            } else {
                None
            },
            columns,
        };
        let frames = FrameBuffers::new(world);
        let writer = RunWriter::start(folder, files, frames, names(scene, world));
        Ok(Self::new(folder, writer, scene_toml, energy_start))
    }

    /// Continues after the rows already recorded in `source`, in that folder or in another one.
    pub fn resume(
        source: &RunFolder,
        folder: &'a RunFolder,
        recorded: RecordedRows,
        (scene, world): (&Scene, &World),
        (scene_toml, energy_start): (String, f64),
    ) -> Result<Self, RunError> {
        let RecordedRows { frames, .. } = recorded;
        let open = |name, length| {
            if source.is_same_as(folder.path()) {
                return folder.append_to_file(name, length);
            }
            let rows = File::open(source.file_path(name)).map(|file| file.take(length));
            let mut copy = folder.create_file(name)?;
            rows.and_then(|mut rows| io::copy(&mut rows, &mut copy))
                .map_err(|e| write_error(folder, name, e))?;
            Ok(copy)
        };
        let files = CsvFiles {
            trajectory: open(TRAJECTORY_FILE, recorded.trajectory_bytes)?,
            energy: open(ENERGY_FILE, recorded.energy_bytes)?,
            contacts: open(CONTACTS_FILE, recorded.contacts_bytes)?,
            joints: match recorded.joints_bytes {
                Some(length) => Some(open(JOINTS_FILE, length)?),
                None => None,
            },
            contact_points: match recorded.contact_points_bytes {
                Some(length) => Some(open(CONTACT_POINTS_FILE, length)?),
                None => None,
            },
            columns: EnergyColumns::new(scene),
        };
        let writer = RunWriter::start(folder, files, frames, names(scene, world));
        Ok(Self::new(folder, writer, scene_toml, energy_start))
    }

    fn new(
        folder: &'a RunFolder,
        writer: RunWriter,
        scene_toml: String,
        energy_start: f64,
    ) -> Self {
        let next_checkpoint = Instant::now() + CHECKPOINT_INTERVAL;
        Self { folder, writer, energy_start, scene_toml, next_checkpoint }
    }

    /// Records the current state of the world as a frame.
    pub fn record_frame(&mut self, world: &World) -> Result<(), RunError> {
        let row = self.energy_row(world)?;
        let frame = WorldFrame::new(world);
        let contacts = world.contacts();
        self.writer.write(RunFrame { step: world.state().step, row, frame, contacts })
    }

    /// The current row of the energy ledger; an error if the energy is not finite.
    fn energy_row(&self, world: &World) -> Result<EnergyRow, RunError> {
        let row = energy_row(world.time(), &world.energy(), self.energy_start);
        let is_finite = row.total.is_finite() && row.residual.is_finite();
        if is_finite { Ok(row) } else { Err(RunError::NonFiniteEnergy(world.time())) }
    }

    /// Whether a checkpoint is due by the wall clock.
    pub fn is_checkpoint_due(&self) -> bool {
        Instant::now() >= self.next_checkpoint
    }

    /// Writes a checkpoint, after syncing the rows of all frames so far to the disk.
    pub fn write_checkpoint(&mut self, scene: &Scene, state: &State) -> Result<(), RunError> {
        let begin = Instant::now();
        self.writer.sync()?;
        let name_and_toml = (scene.name.as_str(), self.scene_toml.as_str());
        let bytes = checkpoint::encode(name_and_toml, (scene.force, self.energy_start), state);
        self.folder.write_file(CHECKPOINT_FILE, &bytes)?;
        self.next_checkpoint = Instant::now() + CHECKPOINT_INTERVAL.max(9 * begin.elapsed());
        Ok(())
    }

    /// Writes the plot, the picture and the page; returns the energy ledger of the last state.
    pub fn finish(self, scene: &Scene, world: &World) -> Result<EnergyRow, RunError> {
        let row = self.energy_row(world)?;
        let FrameBuffers { mut pictures, mut page } = self.writer.finish()?;
        // the last state need not be a frame, and a run resumed without its rows may have no frame
        let frame = WorldFrame::new(world);
        pictures.record(picture_frame(row.time, &frame.bodies), row);
        if page.is_empty() {
            page.record(world.state().step, &row, &frame);
        }
        let (frames, rows) = pictures.finish();
        let draw_error = |name, error| RunError::Draw(self.folder.file_path(name), error);
        let svg = energy_svg(&format!("{}: energy", scene.name), &rows)
            .map_err(|error| draw_error(ENERGY_PLOT_FILE, error.to_string()))?;
        self.folder.write_file(ENERGY_PLOT_FILE, svg.as_bytes())?;
        let png = motion_picture(scene, world, &frames)
            .map_err(|error| draw_error(MOTION_PICTURE_FILE, error.to_string()))?;
        self.folder.write_file(MOTION_PICTURE_FILE, &png)?;
        let html = page::motion_html(&page::Header::new(scene, world), &page);
        self.folder.write_file(MOTION_PAGE_FILE, html.as_bytes())?;
        Ok(row)
    }
}

fn names(scene: &Scene, world: &World) -> RowNames {
    let bodies = world.bodies().map(|body| body.name().to_owned()).collect();
    let joints = world.model().joints.list.iter().map(|joint| joint.name.clone()).collect();
    RowNames { bodies, walls: scene.wall_names(), joints }
}

fn write_error(folder: &RunFolder, name: &str, error: io::Error) -> RunError {
    RunError::Write(folder.file_path(name), error)
}
