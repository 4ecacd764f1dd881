//! Reads the rows that a run has already written, so that a resumed run can continue after them.

use tumble::{DQuat, DVec3, World, Wrench};

use super::contact_points::CONTACT_POINTS_HEADER;
use super::csv_reader::{
    CsvReader, RowError, parse_contact, parse_contact_point_time, parse_energy, parse_trajectory,
};
use super::energy_ledger::EnergyColumns;
use super::folder::{CONTACT_POINTS_FILE, CONTACTS_FILE, ENERGY_FILE, RunFolder, TRAJECTORY_FILE};
use super::frame_buffers::FrameBuffers;
use super::joint_rows::JointReader;
use super::trajectory::{CONTACTS_HEADER, TRAJECTORY_HEADER};
use crate::page::{BodyFrame, WorldFrame};
use crate::scene::Scene;

/// The rows of a run up to its checkpoint.
#[derive(Debug)]
pub(super) struct RecordedRows {
    /// Length of `trajectory.csv` up to the checkpoint (bytes).
    pub trajectory_bytes: u64,
    /// Length of `energy.csv` up to the checkpoint (bytes).
    pub energy_bytes: u64,
    /// Length of `contacts.csv` up to the checkpoint (bytes).
    pub contacts_bytes: u64,
    /// Length of `contact_points.csv` up to the checkpoint (bytes), if the scene asks for it.
    pub contact_points_bytes: Option<u64>,
    /// Length of `joints.csv` up to the checkpoint (bytes), if there are joints.
    pub joints_bytes: Option<u64>,
    /// The frames, for the pictures and the page.
    pub frames: FrameBuffers,
}

impl RecordedRows {
    /// Reads all frames up to the state of `world`; `None` if the files do not exist.
    ///
    /// Later rows and an incomplete last row are ignored.
    pub fn read(
        folder: &RunFolder,
        scene: &Scene,
        world: &World,
    ) -> Result<Option<Self>, RowError> {
        let exists = |name| folder.file_path(name).symlink_metadata().is_ok();
        if !exists(TRAJECTORY_FILE) && !exists(ENERGY_FILE) {
            return Ok(None);
        }
        let mut trajectory = CsvReader::open(folder.file_path(TRAJECTORY_FILE), TRAJECTORY_HEADER)?;
        let columns = EnergyColumns::new(scene);
        let parse = |row: String| parse_energy(&row, columns).ok_or(());
        let mut energy = CsvReader::open(folder.file_path(ENERGY_FILE), &columns.header())?;
        let mut contacts = ContactReader::open(folder)?;
        let mut joints = JointReader::open(folder, world)?;
        let mut frames = FrameBuffers::new(world);
        let last = world.state().step;
        let mut row = energy.next_row()?.map(parse).transpose();
        // a run that was resumed without its rows begins with a later frame
        let first = match row {
            Ok(Some(row)) => (row.time / scene.dt).round() as u64,
            _ => scene.next_frame(last),
        };
        let is_frame =
            if first > last { first == scene.next_frame(last) } else { scene.is_frame(first) };
        if !is_frame {
            return Err(energy.error("has a first row at a time without a frame"));
        }
        let mut step = first;
        while step <= last {
            let time = step as f64 * scene.dt;
            let current = match row {
                Ok(Some(row)) if row.time == time => row,
                Ok(None) => return Err(energy.error(&format!("has no row of t = {time} s"))),
                _ => {
                    return Err(energy.error(&format!("has another row than that of t = {time} s")));
                }
            };
            let bodies = read_bodies((&mut trajectory, &mut contacts), world, time)?;
            let joints = joints.frame(world, time)?;
            frames.record(step, &current, &WorldFrame { bodies, joints });
            step = scene.next_frame(step);
            if step <= last {
                row = energy.next_row()?.map(parse).transpose();
            }
        }
        // if the first frame is after the checkpoint, its row was read but is written again
        let energy_bytes = if first > last { energy.header_bytes } else { energy.bytes_read };
        let (trajectory_bytes, contacts_bytes) = (trajectory.bytes_read, contacts.bytes_used);
        let contact_points_bytes = if scene.output.contact_points {
            Some(contact_points_bytes(folder, world.time())?)
        } else {
            None
        };
        Ok(Some(Self {
            trajectory_bytes,
            energy_bytes,
            contacts_bytes,
            contact_points_bytes,
            joints_bytes: joints.length(),
            frames,
        }))
    }
}

/// Length of the rows of `contact_points.csv` up to `time` (s). Those after it may be damaged.
fn contact_points_bytes(folder: &RunFolder, time: f64) -> Result<u64, RowError> {
    let path = folder.file_path(CONTACT_POINTS_FILE);
    let mut rows = CsvReader::open(path, CONTACT_POINTS_HEADER)?;
    let mut bytes = rows.header_bytes;
    while let Ok(Some(row)) = rows.next_row() {
        match parse_contact_point_time(&row) {
            Some(of_row) if of_row <= time => bytes = rows.bytes_read,
            _ => break,
        }
    }
    Ok(bytes)
}

/// Reads one frame: a row of `trajectory.csv` per body, and the rows of `contacts.csv` it has.
fn read_bodies(
    (rows, contacts): (&mut CsvReader, &mut ContactReader),
    world: &World,
    time: f64,
) -> Result<Vec<BodyFrame>, RowError> {
    let mut bodies = Vec::with_capacity(world.body_count());
    for body in world.bodies() {
        let name = body.name();
        let missing = format!("has no row of \"{name}\" at t = {time} s");
        let row = rows.next_row()?.ok_or_else(|| rows.error(&missing))?;
        let frame = parse_body_frame(&row, time, name).ok_or_else(|| {
            rows.error(&format!("has another row than that of \"{name}\" at t = {time} s"))
        })?;
        bodies.push(BodyFrame { contact: contacts.wrench(time, name)?, ..frame });
    }
    Ok(bodies)
}

/// The row as that of the body `name` at `time`, without its contact wrench.
fn parse_body_frame(row: &str, time: f64, name: &str) -> Option<BodyFrame> {
    let (row_time, row_name, numbers) = parse_trajectory(row)?;
    let [px, py, pz, w, x, y, z, vx, vy, vz, wx, wy, wz, lx, ly, lz] = numbers;
    let frame = BodyFrame {
        position: DVec3::new(px, py, pz),
        orientation: DQuat::from_xyzw(x, y, z, w),
        velocity: DVec3::new(vx, vy, vz),
        angular_velocity: DVec3::new(wx, wy, wz),
        angular_momentum: DVec3::new(lx, ly, lz),
        contact: Wrench::default(),
    };
    (row_time == time && row_name == name).then_some(frame)
}

/// Reads `contacts.csv`, which has rows only for bodies in contact.
struct ContactReader {
    rows: CsvReader,
    next: Option<(f64, String, Wrench)>,
    /// Length of the header and of the rows returned so far (bytes).
    bytes_used: u64,
}

impl ContactReader {
    fn open(folder: &RunFolder) -> Result<Self, RowError> {
        let rows = CsvReader::open(folder.file_path(CONTACTS_FILE), CONTACTS_HEADER)?;
        let bytes_used = rows.header_bytes;
        let mut contacts = Self { rows, next: None, bytes_used };
        contacts.advance();
        Ok(contacts)
    }

    /// Contact wrench of a body in a frame. Call it in the order of the rows of `trajectory.csv`.
    fn wrench(&mut self, time: f64, name: &str) -> Result<Wrench, RowError> {
        match &self.next {
            Some((row_time, body, wrench)) if *row_time == time && body == name => {
                let wrench = *wrench;
                self.bytes_used = self.rows.bytes_read;
                self.advance();
                Ok(wrench)
            }
            Some((row_time, body, _)) if *row_time < time => {
                let problem = format!("has a row of \"{body}\" at t = {row_time} s out of order");
                Err(self.rows.error(&problem))
            }
            _ => Ok(Wrench::default()),
        }
    }

    /// Reads one row ahead. The row may lie after the checkpoint, where a power failure may have
    /// left arbitrary bytes, so that an invalid row counts as the end of the file.
    fn advance(&mut self) {
        self.next = self.rows.next_row().ok().flatten().and_then(|row| parse_wrench(&row));
    }
}

fn parse_wrench(row: &str) -> Option<(f64, String, Wrench)> {
    let (time, body, [fx, fy, fz, tx, ty, tz]) = parse_contact(row)?;
    let (force, torque) = (DVec3::new(fx, fy, fz), DVec3::new(tx, ty, tz));
    Some((time, body.into_owned(), Wrench { force, torque }))
}
