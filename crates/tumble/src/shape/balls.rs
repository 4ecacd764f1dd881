//! Mass integrals of a union of equal balls: of a clump of spheres whose overlaps weigh once.
//!
//! By the divergence theorem the integrals over the union are integrals over its skin, the part of each sphere that
//! lies in no other ball. With f homogeneous of degree d, ∇·(f r) = (d + 3) f, so that with n the normal
//!
//! ∫ dV = ∮ (r·n)/3 dA, ∫ r dV = ∮ r (r·n)/4 dA, ∫ r rᵀ dV = ∮ r rᵀ (r·n)/5 dA.
//!
//! Each sphere is cut into circles of constant z, of which dz dφ is the area of the unit sphere. On a circle the
//! arcs within other balls are known in closed form, and Gauss's rule integrates over those that remain. Along z it
//! does so between the places where a ball's cut begins or two of them cross, in a variable that takes the
//! square roots at their ends away. That leaves errors of 1e-5 at most; spheres that overlap more than
//! [`MOST_CROSSED`] others are cut evenly instead, which leaves some more.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DVec3};

use super::Integrals;
use super::integrals::SIZES;
use super::mass::outer;

/// More overlaps than this, each counted from both sides, would take too long: they cost some 100 µs each.
const MOST_OVERLAPS: usize = 50_000;

/// The crossings of more cuts than this would cost more than they help.
const MOST_CROSSED: usize = 16;

/// Pieces along z of a sphere with more cuts.
const PIECES: usize = 128;

/// Places and weights of Gauss's rule on [−1, 1] (Abramowitz & Stegun 25.4.30, n = 8), for the upper half.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

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
/// one). What several balls share counts once. Exact to rounding where none overlap, else to a relative 1e-4 or better.
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
    let mut near = Vec::new();
    if cells.overlaps(&mut near) > MOST_OVERLAPS {
        return Err(BallsError::TooManyOverlaps { balls: centres.len() });
    }
    let mut sum = Part::NOTHING;
    for &place in &places {
        cells.neighbours(place, &mut near);
        if near.is_empty() {
            sum.add_ball(place);
        } else {
            sum.add_skin(place, &near);
        }
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
#[derive(Clone, Copy, Debug)]
struct Part {
    volume: f64,
    first: DVec3,
    second: DMat3,
}

impl Part {
    const NOTHING: Self = Self { volume: 0.0, first: DVec3::ZERO, second: DMat3::ZERO };

    /// Adds a whole ball.
    fn add_ball(&mut self, place: DVec3) {
        let volume = 4.0 / 3.0 * PI;
        self.volume += volume;
        self.first += volume * place;
        self.second += DMat3::IDENTITY * (volume / 5.0) + outer(place, place) * volume;
    }

    /// Adds what the skin of a ball contributes.
    fn add_skin(&mut self, place: DVec3, cuts: &[Cut]) {
        let mut arcs = Vec::new();
        let ends = levels(cuts);
        for piece in ends.windows(2) {
            let (middle, half) = (0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] - piece[0]));
            for (x, weight) in gauss() {
                let (sin, cos) = libm::sincos(FRAC_PI_2 * x);
                let (z, weight) = (middle + half * sin, weight * half * FRAC_PI_2 * cos);
                free_arcs(cuts, z, &mut arcs);
                for &(start, end) in &arcs {
                    self.add_arc(place, z, (start, end), weight);
                }
            }
        }
    }

    /// Adds an arc of a circle of constant z, from one angle to another.
    fn add_arc(&mut self, place: DVec3, z: f64, (start, end): (f64, f64), weight: f64) {
        let across = (1.0 - z * z).max(0.0).sqrt();
        // Gauss's rule of this order is exact to 1e-12 over a quarter turn
        let count = ((end - start) / FRAC_PI_2).ceil().max(1.0);
        let half = 0.5 * (end - start) / count;
        for piece in 0..count as u32 {
            let middle = start + half * (2.0 * f64::from(piece) + 1.0);
            for (x, share) in gauss() {
                let (sin, cos) = libm::sincos(middle + half * x);
                let normal = DVec3::new(across * cos, across * sin, z);
                let at = place + normal;
                let flux = weight * share * half * at.dot(normal);
                self.volume += flux / 3.0;
                self.first += at * (flux / 4.0);
                self.second += outer(at, at) * (flux / 5.0);
            }
        }
    }
}

/// The places and weights of Gauss's rule on [−1, 1].
fn gauss() -> impl Iterator<Item = (f64, f64)> {
    GAUSS.into_iter().flat_map(|(x, weight)| [(-x, weight), (x, weight)])
}

/// What another ball takes of the unit sphere: all u with u·direction > reach.
#[derive(Clone, Copy, Debug)]
struct Cut {
    direction: DVec3,
    reach: f64,
    /// Angle of the direction about z (rad), and its part across z.
    angle: f64,
    across: f64,
}

impl Cut {
    /// Half-way to a ball `apart` from this one (radii).
    fn towards(apart: DVec3) -> Self {
        let distance = apart.length();
        let direction = apart / distance;
        Self {
            direction,
            reach: 0.5 * distance,
            angle: libm::atan2(direction.y, direction.x),
            across: libm::hypot(direction.x, direction.y),
        }
    }
}

/// Where along z something begins or ends on the unit sphere, in rising order, from −1 to 1.
fn levels(cuts: &[Cut]) -> Vec<f64> {
    let mut levels = vec![-1.0, 1.0];
    for cut in cuts {
        let middle = cut.direction.z * cut.reach;
        let half = cut.across * (1.0 - cut.reach * cut.reach).max(0.0).sqrt();
        levels.extend([middle - half, middle + half]);
    }
    if cuts.len() > MOST_CROSSED {
        levels.extend((1..PIECES).map(|i| 2.0 * i as f64 / PIECES as f64 - 1.0));
    } else {
        for (index, a) in cuts.iter().enumerate() {
            levels.extend(cuts[index + 1..].iter().flat_map(|b| crossings(a, b)).flatten());
        }
    }
    levels.retain(|z| (-1.0..=1.0).contains(z));
    levels.sort_by(f64::total_cmp);
    // a piece thinner than this holds nothing
    levels.dedup_by(|next, before| *next - *before < 1e-13);
    levels
}

/// Where along z the rims of two cuts cross.
fn crossings(a: &Cut, b: &Cut) -> Option<[f64; 2]> {
    let axis = a.direction.cross(b.direction);
    let (square, cosine) = (axis.length_squared(), a.direction.dot(b.direction));
    let foot = (a.direction * (a.reach - b.reach * cosine)
        + b.direction * (b.reach - a.reach * cosine))
        / square;
    let rest = 1.0 - foot.length_squared();
    let half = axis.z * (rest / square).sqrt();
    // rims that do not cross, or are one, come out as no number
    half.is_finite().then_some([foot.z - half, foot.z + half])
}

/// The arcs of the circle at height z that lie in no cut, as angles from 0 to 2π.
fn free_arcs(cuts: &[Cut], z: f64, free: &mut Vec<(f64, f64)>) {
    free.clear();
    let across = (1.0 - z * z).max(0.0).sqrt();
    let mut taken: Vec<(f64, f64)> = Vec::with_capacity(2 * cuts.len());
    for cut in cuts {
        let (least, most) = (cut.reach - z * cut.direction.z, across * cut.across);
        if least <= -most {
            return;
        }
        if least < most {
            let half = libm::acos(least / most);
            let start = (cut.angle - half).rem_euclid(TAU);
            let end = start + 2.0 * half;
            taken.push((start, end.min(TAU)));
            if end > TAU {
                taken.push((0.0, end - TAU));
            }
        }
    }
    taken.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut from = 0.0;
    for (start, end) in taken {
        if start > from {
            free.push((from, start));
        }
        from = end.max(from);
    }
    if from < TAU {
        free.push((from, TAU));
    }
}

/// Places sorted into cubes as wide as a ball, so that balls which overlap lie in cubes side by side.
struct Cells(Vec<(DVec3, DVec3)>);

impl Cells {
    fn of(places: &[DVec3]) -> Self {
        let mut cells: Vec<_> = places.iter().map(|&place| (cell(place), place)).collect();
        cells.sort_by(|a, b| order(a.0, b.0).then(order(a.1, b.1)));
        Self(cells)
    }

    /// How many overlaps there are, each counted from both sides; counting ends where they are too many.
    fn overlaps(&self, near: &mut Vec<Cut>) -> usize {
        let mut count = 0;
        for (_, place) in &self.0 {
            self.neighbours(*place, near);
            count += near.len();
            if count > MOST_OVERLAPS {
                break;
            }
        }
        count
    }

    /// What every other ball that overlaps the one at `place` takes of it, in a fixed order; one more than is allowed ends
    /// the search.
    fn neighbours(&self, place: DVec3, near: &mut Vec<Cut>) {
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
                    near.push(Cut::towards(apart));
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
