//! What glTF and USD share: meshes with normals, walls, colours, which way is up.

use std::sync::Arc;

use glam::Vec3;
use tumble::{BodyModel, DQuat, DVec3};

use super::{ExportError, Job};
use crate::appearance::{KINEMATIC_COLOUR, is_kinematic, surface_of};
use crate::picture::{Boundary, body_colour, corner_normals};
use crate::replay::{Replay, ReplayFrame};
use crate::run::boundary;

/// All that does not move by itself.
pub(super) struct Stage {
    /// The shapes, each once.
    pub forms: Vec<Form>,
    /// Which of the shapes each body has.
    pub form_of: Vec<usize>,
    /// The colour of each body as light, and how much it hides of what is behind it, from 0 to 1.
    pub colours: Vec<[f32; 4]>,
    /// The corners (m) of finite pieces of all walls, counter-clockwise seen from the free side.
    pub walls: Vec<[DVec3; 4]>,
}

/// A shape, in the body frame (m).
pub(super) struct Form {
    /// Vertices of the surface, or bare particles.
    pub points: Vec<DVec3>,
    /// Triangles with an area; none for bare particles.
    pub triangles: Vec<[u32; 3]>,
    /// The normal at each corner of each triangle: smooth, but sharp across creases.
    pub normals: Vec<[Vec3; 3]>,
}

impl Stage {
    /// # Errors
    /// [`ExportError::Unfit`] where single precision cannot hold a place.
    pub fn new(job: &Job) -> Result<Self, ExportError> {
        let mut shown: Vec<&BodyModel> = Vec::new();
        let models = job.replay.world.model().bodies.iter();
        let form_of = models.map(|own| {
            let is_same = |body: &&BodyModel| Arc::ptr_eq(&body.shape, &own.shape);
            shown.iter().position(is_same).unwrap_or_else(|| {
                shown.push(own);
                shown.len() - 1
            })
        });
        let form_of = form_of.collect();
        let forms: Vec<Form> = shown.iter().map(|body| Form::new(body)).collect();
        let bounds = Bounds::of(job.replay, job.chosen.span);
        let walls = boundary(&job.replay.scene);
        let walls: Vec<[DVec3; 4]> = walls.iter().flat_map(|part| pieces(part, &bounds)).collect();
        let points = forms.iter().flat_map(|form| &form.points).chain(walls.iter().flatten());
        let is_held = |point: &DVec3| point.as_vec3().is_finite();
        if !points.chain([&(bounds.centre + bounds.radius)]).all(is_held) {
            return Err(too_far());
        }
        let colours = job.replay.world.model().bodies.iter().enumerate().map(linear_colour);
        Ok(Self { forms, form_of, colours: colours.collect(), walls })
    }
}

/// What single precision cannot hold.
pub(super) fn too_far() -> ExportError {
    ExportError::Unfit(
        "a place is too far away for the single precision of .glb and .usda; .csv can hold it"
            .to_owned(),
    )
}

impl Form {
    fn new(body: &BodyModel) -> Self {
        let surface = surface_of(body);
        let farthest = surface.vertices.iter().fold(0.0f64, |far, v| far.max(v.length()));
        let normals = corner_normals(&surface.vertices, &surface.triangles, farthest);
        let with_area = |normals: &[Vec3; 3]| normals.iter().all(|n| n.length() > 0.5);
        let pairs = surface.triangles.iter().zip(normals);
        let (triangles, normals): (Vec<_>, Vec<_>) =
            pairs.filter(|(_, normals)| with_area(normals)).unzip();
        if triangles.is_empty() {
            let points = body.shape.particles().iter().collect();
            return Self { points, triangles, normals };
        }
        Self { points: surface.into_owned().vertices, triangles, normals }
    }
}

/// The colour of a body as light, not as it is stored in pictures: red, green, blue and opacity from 0 to 1.
fn linear_colour((index, body): (usize, &Arc<BodyModel>)) -> [f32; 4] {
    let is_kinematic = is_kinematic(body);
    let stored = if is_kinematic { KINEMATIC_COLOUR } else { body_colour(index) };
    let [r, g, b] = stored.map(|byte| {
        let stored = byte / 255.0;
        if stored <= 0.04045 { stored / 12.92 } else { libm::powf((stored + 0.055) / 1.055, 2.4) }
    });
    // what stands around the others must not hide them
    [r, g, b, if is_kinematic { 0.35 } else { 1.0 }]
}

/// Turns the direction against gravity to `up`.
pub(super) fn upright(gravity: DVec3, up: DVec3) -> DQuat {
    match (-gravity).try_normalize() {
        Some(own) if (own - up).length() > 1e-9 => DQuat::from_rotation_arc(own, up),
        _ => DQuat::IDENTITY,
    }
}

/// Each orientation as the one of its two quaternions that is nearer to the one before, with
/// length one, so that what lies between two frames is the shorter way.
pub(super) fn steady<'a>(
    frames: impl Iterator<Item = &'a ReplayFrame> + 'a,
    body: usize,
) -> impl Iterator<Item = DQuat> + 'a {
    let mut last = DQuat::IDENTITY;
    frames.map(move |frame| {
        let own = frame.poses[body].orientation.normalize();
        last = if own.dot(last) < 0.0 { -own } else { own };
        last
    })
}

/// Where the motion takes place.
struct Bounds {
    centre: DVec3,
    radius: f64,
}

impl Bounds {
    fn of(replay: &Replay, frames: &[ReplayFrame]) -> Self {
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for pose in frames.iter().flat_map(|frame| &frame.poses) {
            low = low.min(pose.position);
            high = high.max(pose.position);
        }
        let largest =
            replay.world.bodies().map(|body| body.model().bounding_radius()).fold(0.0, f64::max);
        let radius = 0.5 * (high - low).length() + 1.5 * largest;
        // a lone particle at rest still lies on something
        let radius = if radius > 0.0 { radius } else { 1.0 };
        Self { centre: 0.5 * (low + high), radius }
    }
}

/// The corners of the faces of a box, or of a piece of a plane as large as the motion.
fn pieces(part: &Boundary, bounds: &Bounds) -> Vec<[DVec3; 4]> {
    match *part {
        Boundary::Box { min, max, orientation, open } => (0..6)
            .filter(|&face| !open[face])
            .map(|face| face_of(min, max, face))
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

/// One face of a box in its own axes, counter-clockwise seen from inside.
fn face_of(min: DVec3, max: DVec3, face: usize) -> [DVec3; 4] {
    let (axis, is_high) = (face / 2, face % 2 == 1);
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |a: bool, b: bool| {
        let mut corner = DVec3::ZERO;
        corner[axis] = if is_high { max[axis] } else { min[axis] };
        corner[u] = if a { max[u] } else { min[u] };
        corner[v] = if b { max[v] } else { min[v] };
        corner
    };
    let round =
        [corner(false, false), corner(true, false), corner(true, true), corner(false, true)];
    let [a, b, c, d] = round;
    if is_high { [a, d, c, b] } else { round }
}
