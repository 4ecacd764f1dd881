//! Which of the recorded frames are meant.

use super::{ExportError, ExportOptions, Format};
use crate::replay::{Replay, ReplayFrame};

/// The usual rate of films (1/s).
const FILM: f64 = 30.0;
/// The usual rate where frames come one by one (1/s).
const LONE: f64 = 60.0;

/// The frames of an export, at least one.
#[derive(Debug)]
pub(super) struct Chosen<'a> {
    /// All recorded frames of the span of time that is meant.
    pub span: &'a [ReplayFrame],
    /// Those of `span` that are meant, times rising.
    pub indices: Vec<usize>,
    /// Frames a second.
    pub rate: f64,
}

impl<'a> Chosen<'a> {
    pub fn new(
        replay: &'a Replay,
        format: Format,
        options: &ExportOptions,
    ) -> Result<Self, ExportError> {
        let span = span(replay, options)?;
        let duration = duration(span);
        let recorded = if duration > 0.0 { (span.len() - 1) as f64 / duration } else { LONE };
        // of the rates that show every frame, every second, … the one near the usual rate: others
        // would stutter
        let every = (recorded / (1.15 * FILM)).ceil().max(1.0);
        let asked = options.fps.or(format.is_film().then_some(recorded / every));
        // some rounding aside, an asked rate above the recorded one is the recorded one
        let slower = asked.filter(|rate| *rate < recorded * (1.0 - 1e-6));
        if slower.is_none() && !format.is_film() {
            return Ok(Self { span, indices: (0..span.len()).collect(), rate: recorded });
        }
        let rate = slower.unwrap_or(recorded);
        let count = ((duration * rate * (1.0 + 1e-9)) as usize + 1).min(span.len());
        let mut indices: Vec<usize> =
            (0..count).map(|i| nearest(span, span[0].time + i as f64 / rate)).collect();
        // a film keeps its beat
        if !format.is_film() {
            indices.dedup();
        }
        Ok(Self { span, indices, rate })
    }

    /// The index within `span` of the frame nearest to `time` (s).
    pub fn moment(&self, time: f64) -> Result<usize, ExportError> {
        let (first, last) = (self.span[0].time, self.span[self.span.len() - 1].time);
        let slack = 1.0 / self.rate;
        if !(first - slack..=last + slack).contains(&time) {
            return Err(ExportError::NoFrames(format!(
                "no frame was recorded at {time} s; the frames go from {first} s to {last} s"
            )));
        }
        Ok(nearest(self.span, time))
    }

    /// The frames that are meant.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = &'a ReplayFrame> + Clone + '_ {
        self.indices.iter().map(|&index| &self.span[index])
    }
}

/// The frames from `--from` to `--to-time`.
fn span<'a>(replay: &'a Replay, options: &ExportOptions) -> Result<&'a [ReplayFrame], ExportError> {
    let frames = &replay.frames;
    let (from, to) = (options.from.unwrap_or(f64::MIN), options.to_time.unwrap_or(f64::MAX));
    // 0.3 is meant to hold a frame of 0.30000000000000004 s
    let slack = 1e-9 * frames.last().map_or(0.0, |last| last.time.abs());
    let start = frames.partition_point(|frame| frame.time < from - slack);
    let end = frames.partition_point(|frame| frame.time <= to + slack);
    match frames.get(start..end) {
        Some(span) if !span.is_empty() => Ok(span),
        _ => {
            let ends =
                frames.first().zip(frames.last()).map_or((0.0, 0.0), |(a, b)| (a.time, b.time));
            Err(ExportError::NoFrames(format!(
                "no frame was recorded in the asked time; the run has {} from {} s to {} s",
                frames.len(),
                ends.0,
                ends.1
            )))
        }
    }
}

fn duration(span: &[ReplayFrame]) -> f64 {
    span.first().zip(span.last()).map_or(0.0, |(a, b)| b.time - a.time)
}

/// The frame whose time (s) is nearest.
fn nearest(span: &[ReplayFrame], time: f64) -> usize {
    let after = span.partition_point(|frame| frame.time < time).min(span.len() - 1);
    let before = after.saturating_sub(1);
    let nearer = time - span[before].time < span[after].time - time;
    if nearer { before } else { after }
}
