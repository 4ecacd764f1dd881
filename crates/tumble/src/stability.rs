//! The largest stable time step.

use glam::{DMat3, DVec3};

use crate::shape::diagonalise;
use crate::{BodyModel, ContactLaw, Model, Surface, WallPlane};

/// The largest stable time step, and the body that determines it.
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalStep {
    /// The step h (s) above which contact is unstable.
    pub dt: f64,
    /// The name of the body with the stiffest contact for its mass.
    pub body: String,
}

/// Half the effective number of neighbours of a sphere in a close packing: when neighbours move in opposite
/// directions, ω² = 8 k/M.
const CLOSE_PACKING: f64 = 4.0;

/// The largest time step for which contact is stable; `None` if no contact is possible.
///
/// A particle of mass m on a spring k oscillates at ω = √(k/m), and is unstable for steps above 2/ω. With a
/// dashpot of damping ratio ζ the limit is (2/ω)(√(1 + ζ²) − ζ). However many particles of a body are in
/// contact, the ratio of stiffness to mass is at most that of one particle, and so is the ratio of rotational
/// stiffness to inertia. If the mass is distributed otherwise, the largest ratio over all motions replaces 1/m.
/// The same holds for particles with area weights: the ratio for translation is k/m of the mean particle, that
/// for rotation may be larger.
///
/// Friction acts on the rotation of spheres: for N spheres of radius r its springs and dashpots contribute
/// N r²/I in addition to N/M, with I the smallest moment. Contact between bodies is estimated for two identical
/// bodies with all particles in contact, and for spheres with at least the neighbours of a close packing. The
/// contributions of walls that meet in a corner add up; of two opposite walls the stiffer counts. Dashpots from a restitution depend on
/// the particles in contact; the largest damping rate that any set of them can have counts.
pub fn critical_dt(model: &Model) -> Option<CriticalStep> {
    let free = model.bodies.iter().zip(&model.names).filter(|(body, _)| body.is_free());
    let steps = free.map(|(body, name)| (critical_dt_of(model, body), name));
    let (dt, name) = steps.min_by(|a, b| a.0.total_cmp(&b.0))?;
    dt.is_finite().then(|| CriticalStep { dt, body: name.clone() })
}

fn critical_dt_of(model: &Model, body: &BodyModel) -> f64 {
    let per_mass = match (body.shape.fastest_contact(), &body.drag_modes) {
        (Some(fastest), _) => fastest / body.mass,
        (None, Some(modes)) => modes.fastest(),
        (None, None) => 1.0 / body.particle_mass(),
    };
    let (lever, neighbours) = match body.surface {
        Surface::Spheres { radius } => {
            let count = body.shape.moments().count;
            let rotational = count * radius * radius * body.inverse_moments.max_element();
            (1.0 + rotational / per_mass, (CLOSE_PACKING / count).max(1.0))
        }
        _ => (1.0, 1.0),
    };
    let springs = |law: &ContactLaw| {
        let tangential = if law.friction > 0.0 { law.friction_spring } else { 0.0 };
        [law.stiffness, lever * tangential]
    };
    let reach = Reach::new(body, per_mass, lever);
    // `share`: 1 at a wall, ½ for the reduced mass of two identical bodies
    let dashpots = |law: &ContactLaw, share: f64| {
        let [normal, tangential] = reach.dashpots(law, share);
        [normal, if law.friction > 0.0 { lever * tangential } else { 0.0 }]
    };
    let at_walls = |terms: &dyn Fn(&ContactLaw) -> [f64; 2]| {
        per_mass * stiffest(&model.walls, &body.contacts, terms)
    };
    // two identical bodies with all particles in contact
    let law = body.pair_material.law(&body.pair_material);
    let meets = if model.has_body_contact { 2.0 * per_mass * neighbours } else { 0.0 };
    let between = |[normal, tangential]: [f64; 2]| meets * normal.max(tangential);
    let square = at_walls(&springs).max(between(springs(&law)));
    let half_rate = 0.5 * at_walls(&|law| dashpots(law, 1.0)).max(between(dashpots(&law, 0.5)));
    // (2/ω)(√(1 + ζ²) − ζ), without cancellation and valid for ω = 0
    2.0 / ((square + half_rate * half_rate).sqrt() + half_rate)
}

/// How much more easily the particles of a body move than its centre of mass.
struct Reach {
    /// k/ω² of all particles (kg), for translation and rotation together, and for friction.
    masses: [f64; 2],
    /// M g, with g the largest acceleration of a particle by a unit force on it (1/kg), normal and tangential.
    mobility: [f64; 2],
}

impl Reach {
    fn new(body: &BodyModel, per_mass: f64, lever: f64) -> Self {
        let turning = if body.shape.is_single_particle() { 0.0 } else { largest_turning(body) };
        let normal = 1.0 + body.mass * turning;
        let tangential = match body.surface {
            Surface::Spheres { .. } => {
                1.0 + body.mass * body.extent * body.extent * body.inverse_moments.max_element()
            }
            _ => normal,
        };
        Self { masses: [1.0 / per_mass, 1.0 / (per_mass * lever)], mobility: [normal, tangential] }
    }

    /// Dashpots of a particle (N·s/m), normal and tangential, that damp all motions at least as much as those of any patch do.
    ///
    /// A patch of stiffness K and effective mass m ≤ M has c = k τ, τ ≤ 2 ζ √(M/K). The squared frequency of its fastest motion is at
    /// most K g, and at most k/m₁, with m₁ the mass in `masses`. The damping rate τ ω² is therefore largest where both are equal:
    /// 2 ζ √(M g k/m₁), which is the rate that c = 2 ζ √(M g k m₁) on every particle has.
    fn dashpots(&self, law: &ContactLaw, share: f64) -> [f64; 2] {
        let [normal, tangential] = [0, 1].map(|i| share * self.mobility[i] * self.masses[i]);
        [
            law.damping + 2.0 * law.damping_ratio * (law.stiffness * normal).sqrt(),
            law.friction_damping
                + law.friction_damping_factor * (law.friction_spring * tangential).sqrt(),
        ]
    }
}

/// The largest part of g that is due to rotation (1/kg): n·(r × ·)ᵀ I⁻¹ (r × n) over all particles r and directions n.
fn largest_turning(body: &BodyModel) -> f64 {
    let inverse = body.inverse_inertia;
    let of_particle = |r: DVec3| {
        let cross = DMat3::from_cols(
            DVec3::new(0.0, r.z, -r.y),
            DVec3::new(-r.z, 0.0, r.x),
            DVec3::new(r.y, -r.x, 0.0),
        );
        let matrix = cross.transpose() * inverse * cross;
        let trace = |m: DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
        // one eigenvalue is zero, along r; the larger of the others follows from the traces of the matrix and of its square
        let (sum, squares) = (trace(matrix), trace(matrix * matrix));
        0.5 * (sum + (2.0 * squares - sum * sum).max(0.0).sqrt())
    };
    body.shape.particles().iter().map(of_particle).fold(0.0, f64::max)
}

/// The largest eigenvalue of Σ (a n nᵀ + b (1 − n nᵀ)) over walls that can be in contact at once; `terms`
/// returns the normal coefficient a and the tangential coefficient b.
fn stiffest(
    walls: &[WallPlane],
    laws: &[ContactLaw],
    terms: impl Fn(&ContactLaw) -> [f64; 2],
) -> f64 {
    let mut sum = DMat3::ZERO;
    let mut paired = vec![false; walls.len()];
    for (i, (wall, law)) in walls.iter().zip(laws).enumerate() {
        let [mut along, mut across] = terms(law);
        // of two opposite walls, the later one adds only its excess over the other
        let facing = (0..i).find(|&j| !paired[j] && walls[j].normal.dot(wall.normal) < -1.0 + 1e-9);
        if let Some(j) = facing {
            (paired[i], paired[j]) = (true, true);
            let [other_along, other_across] = terms(&laws[j]);
            along = (along - other_along).max(0.0);
            across = (across - other_across).max(0.0);
        }
        let n = wall.normal;
        let outer = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        sum += outer * along + (DMat3::IDENTITY - outer) * across;
    }
    let (values, _) = diagonalise(sum.to_cols_array_2d());
    values.into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::{Body, Damping, Material, Shape, World, WorldBuilder};

    /// A solid sphere of radius 1 m and mass 1 kg.
    fn ball(at: DVec3) -> Body {
        let inertia = DMat3::IDENTITY * 0.4;
        let mesh = crate::Mesh::default();
        let shape = Shape::from_distribution(&[DVec3::ZERO], mesh, DVec3::ZERO, inertia).unwrap();
        Body::new(shape).mass(1.0).surface(Surface::Spheres { radius: 1.0 }).position(at)
    }

    /// A floor with friction springs as stiff as the normal springs, 100 N/m.
    fn world(dt: f64) -> WorldBuilder {
        let material = Material {
            collision_stiffness: 100.0,
            damping: Damping::Dashpot(0.0),
            friction_stiffness: 100.0,
            friction_spring: Some(100.0),
            friction_damping: Some(0.0),
            ..Material::default()
        };
        let floor = WallPlane { normal: DVec3::Y, offset: 0.0 };
        let world = World::builder().dt(dt).gravity(DVec3::Y * -5.0).material(material);
        world.wall(floor).force(true)
    }

    /// The largest angular velocity of a sphere that rests on the floor, after a small perturbation.
    fn largest_spin(dt: f64) -> f64 {
        let ball = ball(DVec3::Y * 0.95).angular_velocity(DVec3::X * 1e-3);
        let mut world = world(dt).body(ball).build().unwrap();
        let mut largest = 0.0f64;
        for _ in 0..60 {
            world.step().unwrap();
            largest = largest.max(world.body(0).angular_velocity().length());
        }
        largest
    }

    #[test]
    fn the_critical_step_of_spheres_is_that_of_rotation_by_friction() {
        // k_t (1/M + r²/I) on the floor, and eight times as much in a close packing
        let rate = 350.0f64;
        let found = critical_dt(world(1e-3).body(ball(DVec3::Y * 5.0)).build().unwrap().model());
        let dt = found.unwrap().dt;
        assert!((dt * (8.0 * rate).sqrt() - 2.0).abs() < 1e-12, "{dt}");
        // the spin oscillates for steps up to 2/ω and grows for larger ones
        let critical = 2.0 / rate.sqrt();
        let (below, above) = (largest_spin(0.95 * critical), largest_spin(1.05 * critical));
        assert!(below < 1e-2 && above > 1e-1, "{below} {above}");
    }
}
