//! Joints in the model: constant during a run.

use glam::{DMat3, DVec3};

use super::definition::{Joint, JointKind, Motor};
use super::elimination::Elimination;
use crate::{BodyModel, BodyState, State};

/// A joint, in the axes of its bodies.
#[derive(Clone, Debug)]
pub struct JointModel {
    /// The name.
    pub name: String,
    /// The kind.
    pub kind: JointKind,
    /// The index of each body; `None` is the world.
    pub bodies: [Option<u32>; 2],
    /// The point of each body at which the joint acts (m, body axes, from the centre of mass; of the world its coordinates).
    pub anchors: [DVec3; 2],
    /// For each body three axes that coincide at the start, as columns; the first is that of a hinge or slider (body axes).
    pub axes: [DMat3; 2],
    /// The distance of the two points at the start (m); 0 for joints whose points stay together.
    pub start_length: f64,
    /// The smallest and largest coordinate (rad or m); infinite without limits.
    pub limits: [f64; 2],
    /// Its motor.
    pub motor: Option<Motor>,
    /// Its friction (N·m or N).
    pub friction: f64,
    /// k of its spring (N/m or N·m/rad).
    pub stiffness: f64,
    /// c of its damper (N·s/m or N·m·s/rad).
    pub damping: f64,
    /// The coordinate at which its spring has no force (rad or m).
    pub natural: f64,
    /// Whether the two bodies may touch each other.
    pub contact: bool,
    /// The time at which it lets go (s); infinite if it does not.
    pub until: f64,
}

/// All joints of a model.
#[derive(Clone, Debug, Default)]
pub struct Joints {
    /// In the order in which they were added.
    pub list: Vec<JointModel>,
    /// For each body whether a joint acts on it; empty without joints.
    pub is_joined: Vec<bool>,
    /// Whether constraints follow from others at the start of the run.
    pub(crate) has_redundant: bool,
    /// The bodies that joints act on, by index.
    pub(crate) bodies: Vec<u32>,
    /// Pairs of bodies that do not touch each other, the lower index first, sorted.
    apart: Vec<[u32; 2]>,
    pub(crate) elimination: Elimination,
}

/// A body as joints see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub position: DVec3,
    /// See [`BodyState::position_compensation`].
    pub compensation: DVec3,
    pub rotation: DMat3,
}

impl Place {
    /// The world.
    pub const WORLD: Self =
        Self { position: DVec3::ZERO, compensation: DVec3::ZERO, rotation: DMat3::IDENTITY };

    pub fn new(state: &BodyState) -> Self {
        let (position, compensation) = (state.position, state.position_compensation);
        Self { position, compensation, rotation: DMat3::from_quat(state.orientation) }
    }
}

impl Joints {
    /// Indexes the joints of a model with these bodies.
    pub(crate) fn new(list: Vec<JointModel>, models: &[std::sync::Arc<BodyModel>]) -> Self {
        if list.is_empty() {
            return Self::default();
        }
        let mut is_joined = vec![false; models.len()];
        let mut apart = Vec::new();
        for joint in &list {
            joint.bodies.iter().flatten().for_each(|&body| is_joined[body as usize] = true);
            if let ([Some(a), Some(b)], false) = (joint.bodies, joint.contact) {
                apart.push([a.min(b), a.max(b)]);
            }
        }
        apart.sort_unstable();
        apart.dedup();
        let bodies = (0..).zip(&is_joined).filter(|(_, joined)| **joined).map(|(index, _)| index);
        let bodies = bodies.collect();
        let is_free = |body: &u32| models[*body as usize].is_free();
        let coupled = |joint: &JointModel| joint.bodies.map(|body| body.filter(is_free));
        let elimination = Elimination::new(&list.iter().map(coupled).collect::<Vec<_>>());
        Self { list, is_joined, has_redundant: false, bodies, apart, elimination }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether a joint acts on a body.
    #[inline]
    pub(crate) fn acts_on(&self, body: usize) -> bool {
        self.is_joined.get(body).is_some_and(|joined| *joined)
    }

    /// Whether two bodies, the lower index first, do not touch each other because of a joint.
    pub(crate) fn keeps_apart(&self, first: u32, second: u32) -> bool {
        !self.apart.is_empty() && self.apart.binary_search(&[first, second]).is_ok()
    }
}

impl JointModel {
    /// The description of the same joint with the bodies in these states, and its coordinate beginning at 0 there.
    pub fn description(&self, names: &[String], state: &State, index: usize) -> Joint {
        let place = |body: Option<u32>| {
            body.map_or(Place::WORLD, |body| Place::new(&state.bodies[body as usize]))
        };
        let places = self.bodies.map(place);
        let at = |side: usize| places[side].position + places[side].rotation * self.anchors[side];
        let at = if self.kind.has_length() { [at(0), at(1)] } else { [at(0); 2] };
        let length = (at[0] - at[1]).length();
        let coordinate = state.joints[index].coordinate;
        let has_natural = matches!(self.kind, JointKind::Spring | JointKind::Rope);
        let has_limits = self.is_limited() && self.kind != JointKind::Rope;
        let shifted = |motor: Motor| match motor {
            Motor::Position { target, stiffness, damping, effort } => {
                Motor::Position { target: target - coordinate, stiffness, damping, effort }
            }
            motor => motor,
        };
        Joint {
            name: Some(self.name.clone()),
            kind: self.kind,
            between: self.bodies.map(|body| body.map(|body| names[body as usize].clone())),
            at,
            axis: if self.kind.has_axis() {
                places[1].rotation * self.axes[1].x_axis
            } else {
                DVec3::ZERO
            },
            // rounding may have left a coordinate beyond its limit
            limits: has_limits.then(|| {
                let [low, high] = self.limits.map(|limit| limit - coordinate);
                [low.min(0.0), high.max(0.0)]
            }),
            motor: self.motor.map(shifted),
            friction: self.friction,
            stiffness: self.stiffness,
            rest: if self.kind.has_axis() { self.natural - coordinate } else { 0.0 },
            damping: self.damping,
            length: has_natural.then(|| {
                (self.natural + self.start_length).max(if self.kind == JointKind::Rope {
                    length
                } else {
                    0.0
                })
            }),
            contact: self.contact,
            // in the past if it has let go
            until: (self.until < f64::INFINITY).then_some(self.until - state.time),
        }
    }

    /// A joint between bodies with these indices at `places`. The description is checked.
    pub(crate) fn new(
        joint: &Joint,
        name: String,
        bodies: [Option<u32>; 2],
        places: [Place; 2],
    ) -> Self {
        let at = |k: usize| {
            let place: &Place = &places[k];
            place.rotation.transpose() * (joint.at[k] - place.position)
        };
        let axis = if joint.kind.has_axis() { joint.axis.normalize() } else { DVec3::X };
        let u = axis.any_orthonormal_vector();
        let world = DMat3::from_cols(axis, u, axis.cross(u));
        let start_length =
            if joint.kind.has_length() { (joint.at[0] - joint.at[1]).length() } else { 0.0 };
        let natural = joint.length.map_or(joint.rest, |length| length - start_length);
        let infinite = [f64::NEG_INFINITY, f64::INFINITY];
        let mut limits = joint.limits.unwrap_or(infinite);
        if joint.kind == JointKind::Rope {
            limits[1] = limits[1].min(natural);
        }
        Self {
            name,
            kind: joint.kind,
            bodies,
            anchors: [at(0), at(1)],
            axes: places.map(|place| place.rotation.transpose() * world),
            start_length,
            limits,
            motor: joint.motor,
            friction: joint.friction,
            stiffness: joint.stiffness,
            damping: joint.damping,
            natural,
            contact: joint.contact,
            until: joint.until.unwrap_or(f64::INFINITY),
        }
    }

    /// Whether it acts in a step that begins at a time (s).
    pub(crate) fn acts_at(&self, time: f64) -> bool {
        time < self.until
    }

    /// The number of constraints that hold at a time (s).
    pub(crate) fn constraint_count_at(&self, time: f64) -> usize {
        if self.acts_at(time) { self.constraint_count() } else { 0 }
    }

    /// The number of constraints that hold as long as it acts: the first rows of the joint.
    pub(crate) fn constraint_count(&self) -> usize {
        match self.kind {
            JointKind::Ball => 3,
            JointKind::Hinge | JointKind::Slider => 5,
            JointKind::Weld => 6,
            JointKind::Distance => usize::from(!self.is_limited()),
            JointKind::Rope | JointKind::Spring => 0,
        }
    }

    /// Whether the joint has a coordinate, which forces may act along: the angle of a hinge, the displacement of a slider, the
    /// distance of two points less that at the start.
    pub(crate) fn has_coordinate(&self) -> bool {
        self.kind.has_axis() || self.kind.has_length()
    }

    /// The coordinate with this value of its row that is nearest to an earlier one: the angle of a hinge is counted beyond a turn.
    pub(crate) fn near(&self, value: f64, earlier: f64) -> f64 {
        if self.kind != JointKind::Hinge {
            return value;
        }
        let turns = ((earlier - value) / std::f64::consts::TAU).round();
        value + turns * std::f64::consts::TAU
    }

    /// The row of the coordinate, after the constraints; that of a rod is its only constraint.
    pub(crate) fn coordinate_row(&self) -> Option<usize> {
        let is_free = self.has_coordinate() && self.constraint_count() != 1;
        is_free.then(|| self.constraint_count())
    }

    /// Whether forces act along its coordinate: a motor, friction, a spring or a damper.
    pub(crate) fn acts_along_coordinate(&self) -> bool {
        self.motor.is_some() || self.friction > 0.0 || self.stiffness > 0.0 || self.damping > 0.0
    }

    /// Whether its coordinate is limited.
    pub(crate) fn is_limited(&self) -> bool {
        self.limits[0] > f64::NEG_INFINITY || self.limits[1] < f64::INFINITY
    }
}
