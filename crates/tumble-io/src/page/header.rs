//! The constant data of a run for the page: shapes, bodies, walls and settings.

use std::collections::HashMap;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use tumble::{
    BodyModel, BodyView, DQuat, DVec3, JointModel, Load, LoadAxes, LoadCourse, Motor, Shape,
    WallBox, World,
};

use crate::appearance::{is_kinematic, particle_radius, surface_of};
use crate::scene::Scene;

/// The constant data of a run, as the page reads it.
///
/// Arrays of vertices and indices are little-endian `f32` and `u32` numbers in base64.
#[derive(Clone, Debug, Serialize)]
pub struct Header {
    /// Always `"head"`.
    #[serde(rename = "type")]
    message_type: &'static str,
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
    shapes: Vec<ShapeHeader>,
    bodies: Vec<BodyHeader>,
    joints: Vec<JointHeader>,
    loads: Vec<LoadHeader>,
    walls: Vec<WallHeader>,
    #[serde(rename = "box")]
    box_walls: Option<BoxHeader>,
    /// Parameters that the live page can change; empty in `motion.html`.
    pub parameters: Vec<Parameter>,
    /// The integrators that the live page can change to; empty in `motion.html`.
    pub integrators: Vec<IntegratorChoice>,
    /// Number of frames in the page.
    pub frame_count: usize,
    /// Number of recorded frames, including those that the page omits.
    pub frames_recorded: u64,
}

/// An integrator that the live page can change to.
#[derive(Clone, Debug, Serialize)]
pub struct IntegratorChoice {
    /// Its name.
    pub name: &'static str,
    /// The time step that comes with it (s).
    pub dt: f64,
}

/// A parameter that the live page can change.
#[derive(Clone, Debug, Serialize)]
pub struct Parameter {
    /// Key, as for `tumble run --set`.
    pub key: String,
    /// Current value.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// When a change takes effect: `"at once"` or `"at reset"`.
    pub applies: String,
    /// Whether the slider is logarithmic.
    pub log: bool,
    /// Minimum of the slider.
    pub min: f64,
    /// Maximum of the slider.
    pub max: f64,
}

#[derive(Clone, Debug, Serialize)]
struct ShapeHeader {
    vertices: String,
    triangles: String,
    /// Particles; `None` if they are the vertices, in the same order.
    particles: Option<String>,
    particle_count: usize,
    /// Radius of the spheres around the particles (m), if there are any.
    particle_radius: Option<f64>,
    /// Bounding radius (m).
    radius: f64,
    /// Σ rᵢ (m), for the drag force.
    first: [f64; 3],
    /// Σ (rᵢ·rᵢ 1 − rᵢ rᵢᵀ) (m²) by rows, for the drag torque.
    second: [f64; 9],
}

#[derive(Clone, Debug, Serialize)]
struct BodyHeader {
    name: String,
    shape: usize,
    mass: f64,
    particle_mass: f64,
    /// Whether the body is kinematic.
    driven: bool,
    /// Principal moments of inertia (kg·m²).
    moments: [f64; 3],
    /// Principal axes in the body frame as a quaternion w, x, y, z.
    axes: [f64; 4],
}

#[derive(Clone, Debug, Serialize)]
struct WallHeader {
    normal: [f64; 3],
    offset: f64,
    stiffness: f64,
    friction: f64,
}

#[derive(Clone, Debug, Serialize)]
struct BoxHeader {
    min: [f64; 3],
    max: [f64; 3],
    orientation: [f64; 4],
    open: Vec<&'static str>,
}

impl Header {
    /// The header of a run that starts with `world`, without frames and parameters.
    pub fn new(scene: &Scene, world: &World) -> Self {
        let (shapes, shape_of_body) = shape_headers(world);
        let bodies =
            world.bodies().zip(shape_of_body).map(|(body, shape)| body_header(&body, shape));
        let gravity = scene.gravity;
        let up =
            if gravity == DVec3::ZERO { DVec3::Y } else { -gravity.normalize_or(DVec3::NEG_Y) };
        Self {
            message_type: "head",
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
            joints: world.model().joints.list.iter().map(joint_header).collect(),
            loads: world.model().loads.list.iter().map(load_header).collect(),
            walls: wall_headers(world),
            box_walls: scene.box_walls.as_ref().map(|box_walls| box_header(&box_walls.walls)),
            parameters: Vec::new(),
            integrators: Vec::new(),
            frame_count: 0,
            frames_recorded: 0,
        }
    }

    /// The name of the scene.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The header as JSON. `<` is escaped, so that the text can be placed in a script element of HTML.
    pub fn to_json(&self) -> String {
        let json = serde_json::to_string(self).unwrap_or_default();
        json.replace('<', "\\u003c")
    }
}

/// A joint, for drawing. Points and axes are in the axes of either body, from its centre of mass; of the world its own.
#[derive(Clone, Debug, Serialize)]
struct JointHeader {
    name: String,
    kind: &'static str,
    /// Indices of both bodies; null is the world.
    bodies: [Option<u32>; 2],
    anchors: [[f64; 3]; 2],
    /// The axis of a hinge or slider.
    axes: Option<[[f64; 3]; 2]>,
    /// Its motor.
    motor: Option<&'static str>,
    /// The length of a rope or of a spring without force (m).
    length: Option<f64>,
    /// The time at which it lets go (s).
    until: Option<f64>,
}

fn joint_header(joint: &JointModel) -> JointHeader {
    let axes = joint.axes.map(|axes| axes.x_axis.to_array());
    JointHeader {
        name: joint.name.clone(),
        kind: joint.kind.name(),
        bodies: joint.bodies,
        anchors: joint.anchors.map(|anchor| anchor.to_array()),
        axes: joint.kind.has_axis().then_some(axes),
        motor: joint.motor.map(|motor| match motor {
            Motor::Speed { .. } => "speed",
            Motor::Position { .. } => "position",
        }),
        length: joint.kind.has_length().then_some(joint.start_length + joint.natural),
        until: Some(joint.until).filter(|until| until.is_finite()),
    }
}

/// A load, for drawing.
#[derive(Clone, Debug, Serialize)]
struct LoadHeader {
    /// Index of the body.
    body: u32,
    force: [f64; 3],
    torque: [f64; 3],
    /// Where the force acts (m, body axes, from the centre of mass).
    at: [f64; 3],
    /// Whether force and torque turn with the body.
    in_body_axes: bool,
    /// Frequency (Hz) and phase (rad), if it is periodic.
    periodic: Option<[f64; 2]>,
    /// Times and forces, if there is a table.
    table: Option<Vec<[f64; 4]>>,
}

fn load_header((body, load): &(u32, Load)) -> LoadHeader {
    let (mut periodic, mut table) = (None, None);
    match &load.course {
        LoadCourse::Constant => {}
        LoadCourse::Periodic { frequency, phase } => periodic = Some([*frequency, *phase]),
        LoadCourse::Table(rows) => {
            table = Some(rows.iter().map(|(t, f)| [*t, f.x, f.y, f.z]).collect());
        }
    }
    LoadHeader {
        body: *body,
        force: load.force.to_array(),
        torque: load.torque.to_array(),
        at: load.at.to_array(),
        in_body_axes: load.axes == LoadAxes::Body,
        periodic,
        table,
    }
}

/// The distinct shapes, and the index of the shape of each body.
fn shape_headers(world: &World) -> (Vec<ShapeHeader>, Vec<usize>) {
    let mut headers = Vec::new();
    let mut index_of: HashMap<*const Shape, usize> = HashMap::new();
    let shape_of_body = world.bodies().map(|body| {
        let shape = &body.model().shape;
        *index_of.entry(Arc::as_ptr(shape)).or_insert_with(|| {
            headers.push(shape_header(body.model()));
            headers.len() - 1
        })
    });
    let shape_of_body = shape_of_body.collect();
    (headers, shape_of_body)
}

fn shape_header(body: &BodyModel) -> ShapeHeader {
    let (shape, surface) = (&body.shape, surface_of(body));
    let particle_radius = particle_radius(body);
    let particles: Vec<DVec3> = shape.particles().iter().collect();
    let has_no_surface = surface.vertices.is_empty();
    let vertices = if has_no_surface { &particles } else { &surface.vertices };
    let are_shared = has_no_surface || *vertices == particles;
    let triangles = surface.triangles.iter().flatten().flat_map(|index| index.to_le_bytes());
    ShapeHeader {
        vertices: encode_points(vertices),
        triangles: STANDARD.encode(triangles.collect::<Vec<u8>>()),
        particles: (!are_shared).then(|| encode_points(&particles)),
        particle_count: particles.len(),
        particle_radius,
        radius: shape.radius() + particle_radius.unwrap_or(0.0),
        first: shape.moments().first.to_array(),
        // the matrix is symmetric, so its columns are its rows
        second: shape.moments().second.to_cols_array(),
    }
}

/// Coordinates as little-endian `f32` in base64.
fn encode_points(points: &[DVec3]) -> String {
    let numbers = points.iter().flat_map(|p| p.to_array());
    STANDARD.encode(numbers.flat_map(|number| (number as f32).to_le_bytes()).collect::<Vec<u8>>())
}

fn body_header(body: &BodyView, shape: usize) -> BodyHeader {
    let model = body.model();
    let principal = model.shape.principal();
    BodyHeader {
        name: body.name().to_owned(),
        shape,
        mass: model.mass,
        particle_mass: model.particle_mass(),
        driven: is_kinematic(model),
        moments: (principal.moments * model.mass).to_array(),
        axes: wxyz(DQuat::from_mat3(&principal.axes)),
    }
}

/// The walls, with the stiffness and friction of their contacts with the first body.
fn wall_headers(world: &World) -> Vec<WallHeader> {
    let first = world.model().bodies.first();
    let walls = world.model().walls.iter().enumerate();
    walls
        .map(|(index, wall)| {
            let law = first.and_then(|body| body.contacts.get(index));
            WallHeader {
                normal: wall.normal.to_array(),
                offset: wall.offset,
                stiffness: law.map_or(0.0, |law| law.stiffness),
                friction: law.map_or(0.0, |law| law.friction),
            }
        })
        .collect()
}

fn box_header(walls: &WallBox) -> BoxHeader {
    let open = WallBox::FACES.into_iter().zip(walls.open);
    BoxHeader {
        min: walls.min.to_array(),
        max: walls.max.to_array(),
        orientation: wxyz(walls.orientation),
        open: open.filter_map(|(face, is_open)| is_open.then_some(face)).collect(),
    }
}

/// A quaternion in the order of the page: w, x, y, z.
fn wxyz(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use tumble::DMat3;

    #[test]
    fn a_quaternion_of_axes_rotates_x_to_the_first_axis() {
        let axes = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
        let q = DQuat::from_mat3(&axes);
        assert!(((q * DVec3::X) - DVec3::Y).length() < 1e-12);
        assert_eq!(wxyz(DQuat::IDENTITY), [1.0, 0.0, 0.0, 0.0]);
    }
}
