//! `joints.csv`: one row per frame and joint.

use std::io::{self, Write};

use tumble::{DVec3, JointView, World, Wrench};

use super::csv_reader::{CsvReader, RowError, parse_joint};
use super::folder::{JOINTS_FILE, RunFolder};
use super::trajectory::write_row;

/// Columns of `joints.csv`.
pub const JOINTS_HEADER: &str = "time,joint,fx,fy,fz,tx,ty,tz,coordinate,rate";

/// Writes the rows of one frame at `time` (s).
///
/// A row holds the force (N) that the joint exerts on its first body and the torque about the point of the joint (N·m), in world axes, as
/// means over the latest step, then the coordinate and its rate.
pub(super) fn write_joints(
    out: &mut impl Write,
    time: f64,
    names: &[String],
    joints: &[JointView],
) -> io::Result<()> {
    for (name, JointView { wrench, coordinate, rate }) in names.iter().zip(joints) {
        let (f, t) = (wrench.force, wrench.torque);
        write_row(out, (time, Some(name)), &[f.x, f.y, f.z, t.x, t.y, t.z, *coordinate, *rate])?;
    }
    Ok(())
}

/// Reads `joints.csv`, a row of each joint for each frame.
pub(super) struct JointReader {
    rows: Option<CsvReader>,
}

impl JointReader {
    /// Opens the file if the world has joints.
    pub fn open(folder: &RunFolder, world: &World) -> Result<Self, RowError> {
        let open = || CsvReader::open(folder.file_path(JOINTS_FILE), JOINTS_HEADER);
        Ok(Self { rows: if world.joint_count() > 0 { Some(open()?) } else { None } })
    }

    /// The joints of the frame at `time` (s).
    pub fn frame(&mut self, world: &World, time: f64) -> Result<Vec<JointView>, RowError> {
        let Some(rows) = &mut self.rows else { return Ok(Vec::new()) };
        let joints = &world.model().joints.list;
        joints.iter().map(|joint| read_joint(rows, &joint.name, time)).collect()
    }

    /// Length of the rows read so far with the header (bytes), if the file is there.
    pub fn length(&self) -> Option<u64> {
        self.rows.as_ref().map(|rows| rows.bytes_read.max(rows.header_bytes))
    }
}

fn read_joint(rows: &mut CsvReader, name: &str, time: f64) -> Result<JointView, RowError> {
    let row = rows.next_row()?;
    let row =
        row.ok_or_else(|| rows.error(&format!("has no row of \"{name}\" at t = {time} s")))?;
    let parsed = parse_joint(&row).filter(|(at, found, _)| *at == time && found == name);
    let Some((_, _, [fx, fy, fz, tx, ty, tz, coordinate, rate])) = parsed else {
        return Err(rows.error(&format!("has another row than that of \"{name}\" at t = {time} s")));
    };
    let wrench = Wrench { force: DVec3::new(fx, fy, fz), torque: DVec3::new(tx, ty, tz) };
    Ok(JointView { wrench, coordinate, rate })
}
