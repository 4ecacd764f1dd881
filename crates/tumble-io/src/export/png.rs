//! `.png`: the whole motion, or one moment; and what all pictures of a run share.

use std::io::Write;

use super::{ExportError, Exported, Job, Watch, tell};
use crate::picture::{Frame, Pose, Renderer, encode_png};
use crate::run::in_studio;

pub(super) fn write(job: &Job, watch: &mut Watch) -> Result<Exported, ExportError> {
    let options = &job.export.options;
    let moment = options.at.map(|time| job.chosen.moment(time)).transpose()?;
    let size = options.picture_size(job.export.format);
    let image = drawn(job, size, |studio| match moment {
        Some(frame) => studio.render_frame(frame),
        None => studio.render_motion(),
    });
    tell(watch, 1, 1)?;
    let bytes = encode_png(&image).map_err(|error| ExportError::Draw(error.to_string()))?;
    let mut out = job.draft()?;
    out.write_all(&bytes).map_err(|error| job.failed(error))?;
    Ok(Exported { frames: 1, bytes: out.finish()? })
}

/// Draws with a studio that knows all frames of the span of time, under the indices they have in it.
pub(super) fn drawn<T>(job: &Job, size: (u32, u32), draw: impl FnOnce(&Renderer) -> T) -> T {
    let pose = |pose: &crate::replay::Pose| Pose {
        position: pose.position,
        orientation: pose.orientation,
    };
    let frames: Vec<Frame> = job
        .chosen
        .span
        .iter()
        .map(|frame| Frame { time: frame.time, poses: frame.poses.iter().map(pose).collect() })
        .collect();
    let view = (size, job.export.options.view);
    in_studio((&job.replay.scene, &job.replay.world), &frames, view, draw)
}
