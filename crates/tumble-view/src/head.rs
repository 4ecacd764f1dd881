//! What a page needs to know before the first frame: shapes, bodies, walls, parameters.

use std::collections::BTreeMap;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use tumble::{DQuat, DVec3, Shape, WallBox, World};
use tumble_io::scene::Scene;

use crate::Session;
use crate::parameters::{Parameter, parameters};

/// More bodies than this would make frames too large to be sent sixty times a second.
const MOST_BODIES: usize = 20_000;
/// More vertices, triangles and particles than this in all shapes together are more than a page can bear.
const MOST_POINTS: usize = 8_000_000;

#[derive(Serialize)]
struct Head<'a> {
    #[serde(rename = "type")]
    kind: &'static str,
    version: &'static str,
    name: &'a str,
    description: &'a str,
    live: bool,
    dt: f64,
    integrator: &'static str,
    duration: f64,
    gravity: [f64; 3],
    up: [f64; 3],
    interval: f64,
    shapes: Vec<ShapeHead>,
    bodies: Vec<BodyHead<'a>>,
    walls: Vec<WallHead>,
    #[serde(rename = "box")]
    walls_of_box: Option<BoxHead>,
    parameters: Vec<Parameter>,
    frame_count: u64,
}

#[derive(Serialize)]
struct ShapeHead {
    vertices: String,
    triangles: String,
    particles: Option<String>,
    particle_count: usize,
    radius: f64,
}

#[derive(Serialize)]
struct BodyHead<'a> {
    name: &'a str,
    shape: usize,
    mass: f64,
    particle_mass: f64,
    moments: [f64; 3],
    axes: [f64; 4],
}

#[derive(Serialize)]
struct WallHead {
    normal: [f64; 3],
    offset: f64,
    stiffness: f64,
    friction: f64,
}

#[derive(Serialize)]
struct BoxHead {
    min: [f64; 3],
    max: [f64; 3],
    orientation: [f64; 4],
    open: Vec<&'static str>,
}

/// The head of a live session as JSON; see `docs/formats.md`.
pub fn json(session: &Session) -> String {
    let (scene, world) = (session.scene(), session.world());
    let shapes = Shapes::of(world);
    let head = Head {
        kind: "head",
        version: env!("CARGO_PKG_VERSION"),
        name: &scene.name,
        description: scene.description.as_deref().unwrap_or_default(),
        live: true,
        dt: scene.dt,
        integrator: scene.integrator.name(),
        duration: scene.duration,
        gravity: scene.gravity.to_array(),
        up: [0.0, 1.0, 0.0],
        interval: scene.output.interval,
        bodies: bodies(world, &shapes),
        shapes: shapes.list.iter().map(|shape| shape_head(shape)).collect(),
        walls: walls(scene),
        walls_of_box: scene.walls_of_box.map(|own| box_head(&own.walls)),
        parameters: parameters(session.next_scene()),
        frame_count: 0,
    };
    serde_json::to_string(&head).unwrap_or_default()
}

/// Whether a page could bear it.
///
/// # Errors
/// What there is too much of.
pub fn can_be_shown(world: &World) -> Result<(), String> {
    let count = world.body_count();
    if count > MOST_BODIES {
        return Err(format!(
            "the viewer shows at most {MOST_BODIES} bodies, the scene has {count}; \
             take fewer `copies`, or use `tumble run`"
        ));
    }
    let points = |shape: &Arc<Shape>| {
        let surface = shape.surface();
        surface.vertices.len() + surface.triangles.len() + shape.particles().len()
    };
    let total: usize = Shapes::of(world).list.iter().map(points).sum();
    if total > MOST_POINTS {
        return Err(format!(
            "the viewer shows at most {MOST_POINTS} vertices, triangles and particles, the shapes \
             have {total}; take coarser shapes, or use `tumble run`"
        ));
    }
    Ok(())
}

/// The shapes of a world, each once.
struct Shapes {
    list: Vec<Arc<Shape>>,
    /// Which of them each body has.
    of_body: Vec<usize>,
}

impl Shapes {
    fn of(world: &World) -> Self {
        let mut known = BTreeMap::new();
        let mut list: Vec<Arc<Shape>> = Vec::new();
        let of_body = world
            .bodies()
            .map(|body| {
                let shape = &body.model().shape;
                *known.entry(Arc::as_ptr(shape)).or_insert_with(|| {
                    list.push(Arc::clone(shape));
                    list.len() - 1
                })
            })
            .collect();
        Self { list, of_body }
    }
}

fn shape_head(shape: &Shape) -> ShapeHead {
    let (surface, particles) = (shape.surface(), shape.particles());
    let same = surface.vertices.len() == particles.len()
        && surface.vertices.iter().zip(particles.iter()).all(|(vertex, place)| *vertex == place);
    let triangles = surface.triangles.iter().flatten().flat_map(|index| index.to_le_bytes());
    ShapeHead {
        vertices: points(surface.vertices.iter().copied()),
        triangles: STANDARD.encode(triangles.collect::<Vec<u8>>()),
        particles: (!same).then(|| points(particles.iter())),
        particle_count: particles.len(),
        radius: shape.radius(),
    }
}

/// x, y, z of all points as single-precision numbers, in base64.
fn points(points: impl Iterator<Item = DVec3>) -> String {
    let bytes = points.flat_map(|p| p.to_array()).flat_map(|x| (x as f32).to_le_bytes());
    STANDARD.encode(bytes.collect::<Vec<u8>>())
}

fn bodies<'a>(world: &'a World, shapes: &Shapes) -> Vec<BodyHead<'a>> {
    let bodies = world.bodies().zip(&shapes.of_body);
    bodies
        .map(|(body, &shape)| {
            let model = body.model();
            let principal = model.shape.principal();
            BodyHead {
                name: body.name(),
                shape,
                mass: model.mass,
                particle_mass: model.particle_mass(),
                moments: (principal.moments * model.mass).to_array(),
                axes: quaternion(DQuat::from_mat3(&principal.axes)),
            }
        })
        .collect()
}

fn walls(scene: &Scene) -> Vec<WallHead> {
    let wall = |(plane, material): (tumble::WallPlane, tumble::MaterialOverride)| {
        let material = material.over(scene.collision);
        WallHead {
            normal: plane.normal.to_array(),
            offset: plane.offset,
            stiffness: material.collision_stiffness,
            friction: material.friction_stiffness,
        }
    };
    scene.all_walls().into_iter().map(wall).collect()
}

fn box_head(walls: &WallBox) -> BoxHead {
    let open = WallBox::FACES.iter().zip(walls.open).filter(|(_, open)| *open);
    BoxHead {
        min: walls.min.to_array(),
        max: walls.max.to_array(),
        orientation: quaternion(walls.orientation),
        open: open.map(|(face, _)| *face).collect(),
    }
}

fn quaternion(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}
