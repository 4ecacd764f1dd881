//! Selects recorded frames by time and frame rate.

use super::error::ExportError;
use super::options::{ExportOptions, Format};
use crate::counted::counted;
use crate::replay::{Replay, ReplayFrame};

/// Default frame rate of videos (1/s).
const VIDEO_RATE: f64 = 30.0;
/// Frame rate of a run with a single frame (1/s).
const SINGLE_FRAME_RATE: f64 = 60.0;

/// The frames of an export; at least one.
#[derive(Debug)]
pub(super) struct FrameSelection<'a> {
    /// All recorded frames in the selected time span.
    pub span: &'a [ReplayFrame],
    /// Indices of the frames to export within `span`, in ascending order. In a video an index may
    /// occur more than once.
    pub indices: Vec<usize>,
    /// Frame rate (1/s).
    pub rate: f64,
}

impl<'a> FrameSelection<'a> {
    pub fn new(
        replay: &'a Replay,
        format: Format,
        options: &ExportOptions,
    ) -> Result<Self, ExportError> {
        let span = time_span(replay, options)?;
        let duration = duration(span);
        let recorded =
            if duration > 0.0 { (span.len() - 1) as f64 / duration } else { SINGLE_FRAME_RATE };
        // the default rate of a video is the recorded rate divided by an integer: with any other rate
        // the motion would stutter
        let stride = (recorded / (1.15 * VIDEO_RATE)).ceil().max(1.0);
        let requested = options.fps.or(format.is_video().then_some(recorded / stride));
        // a higher rate than the recorded one is not possible; the tolerance is for rounding
        let lower = requested.filter(|rate| *rate < recorded * (1.0 - 1e-6));
        if lower.is_none() && !format.is_video() {
            return Ok(Self { span, indices: (0..span.len()).collect(), rate: recorded });
        }
        let rate = lower.unwrap_or(recorded);
        let count = ((duration * rate * (1.0 + 1e-9)) as usize + 1).min(span.len());
        let mut indices: Vec<usize> =
            (0..count).map(|i| nearest_frame(span, span[0].time + i as f64 / rate)).collect();
        // a video repeats a frame rather than change its rate
        if !format.is_video() {
            indices.dedup();
        }
        Ok(Self { span, indices, rate })
    }

    /// The index within `span` of the frame nearest to `time` (s).
    pub fn frame_at(&self, time: f64) -> Result<usize, ExportError> {
        let (first, last) = (self.span[0].time, self.span[self.span.len() - 1].time);
        let tolerance = 1.0 / self.rate;
        if !(first - tolerance..=last + tolerance).contains(&time) {
            return Err(ExportError::NoFrames(format!(
                "no frame was recorded at {time} s; the frames go from {first} s to {last} s"
            )));
        }
        Ok(nearest_frame(self.span, time))
    }

    /// The frames to export.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = &'a ReplayFrame> + Clone + '_ {
        self.indices.iter().map(|&index| &self.span[index])
    }
}

/// The frames from `--from` to `--to-time`.
fn time_span<'a>(
    replay: &'a Replay,
    options: &ExportOptions,
) -> Result<&'a [ReplayFrame], ExportError> {
    let frames = &replay.frames;
    let (from, to) = (options.from.unwrap_or(f64::MIN), options.to_time.unwrap_or(f64::MAX));
    // `--to-time 0.3` includes a frame at 0.30000000000000004 s
    let tolerance = 1e-9 * frames.last().map_or(0.0, |last| last.time.abs());
    let start = frames.partition_point(|frame| frame.time < from - tolerance);
    let end = frames.partition_point(|frame| frame.time <= to + tolerance);
    match frames.get(start..end) {
        Some(span) if !span.is_empty() => Ok(span),
        _ => {
            let (first, last) =
                frames.first().zip(frames.last()).map_or((0.0, 0.0), |(a, b)| (a.time, b.time));
            Err(ExportError::NoFrames(format!(
                "no frame was recorded in the selected time span; the run has {}, from {first} s to \
                 {last} s",
                counted(frames.len(), "frame", "frames"),
            )))
        }
    }
}

/// Time from the first to the last frame (s).
fn duration(span: &[ReplayFrame]) -> f64 {
    span.first().zip(span.last()).map_or(0.0, |(a, b)| b.time - a.time)
}

/// The index of the frame nearest to `time` (s).
fn nearest_frame(span: &[ReplayFrame], time: f64) -> usize {
    let after = span.partition_point(|frame| frame.time < time).min(span.len() - 1);
    let before = after.saturating_sub(1);
    let is_before_nearer = time - span[before].time < span[after].time - time;
    if is_before_nearer { before } else { after }
}
