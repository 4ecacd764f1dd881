//! Errors of building and stepping a world.

use crate::{BodyDepth, Integrator, SurfaceError};

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
        /// The depth of the centre of mass behind the wall (m).
        depth: f64,
    },
    /// A body starts deep in a wall.
    InWall {
        /// Name of the body.
        body: String,
        /// The wall's normal.
        normal: [f64; 3],
        /// The depth of the deepest particle or sphere (m).
        depth: f64,
        /// The position at which the body would only touch its walls.
        position: [f64; 3],
    },
    /// The time step is above the critical one.
    Unstable {
        /// The step (s).
        dt: f64,
        /// The largest stable step (s).
        critical: f64,
        /// Name of the body that determines it.
        body: String,
    },
    /// The mesh of a body cannot be its collision surface.
    Surface {
        /// Name of the body.
        body: String,
        /// What is wrong with the mesh.
        error: Box<SurfaceError>,
    },
    /// Two bodies overlap initially.
    Overlap {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// The penetration depth (m).
        depth: f64,
    },
    /// A quantity of a joint has an impossible value.
    Joint {
        /// Name of the joint.
        joint: String,
        /// The quantity's name, as in scene files.
        quantity: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A quantity of a load has an impossible value.
    Load {
        /// Index of the load; those of functions follow.
        load: usize,
        /// The quantity's name, as in scene files.
        quantity: &'static str,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: &'static str,
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
            Self::Joint { joint, quantity, value, allowed } => {
                write!(f, "joint \"{joint}\": `{quantity}` is {value}, but must be {allowed}")
            }
            Self::Load { load, quantity, value, allowed } => {
                write!(f, "load {load}: `{quantity}` is {value}, but must be {allowed}")
            }
            Self::Outside { body, normal: [x, y, z], depth } => write!(
                f,
                "body \"{body}\" starts outside: its centre of mass lies {depth:.3e} m behind the wall \
                 with normal ({x}, {y}, {z}); move its `position` to the free side"
            ),
            Self::InWall { body, normal: [nx, ny, nz], depth, position: [x, y, z] } => write!(
                f,
                "body \"{body}\" starts {depth:.3e} m in the wall with normal ({nx}, {ny}, {nz}), which would throw it out; \
                 with `position` at ({x}, {y}, {z}) it would touch, or have it pushed out with `overlaps = \"push\"`"
            ),
            Self::Unstable { dt, critical, body } => write!(
                f,
                "`dt` is {dt} s, but contact of body \"{body}\" is stable only up to {critical:.3e} s; \
                 use a smaller `dt` or `collision_stiffness`,{} or insist with --force",
                if *dt <= Integrator::LONGEST_IMPLICIT_DT {
                    " keep it with `integrator = \"implicit\"`,"
                } else {
                    ""
                }
            ),
            Self::Surface { body, error } => {
                write!(f, "body \"{body}\" cannot have `surface = \"mesh\"`: {error}")
            }
            Self::Overlap { first, second, depth } => write!(
                f,
                "bodies \"{first}\" and \"{second}\" start {depth:.3e} m in each other; change the `position` of one of them, \
                 or have them pushed apart with `overlaps = \"push\"`"
            ),
            Self::SameName { body } => {
                write!(f, "two bodies are called \"{body}\"; give each its own `name`")
            }
        }
    }
}

impl std::error::Error for BuildError {}

/// All errors in the description of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildErrors(
    /// The errors, at least one.
    pub Vec<BuildError>,
);

impl std::fmt::Display for BuildErrors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let lines: Vec<_> = self.0.iter().map(BuildError::to_string).collect();
        f.write_str(&lines.join("\n"))
    }
}

impl std::error::Error for BuildErrors {}

/// A step whose result is not valid.
#[derive(Clone, Debug, PartialEq)]
pub struct StepError {
    /// Number of the step, counted from 1.
    pub step: u64,
    /// Time at the end of the step (s).
    pub time: f64,
    /// Name of the body, or of the joint.
    pub body: String,
    /// Index of the particle, if the error concerns one.
    pub particle: Option<usize>,
    /// The quantity that is wrong: a field of [`BodyState`](crate::BodyState), the `depth` of a contact (m), or
    /// the `displacement` of a particle in one step (m).
    pub quantity: &'static str,
    /// Its value.
    pub value: f64,
    /// Name of the other body, if the body could pass through it.
    pub other: Option<Box<str>>,
    /// A suggested time step (s), if there is one.
    pub dt: Option<f64>,
    /// The depth of two bodies in each other, if that is what is wrong.
    pub body_depth: Option<Box<BodyDepth>>,
}

impl StepError {
    /// The quantity of a joint whose constraints cannot be kept.
    pub const CONSTRAINT: &'static str = "constraint";
}

impl std::fmt::Display for StepError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { step, time, body, particle, quantity, value, other, dt, body_depth } = self;
        if let Some(depth) = body_depth {
            return write!(f, "the simulation was stopped at step {step} (t = {time} s): {depth}");
        }
        if *quantity == StepError::CONSTRAINT {
            return write!(
                f,
                "the simulation was stopped at step {step} (t = {time} s): the constraints of joint \"{body}\" cannot be kept, they are \
                 off by {value:.1e}; try a smaller `dt`"
            );
        }
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
                " m, more than half the distance to the opposite wall; try --set dt={dt:.1e} or a larger \
                 `collision_stiffness`"
            ),
            (None, _) => write!(f, "; try a smaller `dt` or a smaller `collision_stiffness`"),
        }
    }
}

impl std::error::Error for StepError {}
