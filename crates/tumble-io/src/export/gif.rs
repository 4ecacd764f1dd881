//! `.gif`: an animated image that repeats forever, in real time.

use std::borrow::Cow;

use ::gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

use super::error::ExportError;
use super::images::with_renderer;
use super::job::{Exported, Job, Progress, report};
use super::palette::{COLOUR_COUNT, Palette};
use crate::picture::Renderer;

/// Colour index of a pixel that does not change.
const TRANSPARENT: u8 = COLOUR_COUNT as u8;
/// Minimum delay between frames (1/100 s). Players replace a shorter delay by a longer one.
const MIN_DELAY: f64 = 2.0;
/// Number of frames from which the palette is computed.
const PALETTE_FRAMES: usize = 6;
/// Delay after the last frame (1/100 s), before the animation repeats.
const LAST_DELAY: f64 = 100.0;

pub(super) fn write(job: &Job, progress: &mut Progress) -> Result<Exported, ExportError> {
    let schedule = schedule(&job.selection.indices, job.selection.rate);
    let (width, height) = job.options.image_size(job.format);
    with_renderer(job, (width, height), |renderer| {
        let mut palette = palette(renderer, &schedule, progress)?;
        let mut out = job.create_file()?;
        let mut colours = palette.colours();
        colours.resize(3 * (COLOUR_COUNT + 1), 0);
        let (w, h) = (width as u16, height as u16);
        let encoding_error = |error| encoding_error(job, error);
        let mut encoder = Encoder::new(&mut out, w, h, &colours).map_err(encoding_error)?;
        encoder.set_repeat(Repeat::Infinite).map_err(encoding_error)?;
        let mut previous = Vec::new();
        for (done, &(index, delay)) in schedule.iter().enumerate() {
            report(progress, done, schedule.len())?;
            let pixels = palette.indices(&renderer.render_animation_frame(index).pixels);
            let frame = frame(&previous, &pixels, (w, h), delay);
            encoder.write_frame(&frame).map_err(encoding_error)?;
            previous = pixels;
        }
        encoder.into_inner().map_err(encoding_error)?;
        Ok(Exported { frames: schedule.len(), bytes: out.finish()? })
    })
}

/// The frames to show, each with its delay (1/100 s).
///
/// The times are rounded, not the delays, so that the total duration is exact.
fn schedule(indices: &[usize], rate: f64) -> Vec<(usize, u16)> {
    let step = 100.0 / rate;
    let mut shown: Vec<(usize, f64)> = Vec::new();
    for (number, &index) in indices.iter().enumerate() {
        let time = number as f64 * step;
        if shown.last().is_none_or(|(_, last)| time - last >= MIN_DELAY - 1e-9) {
            shown.push((index, time));
        }
    }
    let end = shown.last().map_or(0.0, |(_, last)| last + LAST_DELAY);
    let ends = shown.iter().skip(1).map(|(_, time)| *time).chain([end]);
    let delays = ends.zip(&shown).map(|(end, (_, start))| (end.round() - start.round()) as u16);
    shown.iter().map(|(index, _)| *index).zip(delays).collect()
}

/// The palette of some frames, evenly distributed over the animation.
fn palette(
    renderer: &Renderer,
    schedule: &[(usize, u16)],
    progress: &mut Progress,
) -> Result<Palette, ExportError> {
    let mut samples = Vec::new();
    for sample in 0..PALETTE_FRAMES.min(schedule.len()) {
        report(progress, 0, schedule.len())?;
        let (index, _) = schedule[sample * (schedule.len() - 1) / (PALETTE_FRAMES - 1).max(1)];
        samples.push(renderer.render_animation_frame(index).pixels);
    }
    Ok(Palette::from_frames(samples.iter().map(Vec::as_slice)))
}

/// The smallest rectangle that contains all changed pixels; unchanged pixels in it are transparent.
fn frame(
    previous: &[u8],
    pixels: &[u8],
    (width, height): (u16, u16),
    delay: u16,
) -> Frame<'static> {
    let row = usize::from(width);
    let mut frame = Frame { delay, dispose: DisposalMethod::Keep, ..Frame::default() };
    if previous.is_empty() {
        (frame.width, frame.height, frame.buffer) = (width, height, Cow::Owned(pixels.to_vec()));
        return frame;
    }
    let (mut low, mut high) = ((row, usize::from(height)), (0, 0));
    for (at, _) in pixels.iter().zip(previous).enumerate().filter(|(_, (new, old))| new != old) {
        let (x, y) = (at % row, at / row);
        low = (low.0.min(x), low.1.min(y));
        high = (high.0.max(x + 1), high.1.max(y + 1));
    }
    // if nothing changed, one transparent pixel carries the delay
    if high == (0, 0) {
        (low, high) = ((0, 0), (1, 1));
    }
    let rows = (low.1..high.1).map(|y| y * row);
    let inside = rows.flat_map(|start| start + low.0..start + high.0);
    let buffer: Vec<u8> = inside
        .map(|at| if pixels[at] == previous[at] { TRANSPARENT } else { pixels[at] })
        .collect();
    (frame.left, frame.top) = (low.0 as u16, low.1 as u16);
    (frame.width, frame.height) = ((high.0 - low.0) as u16, (high.1 - low.1) as u16);
    frame.transparent = Some(TRANSPARENT);
    frame.buffer = Cow::Owned(buffer);
    frame
}

fn encoding_error(job: &Job, error: EncodingError) -> ExportError {
    match error {
        EncodingError::Io(error) => job.write_error(error),
        other => ExportError::Draw(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_delays_add_up_to_the_duration() {
        let indices: Vec<usize> = (0..=90).collect();
        let shown = schedule(&indices, 30.0);
        assert_eq!(shown.len(), 91);
        let total: u32 = shown.iter().map(|(_, delay)| u32::from(*delay)).sum();
        assert_eq!(total, 300 + 100);
        // a higher rate than players support
        let shown = schedule(&indices, 200.0);
        assert!(shown.iter().all(|(_, delay)| *delay >= 2));
        let total: u32 = shown.iter().map(|(_, delay)| u32::from(*delay)).sum();
        assert_eq!(total, 44 + 100);
        assert_eq!(schedule(&[7], 60.0), [(7, 100)]);
    }

    #[test]
    fn a_frame_contains_only_changed_pixels() {
        let before = [0, 1, 2, 3, 4, 5];
        let first = frame(&[], &before, (3, 2), 4);
        assert_eq!((first.width, first.height, first.transparent), (3, 2, None));
        let next = frame(&before, &[0, 9, 2, 3, 4, 8], (3, 2), 4);
        assert_eq!((next.left, next.top, next.width, next.height), (1, 0, 2, 2));
        assert_eq!(next.buffer.as_ref(), [9, TRANSPARENT, TRANSPARENT, 8]);
        let same = frame(&before, &before, (3, 2), 4);
        assert_eq!((same.width, same.height, same.buffer.as_ref()), (1, 1, &[TRANSPARENT][..]));
    }
}
