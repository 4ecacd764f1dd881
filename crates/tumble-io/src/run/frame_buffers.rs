//! The frames that a run holds in memory for its pictures and its page.

use tumble::World;

use crate::page::{BodyFrame, Recording, WorldFrame};
use crate::picture::{Frame, Pose};
use crate::plot::EnergyRow;

/// Frames for the pictures and for the page.
#[derive(Debug)]
pub(super) struct FrameBuffers {
    /// For `energy.svg` and `motion.png`.
    pub pictures: FrameHistory,
    /// For `motion.html`.
    pub page: Recording,
}

impl FrameBuffers {
    /// Empty buffers for a world.
    pub fn new(world: &World) -> Self {
        let (bodies, joints) = (world.body_count(), world.joint_count());
        Self { pictures: FrameHistory::new(bodies), page: Recording::new(bodies, joints) }
    }

    /// Adds a frame: the step, the row of the energy ledger, all bodies and joints.
    pub fn record(&mut self, step: u64, row: &EnergyRow, frame: &WorldFrame) {
        self.pictures.record(picture_frame(row.time, &frame.bodies), *row);
        self.page.record(step, row, frame);
    }
}

/// The poses of a frame at `time` (s).
pub(super) fn picture_frame(time: f64, bodies: &[BodyFrame]) -> Frame {
    let pose = |body: &BodyFrame| Pose { position: body.position, orientation: body.orientation };
    Frame { time, poses: bodies.iter().map(pose).collect() }
}

/// Frames and energy rows of a run, evenly thinned to bounded memory.
///
/// When the buffer is full, every other frame is dropped and the stride doubles.
#[derive(Debug)]
pub struct FrameHistory {
    frames: Vec<Frame>,
    rows: Vec<EnergyRow>,
    capacity: usize,
    /// One of so many recorded frames is stored.
    stride: u64,
    /// Frames recorded, including those dropped.
    recorded: u64,
    last: Option<(Frame, EnergyRow)>,
}

impl FrameHistory {
    /// An empty history for a world of `body_count` bodies.
    pub fn new(body_count: usize) -> Self {
        // about a million poses in all: some tens of megabytes
        let capacity = (1_000_000 / body_count.max(1)).clamp(16, 4096);
        Self { frames: Vec::new(), rows: Vec::new(), capacity, stride: 1, recorded: 0, last: None }
    }

    /// Adds a frame with its row of the energy ledger.
    pub fn record(&mut self, frame: Frame, row: EnergyRow) {
        if self.recorded.is_multiple_of(self.stride) {
            if self.frames.len() == self.capacity {
                self.stride *= 2;
                retain_even(&mut self.frames);
                retain_even(&mut self.rows);
            }
            if self.recorded.is_multiple_of(self.stride) {
                self.frames.push(frame.clone());
                self.rows.push(row);
            }
        }
        self.last = Some((frame, row));
        self.recorded += 1;
    }

    /// The stored frames and rows, always with the last one recorded.
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

fn retain_even<T>(items: &mut Vec<T>) {
    let mut index = 0;
    items.retain(|_| {
        index += 1;
        index % 2 == 1
    });
}
