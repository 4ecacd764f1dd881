//! Loads a scene file or a built-in scene and builds its world.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use tumble::{Body, BodyView, BuildError, DQuat, DVec3, Joint, World, WorldBuilder};

use super::body::MASS_KEYS;
use super::builtin::builtin;
use super::default_dt::{self, Unstable};
use super::description::{BodyScene, Copies, Geometry, Scene};
use super::geometry::{self, ShapeAndMass};
use super::place::{Place, Source};
use super::problem::{Problem, SceneError};
use super::scene_text::read_scene_text;
use super::tree::{self, Node};
use super::{read, reader::Reader};

/// A scene and the world it describes.
#[derive(Debug)]
pub struct Loaded {
    /// The scene, with all defaults filled in.
    pub scene: Scene,
    /// The world at t = 0.
    pub world: World,
}

/// Changes to a scene by the caller.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Assignments `KEY=VALUE` that override those of the scene, in order.
    pub sets: Vec<String>,
    /// Accept a time step above the critical one.
    pub force: bool,
}

/// Reads the scene file at `path` and applies `options`.
///
/// # Errors
/// [`SceneError`] holds all problems.
pub fn load_file(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneError> {
    read_and_load(path, options, false)
}

/// As [`load_file`], for the scene of a run that has begun: how it started is accepted.
///
/// # Errors
/// [`SceneError`] holds all problems.
pub(crate) fn load_recorded_file(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneError> {
    read_and_load(path, options, true)
}

fn read_and_load(
    path: &Path,
    options: &LoadOptions,
    is_recorded: bool,
) -> Result<Loaded, SceneError> {
    let file = path.display().to_string();
    let text = read_scene_text(path).map_err(|message| {
        let problem = Problem::new(Place { source: usize::MAX, span: 0..0 }, "", message);
        SceneError::new(Vec::new(), vec![problem])
    })?;
    let name = path.file_stem().map_or_else(|| file.clone(), |s| s.to_string_lossy().into_owned());
    let folder = path.parent().unwrap_or(Path::new("."));
    load(&name, Source { name: file, text }, folder, options, is_recorded)
}

/// Reads the built-in scene `name`; `None` if it does not exist.
///
/// # Errors
/// [`SceneError`] holds all problems, which can only be in the options.
pub fn load_builtin(name: &str, options: &LoadOptions) -> Option<Result<Loaded, SceneError>> {
    let scene = builtin(name)?;
    let source = Source { name: format!("{name} (built in)"), text: scene.text.to_owned() };
    Some(load_text(name, source, Path::new("."), options))
}

/// Reads a scene from text. Relative mesh paths start at `folder`.
///
/// # Errors
/// [`SceneError`] holds all problems.
pub fn load_text(
    name: &str,
    source: Source,
    folder: &Path,
    options: &LoadOptions,
) -> Result<Loaded, SceneError> {
    load(name, source, folder, options, false)
}

/// As [`load_text`], for the scene of a run that has begun: how it started is accepted.
///
/// # Errors
/// [`SceneError`] holds all problems.
pub(crate) fn load_recorded(
    name: &str,
    source: Source,
    folder: &Path,
    options: &LoadOptions,
) -> Result<Loaded, SceneError> {
    load(name, source, folder, options, true)
}

fn load(
    name: &str,
    source: Source,
    folder: &Path,
    options: &LoadOptions,
    is_recorded: bool,
) -> Result<Loaded, SceneError> {
    let (mut root, syntax) = tree::parse(&source.text, 0);
    let mut sources = vec![source];
    // after a syntax error the rest of the tree is unreliable
    if !syntax.is_empty() {
        return Err(SceneError::new(sources, syntax));
    }
    let problems = RefCell::new(Vec::new());
    for assignment in &options.sets {
        let index = sources.len();
        sources.push(Source { name: "--set".to_owned(), text: assignment.clone() });
        if let Err(problem) = tree::set(&mut root, assignment, index) {
            problems.borrow_mut().push(problem);
        }
    }
    let (mut scene, is_valid) = read::scene(&root, name.to_owned(), &problems);
    scene.force = options.force;
    let world = world((&mut scene, is_recorded), &is_valid, &root, folder, &problems);
    let problems = problems.into_inner();
    match world {
        Some(world) if problems.is_empty() => Ok(Loaded { scene, world }),
        _ => Err(SceneError::new(sources, problems)),
    }
}

/// Builds the world; `None` if there is a problem, now or before. Meshes are read in either case, so that their problems are reported
/// together with all others. `is_valid` tells which bodies were read without a problem, `is_recorded` that the scene is that of a run
/// that has begun.
fn world(
    (scene, is_recorded): (&mut Scene, bool),
    is_valid: &[bool],
    root: &Node,
    folder: &Path,
    problems: &RefCell<Vec<Problem>>,
) -> Option<World> {
    // problems of these tables were reported when the scene was read
    let already_reported = RefCell::default();
    let top = Reader::new(root, String::new(), &already_reported);
    let readers = top.tables("body");
    let report = |index: Option<usize>, key: &str, message: String| {
        let reader = index.and_then(|index| readers.get(index)).unwrap_or(&top);
        problems.borrow_mut().push(Problem::new(reader.place_of(key), reader.key(key), message));
    };
    let mut builder = World::builder()
        .gravity(scene.gravity)
        .velocity_damping_stiffness(scene.velocity_damping_stiffness)
        .dt(scene.dt)
        .integrator(scene.integrator)
        .solver(scene.solver)
        .energy_tolerance(scene.energy_tolerance)
        .force(scene.force)
        .overlaps(scene.overlaps)
        .accept_start_in_walls(is_recorded)
        .material(scene.collision);
    for (wall, material) in scene.all_walls() {
        builder = builder.wall_with_material(wall, material);
    }
    // bodies with equal geometry share one shape
    let mut shapes: BTreeMap<String, (ShapeAndMass, Geometry)> = BTreeMap::new();
    let has_chains = scene.joints.iter().any(|joint| joint.chain.is_some());
    let mut centres = BTreeMap::new();
    for (index, body) in scene.bodies.iter_mut().enumerate() {
        // an invalid body is not built, but its mesh file is checked
        if !is_valid[index] {
            if matches!(body.geometry, Geometry::Mesh(_))
                && let Err(error) = geometry::load_points(&mut body.geometry, folder)
            {
                report(Some(index), error.key, error.message);
            }
            continue;
        }
        let key = shape_key(body);
        match shapes.get(&key) {
            // with path and hash of the mesh filled in
            Some((_, geometry)) => body.geometry = geometry.clone(),
            None => match geometry::build_shape(body, folder) {
                Ok(shape) => {
                    shapes.insert(key.clone(), (shape, body.geometry.clone()));
                }
                Err(error) => report(Some(index), error.key, error.message),
            },
        }
        // with any problem, no world is built
        if let Some((shape, _)) = shapes.get(&key)
            && problems.borrow().is_empty()
        {
            if has_chains {
                centres.extend(places(body, shape));
            }
            builder = bodies(body, shape).into_iter().fold(builder, WorldBuilder::body);
        }
    }
    if !problems.borrow().is_empty() {
        return None;
    }
    let owners = owners(scene);
    let (joints, joint_owners) = joints(scene, &centres, |index, key, message| {
        let tables = top.tables("joint");
        if let Some(reader) = tables.get(index) {
            let problem = Problem::new(reader.place_of(key), reader.key(key), message);
            problems.borrow_mut().push(problem);
        }
    });
    if !problems.borrow().is_empty() {
        return None;
    }
    builder = joints.into_iter().fold(builder, WorldBuilder::joint);
    builder = scene.loads.iter().cloned().fold(builder, WorldBuilder::load);
    if let Some(gravity) = scene.central_gravity {
        builder = builder.central_gravity(gravity);
    }
    let hint = |error: &BuildError| match error {
        BuildError::Surface { body, .. } => {
            let index = owners.get(body);
            index.map(|&index| geometry::hint(&scene.bodies[index])).unwrap_or_default()
        }
        _ => String::new(),
    };
    let world = builder.build().map_err(|errors| {
        let mut reported = BTreeSet::new();
        for error in errors.0 {
            if let BuildError::Unstable { dt, critical, body } = &error
                && !top.has("dt")
            {
                let reader = owners.get(body).and_then(|&index| readers.get(index));
                let unstable = Unstable { dt: *dt, critical: *critical, body };
                problems.borrow_mut().push(default_dt::problem(&top, reader, &unstable));
                continue;
            }
            if let Some(problem) = of_joint_or_load(&error, &top, &joint_owners) {
                problems.borrow_mut().push(problem);
                continue;
            }
            let (index, key) = origin(&error, &owners, &readers);
            // report only one of the copies of a body
            if reported.insert((index, key)) {
                report(index, key, format!("cannot work: {error}{}", hint(&error)));
            }
        }
    });
    let world = world.ok()?;
    let overflowing = world.bodies().find(|body| !has_finite_energy(&world, body));
    if let Some(name) = overflowing.map(|body| body.name()) {
        let message = "has an energy that is not a finite number at the start: \
                       its mass, place or velocity is too large";
        report(owners.get(name).copied(), "", message.to_owned());
        return None;
    }
    Some(world)
}

fn has_finite_energy(world: &World, body: &BodyView) -> bool {
    let mass = body.model().mass;
    let flight = 0.5 * mass * body.velocity().length_squared();
    let spin = 0.5 * body.angular_velocity().dot(body.angular_momentum());
    let height = mass * world.model().gravity.dot(body.position());
    (flight + spin + height).is_finite()
}

/// The index of the `[[body]]` that each body of the world comes from, by name.
fn owners(scene: &Scene) -> BTreeMap<String, usize> {
    let names = |(index, body): (usize, &BodyScene)| {
        body.names().into_iter().map(move |name| (name, index))
    };
    // if bodies share a name, the last one is reported
    scene.bodies.iter().enumerate().flat_map(names).collect()
}

/// A key that is equal for bodies with equal shape, mass and surface.
fn shape_key(body: &BodyScene) -> String {
    let BodyScene { geometry, scale, sampling, mass_model, mass, surface, .. } = body;
    let given = (body.center_of_mass, body.inertia);
    format!("{geometry:?} {scale:?} {sampling:?} {mass_model:?} {mass:?} {given:?} {surface:?}")
}

/// The centre of mass of the body, or of its copies, by name.
fn places(scene: &BodyScene, built: &ShapeAndMass) -> Vec<(String, DVec3)> {
    let centre = scene.position.unwrap_or(built.shape.centre());
    let poses = scene.copies.as_ref().map_or(vec![(DVec3::ZERO, DQuat::IDENTITY)], |c| c.poses());
    scene
        .names()
        .into_iter()
        .zip(poses)
        .map(|(name, (offset, _))| (name, centre + offset))
        .collect()
}

/// All joints, and for each name of one the index of its `[[joint]]`; `report` gets the faults of chains.
fn joints(
    scene: &Scene,
    centres: &BTreeMap<String, DVec3>,
    report: impl Fn(usize, &str, String),
) -> (Vec<Joint>, BTreeMap<String, usize>) {
    let mut owners = BTreeMap::new();
    let mut all = Vec::new();
    for (index, own) in scene.joints.iter().enumerate() {
        let count = own.chain.as_ref().map_or(0, |chain| {
            let body = scene.bodies.iter().find(|body| body.name == *chain);
            body.and_then(|body| body.copies.as_ref()).map_or(0, Copies::total)
        });
        if let (Some(chain), true) = (&own.chain, count < 2) {
            report(
                index,
                "chain",
                format!(
                    "is \"{chain}\", but must be the name of a body with `copies`, two or more"
                ),
            );
        }
        for joint in own.joints(count, |name| centres.get(name).copied()) {
            owners.insert(joint.name.clone().unwrap_or_default(), index);
            all.push(joint);
        }
    }
    (all, owners)
}

/// The problem that an error of a joint or load is, at its key.
fn of_joint_or_load(
    error: &BuildError,
    top: &Reader,
    joint_owners: &BTreeMap<String, usize>,
) -> Option<Problem> {
    let (table, index, quantity) = match error {
        BuildError::Joint { joint, quantity, .. } => {
            ("joint", *joint_owners.get(joint)?, *quantity)
        }
        BuildError::Load { load, quantity, .. } => ("load", *load, *quantity),
        _ => return None,
    };
    let tables = top.tables(table);
    let reader = tables.get(index)?;
    // a key of another table, or one of the motor
    let key = quantity.split('.').next().unwrap_or(quantity);
    let place = reader.place_of(key);
    Some(Problem::new(place, reader.key(key), format!("cannot work: {error}")))
}

/// The body, or all its copies.
fn bodies(scene: &BodyScene, built: &ShapeAndMass) -> Vec<Body> {
    let centre = scene.position.unwrap_or(built.shape.centre());
    let poses = scene.copies.as_ref().map_or(vec![(DVec3::ZERO, DQuat::IDENTITY)], |c| c.poses());
    scene
        .names()
        .into_iter()
        .zip(poses)
        .map(|(name, (offset, rotation))| {
            let body = Body::new(built.shape.clone())
                .name(name)
                .mass(built.mass)
                .position(centre + offset)
                .orientation(rotation * scene.orientation)
                .material(scene.material)
                .surface(scene.surface)
                .motion(scene.motion.motion());
            let body = scene.initial_velocity.into_iter().fold(body, Body::velocity);
            scene.initial_angular_velocity.into_iter().fold(body, Body::angular_velocity)
        })
        .collect()
}

/// The body and key that cause an error in building the world.
fn origin(
    error: &BuildError,
    owners: &BTreeMap<String, usize>,
    readers: &[Reader],
) -> (Option<usize>, &'static str) {
    let (body, key) = match error {
        BuildError::World { quantity, .. } => (None, *quantity),
        BuildError::Body { body, quantity, .. } => (Some(body), *quantity),
        BuildError::Outside { body, .. } | BuildError::InWall { body, .. } => {
            (Some(body), "position")
        }
        BuildError::SameName { body } => (Some(body), "name"),
        BuildError::Surface { body, .. } => (Some(body), "surface"),
        BuildError::Overlap { second, .. } => (Some(second), "position"),
        BuildError::Unstable { .. } => (None, "dt"),
        // reported where their own tables are
        BuildError::Joint { quantity, .. } | BuildError::Load { quantity, .. } => (None, *quantity),
    };
    let index = body.and_then(|name| owners.get(name).copied());
    // the mass can be given by one of three keys
    let key = match index.and_then(|index| readers.get(index)) {
        Some(reader) if key == "mass" => {
            MASS_KEYS.into_iter().find(|key| reader.has(key)).unwrap_or(key)
        }
        _ => key,
    };
    (index, key)
}
