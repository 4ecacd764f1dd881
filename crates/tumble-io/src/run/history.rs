//! The rows that a run has already written, read back so that it can go on after them.

use tumble::{DQuat, DVec3, World};

use super::folder::{LEDGER, RunFolder, TRAJECTORY};
use super::ledger::LEDGER_HEADER;
use super::recorder::Recorder;
use super::resume::ResumeError;
use super::rows::{Rows, parse_ledger, parse_trajectory};
use super::trajectory::TRAJECTORY_HEADER;
use crate::picture::{Frame, Pose};
use crate::scene::Scene;

/// The rows of a run up to a moment.
#[derive(Debug)]
pub(super) struct History {
    /// Bytes of `trajectory.csv` up to there.
    pub trajectory: u64,
    /// Bytes of `energy.csv` up to there.
    pub ledger: u64,
    /// What the pictures need of it.
    pub recorder: Recorder,
}

impl History {
    /// Reads the frames up to the state of `world`; `None` if there are no such files. What comes
    /// after, and a last row that is cut short, does not matter.
    pub fn read(
        folder: &RunFolder,
        scene: &Scene,
        world: &World,
    ) -> Result<Option<Self>, ResumeError> {
        let is_there = |name| folder.file(name).symlink_metadata().is_ok();
        if !is_there(TRAJECTORY) && !is_there(LEDGER) {
            return Ok(None);
        }
        let mut trajectory = Rows::open(folder.file(TRAJECTORY), TRAJECTORY_HEADER)?;
        let mut ledger = Rows::open(folder.file(LEDGER), LEDGER_HEADER)?;
        let mut recorder = Recorder::new(world.body_count());
        let last = world.state().step;
        let mut row = ledger.next()?.map(|row| parse_ledger(&row).ok_or(())).transpose();
        // a run that lost its first rows begins with a later frame
        let first = match row {
            Ok(Some(row)) => (row.time / scene.dt).round() as u64,
            _ => scene.next_frame(last),
        };
        let is_frame =
            if first > last { first == scene.next_frame(last) } else { scene.is_frame(first) };
        if !is_frame {
            return Err(ledger.wrong("has a first row of a time without a frame").into());
        }
        let mut step = first;
        while step <= last {
            let time = step as f64 * scene.dt;
            let next = match row {
                Ok(Some(row)) if row.time == time => row,
                Ok(None) => {
                    return Err(ledger.wrong(&format!("has no row of t = {time} s")).into());
                }
                _ => {
                    let other = format!("has another row than that of t = {time} s");
                    return Err(ledger.wrong(&other).into());
                }
            };
            let poses = poses(&mut trajectory, world, time)?;
            recorder.record_frame(Frame { time, poses }, next);
            step = scene.next_frame(step);
            if step <= last {
                row = ledger.next()?.map(|row| parse_ledger(&row).ok_or(())).transpose();
            }
        }
        // of a first frame that is still to come, the row was read but is not kept
        let ledger = if first > last { ledger.header } else { ledger.at };
        Ok(Some(Self { trajectory: trajectory.at, ledger, recorder }))
    }
}

/// The rows of one frame of `trajectory.csv`, one a body.
fn poses(rows: &mut Rows, world: &World, time: f64) -> Result<Vec<Pose>, ResumeError> {
    let mut poses = Vec::with_capacity(world.body_count());
    for body in world.bodies() {
        let name = body.name();
        let missing = format!("has no row of \"{name}\" at t = {time} s");
        let row = rows.next()?.ok_or_else(|| rows.wrong(&missing))?;
        let pose = pose(&row, time, name);
        poses.push(pose.ok_or_else(|| {
            rows.wrong(&format!("has another row than that of \"{name}\" at t = {time} s"))
        })?);
    }
    Ok(poses)
}

fn pose(row: &str, time: f64, name: &str) -> Option<Pose> {
    let (of, body, [px, py, pz, w, x, y, z, ..]) = parse_trajectory(row)?;
    if of != time || body != name {
        return None;
    }
    Some(Pose { position: DVec3::new(px, py, pz), orientation: DQuat::from_xyzw(x, y, z, w) })
}
