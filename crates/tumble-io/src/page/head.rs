//! What the page must know once: shapes, bodies, walls and settings.

use std::collections::HashMap;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use tumble::{BodyModel, BodyView, DQuat, DVec3, Shape, WallBox, World};

use crate::appearance::{is_kinematic, particle_radius, surface_of};
use crate::scene::Scene;

/// All that is constant during a run, as the page reads it.
#[derive(Clone, Debug, Serialize)]
pub struct Head {
    /// Always `"head"`.
    #[serde(rename = "type")]
    kind: &'static str,
    version: &'static str,
    name: String,
    description: Option<String>,
    /// Whether the page is connected to a running simulation.
    pub live: bool,
    dt: f64,
    integrator: &'static str,
    duration: f64,
    gravity: [f64; 3],
    velocity_damping_stiffness: f64,
    up: [f64; 3],
    interval: f64,
    shapes: Vec<ShapeHead>,
    bodies: Vec<BodyHead>,
    walls: Vec<WallHead>,
    #[serde(rename = "box")]
    box_walls: Option<BoxHead>,
    /// What can be changed while it runs; empty in a file.
    pub parameters: Vec<Parameter>,
    /// Frames in the page.
    pub frame_count: usize,
    /// Frames of the run, those that the page leaves out included.
    pub frames_recorded: u64,
}

/// A number that the live page can set.
#[derive(Clone, Debug, Serialize)]
pub struct Parameter {
    /// As for `tumble run --set`.
    pub key: String,
    /// Its value now.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// `"at once"` or `"at reset"`.
    pub applies: String,
    /// Whether its slider is logarithmic.
    pub log: bool,
    /// The slider's lower end.
    pub min: f64,
    /// The slider's upper end.
    pub max: f64,
}

#[derive(Clone, Debug, Serialize)]
struct ShapeHead {
    vertices: String,
    triangles: String,
    /// Nothing where the particles are the vertices, in their order.
    particles: Option<String>,
    particle_count: usize,
    /// Of the spheres about the particles (m); nothing where there are none.
    particle_radius: Option<f64>,
    radius: f64,
    /// Σ rᵢ (m) and Σ (rᵢ·rᵢ 1 − rᵢ rᵢᵀ) (m²), by rows: what the force of drag needs.
    first: [f64; 3],
    second: [f64; 9],
}

#[derive(Clone, Debug, Serialize)]
struct BodyHead {
    name: String,
    shape: usize,
    mass: f64,
    particle_mass: f64,
    /// Whether something other than forces moves it.
    driven: bool,
    moments: [f64; 3],
    axes: [f64; 4],
}

#[derive(Clone, Debug, Serialize)]
struct WallHead {
    normal: [f64; 3],
    offset: f64,
    stiffness: f64,
    friction: f64,
}

#[derive(Clone, Debug, Serialize)]
struct BoxHead {
    min: [f64; 3],
    max: [f64; 3],
    orientation: [f64; 4],
    open: Vec<&'static str>,
}

impl Head {
    /// Of a run: a scene and its world.
    pub fn of(scene: &Scene, world: &World) -> Self {
        let (shapes, shape_of) = shapes(world);
        let bodies = world.bodies().zip(shape_of).map(|(body, shape)| of_body(&body, shape));
        let gravity = scene.gravity;
        let up =
            if gravity == DVec3::ZERO { DVec3::Y } else { -gravity.normalize_or(DVec3::NEG_Y) };
        Self {
            kind: "head",
            version: env!("CARGO_PKG_VERSION"),
            name: scene.name.clone(),
            description: scene.description.clone(),
            live: false,
            dt: scene.dt,
            integrator: scene.integrator.name(),
            duration: scene.duration,
            gravity: gravity.to_array(),
            velocity_damping_stiffness: scene.velocity_damping_stiffness,
            up: up.to_array(),
            interval: scene.output.interval,
            shapes,
            bodies: bodies.collect(),
            walls: walls(world),
            box_walls: scene.box_walls.as_ref().map(|own| of_box(&own.walls)),
            parameters: Vec::new(),
            frame_count: 0,
            frames_recorded: 0,
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// As JSON that may stand inside a script element: without `<`, nothing in it can end the element
    /// or begin a comment.
    pub fn to_json(&self) -> String {
        let json = serde_json::to_string(self).unwrap_or_default();
        json.replace('<', "\\u003c")
    }
}

/// Every shape once, and which of them each body has.
fn shapes(world: &World) -> (Vec<ShapeHead>, Vec<usize>) {
    let mut heads = Vec::new();
    let mut known: HashMap<*const Shape, usize> = HashMap::new();
    let shape_of = world.bodies().map(|body| {
        let shape = &body.model().shape;
        *known.entry(Arc::as_ptr(shape)).or_insert_with(|| {
            heads.push(of_shape(body.model()));
            heads.len() - 1
        })
    });
    let shape_of = shape_of.collect();
    (heads, shape_of)
}

fn of_shape(body: &BodyModel) -> ShapeHead {
    let (shape, surface) = (&body.shape, surface_of(body));
    let particle_radius = particle_radius(body);
    let particles: Vec<DVec3> = shape.particles().iter().collect();
    let bare = surface.vertices.is_empty();
    let vertices = if bare { &particles } else { &surface.vertices };
    let same = bare || *vertices == particles;
    let triangles = surface.triangles.iter().flatten().flat_map(|index| index.to_le_bytes());
    ShapeHead {
        vertices: points(vertices),
        triangles: STANDARD.encode(triangles.collect::<Vec<u8>>()),
        particles: (!same).then(|| points(&particles)),
        particle_count: particles.len(),
        particle_radius,
        radius: shape.radius() + particle_radius.unwrap_or(0.0),
        first: shape.moments().first.to_array(),
        // symmetric: columns are rows
        second: shape.moments().second.to_cols_array(),
    }
}

fn points(points: &[DVec3]) -> String {
    let numbers = points.iter().flat_map(|p| p.to_array());
    STANDARD.encode(numbers.flat_map(|number| (number as f32).to_le_bytes()).collect::<Vec<u8>>())
}

fn of_body(body: &BodyView, shape: usize) -> BodyHead {
    let model = body.model();
    let principal = model.shape.principal();
    BodyHead {
        name: body.name().to_owned(),
        shape,
        mass: model.mass,
        particle_mass: model.particle_mass(),
        driven: is_kinematic(model),
        moments: (principal.moments * model.mass).to_array(),
        axes: wxyz(DQuat::from_mat3(&principal.axes)),
    }
}

/// With the stiffness and friction that the first body meets.
fn walls(world: &World) -> Vec<WallHead> {
    let first = world.model().bodies.first();
    let walls = world.model().walls.iter().enumerate();
    walls
        .map(|(index, wall)| {
            let law = first.and_then(|body| body.contacts.get(index));
            WallHead {
                normal: wall.normal.to_array(),
                offset: wall.offset,
                stiffness: law.map_or(0.0, |law| law.stiffness),
                friction: law.map_or(0.0, |law| law.friction),
            }
        })
        .collect()
}

fn of_box(walls: &WallBox) -> BoxHead {
    let open = WallBox::FACES.into_iter().zip(walls.open);
    BoxHead {
        min: walls.min.to_array(),
        max: walls.max.to_array(),
        orientation: wxyz(walls.orientation),
        open: open.filter_map(|(face, is_open)| is_open.then_some(face)).collect(),
    }
}

fn wxyz(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use tumble::DMat3;

    #[test]
    fn axes_are_a_rotation() {
        let turned = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
        let q = DQuat::from_mat3(&turned);
        assert!(((q * DVec3::X) - DVec3::Y).length() < 1e-12);
        assert_eq!(wxyz(DQuat::IDENTITY), [1.0, 0.0, 0.0, 0.0]);
    }
}
