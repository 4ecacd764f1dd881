//! The frames of a run for the page, as binary records. Long runs are thinned out.

use tumble::{DQuat, DVec3, JointView, World, Wrench};

use crate::plot::EnergyRow;

/// Maximum number of frames in a page.
const MAX_FRAMES: usize = 20_000;
/// Maximum size of the records in a page (bytes): about 40 MB as base64.
const MAX_BYTES: usize = 30_000_000;

/// State of one body in a frame.
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
    /// Contact wrench of the walls in the previous step, about the centre of mass (N, N·m).
    pub contact: Wrench,
}

impl BodyFrame {
    /// The current state of all bodies of a world.
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

/// The bodies and joints of a world in a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorldFrame {
    /// All bodies.
    pub bodies: Vec<BodyFrame>,
    /// All joints.
    pub joints: Vec<JointView>,
}

impl WorldFrame {
    /// The current state of a world.
    pub fn new(world: &World) -> Self {
        let joints = (0..world.joint_count()).map(|index| world.joint(index));
        Self { bodies: BodyFrame::all(world).collect(), joints: joints.collect() }
    }
}

/// Size of the record of one frame (bytes): thirteen `f64`, 22 `f32` per body, and 8 `f32` per joint.
pub fn record_size(body_count: usize, joint_count: usize) -> usize {
    104 + 88 * body_count + 32 * joint_count
}

/// Appends the record of one frame to `out`.
///
/// All numbers are little-endian. As `f64`: time, step, and the energies kinetic, gravitational,
/// elastic, drag, dashpot, slip, numerical, spring, joint friction, total and residual. Then as `f32` for each body: position, orientation
/// w x y z, velocity, angular velocity, angular momentum, contact force and contact torque. Then as `f32` for each joint: force and
/// torque on its first body, coordinate and rate.
pub fn encode_frame(out: &mut Vec<u8>, step: u64, row: &EnergyRow, frame: &WorldFrame) {
    // the page computes the work, that of motors included, as the sum of the parts minus the total
    let EnergyRow { time, kinetic, gravitational, elastic, drag, .. } = *row;
    let EnergyRow { dashpot, slip, numerical, spring, joint_friction, total, residual, .. } = *row;
    let losses = [drag, dashpot, slip, numerical, spring, joint_friction];
    let ledger =
        [kinetic, gravitational, elastic].into_iter().chain(losses).chain([total, residual]);
    for number in [time, step as f64].into_iter().chain(ledger) {
        out.extend(number.to_le_bytes());
    }
    for body in &frame.bodies {
        let q = body.orientation;
        write_f32(out, &body.position.to_array());
        write_f32(out, &[q.w, q.x, q.y, q.z]);
        let vectors = [
            body.velocity,
            body.angular_velocity,
            body.angular_momentum,
            body.contact.force,
            body.contact.torque,
        ];
        vectors.into_iter().for_each(|v| write_f32(out, &v.to_array()));
    }
    for JointView { wrench, coordinate, rate } in &frame.joints {
        write_f32(out, &wrench.force.to_array());
        write_f32(out, &wrench.torque.to_array());
        write_f32(out, &[*coordinate, *rate]);
    }
}

fn write_f32(out: &mut Vec<u8>, numbers: &[f64]) {
    for &number in numbers {
        out.extend((number as f32).to_le_bytes());
    }
}

/// The recorded frames of a run. When there are too many, every second one is removed.
#[derive(Clone, Debug)]
pub struct Recording {
    records: Vec<u8>,
    record_size: usize,
    /// Maximum number of frames in `records`.
    capacity: usize,
    /// `records` contains every frame whose number is a multiple of this.
    stride: u64,
    recorded: u64,
    /// The record of the latest frame, if it is not in `records`.
    last: Vec<u8>,
}

impl Recording {
    /// An empty recording of a world with so many bodies and joints.
    pub fn new(body_count: usize, joint_count: usize) -> Self {
        let size = record_size(body_count, joint_count);
        Self::with_capacity(size, (MAX_BYTES / size).clamp(2, MAX_FRAMES))
    }

    /// An empty recording of at most `capacity` frames with records of `record_size` bytes.
    pub(super) fn with_capacity(record_size: usize, capacity: usize) -> Self {
        let (records, last) = (Vec::new(), Vec::new());
        Self { records, record_size, capacity, stride: 1, recorded: 0, last }
    }

    /// Appends a frame; see [`encode_frame`].
    pub fn record(&mut self, step: u64, row: &EnergyRow, frame: &WorldFrame) {
        self.last.clear();
        encode_frame(&mut self.last, step, row, frame);
        if self.recorded.is_multiple_of(self.stride) && self.stored() == self.capacity {
            self.stride *= 2;
            self.remove_odd_frames();
        }
        if self.recorded.is_multiple_of(self.stride) {
            self.records.append(&mut self.last);
        }
        self.recorded += 1;
    }

    /// Number of recorded frames, including removed ones.
    pub fn recorded_count(&self) -> u64 {
        self.recorded
    }

    /// Whether no frame was recorded.
    pub fn is_empty(&self) -> bool {
        self.recorded == 0
    }

    /// Number of frames in [`Recording::records`].
    pub fn frame_count(&self) -> usize {
        self.stored() + usize::from(!self.last.is_empty())
    }

    /// The records that are left, one after the other; always includes the first and the latest frame.
    pub fn records(&self) -> Vec<u8> {
        [self.records.as_slice(), &self.last].concat()
    }

    fn stored(&self) -> usize {
        self.records.len() / self.record_size
    }

    fn remove_odd_frames(&mut self) {
        let mut to = 0;
        for from in (0..self.records.len()).step_by(2 * self.record_size) {
            self.records.copy_within(from..from + self.record_size, to);
            to += self.record_size;
        }
        self.records.truncate(to);
    }
}
