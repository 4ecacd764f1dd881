//! Springs and dashpots along the normal, where there is no friction: sums over the tree of the shape.

use super::placed::{NearWall, Placed};
use crate::shape::RampSums;
use crate::{ContactLaw, Model, Wrench};

/// What the springs of the walls without friction do: F = k Σ δ n and τ = R (k Σ δ r × n_b).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Springs {
    /// Of all these walls.
    pub all: Wrench,
    /// Of those of them that have a dashpot too.
    damped: Wrench,
    /// Whether there are such, with particles behind them.
    is_damped: bool,
    /// The deepest particle (m).
    pub max_depth: f64,
}

impl Springs {
    /// At a place; velocities do not matter.
    pub fn at(model: &Model, place: &Placed) -> Self {
        let mut springs = Self::default();
        for (wall, law) in near_walls(model, place) {
            let depths = wall.depths(place);
            if depths.sum <= 0.0 {
                continue;
            }
            let push = along(place, &wall, law.stiffness, &depths);
            springs.all += push;
            if law.damping > 0.0 {
                springs.damped += push;
                springs.is_damped = true;
            }
            let search = || place.body.shape.particles().largest(place.level, &wall.depth);
            let deepest = depths.largest.unwrap_or_else(search);
            springs.max_depth = springs.max_depth.max(deepest);
        }
        springs
    }

    /// What the dashpots add with the velocities of `place`: the sums of k δ − c_n u·n where that is above
    /// zero, less the springs.
    pub fn dashpots(&self, model: &Model, place: &Placed) -> Wrench {
        if !self.is_damped {
            return Wrench::default();
        }
        let mut both = Wrench::default();
        for (wall, law) in near_walls(model, place) {
            if law.damping > 0.0 {
                let damped = wall.damped(place, law);
                let sums =
                    place.body.shape.particles().sums(place.level, &damped, Some(&wall.depth));
                both += along(place, &wall, 1.0, &sums);
            }
        }
        both - self.damped
    }
}

/// The walls without friction that are within reach.
fn near_walls<'a>(
    model: &'a Model,
    place: &'a Placed,
) -> impl Iterator<Item = (NearWall, &'a ContactLaw)> {
    let walls = model.walls.iter().zip(&place.body.contacts);
    walls
        .filter(|(_, law)| law.friction == 0.0)
        .filter_map(|(wall, law)| Some((NearWall::of(wall, place)?, law)))
}

/// The wrench of forces `factor` f n on the particles, from the sums of f.
fn along(place: &Placed, wall: &NearWall, factor: f64, sums: &RampSums) -> Wrench {
    Wrench {
        force: wall.normal * (factor * sums.sum),
        torque: place.rotation * (sums.moment.cross(wall.depth.slope) * factor),
    }
}
