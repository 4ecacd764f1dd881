//! `.gif`: an animated picture that runs for ever, in real time.

use std::borrow::Cow;

use ::gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

use super::palette::{COLOURS, Palette};
use super::png::drawn;
use super::{ExportError, Exported, Job, Watch, tell};
use crate::picture::Renderer;

/// The number of the colour that leaves a pixel as it was.
const AS_BEFORE: u8 = COLOURS as u8;
/// Players show a shorter delay as a longer one (1/100 s).
const LEAST_DELAY: f64 = 2.0;
/// So many frames teach the palette.
const LESSONS: usize = 6;
/// The last frame stays for so long (1/100 s), so that the end can be seen.
const REST: f64 = 100.0;

pub(super) fn write(job: &Job, watch: &mut Watch) -> Result<Exported, ExportError> {
    let beats = beats(&job.chosen.indices, job.chosen.rate);
    let (width, height) = job.export.options.picture_size(job.export.format);
    drawn(job, (width, height), |studio| {
        let mut palette = palette(studio, &beats, watch)?;
        let mut out = job.draft()?;
        let mut colours = palette.colours();
        colours.resize(3 * (COLOURS + 1), 0);
        let (w, h) = (width as u16, height as u16);
        let failed = |error| failed(job, error);
        let mut encoder = Encoder::new(&mut out, w, h, &colours).map_err(failed)?;
        encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
        let mut before = Vec::new();
        for (done, &(index, delay)) in beats.iter().enumerate() {
            tell(watch, done, beats.len())?;
            let now = palette.numbers(&studio.render_animation_frame(index).pixels);
            encoder.write_frame(&frame(&before, &now, (w, h), delay)).map_err(failed)?;
            before = now;
        }
        encoder.into_inner().map_err(failed)?;
        Ok(Exported { frames: beats.len(), bytes: out.finish()? })
    })
}

/// Which frames to show, and for how long (1/100 s); rounded so that the whole keeps its time.
fn beats(indices: &[usize], rate: f64) -> Vec<(usize, u16)> {
    let step = 100.0 / rate;
    let mut shown: Vec<(usize, f64)> = Vec::new();
    for (number, &index) in indices.iter().enumerate() {
        let at = number as f64 * step;
        if shown.last().is_none_or(|(_, last)| at - last >= LEAST_DELAY - 1e-9) {
            shown.push((index, at));
        }
    }
    let end = shown.last().map_or(0.0, |(_, last)| last + REST);
    let ends = shown.iter().skip(1).map(|(_, at)| *at).chain([end]);
    let delays = ends.zip(&shown).map(|(end, (_, at))| (end.round() - at.round()) as u16);
    shown.iter().map(|(index, _)| *index).zip(delays).collect()
}

fn palette(
    studio: &Renderer,
    beats: &[(usize, u16)],
    watch: &mut Watch,
) -> Result<Palette, ExportError> {
    let mut lessons = Vec::new();
    for lesson in 0..LESSONS.min(beats.len()) {
        tell(watch, 0, beats.len())?;
        let (index, _) = beats[lesson * (beats.len() - 1) / (LESSONS - 1).max(1)];
        lessons.push(studio.render_animation_frame(index).pixels);
    }
    Ok(Palette::learn(lessons.iter().map(Vec::as_slice)))
}

/// The rectangle of what changed; what stayed in it is left as it was.
fn frame(before: &[u8], now: &[u8], (width, height): (u16, u16), delay: u16) -> Frame<'static> {
    let row = usize::from(width);
    let mut frame = Frame { delay, dispose: DisposalMethod::Keep, ..Frame::default() };
    if before.is_empty() {
        (frame.width, frame.height, frame.buffer) = (width, height, Cow::Owned(now.to_vec()));
        return frame;
    }
    let (mut low, mut high) = ((row, usize::from(height)), (0, 0));
    for (at, _) in now.iter().zip(before).enumerate().filter(|(_, (now, before))| now != before) {
        let (x, y) = (at % row, at / row);
        low = (low.0.min(x), low.1.min(y));
        high = (high.0.max(x + 1), high.1.max(y + 1));
    }
    // nothing changed: a single pixel keeps the time
    if high == (0, 0) {
        (low, high) = ((0, 0), (1, 1));
    }
    let rows = (low.1..high.1).map(|y| y * row);
    let pixels = rows.flat_map(|start| start + low.0..start + high.0);
    let buffer: Vec<u8> =
        pixels.map(|at| if now[at] == before[at] { AS_BEFORE } else { now[at] }).collect();
    (frame.left, frame.top) = (low.0 as u16, low.1 as u16);
    (frame.width, frame.height) = ((high.0 - low.0) as u16, (high.1 - low.1) as u16);
    frame.transparent = Some(AS_BEFORE);
    frame.buffer = Cow::Owned(buffer);
    frame
}

fn failed(job: &Job, error: EncodingError) -> ExportError {
    match error {
        EncodingError::Io(error) => job.failed(error),
        other => ExportError::Draw(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_keeps_its_time() {
        let indices: Vec<usize> = (0..=90).collect();
        let shown = beats(&indices, 30.0);
        assert_eq!(shown.len(), 91);
        let total: u32 = shown.iter().map(|(_, delay)| u32::from(*delay)).sum();
        assert_eq!(total, 300 + 100);
        // more than players can show
        let shown = beats(&indices, 200.0);
        assert!(shown.iter().all(|(_, delay)| *delay >= 2));
        let total: u32 = shown.iter().map(|(_, delay)| u32::from(*delay)).sum();
        assert_eq!(total, 44 + 100);
        assert_eq!(beats(&[7], 60.0), [(7, 100)]);
    }

    #[test]
    fn only_what_changed_is_in_a_frame() {
        let before = [0, 1, 2, 3, 4, 5];
        let first = frame(&[], &before, (3, 2), 4);
        assert_eq!((first.width, first.height, first.transparent), (3, 2, None));
        let next = frame(&before, &[0, 9, 2, 3, 4, 8], (3, 2), 4);
        assert_eq!((next.left, next.top, next.width, next.height), (1, 0, 2, 2));
        assert_eq!(next.buffer.as_ref(), [9, AS_BEFORE, AS_BEFORE, 8]);
        let same = frame(&before, &before, (3, 2), 4);
        assert_eq!((same.width, same.height, same.buffer.as_ref()), (1, 1, &[AS_BEFORE][..]));
    }
}
