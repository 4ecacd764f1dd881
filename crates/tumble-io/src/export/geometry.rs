//! Geometry for glTF and USD: meshes with normals, walls, colours, orientation of the scene.

use std::sync::Arc;

use glam::Vec3;
use tumble::{BodyModel, DQuat, DVec3};

use super::error::ExportError;
use super::job::Job;
use crate::appearance::{KINEMATIC_COLOUR, is_kinematic, surface_of};
use crate::picture::{Boundary, body_colour, corner_normals};
use crate::replay::{Replay, ReplayFrame};
use crate::run::boundaries;

/// Opacity of kinematic bodies, which may enclose others.
const KINEMATIC_OPACITY: f32 = 0.35;

/// The constant part of a scene: shapes, colours and walls.
pub(super) struct SceneGeometry {
    /// The distinct shapes.
    pub shapes: Vec<ShapeGeometry>,
    /// Index into `shapes` for each body.
    pub shape_of_body: Vec<usize>,
    /// Linear RGB colour and opacity of each body, from 0 to 1.
    pub colours: Vec<[f32; 4]>,
    /// Vertices (m) of rectangles for all walls, counter-clockwise seen from the free side. An
    /// infinite plane becomes a rectangle about as large as the motion.
    pub walls: Vec<[DVec3; 4]>,
}

/// A shape in the body frame (m).
pub(super) struct ShapeGeometry {
    /// Vertices of the surface, or the particles if the shape has no surface.
    pub points: Vec<DVec3>,
    /// Triangles with non-zero area; empty for a shape without a surface.
    pub triangles: Vec<[u32; 3]>,
    /// Normals at the three vertices of each triangle: smooth, except across creases.
    pub normals: Vec<[Vec3; 3]>,
}

impl SceneGeometry {
    /// Collects the geometry of a run.
    ///
    /// # Errors
    /// [`ExportError::Unsupported`] if a coordinate exceeds the range of single precision.
    pub fn new(job: &Job) -> Result<Self, ExportError> {
        let mut distinct: Vec<&BodyModel> = Vec::new();
        let models = job.replay.world.model().bodies.iter();
        let shape_of_body = models.map(|model| {
            let is_same = |body: &&BodyModel| Arc::ptr_eq(&body.shape, &model.shape);
            distinct.iter().position(is_same).unwrap_or_else(|| {
                distinct.push(model);
                distinct.len() - 1
            })
        });
        let shape_of_body = shape_of_body.collect();
        let shapes: Vec<ShapeGeometry> =
            distinct.iter().map(|body| ShapeGeometry::new(body)).collect();
        let bounds = Bounds::new(job.replay, job.selection.span);
        let walls = boundaries(&job.replay.scene);
        let walls: Vec<[DVec3; 4]> =
            walls.iter().flat_map(|part| rectangles(part, &bounds)).collect();
        let points = shapes.iter().flat_map(|shape| &shape.points).chain(walls.iter().flatten());
        let is_in_range = |point: &DVec3| point.as_vec3().is_finite();
        if !points.chain([&(bounds.centre + bounds.radius)]).all(is_in_range) {
            return Err(range_error());
        }
        let colours = job.replay.world.model().bodies.iter().enumerate().map(linear_colour);
        Ok(Self { shapes, shape_of_body, colours: colours.collect(), walls })
    }
}

/// The error for a coordinate that exceeds the range of single precision.
pub(super) fn range_error() -> ExportError {
    ExportError::Unsupported(
        "a position exceeds the range of single precision, which .glb and .usda use; export a .csv \
         instead"
            .to_owned(),
    )
}

impl ShapeGeometry {
    fn new(body: &BodyModel) -> Self {
        let surface = surface_of(body);
        let radius = surface.vertices.iter().fold(0.0f64, |radius, v| radius.max(v.length()));
        let normals = corner_normals(&surface.vertices, &surface.triangles, radius);
        // degenerate triangles have normals of length zero
        let has_area = |normals: &[Vec3; 3]| normals.iter().all(|n| n.length() > 0.5);
        let pairs = surface.triangles.iter().zip(normals);
        let (triangles, normals): (Vec<_>, Vec<_>) =
            pairs.filter(|(_, normals)| has_area(normals)).unzip();
        if triangles.is_empty() {
            let points = body.shape.particles().iter().collect();
            return Self { points, triangles, normals };
        }
        Self { points: surface.into_owned().vertices, triangles, normals }
    }
}

/// Linear RGB colour and opacity of a body, from 0 to 1, converted from sRGB (IEC 61966-2-1).
fn linear_colour((index, body): (usize, &Arc<BodyModel>)) -> [f32; 4] {
    let is_kinematic = is_kinematic(body);
    let srgb = if is_kinematic { KINEMATIC_COLOUR } else { body_colour(index) };
    let [r, g, b] = srgb.map(|byte| {
        let stored = byte / 255.0;
        if stored <= 0.04045 { stored / 12.92 } else { libm::powf((stored + 0.055) / 1.055, 2.4) }
    });
    [r, g, b, if is_kinematic { KINEMATIC_OPACITY } else { 1.0 }]
}

/// The rotation from the direction against gravity to `up`.
pub(super) fn upright_rotation(gravity: DVec3, up: DVec3) -> DQuat {
    match (-gravity).try_normalize() {
        Some(scene_up) if (scene_up - up).length() > 1e-9 => DQuat::from_rotation_arc(scene_up, up),
        _ => DQuat::IDENTITY,
    }
}

/// The orientations of a body, normalised, with signs chosen for interpolation.
///
/// q and −q are the same orientation. The sign nearer to the previous frame makes an interpolation
/// take the shorter rotation.
pub(super) fn continuous_orientations<'a>(
    frames: impl Iterator<Item = &'a ReplayFrame> + 'a,
    body: usize,
) -> impl Iterator<Item = DQuat> + 'a {
    let mut last = DQuat::IDENTITY;
    frames.map(move |frame| {
        let q = frame.poses[body].orientation.normalize();
        last = if q.dot(last) < 0.0 { -q } else { q };
        last
    })
}

/// A sphere that contains the motion (m).
struct Bounds {
    centre: DVec3,
    radius: f64,
}

impl Bounds {
    fn new(replay: &Replay, frames: &[ReplayFrame]) -> Self {
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for pose in frames.iter().flat_map(|frame| &frame.poses) {
            low = low.min(pose.position);
            high = high.max(pose.position);
        }
        let largest_body =
            replay.world.bodies().map(|body| body.model().bounding_radius()).fold(0.0, f64::max);
        let radius = 0.5 * (high - low).length() + 1.5 * largest_body;
        // a single particle at rest; its wall is still shown
        let radius = if radius > 0.0 { radius } else { 1.0 };
        Self { centre: 0.5 * (low + high), radius }
    }
}

/// Vertices of the closed faces of a box, or of a rectangle in a plane about as large as the motion.
fn rectangles(part: &Boundary, bounds: &Bounds) -> Vec<[DVec3; 4]> {
    match *part {
        Boundary::Box { min, max, orientation, open } => (0..6)
            .filter(|&face| !open[face])
            .map(|face| box_face(min, max, face))
            .map(|corners| corners.map(|corner| orientation * corner))
            .collect(),
        Boundary::Plane { normal, offset } => {
            let foot = bounds.centre - normal * (normal.dot(bounds.centre) - offset);
            let (u, v) = normal.any_orthonormal_pair();
            let (u, v) = (u * bounds.radius, v * bounds.radius);
            vec![[foot - u - v, foot + u - v, foot + u + v, foot - u + v]]
        }
    }
}

/// Vertices of one face of a box in the box axes, counter-clockwise seen from inside.
fn box_face(min: DVec3, max: DVec3, face: usize) -> [DVec3; 4] {
    let (axis, is_high) = (face / 2, face % 2 == 1);
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |a: bool, b: bool| {
        let mut corner = DVec3::ZERO;
        corner[axis] = if is_high { max[axis] } else { min[axis] };
        corner[u] = if a { max[u] } else { min[u] };
        corner[v] = if b { max[v] } else { min[v] };
        corner
    };
    let vertices =
        [corner(false, false), corner(true, false), corner(true, true), corner(false, true)];
    let [a, b, c, d] = vertices;
    if is_high { [a, d, c, b] } else { vertices }
}
