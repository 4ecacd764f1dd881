//! The frames of a run for the page: binary records, thinned out when they become too many.

use tumble::{DQuat, DVec3, World, Wrench};

use crate::plot::EnergyRow;

/// No page keeps more frames than this.
const MOST_FRAMES: usize = 20_000;
/// Nor more bytes: as base64 they make some 40 MB.
const MOST_BYTES: usize = 30_000_000;

/// What a frame says of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyFrame {
    /// Centre of mass x (m).
    pub position: DVec3,
    /// Orientation q, body axes to world axes.
    pub orientation: DQuat,
    /// Velocity v (m/s).
    pub velocity: DVec3,
    /// Angular velocity ω, world axes (rad/s).
    pub angular_velocity: DVec3,
    /// Angular momentum L about the centre of mass, world axes (kg·m²/s).
    pub angular_momentum: DVec3,
    /// What the walls did in the step before, about the centre of mass (N, N·m).
    pub contact: Wrench,
}

impl BodyFrame {
    /// All bodies of a world as they are now.
    pub fn all(world: &World) -> impl ExactSizeIterator<Item = Self> + '_ {
        (0..world.body_count()).map(|index| {
            let body = world.body(index);
            Self {
                position: body.position(),
                orientation: body.orientation(),
                velocity: body.velocity(),
                angular_velocity: body.angular_velocity(),
                angular_momentum: body.angular_momentum(),
                contact: world.contact_wrench(index),
            }
        })
    }
}

/// Bytes of the record of one frame: ten doubles, and 22 floats a body.
pub fn record_size(body_count: usize) -> usize {
    80 + 88 * body_count
}

/// Appends the record of one frame to `out`, little endian: time, step and the eight columns of the
/// ledger as doubles; then for each body, as floats, position, orientation w x y z, velocity, angular
/// velocity, angular momentum, contact force and contact torque.
pub fn encode_frame(
    out: &mut Vec<u8>,
    step: u64,
    row: &EnergyRow,
    bodies: impl Iterator<Item = BodyFrame>,
) {
    // the page finds the work from the rest: the sum of the parts less the total
    let EnergyRow { time, kinetic, gravitational, elastic, drag, .. } = *row;
    let EnergyRow { dashpot, slip, work: _, total, residual, .. } = *row;
    let ledger = [kinetic, gravitational, elastic, drag, dashpot, slip, total, residual];
    for number in [time, step as f64].into_iter().chain(ledger) {
        out.extend(number.to_le_bytes());
    }
    for body in bodies {
        let q = body.orientation;
        put(out, &body.position.to_array());
        put(out, &[q.w, q.x, q.y, q.z]);
        let rest = [
            body.velocity,
            body.angular_velocity,
            body.angular_momentum,
            body.contact.force,
            body.contact.torque,
        ];
        rest.into_iter().for_each(|v| put(out, &v.to_array()));
    }
}

fn put(out: &mut Vec<u8>, numbers: &[f64]) {
    for &number in numbers {
        out.extend((number as f32).to_le_bytes());
    }
}

/// The frames of a run, thinned out by half whenever they become too many.
#[derive(Clone, Debug)]
pub struct Film {
    records: Vec<u8>,
    size: usize,
    most: usize,
    stride: u64,
    seen: u64,
    /// The latest frame, if it is not among the records.
    last: Vec<u8>,
}

impl Film {
    /// For a world of `body_count` bodies.
    pub fn new(body_count: usize) -> Self {
        let size = record_size(body_count);
        Self::holding(size, (MOST_BYTES / size).clamp(2, MOST_FRAMES))
    }

    pub(super) fn holding(size: usize, most: usize) -> Self {
        Self { records: Vec::new(), size, most, stride: 1, seen: 0, last: Vec::new() }
    }

    /// One more frame; see [`encode_frame`].
    pub fn record(&mut self, step: u64, row: &EnergyRow, bodies: impl Iterator<Item = BodyFrame>) {
        self.last.clear();
        encode_frame(&mut self.last, step, row, bodies);
        if self.seen.is_multiple_of(self.stride) && self.kept() == self.most {
            self.stride *= 2;
            self.keep_even();
        }
        if self.seen.is_multiple_of(self.stride) {
            self.records.append(&mut self.last);
        }
        self.seen += 1;
    }

    /// How many frames were recorded, those that were thinned out included.
    pub fn seen(&self) -> u64 {
        self.seen
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.seen == 0
    }

    /// How many frames [`Film::records`] holds.
    pub fn frame_count(&self) -> usize {
        self.kept() + usize::from(!self.last.is_empty())
    }

    /// The records that are kept, one after the other, and the latest one.
    pub fn records(&self) -> Vec<u8> {
        [self.records.as_slice(), &self.last].concat()
    }

    fn kept(&self) -> usize {
        self.records.len() / self.size
    }

    fn keep_even(&mut self) {
        let mut to = 0;
        for from in (0..self.records.len()).step_by(2 * self.size) {
            self.records.copy_within(from..from + self.size, to);
            to += self.size;
        }
        self.records.truncate(to);
    }
}
