//! A scene: its bodies, its critical time step, and what each integrator would cost.

use tumble::{Integrator, JointKind, World};
use tumble_io::on_one_line;
use tumble_io::scene::{LoadOptions, Scene, StepLimits};

use crate::failure::{Failure, print};
use crate::format::{count, number, wrapped_columns};
use crate::integrator_cost::measure;
use crate::mesh_verdict::plural;
use crate::scene_argument::load_scene;

type Row = (&'static str, String);

/// When to take which integrator.
const WHICH: &str = "implicit for heaps, stacks and all that comes to rest; splitting where the motion in a contact matters, \
    or where it is cheap enough; euler to see what the basic system does";

/// What the times are.
const MEASURED: &str =
    "these are times of the first steps on this machine; before bodies meet, a second costs less";

/// Prints what to know about a scene before it is run.
pub fn scene_info(name: &str, sets: &[String]) -> Result<(), Failure> {
    // a step above the critical one is what the user asks about, not an error
    let options = LoadOptions { sets: sets.to_vec(), force: true };
    let loaded = load_scene(name, &options)?;
    let (scene, world) = (&loaded.scene, &loaded.world);
    let limits = StepLimits::new(scene, world);
    let mut rows = about(scene, world);
    rows.extend(given_mass(scene, world));
    rows.extend(joints(world));
    rows.extend(steps(scene, &limits));
    rows.extend(choices(scene, &limits));
    print(&wrapped_columns(&rows))
}

fn about(scene: &Scene, world: &World) -> Vec<Row> {
    let mut rows = vec![("scene", on_one_line(&scene.name))];
    rows.extend(scene.description.as_ref().map(|text| ("", on_one_line(text))));
    let driven = world.bodies().filter(|body| !body.model().is_free()).count();
    let driven = match driven {
        0 => String::new(),
        n => format!(", {} of them fixed or prescribed", count(n as u64)),
    };
    let particles: usize = world.bodies().map(|body| body.particle_count()).sum();
    rows.extend([
        ("bodies", format!("{}{driven}", count(world.body_count() as u64))),
        ("particles", count(particles as u64)),
        ("walls", count(world.model().walls.len() as u64)),
        ("duration", format!("{} s", number(scene.duration))),
        ("integrator", scene.integrator.name().to_owned()),
    ]);
    rows
}

/// The most bodies with given mass properties that are listed.
const MAX_LISTED: usize = 8;

/// The mass properties that the scene gives in place of those of the mass model.
fn given_mass(scene: &Scene, world: &World) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut index = 0;
    for body in &scene.bodies {
        // copies have the properties of the first one
        let shape = &world.body(index).model().shape;
        let mass = world.body(index).model().mass;
        index += body.names().len();
        let centre = body.center_of_mass.map(|_| {
            let [x, y, z] = shape.centre().to_array().map(number);
            format!("centre of mass ({x}, {y}, {z}) m")
        });
        let moments = body.inertia.map(|_| {
            let [x, y, z] = (shape.principal().moments * mass).to_array().map(number);
            format!("principal moments ({x}, {y}, {z}) kg·m²")
        });
        let given: Vec<String> = centre.into_iter().chain(moments).collect();
        if !given.is_empty() {
            let label = if rows.is_empty() { "given mass" } else { "" };
            rows.push((label, format!("\"{}\": {}", on_one_line(&body.name), given.join(", "))));
        }
    }
    if rows.len() > MAX_LISTED {
        let more = rows.len() - MAX_LISTED;
        rows.truncate(MAX_LISTED);
        rows.push(("", format!("and {}", plural(more, "more body", "more bodies"))));
    }
    rows
}

/// The step of the scene, and what limits it.
/// The joints, by kind.
fn joints(world: &World) -> Option<(&'static str, String)> {
    let joints = &world.model().joints.list;
    if joints.is_empty() {
        return None;
    }
    let of_kind = |kind: &JointKind| joints.iter().filter(|joint| joint.kind == *kind).count();
    let kinds = JointKind::ALL.iter().filter(|kind| of_kind(kind) > 0);
    let kinds: Vec<_> = kinds.map(|kind| format!("{} {}", of_kind(kind), kind.name())).collect();
    let redundant = match world.redundant_constraints() {
        0 => String::new(),
        count => format!("; {count} of their constraints follow from the others"),
    };
    Some(("joints", kinds.join(", ") + &redundant))
}

fn steps(scene: &Scene, limits: &StepLimits) -> Vec<Row> {
    let mut rows = vec![("dt", format!("{} s", step(scene.dt)))];
    let Some(critical) = &limits.critical else {
        rows.push(("critical dt", "none: nothing can touch anything".to_owned()));
        return rows;
    };
    let (size, body) = (number(critical.dt), on_one_line(&critical.body));
    let is_refused = scene.dt > critical.dt && scene.integrator != Integrator::Implicit;
    let part = format!("dt is {} of it", step(rounded(scene.dt / critical.dt)));
    let refused = if is_refused { ", so that tumble run refuses the scene" } else { "" };
    rows.push(("critical dt", format!("{size} s, for contacts of \"{body}\"; {part}{refused}")));
    if let Some(dt) = limits.dt_for_restitution {
        let text =
            format!("splitting rebounds with the given restitution up to dt = {} s", number(dt));
        rows.push(("restitution", text));
    }
    rows
}

/// A suggestion for each integrator, with its cost.
fn choices(scene: &Scene, limits: &StepLimits) -> Vec<Row> {
    let mut rows = vec![("as it is", choice(scene, scene.integrator, scene.dt))];
    for integrator in [Integrator::Splitting, Integrator::Implicit, Integrator::Euler] {
        // with this key a scene is for one integrator
        if scene.energy_tolerance.is_some() && integrator != Integrator::Splitting {
            continue;
        }
        let dt = limits.suggested_dt(integrator);
        if (integrator, dt) != (scene.integrator, scene.dt) {
            rows.push((integrator.name(), choice(scene, integrator, dt)));
        }
    }
    rows.push(("measured", MEASURED.to_owned()));
    if limits.critical.is_some() {
        rows.push(("which", WHICH.to_owned()));
    }
    rows
}

fn choice(scene: &Scene, integrator: Integrator, dt: f64) -> String {
    let dt_text = format!("dt = {} s", step(dt));
    let cost = match measure(scene, integrator, dt) {
        Ok(cost) => cost,
        Err(why) => return format!("{dt_text}: it cannot run: {}", on_one_line(&why)),
    };
    let seconds = step(rounded(cost.seconds_per_second()));
    let steps = plural(cost.steps, "step", "steps");
    let simulated = step(rounded(cost.simulated));
    let failed = cost
        .failure
        .map_or(String::new(), |why| format!("; then it failed: {}", on_one_line(&why)));
    format!("{dt_text}: {seconds} s for each simulated second ({steps}, {simulated} s{failed})")
}

/// A time step, or another number of few digits, as one would write it in a scene.
fn step(x: f64) -> String {
    let short = format!("{x:e}");
    if x < 1e-3 && short.len() < 8 { short } else { number(x) }
}

/// A measured number, without digits that mean nothing.
fn rounded(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}
