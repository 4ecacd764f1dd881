//! From a file, or a built-in scene, to a world that is ready to run.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use tumble::{Body, BuildError, DQuat, DVec3, World};

use super::builtin::builtin;
use super::description::{BodyScene, Scene};
use super::geometry::{self, Made};
use super::problem::{Problem, SceneError, Source};
use super::tree::{self, Node, Place};
use super::{read, reader::Reader};

/// A scene file larger than this is something else.
const MOST_BYTES: u64 = 256 << 20;

/// A scene and the world it describes.
#[derive(Debug)]
pub struct Loaded {
    /// What was read, every default filled in.
    pub scene: Scene,
    /// The world at t = 0.
    pub world: World,
}

/// Reads the scene file at `path`, with `sets` (each `KEY=VALUE`) laid over it.
///
/// # Errors
/// [`SceneError`] holds everything that is wrong.
pub fn load_file(path: &Path, sets: &[String]) -> Result<Loaded, SceneError> {
    let file = path.display().to_string();
    let text = read_text(path).map_err(|message| {
        let problem = Problem::new(Place { source: usize::MAX, span: 0..0 }, "", message);
        SceneError::new(Vec::new(), vec![problem])
    })?;
    let name = path.file_stem().map_or_else(|| file.clone(), |s| s.to_string_lossy().into_owned());
    let folder = path.parent().unwrap_or(Path::new("."));
    load_text(&name, Source { name: file, text }, folder, sets)
}

/// Reads the built-in scene `name`; `None` if there is none of that name.
///
/// # Errors
/// [`SceneError`] holds everything that is wrong, which can only be in `sets`.
pub fn load_builtin(name: &str, sets: &[String]) -> Option<Result<Loaded, SceneError>> {
    let scene = builtin(name)?;
    let source = Source { name: format!("{name} (built in)"), text: scene.text.to_owned() };
    Some(load_text(name, source, Path::new("."), sets))
}

fn read_text(path: &Path) -> Result<String, String> {
    let shown = path.display();
    let metadata = std::fs::metadata(path)
        .map_err(|error| format!("cannot read the scene {shown}: {error}"))?;
    if metadata.is_dir() {
        return Err(format!("{shown} is a folder; name the scene file in it"));
    }
    if !metadata.is_file() {
        return Err(format!("{shown} is no ordinary file; save the scene to one first"));
    }
    if metadata.len() > MOST_BYTES {
        let most = MOST_BYTES >> 20;
        return Err(format!(
            "{shown} is larger than {most} MiB: no scene; put particles into a mesh file"
        ));
    }
    let bytes =
        std::fs::read(path).map_err(|error| format!("cannot read the scene {shown}: {error}"))?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        format!("{shown} is no scene: a scene is TOML text in UTF-8, and byte {at} is not")
    })
}

/// Reads a scene from text. `folder` is where relative mesh paths start.
///
/// # Errors
/// [`SceneError`] holds everything that is wrong.
pub fn load_text(
    name: &str,
    source: Source,
    folder: &Path,
    sets: &[String],
) -> Result<Loaded, SceneError> {
    let (mut root, syntax) = tree::parse(&source.text, 0);
    let mut sources = vec![source];
    // after a syntax error the rest of the tree is guesswork
    if !syntax.is_empty() {
        return Err(SceneError::new(sources, syntax));
    }
    let problems = RefCell::new(Vec::new());
    for assignment in sets {
        let index = sources.len();
        let told = Source { name: "--set".to_owned(), text: assignment.clone() };
        sources.push(told);
        if let Err(problem) = tree::set(&mut root, assignment, index) {
            problems.borrow_mut().push(problem);
        }
    }
    let mut scene = read::scene(&root, name.to_owned(), &problems);
    let world = if problems.borrow().is_empty() {
        world(&mut scene, &root, folder, &problems)
    } else {
        None
    };
    let problems = problems.into_inner();
    match world {
        Some(world) if problems.is_empty() => Ok(Loaded { scene, world }),
        _ => Err(SceneError::new(sources, problems)),
    }
}

/// Builds the world; `None` with at least one problem added.
fn world(
    scene: &mut Scene,
    root: &Node,
    folder: &Path,
    problems: &RefCell<Vec<Problem>>,
) -> Option<World> {
    let top = Reader::new(root, String::new(), problems);
    let readers = top.tables("body");
    let mut builder = World::builder()
        .gravity(scene.gravity)
        .velocity_damping_stiffness(scene.velocity_damping_stiffness)
        .dt(scene.dt)
        .integrator(scene.integrator)
        .material(scene.collision);
    for (wall, material) in scene.all_walls() {
        builder = builder.wall_of(wall, material);
    }
    // bodies that look alike share one shape
    let mut made: BTreeMap<String, Made> = BTreeMap::new();
    let mut owners = Vec::new();
    for (index, body) in scene.bodies.iter_mut().enumerate() {
        let look = look(body);
        let shape = match made.get(&look) {
            Some(shape) => Ok(shape.clone()),
            None => geometry::make(body, folder),
        };
        match shape {
            Ok(shape) => {
                for body in bodies(body, &shape) {
                    builder = builder.body(body);
                    owners.push(index);
                }
                made.insert(look, shape);
            }
            Err(error) => readers[index].problem(error.key, error.message),
        }
    }
    if !problems.borrow().is_empty() {
        return None;
    }
    match builder.build() {
        Ok(world) => Some(world),
        Err(errors) => {
            let names = scene.body_names();
            let owner = |name: &str| {
                let at = names.iter().position(|n| n == name)?;
                owners.get(at).copied()
            };
            for error in errors.0 {
                report(&error, &top, &readers, owner);
            }
            None
        }
    }
}

/// Two bodies with the same look have the same shape and mass.
fn look(body: &BodyScene) -> String {
    let BodyScene { geometry, scale, sampling, mass_model, mass, .. } = body;
    format!("{geometry:?} {scale:?} {sampling:?} {mass_model:?} {mass:?}")
}

/// The body, or all its copies.
fn bodies(scene: &BodyScene, made: &Made) -> Vec<Body> {
    let centre = scene.position.unwrap_or(made.shape.centre());
    let poses = scene.copies.as_ref().map_or(vec![(DVec3::ZERO, DQuat::IDENTITY)], |c| c.poses());
    scene
        .names()
        .into_iter()
        .zip(poses)
        .map(|(name, (at, turn))| {
            Body::new(made.shape.clone())
                .name(name)
                .mass(made.mass)
                .position(centre + at)
                .orientation(turn * scene.orientation)
                .velocity(scene.initial_velocity)
                .angular_velocity(scene.initial_angular_velocity)
                .material(scene.material)
        })
        .collect()
}

/// Points a problem that only the finished world shows at the key it comes from.
fn report(
    error: &BuildError,
    top: &Reader,
    readers: &[Reader],
    owner: impl Fn(&str) -> Option<usize>,
) {
    let (body, key) = match error {
        BuildError::World { quantity, .. } => (None, *quantity),
        BuildError::Body { body, quantity, .. } => (Some(body), *quantity),
        BuildError::Outside { body, .. } => (Some(body), "position"),
        BuildError::SameName { body } => (Some(body), "name"),
    };
    match body.and_then(|name| owner(name)).and_then(|index| readers.get(index)) {
        Some(reader) => reader.problem(key, format!("cannot work: {error}")),
        None => top.problem(key, format!("cannot work: {error}")),
    }
}
