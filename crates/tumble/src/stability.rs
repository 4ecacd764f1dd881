//! The largest stable time step.

use glam::DMat3;

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
/// contributions of walls that meet in a corner add up; of two opposite walls the stiffer counts. Dashpots from a restitution are
/// those of a patch of all N particles, c = 2 ζ √(k M/N) each. A patch of n particles has c = 2 ζ √(k M/n), but only n of them: it
/// damps at a rate that is lower by √(n/N).
pub fn critical_dt(model: &Model) -> Option<CriticalStep> {
    let free = model.bodies.iter().zip(&model.names).filter(|(body, _)| body.is_free());
    let has_surfaces = model.bodies.iter().any(|body| body.surface != Surface::None);
    let steps = free.map(|(body, name)| (critical_dt_of(model, body, has_surfaces), name));
    let (dt, name) = steps.min_by(|a, b| a.0.total_cmp(&b.0))?;
    dt.is_finite().then(|| CriticalStep { dt, body: name.clone() })
}

fn critical_dt_of(model: &Model, body: &BodyModel, has_surfaces: bool) -> f64 {
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
        // points in addition to the particles
        _ => (1.0, body.contact_points.as_ref().map_or(1.0, |points| points.load())),
    };
    let springs = |law: &ContactLaw| {
        let tangential = if law.friction > 0.0 { law.friction_spring } else { 0.0 };
        [law.stiffness, lever * tangential]
    };
    // each sphere may carry the whole mass, particles share it
    let mass = if body.has_spheres() { body.mass } else { body.particle_mass() };
    let dashpots = |law: &ContactLaw, mass: f64| {
        let law = law.of_single_particle(mass);
        let tangential = if law.friction > 0.0 { law.friction_damping } else { 0.0 };
        [law.damping, lever * tangential]
    };
    let at_walls = |terms: &dyn Fn(&ContactLaw) -> [f64; 2]| {
        per_mass * stiffest(&model.walls, &body.contacts, terms)
    };
    // two identical bodies with all particles in contact
    let law = body.pair_material.law(&body.pair_material);
    let meets = if has_surfaces { 2.0 * per_mass * neighbours } else { 0.0 };
    let between = |[normal, tangential]: [f64; 2]| meets * normal.max(tangential);
    let square = at_walls(&springs).max(between(springs(&law)));
    // more points in a patch share its dashpot, which grows with the root of their number
    let sharing = if body.has_spheres() { 1.0 } else { neighbours };
    let between_bodies = between(dashpots(&law, 0.5 * mass / sharing));
    let half_rate = 0.5 * at_walls(&|law| dashpots(law, mass)).max(between_bodies);
    // (2/ω)(√(1 + ζ²) − ζ), without cancellation and valid for ω = 0
    2.0 / ((square + half_rate * half_rate).sqrt() + half_rate)
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
    use crate::{Body, DVec3, Damping, Material, Shape, World, WorldBuilder};

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
