//! Writes a scene as TOML, with all defaults.

use toml::{Table, Value};
use tumble::{
    DQuat, DVec3, Damping, Integrator, MaterialOverride, Oscillation, Overlaps, Primitive,
    Sampling, Surface, WallBox, WallPlane,
};

use super::description::{
    BodyScene, Geometry, MASS_MODELS, MassScene, MotionScene, Scene, ShapeScene,
};

use crate::mesh::{Repair, Weld};

/// The first lines of every scene that a run writes.
pub const HEADER: &str = "# The scene as run, every default written out.";

impl Scene {
    /// The scene as TOML, every default written out, meshes by path and hash. Reading it
    /// again gives the same world.
    pub fn to_toml(&self) -> String {
        let mut top = Table::new();
        if let Some(description) = &self.description {
            put(&mut top, "description", description.clone());
        }
        put(&mut top, "duration", self.duration);
        put(&mut top, "dt", self.dt);
        put(&mut top, "integrator", self.integrator.name());
        if self.integrator == Integrator::Implicit {
            let mut solver = Table::new();
            put(&mut solver, "tolerance", self.solver.tolerance);
            put(&mut solver, "max_iterations", i64::from(self.solver.max_iterations));
            put(&mut top, "solver", solver);
        }
        put(&mut top, "gravity", vector(self.gravity));
        put(&mut top, "velocity_damping_stiffness", self.velocity_damping_stiffness);
        if let Some(tolerance) = self.energy_tolerance {
            put(&mut top, "energy_tolerance", tolerance);
        }
        if self.overlaps == Overlaps::Push {
            put(&mut top, "overlaps", "push");
        }
        let mut collision = Table::new();
        put_material(&mut collision, &self.collision.into());
        put(&mut top, "collision", collision);
        put(&mut top, "output", {
            let mut output = Table::new();
            put(&mut output, "interval", self.output.interval);
            if let Some(interval) = self.output.checkpoint_interval {
                put(&mut output, "checkpoint_interval", interval);
            }
            if self.output.contact_points {
                put(&mut output, "contact_points", true);
            }
            output
        });
        if let Some(own) = &self.box_walls {
            let mut table = Table::new();
            put(&mut table, "min", vector(own.walls.min));
            put(&mut table, "max", vector(own.walls.max));
            put(&mut table, "orientation", quaternion(own.walls.orientation));
            let open = WallBox::FACES.iter().zip(own.walls.open).filter(|(_, open)| *open);
            put(&mut table, "open", open.map(|(face, _)| Value::from(*face)).collect::<Vec<_>>());
            put_material(&mut table, &own.material);
            put(&mut top, "box", table);
        }
        let walls = self.walls.iter().map(|wall| {
            let mut table = Table::new();
            put(&mut table, "normal", vector(wall.plane.normal));
            put(&mut table, "offset", wall.plane.offset);
            put_material(&mut table, &wall.material);
            Value::Table(table)
        });
        put_tables(&mut top, "wall", walls.collect());
        let is_joined = !self.joints.is_empty();
        let bodies = self.bodies.iter().map(|own| Value::Table(body(own, is_joined)));
        put_tables(&mut top, "body", bodies.collect());
        super::write_joints::put_joints_and_loads(&mut top, self);
        format!("{HEADER}\n\n{top}")
    }

    /// Every wall with its own material: the box's faces first, then the single ones.
    pub fn all_walls(&self) -> Vec<(WallPlane, MaterialOverride)> {
        let of_box = self
            .box_walls
            .iter()
            .flat_map(|own| own.walls.planes().into_iter().map(|plane| (plane, own.material)));
        of_box.chain(self.walls.iter().map(|wall| (wall.plane, wall.material))).collect()
    }

    /// The names of all walls, in the order of [`Scene::all_walls`]: a face of the box as in `open`, a single wall as `wall 0`, …
    pub fn wall_names(&self) -> Vec<String> {
        let open = self.box_walls.iter().map(|own| own.walls.open);
        let faces = open.flat_map(|open| {
            let faces = WallBox::FACES.iter().zip(open).filter(|(_, is_open)| !is_open);
            faces.map(|(face, _)| (*face).to_owned())
        });
        faces.chain((0..self.walls.len()).map(|index| format!("wall {index}"))).collect()
    }

    /// The names of all bodies, copies included, in the order of the world.
    pub fn body_names(&self) -> Vec<String> {
        self.bodies.iter().flat_map(BodyScene::names).collect()
    }
}

impl BodyScene {
    /// Its name, or the names of its copies: "ball 0", "ball 1", …
    pub fn names(&self) -> Vec<String> {
        match &self.copies {
            None => vec![self.name.clone()],
            Some(copies) => (0..copies.total()).map(|i| format!("{} {i}", self.name)).collect(),
        }
    }
}

fn body(body: &BodyScene, is_joined: bool) -> Table {
    let mut table = Table::new();
    put(&mut table, "name", body.name.clone());
    match &body.geometry {
        Geometry::Mesh(mesh) => {
            put(&mut table, "mesh", mesh.path.display().to_string());
            put(&mut table, "mesh_sha256", mesh.sha256.clone());
            if let Some(origin) = &mesh.origin {
                put(&mut table, "mesh_origin", origin.display().to_string());
            }
            match mesh.weld {
                None => {}
                Some(Weld::Never) => put(&mut table, "weld", false),
                Some(Weld::Auto) => put(&mut table, "weld", true),
                Some(Weld::Within(tolerance)) => put(&mut table, "weld", tolerance),
            }
            if mesh.repair != Repair::None {
                put(&mut table, "mesh_repair", mesh.repair.name());
            }
        }
        Geometry::Shape(shape) => put_shape(&mut table, shape),
        Geometry::Particles(points) => {
            put(&mut table, "particles", points.iter().map(|&p| vector(p)).collect::<Vec<_>>());
        }
    }
    put(&mut table, "scale", body.scale);
    match body.sampling {
        Sampling::Vertices => put(&mut table, "sampling", "vertices"),
        Sampling::Surface { spacing } => {
            put(&mut table, "sampling", "surface");
            put(&mut table, "spacing", spacing);
        }
        Sampling::Volume { spacing } => {
            put(&mut table, "sampling", "volume");
            put(&mut table, "spacing", spacing);
        }
    }
    if let Some((name, _)) = MASS_MODELS.iter().find(|(_, model)| *model == body.mass_model) {
        put(&mut table, "mass_model", *name);
    }
    match body.mass {
        MassScene::Particle(mass) => put(&mut table, "particle_mass", mass),
        MassScene::Total(mass) => put(&mut table, "mass", mass),
        MassScene::Density(density) => put(&mut table, "density", density),
    }
    if let Some(centre) = body.center_of_mass {
        put(&mut table, "center_of_mass", vector(centre));
    }
    if let Some(inertia) = body.inertia {
        let rows = inertia.transpose().to_cols_array_2d();
        put(&mut table, "inertia", rows.map(|row| row.to_vec()).to_vec());
    }
    if let Some(position) = body.position {
        put(&mut table, "position", vector(position));
    }
    put(&mut table, "orientation", quaternion(body.orientation));
    // where there are joints, what is left out follows from them
    let default = (!is_joined).then_some(DVec3::ZERO);
    for (key, value) in [
        ("initial_velocity", body.initial_velocity),
        ("initial_angular_velocity", body.initial_angular_velocity),
    ] {
        if let Some(value) = value.or(default) {
            put(&mut table, key, vector(value));
        }
    }
    put_material(&mut table, &body.material);
    put_surface(&mut table, body.surface);
    put_motion(&mut table, &body.motion);
    if let Some(copies) = &body.copies {
        let mut of = Table::new();
        put(&mut of, "count", copies.count.map(i64::from).to_vec());
        put(&mut of, "spacing", vector(copies.spacing));
        if let Some(seed) = copies.seed {
            put(&mut of, "seed", seed as i64);
        }
        put(&mut table, "copies", of);
    }
    table
}

fn put_surface(table: &mut Table, surface: Surface) {
    match surface {
        Surface::None => put(table, "surface", "none"),
        Surface::Mesh => put(table, "surface", "mesh"),
        Surface::Spheres { radius } => {
            put(table, "surface", "spheres");
            put(table, "particle_radius", radius);
        }
    }
}

fn put_motion(table: &mut Table, motion: &MotionScene) {
    put(table, "motion", motion.name());
    match motion {
        MotionScene::Free => {}
        MotionScene::Fixed { surface_velocity } => {
            put(table, "surface_velocity", vector(*surface_velocity));
        }
        MotionScene::Prescribed(prescribed) => {
            put(table, "surface_velocity", vector(prescribed.surface_velocity));
            if let Some(Oscillation { amplitude, frequency, phase }) = prescribed.oscillation {
                let mut of = Table::new();
                put(&mut of, "amplitude", vector(amplitude));
                put(&mut of, "frequency", frequency);
                put(&mut of, "phase", phase);
                put(table, "oscillation", of);
            }
        }
    }
}

fn put_shape(table: &mut Table, shape: &ShapeScene) {
    put(table, "shape", shape.name());
    let ShapeScene::Primitive(primitive) = shape else { return };
    let mut number = |key: &str, value: f64| put(table, key, value);
    match *primitive {
        Primitive::Sphere { radius, .. } => number("radius", radius),
        Primitive::Box { size, .. } => put(table, "size", vector(size)),
        Primitive::Cylinder { radius, height, .. } | Primitive::Capsule { radius, height, .. } => {
            number("radius", radius);
            number("height", height);
        }
        Primitive::Torus { radius, tube_radius, .. }
        | Primitive::Knot { radius, tube_radius, .. } => {
            number("radius", radius);
            number("tube_radius", tube_radius);
        }
        Primitive::Tube { radius, bottom_radius, height, thickness, .. } => {
            number("radius", radius);
            number("bottom_radius", bottom_radius);
            number("height", height);
            number("thickness", thickness);
        }
        Primitive::Dumbbell { radius, length, bar_radius, .. } => {
            number("radius", radius);
            number("length", length);
            number("bar_radius", bar_radius);
        }
        Primitive::THandle { length, width, thickness, .. } => {
            number("length", length);
            number("width", width);
            number("thickness", thickness);
        }
        Primitive::Tetrahedron { size } => number("size", size),
    }
    match *primitive {
        Primitive::Sphere { subdivisions, .. } => {
            put(table, "subdivisions", i64::from(subdivisions));
        }
        Primitive::Box { divisions, .. } | Primitive::THandle { divisions, .. } => {
            put(table, "divisions", i64::from(divisions));
        }
        Primitive::Cylinder { segments, .. }
        | Primitive::Capsule { segments, .. }
        | Primitive::Torus { segments, .. }
        | Primitive::Tube { segments, .. }
        | Primitive::Knot { segments, .. }
        | Primitive::Dumbbell { segments, .. } => put(table, "segments", i64::from(segments)),
        Primitive::Tetrahedron { .. } => {}
    }
}

fn put_material(table: &mut Table, material: &MaterialOverride) {
    let mut number = |key, value: Option<f64>| {
        if let Some(value) = value {
            put(table, key, value);
        }
    };
    // the reader accepts only one of the two; the one per area takes precedence
    match material.collision_stiffness_per_area {
        Some(stiffness) => number("collision_stiffness_per_area", Some(stiffness)),
        None => number("collision_stiffness", material.collision_stiffness),
    }
    match material.damping {
        Some(Damping::Dashpot(c)) => number("collision_damping", Some(c)),
        Some(Damping::Restitution(e)) => number("restitution", Some(e)),
        None => {}
    }
    number("friction_stiffness", material.friction_stiffness);
    number("friction_spring", material.friction_spring);
    number("friction_damping", material.friction_damping);
}

pub(super) fn put(table: &mut Table, key: &str, value: impl Into<Value>) {
    table.insert(key.to_owned(), value.into());
}

pub(super) fn put_tables(table: &mut Table, key: &str, tables: Vec<Value>) {
    if !tables.is_empty() {
        put(table, key, tables);
    }
}

pub(super) fn vector(v: DVec3) -> Value {
    Value::from(v.to_array().to_vec())
}

fn quaternion(q: DQuat) -> Value {
    Value::from(vec![q.w, q.x, q.y, q.z])
}
