//! `.csv`: the rows of `trajectory.csv`, some of its frames.

use std::io::Write;

use super::{ExportError, Exported, Job, Watch, tell};
use crate::replay::Pose;
use crate::run::{TRAJECTORY_HEADER, write_row};

pub(super) fn write(job: &Job, watch: &mut Watch) -> Result<Exported, ExportError> {
    let mut out = job.draft()?;
    let failed = |error| job.failed(error);
    writeln!(out, "{TRAJECTORY_HEADER}").map_err(failed)?;
    let frames = job.chosen.frames();
    for (index, frame) in frames.clone().enumerate() {
        tell(watch, index, frames.len())?;
        for (body, pose) in job.replay.world.bodies().zip(&frame.poses) {
            write_row(&mut out, (frame.time, Some(body.name())), &numbers(pose)).map_err(failed)?;
        }
    }
    Ok(Exported { frames: frames.len(), bytes: out.finish()? })
}

fn numbers(pose: &Pose) -> [f64; 16] {
    let (p, q, v) = (pose.position, pose.orientation, pose.velocity);
    let (w, l) = (pose.angular_velocity, pose.angular_momentum);
    [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z, l.x, l.y, l.z]
}
