//! An estimate at the start: springs that the weight on them will press too deep.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::body_depth::round_up;
use crate::contact::deep_contact::LARGEST_DEPTH;
use crate::contact::{contact_kinds, contact_law, sphere_radius, tunnelling_limit};
use crate::{BodyModel, BodyState, ContactKind, Model, State};

/// With more bodies, what lies on what is not looked at: it would take time with the square of their number.
const MAX_BODIES: usize = 2000;
/// The number of bodies from which on a column bends rather than tilts as one.
const BENDING: f64 = 3.9;
/// Bodies closer than this stand on each other, in units of the size of the upper one.
const GAP: f64 = 0.05;
/// The second moment of an evenly loaded square over that of its corners.
const SPREAD: f64 = 1.0 / 3.0;

/// What springs that are too soft do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SoftSprings {
    /// They are pressed deeper than a limit (m).
    TooDeep {
        /// The limit (m).
        limit: f64,
    },
    /// A column of this many bodies leans and falls over.
    MayLean {
        /// The number of bodies.
        bodies: usize,
    },
}

/// Springs that are too soft for the weight on them.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticLoad {
    /// Name of the body.
    pub body: String,
    /// Name of the body that would carry it; `None` for a wall.
    pub support: Option<String>,
    /// Weight of the body and of all bodies above it (N).
    pub weight: f64,
    /// Their mass (kg).
    pub mass: f64,
    /// The depth at which the springs carry this weight (m).
    pub depth: f64,
    /// What they do.
    pub effect: SoftSprings,
    /// A stiffness at which the depth, or the weight, is half of what is too much (N/m).
    pub sufficient_stiffness: f64,
}

impl std::fmt::Display for StaticLoad {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { body, support, weight, mass, depth, effect, sufficient_stiffness } = self;
        let support = match support {
            Some(support) => format!("body \"{support}\""),
            None => "a wall".to_owned(),
        };
        write!(
            f,
            "the springs are too soft: the weight of body \"{body}\" and of what is above it, {weight:.1e} N ({mass:.3} kg), \
             would press it {depth:.2e} m into {support}, "
        )?;
        match effect {
            SoftSprings::TooDeep { limit } => write!(f, "and {limit:.2e} m is the most")?,
            SoftSprings::MayLean { bodies } => {
                write!(f, "and a column of {bodies} would lean on it and fall over")?;
            }
        }
        write!(f, "; use a `collision_stiffness` of {sufficient_stiffness:.0e} N/m or more")
    }
}

/// Free bodies whose weight, with that of the bodies above them, would press the springs of a wall or body below them too
/// deep: three quarters of the bounding radius for a wall, and of what they would have to pass through for a body. And columns
/// of bodies that would lean: springs that resist a tilt with c (N·m) carry the weight W of n bodies at a mean height h above
/// them if W h < c min(1, 3.9/n). For one body that is the balance of an inverted pendulum; for many, as in a column that
/// bends under its own weight, q H³ < 7.84 E I (A. G. Greenhill, Proc. Camb. Phil. Soc. 4 (1881) 65).
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
        let (mut column, below) = column(model, state, index, up);
        column.push(index);
        let mass: f64 = column.iter().map(|&i| model.bodies[i].mass).sum();
        let touched = touched(model, state, index, &below, up);
        let below = if touched.is_empty() { &below } else { &touched };
        let on_bodies = below.iter().filter_map(|&i| body_support(model, index, i, &mut patches));
        let on_bodies: Vec<_> = on_bodies.collect();
        let on_walls = if touched.is_empty() {
            wall_supports(model, index, up, &mut patches)
        } else {
            Vec::new()
        };
        // of several supports, the one that is pressed deepest relative to its limit
        let supports = on_walls.into_iter().chain(on_bodies);
        let pressed = supports.map(|support| (gravity * mass / support.stiffness, support));
        let share = |(depth, support): &(f64, Support)| depth / support.limit;
        let (depth, support) = pressed.max_by(|a, b| share(a).total_cmp(&share(b)))?;
        let standing = Standing::new(model, state, &column, index, up);
        let lean = standing.lean() * depth * standing.mass / (mass * support.spread);
        let too_deep = SoftSprings::TooDeep { limit: support.limit };
        let may_lean = SoftSprings::MayLean { bodies: standing.bodies };
        let effects = [(depth / support.limit, too_deep), (lean, may_lean)];
        let (excess, effect) = effects.into_iter().find(|(excess, _)| *excess > 1.0)?;
        Some(StaticLoad {
            body: model.names[index].clone(),
            support: support.body.map(|body| model.names[body].clone()),
            weight: gravity * mass,
            mass,
            depth,
            effect,
            sufficient_stiffness: round_up(2.0 * support.of_point * excess),
        })
    };
    let mut found: Vec<StaticLoad> = free.filter_map(load).collect();
    // of a column that leans, the body that carries most stands for all
    let leans = |load: &StaticLoad| matches!(load.effect, SoftSprings::MayLean { .. });
    let most = found.iter().filter(|load| leans(load)).map(|load| load.sufficient_stiffness);
    let most = most.fold(0.0, f64::max);
    let mut is_said = false;
    found.retain(|load| {
        let is_kept = !leans(load) || (load.sufficient_stiffness == most && !is_said);
        is_said |= leans(load) && is_kept;
        is_kept
    });
    found
}

/// The bodies of some below a body that are as high as its foot: it stands on them.
fn touched(model: &Model, state: &State, index: usize, below: &[usize], up: DVec3) -> Vec<usize> {
    let level = |index: usize| Level::new(&model.bodies[index], &state.bodies[index], up);
    if below.is_empty() {
        return Vec::new();
    }
    let (foot, gap) = (level(index).bottom, GAP * model.bodies[index].extent);
    below.iter().copied().filter(|&i| (level(i).top - foot).abs() < gap).collect()
}

/// A column of bodies that stand on each other.
struct Standing {
    bodies: usize,
    /// Mass (kg) and height of the centre of mass above the foot (m).
    mass: f64,
    height: f64,
    /// The smaller second moment of the foot, per particle (m²).
    second_moment: f64,
}

impl Standing {
    /// The bodies of a column that stand on body `foot` without gaps.
    fn new(model: &Model, state: &State, column: &[usize], foot: usize, up: DVec3) -> Self {
        let level = |index: usize| Level::new(&model.bodies[index], &state.bodies[index], up);
        let lowest = level(foot);
        let second_moment = lowest.second_moment(up);
        let (mut mass, mut moment, mut top) = (0.0, 0.0, lowest.bottom);
        let mut above: Vec<(f64, usize)> =
            column.iter().map(|&index| (state.bodies[index].position.dot(up), index)).collect();
        above.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut bodies = 0;
        for (height, index) in above {
            let next = level(index);
            if next.bottom > top + GAP * model.bodies[index].extent {
                break;
            }
            mass += model.bodies[index].mass;
            moment += model.bodies[index].mass * (height - lowest.bottom);
            top = top.max(next.top);
            bodies += 1;
        }
        Self { bodies, mass, height: moment / mass, second_moment }
    }

    /// W h/c max(1, n/3.9) over the depth at which the springs carry the weight W (1/m).
    fn lean(&self) -> f64 {
        // one body may stand on a point, and so may a column of spheres
        if self.bodies < 2 || self.second_moment <= 0.0 {
            return 0.0;
        }
        self.height * (self.bodies as f64 / BENDING).max(1.0) / self.second_moment
    }
}

/// The particles of a body, as high as they are.
struct Level {
    places: Vec<DVec3>,
    extent: f64,
    bottom: f64,
    top: f64,
}

impl Level {
    fn new(body: &BodyModel, state: &BodyState, up: DVec3) -> Self {
        let rotation = DMat3::from_quat(state.orientation);
        let particles = body.shape.particles().iter();
        let places: Vec<DVec3> = particles.map(|r| state.position + rotation * r).collect();
        let heights = || places.iter().map(|r| r.dot(up));
        let radius = sphere_radius(body);
        let bottom = heights().fold(f64::INFINITY, f64::min) - radius;
        let top = heights().fold(f64::NEG_INFINITY, f64::max) + radius;
        Self { extent: body.extent, bottom, top, places }
    }

    /// The smaller second moment of the lowest particles across the vertical, per particle (m²).
    fn second_moment(&self, up: DVec3) -> f64 {
        let lowest = self.places.iter().map(|r| r.dot(up)).fold(f64::INFINITY, f64::min);
        let thin = lowest + 0.1 * self.extent;
        let foot: Vec<DVec3> = self.places.iter().filter(|r| r.dot(up) < thin).copied().collect();
        let count = foot.len() as f64;
        let mean = foot.iter().sum::<DVec3>() / count;
        let across = up.any_orthonormal_pair();
        let moment = |a: DVec3, b: DVec3| {
            foot.iter().map(|r| (*r - mean).dot(a) * (*r - mean).dot(b)).sum::<f64>() / count
        };
        let [xx, xy, yy] =
            [(across.0, across.0), across, (across.1, across.1)].map(|(a, b)| moment(a, b));
        0.5 * (xx + yy) - (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt()
    }
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
    /// Second moment of the area that carries, in units of that of the particles around it.
    spread: f64,
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
        spread: 1.0,
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
    Some(Support { body: Some(other), of_point: of_point?, stiffness, limit, spread: SPREAD })
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
    use crate::{
        Body, DMat3, MassModel, Mesh, Primitive, Sampling, Shape, Surface, WallPlane, World,
    };

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
        let SoftSprings::TooDeep { limit } = lower.effect else { panic!("{lower:?}") };
        assert!((limit - 0.075).abs() < 1e-8, "{lower:?}");
        assert_eq!(lower.sufficient_stiffness, 3e4);
        assert!(lower.to_string().contains("of 3e4 N/m or more"), "{lower}");
        // beside each other they rest on the floor
        let beside = |mass: f64| ball(mass, 0.1).position(DVec3::new(0.5, 0.1, 0.0));
        assert_eq!(loads(vec![ball(1.0, 0.1), beside(70.0)]), []);
        assert_eq!(loads(vec![ball(1.0, 0.1), beside(80.0)])[0].body, "body 1");
    }

    /// Cubes of 0.2 m and 1 kg on springs of 1e4 N/m: ten stand, fifteen lean and fall over.
    #[test]
    fn a_high_column_on_soft_springs_leans() {
        let cube = Primitive::Box { size: DVec3::splat(0.2), divisions: 1 }.mesh().unwrap();
        let shape = Shape::from_mesh(&cube, Sampling::Vertices, MassModel::Solid).unwrap();
        let shape = std::sync::Arc::new(shape);
        let stack = |count: u32| {
            let height = |i: u32| DVec3::Y * (0.1 + 0.2 * f64::from(i));
            let body = |i| Body::new(shape.clone()).mass(1.0).position(height(i));
            loads((0..count).map(|i| body(i).surface(Surface::Mesh)).collect())
        };
        assert_eq!(stack(10), []);
        let found = stack(15);
        let [load] = &found[..] else { panic!("{found:?}") };
        assert_eq!(load.effect, SoftSprings::MayLean { bodies: 14 });
        assert_eq!((load.body.as_str(), load.support.as_deref()), ("body 1", Some("body 0")));
        assert!(load.to_string().contains("a column of 14 would lean"), "{load}");
    }
}
