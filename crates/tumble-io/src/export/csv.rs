//! `.csv`: the rows of `trajectory.csv` for the selected frames.

use std::io::Write;

use super::error::ExportError;
use super::job::{Exported, Job, Progress, report};
use crate::replay::Pose;
use crate::run::{TRAJECTORY_HEADER, write_row};

pub(super) fn write(job: &Job, progress: &mut Progress) -> Result<Exported, ExportError> {
    let mut out = job.create_file()?;
    let write_error = |error| job.write_error(error);
    writeln!(out, "{TRAJECTORY_HEADER}").map_err(write_error)?;
    let frames = job.selection.frames();
    for (index, frame) in frames.clone().enumerate() {
        report(progress, index, frames.len())?;
        for (body, pose) in job.replay.world.bodies().zip(&frame.poses) {
            let row = (frame.time, Some(body.name()));
            write_row(&mut out, row, &columns(pose)).map_err(write_error)?;
        }
    }
    Ok(Exported { frames: frames.len(), bytes: out.finish()? })
}

/// The numeric columns of `trajectory.csv` after time and body.
fn columns(pose: &Pose) -> [f64; 16] {
    let (p, q, v) = (pose.position, pose.orientation, pose.velocity);
    let (w, l) = (pose.angular_velocity, pose.angular_momentum);
    [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z, l.x, l.y, l.z]
}
