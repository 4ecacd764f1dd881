//! Mass integrals of a union of equal balls: of a clump of spheres whose overlaps weigh once.
//!
//! Each ball keeps the part of the union that is nearer to its own centre than to any other. Seen from that
//! centre the part reaches, in the direction u, as far as
//!
//! R(u) = min(r, min over the balls j that overlap it of hⱼ / (u·dⱼ)),  where u·dⱼ > 0
//!
//! with dⱼ the direction to the other centre and hⱼ half the distance to it. The parts fill the union
//! without overlap, and each integrates in spherical coordinates:
//! ∫ dV = ∫ R³/3 dΩ, ∫ ρ dV = ∫ u R⁴/4 dΩ, ∫ ρ ρᵀ dV = ∫ u uᵀ R⁵/5 dΩ.
//!
//! The directions are the midpoints of a grid on the six faces of a cube, so a clump with the symmetry of its
//! axes has it to rounding. A ball that overlaps no other is exact; R has a kink where a cut begins, which costs the others
//! a relative error below 1e-4 (the tests find some 1e-5).

use glam::{DMat3, DVec3};

use super::Integrals;
use super::integrals::SIZES;
use super::mass::outer;

/// Directions along an edge of a face of the cube.
const EDGE: usize = 64;

/// More overlaps than this, each counted from both sides, would take too long: they cost some 25 µs each.
const MOST_OVERLAPS: usize = 250_000;

/// Why a union of balls has no integrals.
#[derive(Clone, Debug, PartialEq)]
pub enum BallsError {
    /// The radius is below 1e-60 m, above 1e60 m or no number.
    Radius {
        /// The radius (m).
        radius: f64,
    },
    /// So many balls overlap each other that their union takes too long to measure.
    TooManyOverlaps {
        /// How many balls.
        balls: usize,
    },
}

impl std::fmt::Display for BallsError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Radius { radius } => {
                write!(
                    f,
                    "the radius is {radius} m, and only radii from 1e-60 m to 1e60 m can be integrated"
                )
            }
            Self::TooManyOverlaps { balls } => write!(
                f,
                "the {balls} balls overlap more than {} times, which takes too long to integrate; take fewer or \
                 smaller ones, or leave the mass in the particles",
                MOST_OVERLAPS / 2
            ),
        }
    }
}

impl std::error::Error for BallsError {}

/// Volume (m³), centre (m) and second moment (m⁵) of the union of balls of `radius` (m) about `centres` (m, finite, at least
/// one). What several balls share counts once. Exact to rounding where none overlap, else to a relative 1e-4.
///
/// # Errors
/// [`BallsError`] for a radius beyond the range of doubles, and for too many overlaps.
pub fn ball_integrals(centres: &[DVec3], radius: f64) -> Result<Integrals, BallsError> {
    if !SIZES.contains(&radius) {
        return Err(BallsError::Radius { radius });
    }
    // in radii, from a place among the balls, so that a clump far away loses nothing
    let origin = centres.iter().map(|&c| c / centres.len().max(1) as f64).sum::<DVec3>();
    let mut places: Vec<DVec3> = centres.iter().map(|&c| (c - origin) / radius).collect();
    places.sort_by(|a, b| order(*a, *b));
    places.dedup();

    let cells = Cells::of(&places);
    let (mut near, mut overlaps) = (Vec::new(), 0);
    let mut sum = Part::default();
    let directions = directions();
    for &place in &places {
        cells.neighbours(place, &mut near);
        overlaps += near.len();
        if overlaps > MOST_OVERLAPS {
            return Err(BallsError::TooManyOverlaps { balls: centres.len() });
        }
        sum.add(
            &if near.is_empty() { Part::whole() } else { Part::cut(&directions, &near) },
            place,
        );
    }
    let centre = sum.first / sum.volume;
    let second = sum.second + outer(centre, centre) * -sum.volume;
    let r3 = radius * radius * radius;
    Ok(Integrals {
        measure: r3 * sum.volume,
        centre: origin + radius * centre,
        // symmetric to the last bit
        second_moment: (second + second.transpose()) * (0.5 * r3 * radius * radius),
    })
}

fn order(a: DVec3, b: DVec3) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
}

/// Volume, first and second moment of a part of the union, in radii.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    volume: f64,
    first: DVec3,
    second: DMat3,
}

impl Part {
    /// A ball about the origin.
    fn whole() -> Self {
        let volume = 4.0 / 3.0 * std::f64::consts::PI;
        Self { volume, first: DVec3::ZERO, second: DMat3::IDENTITY * (volume / 5.0) }
    }

    /// A ball about the origin, cut half-way to each neighbour; `cuts` are dⱼ/hⱼ.
    fn cut(directions: &[(DVec3, f64)], cuts: &[DVec3]) -> Self {
        // what is missing of the whole ball, so that only the cuts are inexact
        let mut missing = Self::default();
        for &(u, weight) in directions {
            let nearest = cuts.iter().fold(1.0f64, |most, cut| most.max(cut.dot(u)));
            if nearest > 1.0 {
                let reach = 1.0 / nearest;
                let cube = reach * reach * reach;
                missing.volume += weight * (1.0 - cube) / 3.0;
                missing.first += u * (weight * (1.0 - cube * reach) / 4.0);
                missing.second += outer(u, u) * (weight * (1.0 - cube * reach * reach) / 5.0);
            }
        }
        let whole = Self::whole();
        Self {
            volume: whole.volume - missing.volume,
            first: -missing.first,
            second: whole.second - missing.second,
        }
    }

    /// Adds a part whose origin lies at `place`.
    fn add(&mut self, part: &Self, place: DVec3) {
        self.volume += part.volume;
        self.first += part.first + part.volume * place;
        self.second += part.second
            + outer(part.first, place)
            + outer(place, part.first)
            + outer(place, place) * part.volume;
    }
}

/// Directions over the whole sphere, each with its part of 4π.
fn directions() -> Vec<(DVec3, f64)> {
    // evenly by angle, which spreads them better than evenly by length
    let tangent = |i: usize| {
        let turn = (2.0 * i as f64 + 1.0) / EDGE as f64 - 1.0;
        let angle = std::f64::consts::FRAC_PI_4 * turn;
        libm::tan(angle)
    };
    let mut all = Vec::with_capacity(6 * EDGE * EDGE);
    for i in 0..EDGE {
        for j in 0..EDGE {
            let (a, b) = (tangent(i), tangent(j));
            let length_squared = 1.0 + a * a + b * b;
            let length = length_squared.sqrt();
            // da db as seen from the centre, with da = (1 + a²) dα
            let weight = (1.0 + a * a) * (1.0 + b * b) / (length_squared * length);
            let (a, b, c) = (a / length, b / length, 1.0 / length);
            for side in [c, -c] {
                let faces =
                    [DVec3::new(side, a, b), DVec3::new(a, side, b), DVec3::new(a, b, side)];
                all.extend(faces.map(|u| (u, weight)));
            }
        }
    }
    let total: f64 = all.iter().map(|(_, weight)| weight).sum();
    let scale = 4.0 * std::f64::consts::PI / total;
    all.iter_mut().for_each(|(_, weight)| *weight *= scale);
    all
}

/// Places sorted into cubes as wide as a ball, so that balls which overlap lie in cubes side by side.
struct Cells(Vec<(DVec3, DVec3)>);

impl Cells {
    fn of(places: &[DVec3]) -> Self {
        let mut cells: Vec<_> = places.iter().map(|&place| (cell(place), place)).collect();
        cells.sort_by(|a, b| order(a.0, b.0).then(order(a.1, b.1)));
        Self(cells)
    }

    /// dⱼ/hⱼ for every other ball that overlaps the one at `place`, in a fixed order; one more than is allowed ends
    /// the search.
    fn neighbours(&self, place: DVec3, near: &mut Vec<DVec3>) {
        near.clear();
        let own = cell(place);
        let mut rows: Vec<DVec3> = (0..9)
            .map(|row| own + DVec3::new(f64::from(row / 3 - 1), f64::from(row % 3 - 1), -1.0))
            .collect();
        // far away, where doubles are coarser than a ball, neighbouring rows are one
        rows.dedup();
        for first in rows {
            let last = DVec3 { z: own.z + 1.0, ..first };
            let start = self.0.partition_point(|(cell, _)| order(*cell, first).is_lt());
            let inside = self.0[start..].iter().take_while(|(cell, _)| order(*cell, last).is_le());
            for (_, other) in inside {
                let apart = *other - place;
                let distance = apart.length();
                if distance > 0.0 && distance < 2.0 {
                    near.push(apart * (2.0 / (distance * distance)));
                }
                if near.len() > MOST_OVERLAPS {
                    return;
                }
            }
        }
    }
}

fn cell(place: DVec3) -> DVec3 {
    // without −0, which sorts before 0
    (0.5 * place).floor() + 0.0
}

#[cfg(test)]
#[path = "balls_tests.rs"]
mod tests;
