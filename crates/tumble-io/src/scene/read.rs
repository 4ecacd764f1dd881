//! The top level of a scene file, key by key.

use std::cell::RefCell;

use tumble::{DVec3, Integrator, Material, Overlaps, SolverSettings, WallBox, WallPlane};

use super::body::{self, MAX_COPIES};
use super::common::{is_unit, material, orientation};
use super::description::{BodyScene, BoxScene, Copies, JointScene, OutputScene, Scene, WallScene};
use super::problem::Problem;
use super::reader::{Range, Reader};
use super::tree::Node;
use super::{joint, loads};

/// The largest number of steps: more than a double can count exactly is an error.
const MAX_STEPS: f64 = 9e15;

/// Reads a whole scene. Problems go to `problems`; invalid values are replaced by defaults. The second value tells for each body whether it
/// was read without a problem.
pub fn scene(root: &Node, name: String, problems: &RefCell<Vec<Problem>>) -> (Scene, Vec<bool>) {
    let top = Reader::new(root, String::new(), problems);
    let duration = top.number("duration", Range::NotNegative).unwrap_or(3.0);
    let dt = top.number("dt", Range::Positive).unwrap_or(1e-3);
    if duration / dt > MAX_STEPS {
        let key = if top.has("dt") { "dt" } else { "duration" };
        top.problem(key, format!("leads to {:e} steps, more than can be counted", duration / dt));
    } else if duration > 0.0 && (duration / dt).round() == 0.0 {
        let why = format!("a step of `dt` takes {dt} s, the run of `duration` {duration} s");
        let key = if top.has("duration") { "duration" } else { "dt" };
        top.problem(
            key,
            format!("leads to no step at all: {why}; a `dt` of {duration} s would do"),
        );
    }
    let collision = match top.table("collision") {
        None => Material::default(),
        Some(reader) => {
            let keys = material(&reader);
            reader.finish();
            keys.over(Material::default())
        }
    };
    let box_walls = top.table("box").and_then(box_walls);
    let walls = top.tables("wall").into_iter().filter_map(wall).collect();
    let (bodies, is_valid) = bodies(&top, problems);
    let scene = Scene {
        name,
        description: top.string("description").map(str::to_owned),
        duration,
        dt,
        integrator: integrator(&top),
        solver: top.table("solver").map_or_else(SolverSettings::default, solver),
        gravity: top.vector("gravity").unwrap_or(DVec3::new(0.0, -9.8, 0.0)),
        velocity_damping_stiffness: top
            .number("velocity_damping_stiffness", Range::NotNegative)
            .unwrap_or(0.0),
        collision,
        energy_tolerance: top.number("energy_tolerance", Range::BelowOne),
        overlaps: match top.choice("overlaps", &["refuse", "push"]) {
            Some("push") => Overlaps::Push,
            _ => Overlaps::Refuse,
        },
        box_walls,
        walls,
        bodies,
        joints: joints(&top),
        loads: top.tables("load").into_iter().map(loads::load).collect(),
        central_gravity: top.table("central_gravity").and_then(loads::central_gravity),
        output: top
            .table("output")
            .map_or_else(OutputScene::default, |table| output(table, top.has("energy_tolerance"))),
        force: false,
    };
    top.finish();
    (scene, is_valid)
}

/// All bodies, and whether each was read without a problem.
fn bodies(top: &Reader, problems: &RefCell<Vec<Problem>>) -> (Vec<BodyScene>, Vec<bool>) {
    let before = problems.borrow().len();
    let tables = top.tables("body");
    if tables.is_empty() && problems.borrow().len() == before {
        let problem = Problem::new(top.place_of("body"), "", "the scene has no body");
        let help = "add one, for example:\n[[body]]\nshape = \"sphere\"";
        top.missing(&["body"], problem.help(help));
    }
    let read = |(index, table)| {
        let before = problems.borrow().len();
        let body = body::body(table, index);
        (body, problems.borrow().len() == before)
    };
    let (bodies, is_valid): (Vec<BodyScene>, _) = tables.into_iter().enumerate().map(read).unzip();
    let total: u64 = bodies.iter().map(|b| b.copies.as_ref().map_or(1, Copies::total)).sum();
    if total > MAX_COPIES {
        top.problem("body", format!("leads to {total} bodies; at most {MAX_COPIES} can be run"));
    }
    (bodies, is_valid)
}

fn joints(top: &Reader) -> Vec<JointScene> {
    let tables = top.tables("joint").into_iter().enumerate();
    tables.filter_map(|(index, table)| joint::joint(table, index)).collect()
}

fn solver(reader: Reader) -> SolverSettings {
    let default = SolverSettings::default();
    let iterations = reader.integer("max_iterations", 1, i64::from(u32::MAX));
    let max_iterations = iterations.and_then(|count| u32::try_from(count).ok());
    let settings = SolverSettings {
        tolerance: reader.number("tolerance", Range::BelowOne).unwrap_or(default.tolerance),
        max_iterations: max_iterations.unwrap_or(default.max_iterations),
    };
    reader.finish();
    settings
}

fn integrator(top: &Reader) -> Integrator {
    const NAMES: [&str; 3] = ["splitting", "implicit", "euler"];
    match top.choice("integrator", &NAMES) {
        Some("implicit") => Integrator::Implicit,
        Some("euler") => Integrator::Euler,
        Some("splitting") => Integrator::Splitting,
        _ => Integrator::default(),
    }
}

fn box_walls(reader: Reader) -> Option<BoxScene> {
    let (min, max) = (reader.vector("min"), reader.vector("max"));
    for key in ["min", "max"] {
        reader.need(key, "is missing: a box needs `min` and `max`, two corners [x, y, z]");
    }
    let open = reader.choices("open", &WallBox::FACES).unwrap_or_default();
    let walls = WallBox {
        min: min.unwrap_or(DVec3::NEG_ONE),
        max: max.unwrap_or(DVec3::ONE),
        orientation: orientation(&reader),
        open: WallBox::FACES.map(|face| open.contains(&face)),
    };
    let material = material(&reader);
    if min.is_some() && max.is_some() && !walls.min.cmplt(walls.max).all() {
        reader.problem("max", "must lie above `min` in x, y and z");
    }
    reader.finish();
    Some(BoxScene { walls, material })
}

fn wall(reader: Reader) -> Option<WallScene> {
    let normal = reader.vector("normal");
    reader.need("normal", "is missing: a wall needs the direction out of it, [x, y, z]");
    let offset = reader.number("offset", Range::Finite).unwrap_or(0.0);
    let plane = normal.and_then(|normal| {
        // do not normalise twice: the bits would change
        let plane = if is_unit(normal.length_squared()) {
            Some(WallPlane { normal, offset })
        } else {
            WallPlane::new(normal, offset)
        };
        if plane.is_none() {
            reader.problem("normal", "must not be zero: it is the direction out of the wall");
        }
        plane
    });
    let material = material(&reader);
    reader.finish();
    plane.map(|plane| WallScene { plane, material })
}

fn output(reader: Reader, has_tolerance: bool) -> OutputScene {
    let default = OutputScene::default();
    let interval = reader.number("interval", Range::Positive).unwrap_or(default.interval);
    let checkpoint_interval = reader.number("checkpoint_interval", Range::Positive);
    let contact_points = reader.switch("contact_points").unwrap_or_default();
    if contact_points && has_tolerance {
        let message = "cannot stand beside `energy_tolerance`: a step in parts has no kick at which its contacts are";
        reader.problem("contact_points", message);
    }
    reader.finish();
    OutputScene { interval, checkpoint_interval, contact_points }
}
