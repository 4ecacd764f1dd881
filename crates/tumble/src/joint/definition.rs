//! The description of a joint.

use glam::DVec3;

/// The kind of a joint: which relative motions of two bodies it leaves free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind {
    /// Two points stay together.
    Ball,
    /// Two points stay together, and the bodies turn about one axis only.
    Hinge,
    /// The bodies move along one axis only, and do not turn.
    Slider,
    /// The bodies do not move relative to each other.
    Weld,
    /// A massless rod: two points keep their distance.
    Distance,
    /// A massless rope: two points do not get farther apart than its length.
    Rope,
    /// A massless spring with damping between two points.
    Spring,
}

impl JointKind {
    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball",
            Self::Hinge => "hinge",
            Self::Slider => "slider",
            Self::Weld => "weld",
            Self::Distance => "distance",
            Self::Rope => "rope",
            Self::Spring => "spring",
        }
    }

    /// All kinds.
    pub const ALL: [Self; 7] = [
        Self::Ball,
        Self::Hinge,
        Self::Slider,
        Self::Weld,
        Self::Distance,
        Self::Rope,
        Self::Spring,
    ];

    /// Whether the joint has an axis.
    pub fn has_axis(self) -> bool {
        matches!(self, Self::Hinge | Self::Slider)
    }

    /// Whether the joint is between two points at a distance.
    pub fn has_length(self) -> bool {
        matches!(self, Self::Distance | Self::Rope | Self::Spring)
    }
}

/// What drives the coordinate of a hinge or slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motor {
    /// Turns or moves at a given speed as long as its effort allows.
    Speed {
        /// rad/s or m/s.
        speed: f64,
        /// The largest torque (N·m) or force (N); infinite for an ideal drive.
        effort: f64,
    },
    /// Pulls to a given coordinate with a spring and a damper.
    Position {
        /// The coordinate, 0 at the start (rad or m).
        target: f64,
        /// N·m/rad or N/m.
        stiffness: f64,
        /// N·m·s/rad or N·s/m.
        damping: f64,
        /// The largest torque (N·m) or force (N); infinite without limit.
        effort: f64,
    },
}

/// The description of a joint between two bodies, or a body and the world.
///
/// Points and axes are in world coordinates at the start of the run. The joint is made for the bodies where they are then; its
/// coordinate begins at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The name; the default is `joint` and the index of the joint.
    pub name: Option<String>,
    /// The kind.
    pub kind: JointKind,
    /// The names of both bodies; `None` is the world. Coordinates are those of the first body relative to the second.
    pub between: [Option<String>; 2],
    /// The point of each body at which the joint acts (m). The same point twice, except for joints at a distance.
    pub at: [DVec3; 2],
    /// The axis of a hinge or slider; it need not have unit length.
    pub axis: DVec3,
    /// The smallest and largest value of the coordinate, or of the length less that at the start (rad or m).
    pub limits: Option<[f64; 2]>,
    /// Its motor.
    pub motor: Option<Motor>,
    /// Friction of a hinge (N·m) or slider (N): it resists any motion with at most this.
    pub friction: f64,
    /// Stiffness k of a spring (N/m), or of a spring that pulls a hinge (N·m/rad) or slider (N/m) back to `rest`.
    pub stiffness: f64,
    /// The coordinate at which the spring of a hinge or slider has no force (rad or m).
    pub rest: f64,
    /// Damping c of a spring, hinge or slider (N·s/m or N·m·s/rad).
    pub damping: f64,
    /// The length of a spring without force, or of a rope (m); by default the distance at the start.
    pub length: Option<f64>,
    /// Whether the two bodies may touch each other.
    pub contact: bool,
    /// The time at which the joint lets go (s), if it does.
    pub until: Option<f64>,
}

impl Joint {
    /// A joint of this kind at the point `at` (m, world), between a body and another one, or the world if its name is `"world"`.
    pub fn new(kind: JointKind, between: [&str; 2], at: DVec3) -> Self {
        let name = |name: &str| (name != "world").then(|| name.to_owned());
        Self {
            name: None,
            kind,
            between: between.map(name),
            at: [at; 2],
            axis: DVec3::ZERO,
            limits: None,
            motor: None,
            friction: 0.0,
            stiffness: 0.0,
            rest: 0.0,
            damping: 0.0,
            length: None,
            contact: false,
            until: None,
        }
    }

    /// A ball joint.
    pub fn ball(between: [&str; 2], at: DVec3) -> Self {
        Self::new(JointKind::Ball, between, at)
    }

    /// A hinge.
    pub fn hinge(between: [&str; 2], at: DVec3, axis: DVec3) -> Self {
        Self { axis, ..Self::new(JointKind::Hinge, between, at) }
    }

    /// A slider.
    pub fn slider(between: [&str; 2], at: DVec3, axis: DVec3) -> Self {
        Self { axis, ..Self::new(JointKind::Slider, between, at) }
    }

    /// A weld.
    pub fn weld(between: [&str; 2], at: DVec3) -> Self {
        Self::new(JointKind::Weld, between, at)
    }

    /// A rod between a point of each body.
    pub fn distance(between: [&str; 2], at: [DVec3; 2]) -> Self {
        Self { at, ..Self::new(JointKind::Distance, between, at[0]) }
    }

    /// A rope between a point of each body.
    pub fn rope(between: [&str; 2], at: [DVec3; 2]) -> Self {
        Self { at, ..Self::new(JointKind::Rope, between, at[0]) }
    }

    /// A spring between a point of each body, of stiffness k (N/m) and damping c (N·s/m).
    pub fn spring(between: [&str; 2], at: [DVec3; 2], stiffness: f64, damping: f64) -> Self {
        Self { at, stiffness, damping, ..Self::new(JointKind::Spring, between, at[0]) }
    }

    /// Names the joint.
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// Limits the coordinate.
    pub fn limits(mut self, limits: [f64; 2]) -> Self {
        self.limits = Some(limits);
        self
    }

    /// Adds a motor.
    pub fn motor(mut self, motor: Motor) -> Self {
        self.motor = Some(motor);
        self
    }

    /// Adds friction.
    pub fn friction(mut self, friction: f64) -> Self {
        self.friction = friction;
        self
    }

    /// Adds a spring and a damper to a hinge or slider.
    pub fn spring_back(mut self, stiffness: f64, damping: f64) -> Self {
        (self.stiffness, self.damping) = (stiffness, damping);
        self
    }

    /// The length of a rope, or of a spring without force (m).
    pub fn length(mut self, length: f64) -> Self {
        self.length = Some(length);
        self
    }

    /// Lets the two bodies touch each other.
    pub fn with_contact(mut self) -> Self {
        self.contact = true;
        self
    }
}
