//! The renderer with the frames of a run, for images and video.

use super::job::Job;
use crate::picture::{Frame, Pose, Renderer};
use crate::replay;
use crate::run::draw_run;

/// Calls `draw` with a renderer for images of `size` (width and height in pixels).
///
/// The renderer holds all frames of the selected time span. The index of a frame is its index in
/// `job.selection.span`.
pub(super) fn with_renderer<T>(
    job: &Job,
    size: (u32, u32),
    draw: impl FnOnce(&Renderer) -> T,
) -> T {
    let pose =
        |pose: &replay::Pose| Pose { position: pose.position, orientation: pose.orientation };
    let frames: Vec<Frame> = job
        .selection
        .span
        .iter()
        .map(|frame| Frame { time: frame.time, poses: frame.poses.iter().map(pose).collect() })
        .collect();
    let view = (size, job.options.view);
    draw_run((&job.replay.scene, &job.replay.world), &frames, view, draw)
}
