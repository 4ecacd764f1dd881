//! What a run remembers for its pictures: few enough frames to keep, however long it is.

use crate::picture::Frame;
use crate::plot::EnergyRow;

/// Frames and ledger rows, thinned out by half whenever they become too many.
#[derive(Debug)]
pub struct Recorder {
    frames: Vec<Frame>,
    rows: Vec<EnergyRow>,
    most: usize,
    stride: u64,
    seen: u64,
    last: Option<(Frame, EnergyRow)>,
}

impl Recorder {
    /// For a world of `body_count` bodies.
    pub fn new(body_count: usize) -> Self {
        // about a million poses in all: some tens of megabytes
        let most = (1_000_000 / body_count.max(1)).clamp(16, 4096);
        Self { frames: Vec::new(), rows: Vec::new(), most, stride: 1, seen: 0, last: None }
    }

    /// Remembers a frame, as it was recorded.
    pub fn record_frame(&mut self, frame: Frame, row: EnergyRow) {
        if self.seen.is_multiple_of(self.stride) {
            if self.frames.len() == self.most {
                self.stride *= 2;
                keep_even(&mut self.frames);
                keep_even(&mut self.rows);
            }
            if self.seen.is_multiple_of(self.stride) {
                self.frames.push(frame.clone());
                self.rows.push(row);
            }
        }
        self.last = Some((frame, row));
        self.seen += 1;
    }

    /// Everything that is remembered, the last moment included.
    pub fn finish(mut self) -> (Vec<Frame>, Vec<EnergyRow>) {
        if let Some((frame, row)) = self.last
            && self.frames.last() != Some(&frame)
        {
            self.frames.push(frame);
            self.rows.push(row);
        }
        (self.frames, self.rows)
    }
}

fn keep_even<T>(items: &mut Vec<T>) {
    let mut index = 0;
    items.retain(|_| {
        index += 1;
        index % 2 == 1
    });
}
