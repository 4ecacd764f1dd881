//! An estimate at the start: springs that the weight on them will press too deep.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use crate::body_depth::round_up;
use crate::contact::deep_contact::LARGEST_DEPTH;
use crate::contact::{contact_kinds, contact_law, sphere_radius, tunnelling_limit};
use crate::{BodyModel, ContactKind, Model, State};

/// With more bodies, what lies on what is not looked at: it would take time with the square of their number.
const MAX_BODIES: usize = 2000;

/// Springs that are too soft for the weight on them.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticLoad {
    /// Name of the body.
    pub body: String,
    /// Name of the body that would carry it; `None` for a wall.
    pub support: Option<String>,
    /// Weight of the body and of all bodies above it (N).
    pub weight: f64,
    /// The depth at which the springs carry this weight (m).
    pub depth: f64,
    /// The largest depth that is tolerable (m).
    pub limit: f64,
    /// A stiffness at which the depth is half of that (N/m).
    pub sufficient_stiffness: f64,
}

impl std::fmt::Display for StaticLoad {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { body, support, weight, depth, limit, sufficient_stiffness } = self;
        let support = match support {
            Some(support) => format!("body \"{support}\""),
            None => "a wall".to_owned(),
        };
        write!(
            f,
            "the springs are too soft: the weight of body \"{body}\" and of what is above it, {weight:.1e} N, would press it \
             {depth:.2e} m into {support}, and {limit:.2e} m is the most; use a `collision_stiffness` of \
             {sufficient_stiffness:.0e} N/m or more"
        )
    }
}

/// Free bodies whose weight, with that of the bodies above them, would press the springs of a wall or body below them too
/// deep: three quarters of the bounding radius for a wall, and of what they would have to pass through for a body.
///
/// The estimate is a low one: as many particles share the load as lie in the largest face across the principal axes.
pub fn static_loads(model: &Model, state: &State) -> Vec<StaticLoad> {
    let gravity = model.gravity.length();
    if gravity == 0.0 || model.bodies.len() > MAX_BODIES {
        return Vec::new();
    }
    let up = model.gravity / -gravity;
    let mut patches = Patches::default();
    let free = (0..model.bodies.len()).filter(|&index| model.bodies[index].is_free());
    let load = |index: usize| {
        let (above, below) = column(model, state, index, up);
        let mass: f64 = above.iter().chain([&index]).map(|&i| model.bodies[i].mass).sum();
        let supports = wall_supports(model, index, up, &mut patches).into_iter().chain(
            below.iter().filter_map(|&other| body_support(model, index, other, &mut patches)),
        );
        // of several supports, the one that is pressed deepest relative to its limit
        let pressed = supports.map(|support| (gravity * mass / support.stiffness, support));
        let pressed = pressed.filter(|(depth, support)| *depth > support.limit);
        let share = |(depth, support): &(f64, Support)| depth / support.limit;
        let (depth, support) = pressed.max_by(|a, b| share(a).total_cmp(&share(b)))?;
        Some(StaticLoad {
            body: model.names[index].clone(),
            support: support.body.map(|body| model.names[body].clone()),
            weight: gravity * mass,
            depth,
            limit: support.limit,
            sufficient_stiffness: round_up(2.0 * support.of_point * depth / support.limit),
        })
    };
    free.filter_map(load).collect()
}

/// What could carry a body.
struct Support {
    /// Index of the body; `None` for a wall.
    body: Option<usize>,
    /// Stiffness of the contact law, and that of all points that may share the load (N/m).
    of_point: f64,
    stiffness: f64,
    /// The largest depth that is tolerable (m).
    limit: f64,
}

/// The walls that face upwards.
fn wall_supports(model: &Model, index: usize, up: DVec3, patches: &mut Patches) -> Vec<Support> {
    let body = &model.bodies[index];
    let walls = model.walls.iter().zip(&body.contacts);
    let support = |of_point: f64, points: f64| Support {
        body: None,
        of_point,
        stiffness: of_point * points,
        limit: LARGEST_DEPTH * body.extent,
    };
    let facing = walls.filter(|(wall, _)| wall.normal.dot(up) > 0.5);
    facing.map(|(_, law)| support(law.stiffness, patches.largest(body))).collect()
}

/// The body `other` below the body `index`. All kinds of contact between them share the load.
fn body_support(
    model: &Model,
    index: usize,
    other: usize,
    patches: &mut Patches,
) -> Option<Support> {
    let (a, b) = (&model.bodies[index], &model.bodies[other]);
    let (mut stiffness, mut limit, mut of_point) = (0.0, 0.0f64, None);
    for &kind in contact_kinds(a, b) {
        let points = match kind {
            ContactKind::MeshPoint => patches.largest(b),
            ContactKind::PointMesh => patches.largest(a),
            ContactKind::SphereSphere | ContactKind::SphereWall => {
                patches.largest(a).min(patches.largest(b))
            }
        };
        let law = contact_law(a, b, kind);
        stiffness += points * law.stiffness;
        limit = limit.max(LARGEST_DEPTH * tunnelling_limit(a, b, kind));
        of_point = of_point.or(Some(law.stiffness));
    }
    Some(Support { body: Some(other), of_point: of_point?, stiffness, limit })
}

/// The largest patches of bodies, computed once for identical bodies.
#[derive(Default)]
struct Patches(BTreeMap<*const BodyModel, f64>);

impl Patches {
    fn largest(&mut self, body: &Arc<BodyModel>) -> f64 {
        *self.0.entry(Arc::as_ptr(body)).or_insert_with(|| largest_patch(body))
    }
}

/// The free bodies above a body, and those below it that could carry it: their centres are in the column of its extent.
fn column(model: &Model, state: &State, index: usize, up: DVec3) -> (Vec<usize>, Vec<usize>) {
    let (own, body) = (state.bodies[index].position, &model.bodies[index]);
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for (other, (other_body, other_state)) in model.bodies.iter().zip(&state.bodies).enumerate() {
        let offset = other_state.position - own;
        let height = offset.dot(up);
        let can_touch = !contact_kinds(body, other_body).is_empty();
        if other == index || !can_touch || (offset - up * height).length() > body.extent {
            continue;
        }
        if height > 0.0 && other_body.is_free() {
            above.push(other);
        } else if height < 0.0 {
            below.push(other);
        }
    }
    (above, below)
}

/// The number of particles, with their weights, in the largest face of a body across its principal axes.
fn largest_patch(body: &BodyModel) -> f64 {
    let (particles, axes) = (body.shape.particles(), body.shape.principal().axes);
    let thin = 0.1 * (body.extent - sphere_radius(body)) + 1e-9 * body.extent;
    let directions = [axes.x_axis, axes.y_axis, axes.z_axis];
    let faces = directions.into_iter().flat_map(|axis| [axis, -axis]);
    let count = |outward: DVec3| {
        let height = |r: DVec3| r.dot(outward);
        let top = particles.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
        let in_face = particles.iter().enumerate().filter(|(_, r)| height(*r) > top - thin);
        in_face.map(|(index, _)| particles.weight(index)).sum::<f64>()
    };
    faces.map(count).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::{Body, DMat3, Mesh, Shape, Surface, WallPlane, World};

    const RADIUS: f64 = 0.1;

    fn ball(mass: f64, height: f64) -> Body {
        let inertia = DMat3::IDENTITY * (0.4 * RADIUS * RADIUS);
        let shape = Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, inertia);
        let surface = Surface::Spheres { radius: RADIUS };
        Body::new(shape.unwrap()).mass(mass).surface(surface).position(DVec3::Y * height)
    }

    fn loads(bodies: Vec<Body>) -> Vec<StaticLoad> {
        let floor = WallPlane { normal: DVec3::Y, offset: 0.0 };
        let world = World::builder().dt(1e-4).gravity(DVec3::Y * -10.0).wall(floor);
        let world = bodies.into_iter().fold(world, |world, body| world.body(body));
        let world = world.build().unwrap();
        static_loads(world.model(), world.state())
    }

    /// One ball of 1 kg on springs of 1e4 N/m sinks 1 mm. With 100 kg above it the floor gives way by 101 mm of 75 mm,
    /// and the ball between them by 100 mm of 150 mm.
    #[test]
    fn the_weight_of_a_column_is_compared_with_its_springs() {
        assert_eq!(loads(vec![ball(1.0, 0.1)]), []);
        let found = loads(vec![ball(1.0, 0.1), ball(100.0, 0.3)]);
        let lower = &found[0];
        assert_eq!((lower.body.as_str(), &lower.support), ("body 0", &None));
        assert!((lower.depth - 0.101).abs() < 1e-12, "{lower:?}");
        assert!((lower.limit - 0.075).abs() < 1e-8, "{lower:?}");
        assert_eq!(lower.sufficient_stiffness, 3e4);
        assert!(lower.to_string().contains("of 3e4 N/m or more"), "{lower}");
        // beside each other they rest on the floor
        let beside = |mass: f64| ball(mass, 0.1).position(DVec3::new(0.5, 0.1, 0.0));
        assert_eq!(loads(vec![ball(1.0, 0.1), beside(70.0)]), []);
        assert_eq!(loads(vec![ball(1.0, 0.1), beside(80.0)])[0].body, "body 1");
    }
}
