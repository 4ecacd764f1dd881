//! How long a step may be.

use glam::DMat3;

use crate::shape::diagonalise;
use crate::{BodyModel, ContactLaw, Model, WallPlane};

/// The longest stable step, and the body that sets it.
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalStep {
    /// Step h (s) above which contact is unstable.
    pub dt: f64,
    /// Name of the body with the fastest contact.
    pub body: String,
}

/// The longest step with which contact is stable; `None` where nothing can touch.
///
/// A particle of mass m on a spring k oscillates at ω = √(k/m), and a step above 2/ω makes it grow. With a
/// dashpot of damping ratio ζ the bound is (2/ω)(√(1 + ζ²) − ζ). However many particles of a body are in
/// contact, its stiffness over its mass is no more than that of one of them, and so is its rotational
/// stiffness over its inertia; with mass spread otherwise the largest ratio over all motions takes the place
/// of 1/m. So it does where particles are weighted by their areas, with the weights counted: the ratio of
/// translation is still k/m of the mean particle, that of rotation may be more. Where bodies meet each other, two of a
/// kind count, with all their particles. Walls that meet in a corner add up; of two that face each other the stiffer
/// counts.
pub fn critical_dt(model: &Model) -> Option<CriticalStep> {
    let of_body = |body: &BodyModel| {
        let per_mass = match (body.shape.fastest_contact(), &body.drag_modes) {
            (Some(fastest), _) => fastest / body.mass,
            (None, Some(modes)) => modes.fastest(),
            (None, None) => 1.0 / body.particle_mass(),
        };
        let sum = |normal: fn(&ContactLaw) -> f64, tangential: fn(&ContactLaw) -> f64| {
            stiffest(&model.walls, &body.contacts, normal, tangential) * per_mass
        };
        let square = sum(
            |law| law.stiffness,
            |law| if law.friction > 0.0 { law.friction_spring } else { 0.0 },
        );
        let half_rate = 0.5
            * sum(
                |law| law.damping,
                |law| if law.friction > 0.0 { law.friction_damping } else { 0.0 },
            );
        // two bodies alike, all particles of both in contact
        let between = body.pair_material.law(&body.pair_material);
        let meets = if model.meets { 2.0 * per_mass } else { 0.0 };
        let square = square.max(between.stiffness.max(between.friction_spring) * meets);
        let half_rate = half_rate.max(0.5 * between.damping.max(between.friction_damping) * meets);
        // (2/ω)(√(1 + ζ²) − ζ), without cancellation and for ω = 0 too
        2.0 / ((square + half_rate * half_rate).sqrt() + half_rate)
    };
    let free = model.bodies.iter().filter(|body| body.is_free());
    let steps = free.map(|body| (of_body(body), body));
    let (dt, body) = steps.min_by(|a, b| a.0.total_cmp(&b.0))?;
    dt.is_finite().then(|| CriticalStep { dt, body: body.name.clone() })
}

/// The largest eigenvalue of Σ (normal n nᵀ + tangential (1 − n nᵀ)) over walls that can be
/// touched at once.
fn stiffest(
    walls: &[WallPlane],
    laws: &[ContactLaw],
    normal: fn(&ContactLaw) -> f64,
    tangential: fn(&ContactLaw) -> f64,
) -> f64 {
    let mut sum = DMat3::ZERO;
    let mut paired = vec![false; walls.len()];
    for (i, (wall, law)) in walls.iter().zip(laws).enumerate() {
        let (mut along, mut across) = (normal(law), tangential(law));
        // of two walls that face each other, the later one counts for what it has more
        let facing = (0..i).find(|&j| !paired[j] && walls[j].normal.dot(wall.normal) < -1.0 + 1e-9);
        if let Some(j) = facing {
            (paired[i], paired[j]) = (true, true);
            along = (along - normal(&laws[j])).max(0.0);
            across = (across - tangential(&laws[j])).max(0.0);
        }
        let n = wall.normal;
        let outer = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        sum += outer * along + (DMat3::IDENTITY - outer) * across;
    }
    let (values, _) = diagonalise(sum.to_cols_array_2d());
    values.into_iter().fold(0.0, f64::max)
}
