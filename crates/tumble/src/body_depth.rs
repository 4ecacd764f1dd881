//! Bodies deep in each other: what was found, and what would help.

use crate::contact::deep_contact::{DeepContact, WARNING_DEPTH};
use crate::{Model, State, critical_dt};

/// Masses more different than this are worth mentioning.
const LARGE_MASS_RATIO: f64 = 100.0;
/// The time step that is suggested, as a part of the critical one.
const SAFE_DT: f64 = 0.2;

/// Two bodies that are or were deep in each other.
///
/// The limit is three quarters of what one body would have to pass through to come out on the other side, or less for bodies so
/// fast that they could pass the rest in a step. That is half of the thickness of the mesh at a particle in it, plus the radius
/// of a sphere; of two spheres the sum of their radii.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyDepth {
    /// Name of one body.
    pub first: String,
    /// Name of the other body.
    pub second: String,
    /// Time (s).
    pub time: f64,
    /// Depth of the deepest contact (m).
    pub depth: f64,
    /// The depth above which a step is refused (m).
    pub limit: f64,
    /// Force of the springs between the bodies (N).
    pub load: f64,
    /// Stiffness of the contact law (N/m).
    pub stiffness: f64,
    /// An estimate of the stiffness that keeps the depth below half of the limit (N/m).
    pub sufficient_stiffness: f64,
    /// A time step (s) for that stiffness, if the present one is too large for it.
    pub dt: Option<f64>,
    /// The larger mass over the smaller one, if both bodies are free and their masses are very different.
    pub mass_ratio: Option<f64>,
    /// Whether the motion of one of them is prescribed.
    pub is_driven: bool,
}

impl BodyDepth {
    pub(crate) fn new(model: &Model, state: &State, deep: &DeepContact) -> Self {
        let bodies = [deep.first, deep.second].map(|index| &model.bodies[index as usize]);
        let name = |index: u32| model.names[index as usize].clone();
        let factor = stiffness_factor(model, state, deep);
        let dt = critical_dt(model).map(|critical| critical.dt / factor.sqrt());
        let is_driven = bodies.iter().any(|body| !body.is_free());
        let [a, b] = bodies.map(|body| body.mass);
        let mass_ratio = (a / b).max(b / a);
        Self {
            first: name(deep.first),
            second: name(deep.second),
            time: deep.time,
            depth: deep.depth,
            limit: deep.limit,
            load: deep.load,
            stiffness: deep.stiffness,
            sufficient_stiffness: round_up(factor * deep.stiffness),
            dt: dt.filter(|dt| model.dt > 0.5 * dt).map(|dt| SAFE_DT * dt),
            mass_ratio: Some(mass_ratio).filter(|&ratio| !is_driven && ratio > LARGE_MASS_RATIO),
            is_driven,
        }
    }

    /// What would help.
    fn remedy(&self) -> String {
        let Self { stiffness, sufficient_stiffness, dt, mass_ratio, is_driven, .. } = self;
        let mut remedy = format!(
            "try a `collision_stiffness` {:.0} times as large, {sufficient_stiffness:.0e} N/m instead of {stiffness:.0e} N/m",
            sufficient_stiffness / stiffness
        );
        if let Some(dt) = dt {
            remedy += &format!(", with dt={dt:.0e}");
        }
        if let Some(ratio) = mass_ratio {
            remedy += &format!(", or masses closer to each other than {ratio:.0} : 1");
        }
        if *is_driven {
            remedy += "; where a prescribed motion leaves no room for the other body, no stiffness is enough";
        }
        remedy
    }

    /// The warning about bodies that did not pass through each other, but nearly or with thin parts.
    pub fn warning(&self) -> String {
        let Self { first, second, time, depth, limit, .. } = self;
        let what = if depth > limit { "thin parts of them" } else { "they" };
        format!(
            "bodies \"{first}\" and \"{second}\" were {depth:.2e} m in each other at t = {time} s, and from {limit:.2e} m on {what} \
             may pass through each other: {}",
            self.remedy()
        )
    }
}

impl std::fmt::Display for BodyDepth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { first, second, depth, limit, load, .. } = self;
        write!(
            f,
            "bodies \"{first}\" and \"{second}\" are {depth:.2e} m in each other under a load of {load:.1e} N, and from {limit:.2e} m \
             on they may pass through each other; {}",
            self.remedy()
        )
    }
}

/// By how much the stiffness must be multiplied for a depth below half of the limit; an estimate.
///
/// The springs have to take up the energy of approach and what they hold already, and carry the weight of the upper body:
/// k' δ² / 2 = m u² / 2 + F δ₀ / 2 + W δ, with m the reduced mass, u the speed of approach, and δ₀, F the depth and load now.
fn stiffness_factor(model: &Model, state: &State, deep: &DeepContact) -> f64 {
    let index = [deep.first as usize, deep.second as usize];
    let [a, b] = index.map(|index| &state.bodies[index]);
    let inverse_mass: f64 =
        index.iter().map(|&index| model.bodies[index].pair_material.inverse_mass).sum();
    let approach = (b.velocity - a.velocity).dot(deep.normal).max(0.0);
    let upper =
        if (a.position - b.position).dot(model.gravity) < 0.0 { index[0] } else { index[1] };
    let upper = &model.bodies[upper];
    let weight =
        if upper.is_free() { upper.mass * model.gravity.dot(deep.normal).abs() } else { 0.0 };
    let allowed = WARNING_DEPTH * deep.passage;
    let energy = 0.5 * (approach * approach / inverse_mass + deep.load * deep.depth);
    let needed = 2.0 * (energy + weight * allowed) / (allowed * allowed);
    needed * deep.depth / deep.load
}

/// The next larger number with one significant digit.
pub(crate) fn round_up(value: f64) -> f64 {
    let unit = libm::pow(10.0, libm::log10(value).floor());
    if unit.is_finite() && unit > 0.0 { (value / unit).ceil() * unit } else { value }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use crate::{
        Body, DMat3, DVec3, MassModel, Material, Mesh, Motion, Prescribed, Primitive, Sampling,
        Shape, Surface, WallPlane, World, WorldBuilder,
    };

    const RADIUS: f64 = 0.1;

    fn ball(height: f64, speed: f64) -> Body {
        let inertia = DMat3::IDENTITY * (0.4 * RADIUS * RADIUS);
        let shape = Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, inertia);
        let surface = Surface::Spheres { radius: RADIUS };
        let body = Body::new(shape.unwrap()).name("ball").mass(1.0).surface(surface);
        body.position(DVec3::Y * height).velocity(DVec3::Y * speed)
    }

    /// A plate of 0.1 m that does not turn and is not moved by forces.
    fn plate(height: f64, speed: f64) -> Body {
        let shape = Primitive::Box { size: DVec3::new(1.0, 0.1, 1.0), divisions: 2 };
        let shape =
            Shape::from_mesh(&shape.mesh().unwrap(), Sampling::Vertices, MassModel::Solid).unwrap();
        let body = Body::new(shape).name("plate").mass(1.0).surface(Surface::Mesh);
        let motion = Motion::Prescribed(Prescribed::default());
        body.position(DVec3::Y * height).velocity(DVec3::Y * speed).motion(motion)
    }

    fn world(stiffness: f64, dt: f64) -> WorldBuilder {
        let material = Material { collision_stiffness: stiffness, ..Material::default() };
        World::builder().dt(dt).gravity(DVec3::ZERO).material(material).force(true)
    }

    #[test]
    fn a_ball_that_is_squeezed_is_an_error_with_names_and_numbers() {
        let floor = WallPlane { normal: DVec3::Y, offset: 0.0 };
        for (is_plate, driven) in [
            (true, plate(0.3, -0.5)),
            (
                false,
                ball(0.31, -0.5).name("plate").motion(Motion::Prescribed(Prescribed::default())),
            ),
        ] {
            // half of the plate and the ball's radius; both radii
            let passage = if is_plate { 0.15 } else { 0.2 };
            let squeezed = world(1e4, 1e-4).wall(floor).body(driven).body(ball(0.1, 0.0));
            let mut world = squeezed.build().unwrap();
            let error = (0..20_000).find_map(|_| world.step().err()).unwrap();
            let found = error.body_depth.as_ref().unwrap();
            assert_eq!((error.body.as_str(), error.other.as_deref()), ("plate", Some("ball")));
            assert!(found.depth > 0.74 * passage && found.depth < 0.76 * passage, "{found:?}");
            assert!((found.limit - 0.75 * passage).abs() < 1e-3 * passage, "{found:?}");
            assert!((found.load - 1e4 * found.depth).abs() < 1e-9 * found.load, "{found:?}");
            let text = error.to_string();
            assert!(text.contains("no stiffness is enough"), "{text}");
            assert!(text.contains("`collision_stiffness` 5 times as large, 5e4 N/m"), "{text}");
        }
    }

    /// With the suggested stiffness the ball is stopped before half of the limit.
    #[test]
    fn the_suggested_stiffness_suffices() {
        let run = |stiffness: f64| {
            let mut world = world(stiffness, 1e-5)
                .body(plate(0.0, 0.0))
                .body(ball(0.16, -8.0))
                .build()
                .unwrap();
            let error = (0..5000).find_map(|_| world.step().err());
            (error.map(|error| *error.body_depth.unwrap()), world)
        };
        // m v² / k: a depth of 0.25 m, more than the limit of 0.1125 m
        let found = run(1e3).0.unwrap();
        let (error, world) = run(found.sufficient_stiffness);
        assert_eq!(error, None);
        let deepest = world.state().totals.max_depth;
        assert!(deepest < 0.5 * found.limit && deepest > 0.2 * found.limit, "{deepest}");
        assert_eq!(world.deepest_body_contact(), None);
        // somewhat softer, it is a reason for a warning
        let (error, world) = run(0.5 * found.sufficient_stiffness);
        assert_eq!(error, None);
        let warned = world.deepest_body_contact().unwrap();
        assert!((warned.depth - world.state().totals.max_depth).abs() < 1e-12);
        assert!(warned.warning().starts_with("bodies \"plate\" and \"ball\" were"), "{warned:?}");
    }

    /// A ball goes through the blade of a paddle, which is thin next to its block.
    #[test]
    fn thin_parts_that_are_passed_are_a_warning() {
        let block = Primitive::Box { size: DVec3::splat(1.0), divisions: 4 }.mesh().unwrap();
        let blade =
            Primitive::Box { size: DVec3::new(0.6, 0.02, 0.6), divisions: 1 }.mesh().unwrap();
        let mut both = block.clone();
        let first = block.vertices.len() as u32;
        both.vertices.extend(blade.vertices.iter().map(|&v| v + DVec3::X * 2.0));
        both.triangles.extend(blade.triangles.iter().map(|t| t.map(|i| i + first)));
        let shape = Shape::from_mesh(&both, Sampling::Vertices, MassModel::Solid).unwrap();
        let centre = shape.centre();
        let paddle = Body::new(shape).surface(Surface::Mesh).position(centre);
        let paddle = paddle.motion(Motion::Prescribed(Prescribed::default()));
        let point = Shape::from_distribution(
            &[DVec3::ZERO],
            Mesh::default(),
            DVec3::ZERO,
            DMat3::IDENTITY * 1e-4,
        );
        let radius = 0.01;
        let ball = Body::new(point.unwrap()).mass(1.0).surface(Surface::Spheres { radius });
        let ball = ball.position(DVec3::new(2.0, 0.05, 0.0)).velocity(DVec3::Y * -1.0);
        let mut world = world(100.0, 1e-4).body(paddle).body(ball).build().unwrap();
        (0..2000).for_each(|_| world.step().unwrap());
        assert!(world.body(1).position().y < -0.05);
        let found = world.deepest_body_contact().unwrap();
        assert!(found.depth > found.limit, "{found:?}");
        assert!(found.warning().contains("thin parts of them may pass"), "{found:?}");
    }

    /// At any speed and time step, a ball comes back or the run ends with an error.
    #[test]
    fn nothing_passes_through_a_plate_in_silence() {
        let (mut refused, mut returned) = (0, 0);
        for step in [1e-3, 1e-2, 0.05, 0.2, 0.4, 0.7, 0.99] {
            for i in 0..40 {
                // displacement in a step in units of the passage, 0.15 m, and depth if nothing else were there
                let (dt, depth) = (1e-3, 0.15 * (0.3 + 0.05 * f64::from(i)));
                let speed = 0.15 * step / dt;
                let stiffness = (speed / depth).powi(2);
                let start = 0.151 + 0.003 * f64::from(i);
                let thrown = world(stiffness, dt).body(plate(0.0, 0.0)).body(ball(start, -speed));
                let mut world = thrown.build().unwrap();
                let time = 2.0 * (start + 4.0 * depth) / speed;
                let error = (0..(time / dt) as u32 + 20).find_map(|_| world.step().err());
                let height = world.body(1).position().y;
                assert!(error.is_some() || height > 0.1, "{step} {depth} {height}");
                refused += u32::from(error.is_some());
                returned += u32::from(error.is_none());
            }
        }
        assert!(refused > 50 && returned > 50, "{refused} {returned}");
    }
}
