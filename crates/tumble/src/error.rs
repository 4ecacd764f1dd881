//! What can go wrong, in words that say where and what to do.

use crate::SurfaceError;

/// Why a world cannot be built.
#[derive(Clone, Debug, PartialEq)]
pub enum BuildError {
    /// A quantity of the world has an impossible value.
    World {
        /// Its name, as in scene files.
        quantity: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A quantity of a body has an impossible value.
    Body {
        /// Name of the body.
        body: String,
        /// The quantity's name, as in scene files.
        quantity: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A body starts on the solid side of a wall.
    Outside {
        /// Name of the body.
        body: String,
        /// The wall's normal.
        normal: [f64; 3],
        /// How deep the centre of mass lies behind it (m).
        depth: f64,
    },
    /// The step is longer than contact can bear.
    Unstable {
        /// The step (s).
        dt: f64,
        /// The longest stable step (s).
        critical: f64,
        /// Name of the body with the fastest contact.
        body: String,
    },
    /// A body cannot be met by its mesh.
    Surface {
        /// Name of the body.
        body: String,
        /// What is wrong with the mesh.
        error: Box<SurfaceError>,
    },
    /// Two bodies start in each other.
    Overlap {
        /// Name of the one.
        first: String,
        /// Name of the other.
        second: String,
        /// How deep they are in each other (m).
        depth: f64,
    },
    /// Two bodies have the same name.
    SameName {
        /// The name.
        body: String,
    },
}

impl std::fmt::Display for BuildError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::World { quantity, value, allowed } => {
                write!(f, "`{quantity}` is {value}, but must be {allowed}")
            }
            Self::Body { body, quantity, value, allowed } => {
                write!(f, "body \"{body}\": `{quantity}` is {value}, but must be {allowed}")
            }
            Self::Outside { body, normal: [x, y, z], depth } => write!(
                f,
                "body \"{body}\" starts outside: its centre of mass lies {depth:.3e} m behind the wall \
                 with normal ({x}, {y}, {z}); move its `position` to the free side"
            ),
            Self::Unstable { dt, critical, body } => write!(
                f,
                "`dt` is {dt} s, but contact of body \"{body}\" is stable only up to {critical:.3e} s; \
                 take a smaller `dt` or `collision_stiffness`, or insist with --force"
            ),
            Self::Surface { body, error } => {
                write!(f, "body \"{body}\" cannot have `surface = \"mesh\"`: {error}")
            }
            Self::Overlap { first, second, depth } => write!(
                f,
                "bodies \"{first}\" and \"{second}\" start {depth:.3e} m in each other; move one of them by its `position`, \
                 or have them pushed apart by `overlaps = \"push\"`"
            ),
            Self::SameName { body } => {
                write!(f, "two bodies are called \"{body}\"; give each its own `name`")
            }
        }
    }
}

impl std::error::Error for BuildError {}

/// Everything that keeps a world from being built.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildErrors(
    /// One entry a problem, at least one.
    pub Vec<BuildError>,
);

impl std::fmt::Display for BuildErrors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let lines: Vec<_> = self.0.iter().map(BuildError::to_string).collect();
        f.write_str(&lines.join("\n"))
    }
}

impl std::error::Error for BuildErrors {}

/// A step whose result cannot be trusted.
#[derive(Clone, Debug, PartialEq)]
pub struct StepError {
    /// Number of the step, counted from 1.
    pub step: u64,
    /// Time at the end of the step (s).
    pub time: f64,
    /// Name of the body.
    pub body: String,
    /// The particle that it is about, if it is one.
    pub particle: Option<usize>,
    /// What is wrong: a field of [`BodyState`](crate::BodyState), the `depth` of a contact (m), or the
    /// `displacement` of a particle in one step (m).
    pub quantity: &'static str,
    /// Its value.
    pub value: f64,
    /// Name of the other body, where it could pass through one.
    pub other: Option<String>,
    /// A step (s) that would do, where one can be named.
    pub dt: Option<f64>,
}

impl std::fmt::Display for StepError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { step, time, body, particle, quantity, value, other, dt } = self;
        let whose = match particle {
            Some(particle) => format!("particle {particle} of body \"{body}\""),
            None => format!("body \"{body}\""),
        };
        write!(
            f,
            "the simulation diverged at step {step} (t = {time} s): {quantity} of {whose} is {value}"
        )?;
        match (dt, other) {
            (Some(dt), Some(other)) => write!(
                f,
                " m against body \"{other}\", through which it could pass in one step; try --set dt={dt:.1e}"
            ),
            (Some(dt), None) => write!(
                f,
                " m, more than half the way to the opposite wall; try --set dt={dt:.1e} or a larger \
                 `collision_stiffness`"
            ),
            (None, _) => write!(f, "; try a smaller `dt` or a smaller `collision_stiffness`"),
        }
    }
}

impl std::error::Error for StepError {}
