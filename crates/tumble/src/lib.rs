//! Rigid bodies made of particles.
//!
//! A body is a set of particles at fixed distances: the vertices of a mesh, or points sampled from it. Gravity and drag act on every
//! particle, walls push back the particles behind them, and the forces on the particles add up to the force and torque on the
//! body.
//!
//! # Limits
//! Contact between bodies acts at points, against the [`Surface`] of the other body. The points of a body with a mesh surface are
//! its particles, its sharp edges and points in its large faces ([`ContactPoints`]). Walls are planes.
//!
//! # A tour
//! - [`Shape`]: particles and mass distribution, made from points or a [`Mesh`].
//! - [`World`]: bodies with shapes, and walls. Build it, step it, read it.
//! - [`step::step`]: the time step, as a list of [`stage`]s. Start here to read the physics.
//! - [`Model`], [`State`], [`Scratch`]: what is constant, what evolves, and buffers.
//! - [`Energy`]: the energy ledger. [`PenetrationDepths`]: how deep contacts are.
//!
//! ```
//! use tumble::{Body, DVec3, Shape, WallBox, World};
//!
//! let corners = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO].map(|p| 0.3 * p);
//! let mut world = World::builder()
//!     .box_walls(&WallBox::arena())
//!     .body(
//!         Body::new(Shape::from_particles(&corners)?)
//!             .velocity(DVec3::new(4.0, 2.0, 3.0))
//!             .angular_velocity(DVec3::new(0.0, 100.0, 0.0)),
//!     )
//!     .build()?;
//! while world.time() < 0.1 {
//!     world.step()?;
//! }
//! assert!(world.body(0).position().x > 0.3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![warn(missing_debug_implementations)]

mod batch;
mod body_depth;
mod builder;
mod contact;
mod contact_list;
mod contact_points;
mod contact_time;
mod depths;
mod distance;
mod energy;
mod error;
mod flight;
mod hash;
mod joint;
mod kinematics;
mod lanes;
mod load;
mod material;
mod model;
mod motion;
mod pair_material;
mod parallel;
mod restore;
mod scratch;
mod shape;
mod smooth_step;
mod stability;
pub mod stage;
mod state;
mod static_load;
pub mod step;
mod surface;
mod wall;
mod workspace;
mod world;
mod wrench;

pub use batch::{Batch, for_each_batch};
pub use body_depth::BodyDepth;
pub use builder::{Body, WorldBuilder};
pub use contact_list::{Contact, ContactPartner};
pub use contact_points::ContactPoints;
pub use contact_time::{ContactTime, contact_time};
pub use depths::PenetrationDepths;
pub use distance::{Nearest, SignedDistance, SurfaceError};
pub use energy::Energy;
pub use error::{BuildError, BuildErrors, StepError};
pub use flight::DragModes;
pub use glam::{DMat3, DQuat, DVec3};
pub use joint::{Joint, JointKind, JointModel, Joints, Motor};
pub use load::{CentralGravity, ForceFunction, Load, LoadAxes, LoadCourse, Loads};
pub use material::{ContactLaw, Damping, Material, MaterialOverride, damping_ratio, restitution};
pub use model::{BodyModel, Integrator, Model, SolverSettings};
pub use motion::{Motion, Oscillation, Prescribed};
pub use pair_material::{PairDamping, PairMaterial};
pub use restore::StateError;
pub use scratch::Scratch;
pub use shape::{
    AreaError, Closed, Deduplicated, EdgeFault, FaultyEdge, Hole, HoleError, HoleFault, Integrals,
    MassModel, MassProperties, Mesh, MeshError, Oriented, ParticleMoments, Particles, Primitive,
    PrimitiveError, PrincipalAxes, SampleError, Sampling, Shape, ShapeError, ShellError,
    SolidError, SphereUnionError, Watertightness, Welded, sphere_union_integrals,
};
pub use stability::{CriticalStep, critical_dt};
pub use stage::MouseSpring;
pub use state::{
    BodyState, ContactImpulse, ContactKind, FrictionSpring, JointState, PairSpring, RunTotals,
    State,
};
pub use static_load::{SoftSprings, StaticLoad, static_loads};
pub use surface::{Overlaps, Surface};
pub use wall::{WallBox, WallPlane};
pub use world::{BodyView, JointView, World};
pub use wrench::{BodyForces, Wrench};
