//! A scene as data, with all defaults filled in.

use std::path::PathBuf;

use tumble::{
    CentralGravity, DMat3, DQuat, DVec3, Integrator, Joint, Load, MassModel, Material,
    MaterialOverride, Motion, Overlaps, Prescribed, Primitive, Sampling, SolverSettings, Surface,
    WallBox, WallPlane,
};

use crate::mesh::{LengthUnit, Repair, Weld};

/// The names of the mass models in scene files.
pub const MASS_MODELS: [(&str, MassModel); 3] =
    [("particles", MassModel::Particles), ("shell", MassModel::Shell), ("solid", MassModel::Solid)];

/// A scene: the simulation and its output.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name of the file without its ending, or of the built-in scene.
    pub name: String,
    /// One line of description.
    pub description: Option<String>,
    /// Simulated time (s).
    pub duration: f64,
    /// Time step h (s).
    pub dt: f64,
    /// How a step advances time.
    pub integrator: Integrator,
    /// Gravity g (m/s²).
    pub gravity: DVec3,
    /// Drag c of the medium on every particle (N·s/m).
    pub velocity_damping_stiffness: f64,
    /// When the iterations of `implicit` end.
    pub solver: SolverSettings,
    /// Bound on the energy error of a sub-step in contact, relative to kinetic and elastic energy.
    pub energy_tolerance: Option<f64>,
    /// Default material of contacts.
    pub collision: Material,
    /// How bodies that overlap at the start are treated.
    pub overlaps: Overlaps,
    /// The box, if there is one.
    pub box_walls: Option<BoxScene>,
    /// The single walls.
    pub walls: Vec<WallScene>,
    /// The bodies, before copies.
    pub bodies: Vec<BodyScene>,
    /// The joints.
    pub joints: Vec<JointScene>,
    /// The loads.
    pub loads: Vec<Load>,
    /// Gravity of a mass at a fixed place.
    pub central_gravity: Option<CentralGravity>,
    /// Output settings.
    pub output: OutputScene,
    /// Accept a time step above the critical one; set by the caller, not by the file.
    pub force: bool,
}

/// `[box]`.
#[derive(Clone, Copy, Debug)]
pub struct BoxScene {
    /// Its faces.
    pub walls: WallBox,
    /// Its own material.
    pub material: MaterialOverride,
}

/// One `[[wall]]`.
#[derive(Clone, Copy, Debug)]
pub struct WallScene {
    /// The plane.
    pub plane: WallPlane,
    /// Its own material.
    pub material: MaterialOverride,
}

/// One `[[body]]`.
#[derive(Clone, Debug)]
pub struct BodyScene {
    /// Its name.
    pub name: String,
    /// Where its mesh or particles come from.
    pub geometry: Geometry,
    /// Factor on all coordinates.
    pub scale: f64,
    /// Which points of the mesh become particles.
    pub sampling: Sampling,
    /// How the mass is distributed.
    pub mass_model: MassModel,
    /// The mass.
    pub mass: MassScene,
    /// Its centre of mass, in the coordinates of the geometry, before `scale`; `None`: that of the mass model.
    pub center_of_mass: Option<DVec3>,
    /// Its inertia tensor about its centre of mass, in the axes of the geometry (kg·m²); `None`: that of the mass model.
    pub inertia: Option<DMat3>,
    /// Centre of mass at the start (m); `None`: that of the coordinates.
    pub position: Option<DVec3>,
    /// Orientation at the start.
    pub orientation: DQuat,
    /// Velocity at the start (m/s); `None`: that of its joints, or 0.
    pub initial_velocity: Option<DVec3>,
    /// Angular velocity at the start, world axes (rad/s); likewise.
    pub initial_angular_velocity: Option<DVec3>,
    /// Its own material.
    pub material: MaterialOverride,
    /// Its contact surface.
    pub surface: Surface,
    /// Its motion.
    pub motion: MotionScene,
    /// Its copies.
    pub copies: Option<Copies>,
}

impl BodyScene {
    fn mesh_notes(&self) -> Vec<String> {
        let Geometry::Mesh(mesh) = &self.geometry else { return Vec::new() };
        let uses_triangles = self.mass_model != MassModel::Particles
            || self.surface == Surface::Mesh
            || self.sampling != Sampling::Vertices
            || matches!(self.mass, MassScene::Density(_));
        let of_triangles = mesh.notes.triangles.iter().filter(|_| uses_triangles);
        let of_unit = mesh.notes.unit.filter(|unit| (self.scale / unit.metres - 1.0).abs() > 1e-6);
        let of_unit = of_unit.map(|unit| {
            let LengthUnit { name, metres } = unit;
            format!("its header names {name}, but its numbers are taken as metres: for {name} set scale = {metres}")
        });
        let file = mesh.path.file_name().unwrap_or_default().to_string_lossy();
        let all = mesh.notes.points.iter().chain(of_triangles).cloned().chain(of_unit);
        all.map(|note| format!("mesh {file}: {note}")).collect()
    }
}

/// Where the points of a body come from.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// A mesh file.
    Mesh(MeshScene),
    /// A built-in shape.
    Shape(ShapeScene),
    /// Points, written in the scene.
    Particles(Vec<DVec3>),
}

/// A mesh file and how it is read.
#[derive(Clone, Debug, Default)]
pub struct MeshScene {
    /// Its path: as in the scene when read, relative to the scene's folder, and absolute once the mesh is loaded.
    pub path: PathBuf,
    /// Where the file was when a run began; only the scene of a run has this.
    pub origin: Option<PathBuf>,
    /// The folder that is moved or copied as a whole, scene and mesh included; known once the mesh is loaded.
    pub tree: PathBuf,
    /// The side files of a glTF, relative to its folder; known once the mesh is loaded.
    pub side_files: Vec<PathBuf>,
    /// SHA-256 of the file, lower-case hexadecimal, known once it is read.
    pub sha256: String,
    /// Which of its vertices are merged; `None`: the default of the format.
    pub weld: Option<Weld>,
    /// What is done to its triangles on request.
    pub repair: Repair,
    /// What was done to it and the user may not expect; known once the mesh is loaded.
    pub notes: MeshNotes,
}

/// What was done to a mesh, one sentence each.
#[derive(Clone, Debug, Default)]
pub struct MeshNotes {
    /// To its vertices and holes.
    pub points: Vec<String>,
    /// To its triangles, which matters only if they do.
    pub triangles: Vec<String>,
    /// The unit that the file names.
    pub unit: Option<LengthUnit>,
}

/// A built-in shape with its keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShapeScene {
    /// A shape given by formulas.
    Primitive(Primitive),
    /// The sitting cat of `assets/cat.obj`, two metres high before `scale`.
    Cat,
}

impl ShapeScene {
    /// Its name in scene files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Primitive(primitive) => primitive.name(),
            Self::Cat => "cat",
        }
    }
}

/// One `[[joint]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct JointScene {
    /// The joint; its bodies and points are not given if it is a chain.
    pub joint: Joint,
    /// The name of a body whose copies are joined, each with the next one.
    pub chain: Option<String>,
}

impl JointScene {
    /// The joint, or those of the chain. `place` is where a body is at the start, by name (m); without it the joint is not made.
    pub fn joints(&self, count: u64, place: impl Fn(&str) -> Option<DVec3>) -> Vec<Joint> {
        let Some(chain) = &self.chain else { return vec![self.joint.clone()] };
        let name = |index: u64| format!("{chain} {index}");
        let own_name = self.joint.name.as_deref().unwrap_or_default();
        let link = |index: u64| {
            let names = [name(index), name(index + 1)];
            let [from, to] = [place(&names[0])?, place(&names[1])?];
            let middle = 0.5 * (from + to);
            let at = if self.joint.kind.has_length() { [from, to] } else { [middle; 2] };
            let joint_name = Some(format!("{own_name} {index}"));
            Some(Joint { name: joint_name, between: names.map(Some), at, ..self.joint.clone() })
        };
        (0..count.saturating_sub(1)).filter_map(link).collect()
    }
}

/// The key that gives the mass of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MassScene {
    /// `particle_mass`: mass of each particle (kg).
    Particle(f64),
    /// `mass`: total mass (kg).
    Total(f64),
    /// `density`: kg/m³ of the enclosed volume, or kg/m² of the surface for a shell.
    Density(f64),
}

/// The motion of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum MotionScene {
    /// `"free"`: moved by forces.
    #[default]
    Free,
    /// `"fixed"`: does not move.
    Fixed {
        /// Velocity of its surface along itself (m/s, body axes).
        surface_velocity: DVec3,
    },
    /// `"prescribed"`: keeps its initial velocities.
    Prescribed(Prescribed),
}

impl MotionScene {
    /// Its name in scene files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Fixed { .. } => "fixed",
            Self::Prescribed(_) => "prescribed",
        }
    }

    /// The motion as the physics uses it.
    pub fn motion(&self) -> Motion {
        match *self {
            Self::Free => Motion::Free,
            Self::Fixed { surface_velocity } => {
                Motion::Prescribed(Prescribed { oscillation: None, surface_velocity })
            }
            Self::Prescribed(prescribed) => Motion::Prescribed(prescribed),
        }
    }
}

/// `copies`: a lattice of bodies, centred on the body's place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Copies {
    /// Number of copies along x, y and z.
    pub count: [u32; 3],
    /// Distance between neighbours along x, y and z (m).
    pub spacing: DVec3,
    /// Seed of random orientations; `None`: all as the body's.
    pub seed: Option<u64>,
}

/// `[output]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputScene {
    /// Time between frames (s).
    pub interval: f64,
    /// Simulated time between checkpoints (s), in addition to those by wall-clock time.
    pub checkpoint_interval: Option<f64>,
    /// Whether `contact_points.csv` is written.
    pub contact_points: bool,
}

impl Default for OutputScene {
    fn default() -> Self {
        Self { interval: 1.0 / 60.0, checkpoint_interval: None, contact_points: false }
    }
}

impl Scene {
    /// Whether a body may do work, by a prescribed motion or a surface velocity, or a load.
    pub fn does_work(&self) -> bool {
        let moves = |body: &BodyScene| match body.motion {
            MotionScene::Free => false,
            MotionScene::Fixed { surface_velocity } => surface_velocity != DVec3::ZERO,
            MotionScene::Prescribed(_) => true,
        };
        self.has_loads() || self.bodies.iter().any(moves)
    }

    /// Whether there are loads.
    pub fn has_loads(&self) -> bool {
        !self.loads.is_empty()
    }

    /// If there are several bodies, those without joints that others pass through: they have no contact surface.
    pub fn without_surface(&self) -> Vec<&BodyScene> {
        let count: u64 =
            self.bodies.iter().map(|b| b.copies.as_ref().map_or(1, Copies::total)).sum();
        let is_joined = |body: &&BodyScene| {
            let is = |name: &Option<String>| name.as_ref() == Some(&body.name);
            let joints = self.joints.iter();
            joints.clone().any(|own| is(&own.chain) || own.joint.between.iter().any(is))
        };
        let without = self.bodies.iter().filter(|body| body.surface == Surface::None);
        let without = without.filter(|body| !is_joined(body));
        if count > 1 { without.collect() } else { Vec::new() }
    }

    /// What was done to meshes and the user may not expect, one sentence each.
    pub fn mesh_notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = Vec::new();
        for body in &self.bodies {
            for note in body.mesh_notes() {
                if !notes.contains(&note) {
                    notes.push(note);
                }
            }
        }
        notes
    }

    /// Number of steps of the run: the integer nearest to duration/dt.
    pub fn step_count(&self) -> u64 {
        (self.duration / self.dt).round() as u64
    }

    /// The first step after `step` that has a frame.
    pub fn next_frame(&self, step: u64) -> u64 {
        self.next_of(self.output.interval, step)
    }

    /// Whether `step` has a frame.
    pub fn is_frame(&self, step: u64) -> bool {
        step == 0 || self.next_frame(step - 1) == step
    }

    /// The first step after `step` that has a checkpoint, if the scene requests any.
    pub fn next_checkpoint(&self, step: u64) -> Option<u64> {
        self.output.checkpoint_interval.map(|interval| self.next_of(interval, step))
    }

    /// The first step after `step` that is nearest to a multiple of `interval`.
    fn next_of(&self, interval: f64, step: u64) -> u64 {
        let steps_each = interval / self.dt;
        // closer to each other than steps: every step
        if steps_each <= 1.0 {
            return step + 1;
        }
        let mut number = ((step as f64 / steps_each) as u64).saturating_sub(1);
        while self.step_of(interval, number) <= step {
            number += 1;
        }
        self.step_of(interval, number)
    }

    /// The step of frame number `frame`: the one nearest to its time.
    pub fn frame_step(&self, frame: u64) -> u64 {
        self.step_of(self.output.interval, frame)
    }

    fn step_of(&self, interval: f64, number: u64) -> u64 {
        (number as f64 * interval / self.dt).round() as u64
    }
}
