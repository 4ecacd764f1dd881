//! Mass integrals of a union of equal spheres: a clump of uniform density in which overlaps count once.
//!
//! By the divergence theorem the integrals over the union are integrals over its surface, the parts of the
//! spheres that lie in no other sphere. With f homogeneous of degree d, ∇·(f r) = (d + 3) f, so that with n the normal
//!
//! ∫ dV = ∮ (r·n)/3 dA, ∫ r dV = ∮ r (r·n)/4 dA, ∫ r rᵀ dV = ∮ r rᵀ (r·n)/5 dA.
//!
//! What other spheres cover of a sphere are caps. Where the caps of a sphere do not overlap, its integrals are those of the
//! whole sphere less those of the caps, in closed form: two spheres, and all clumps of which no three have a point in common,
//! are exact to rounding.
//!
//! Other spheres are cut into circles of constant z; dz dφ is the area element of the unit sphere. The arcs of a
//! circle inside other spheres are known in closed form, and the remaining arcs are integrated by Gauss's rule.
//! Along z, Gauss's rule is applied between the heights at which a cap begins or ends or two cap rims cross, in
//! a variable that removes the square-root singularities at the ends, and on halves of these intervals until the result
//! changes by less than [`TOLERANCE`]. Spheres that overlap more than [`MAX_CROSSED`] others are divided into equal intervals
//! instead. The error is below 1e-6.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DMat3, DVec3};

use super::integrals::{Integrals, SIZES};
use super::mass::outer;

/// Limit on the number of overlaps, each counted from both sides; an overlap costs about 100 µs.
const MAX_OVERLAPS: usize = 50_000;

/// Limit on the caps of a sphere for which the crossings of their rims are computed.
const MAX_CROSSED: usize = 16;

/// Equal intervals along z for a sphere with more caps.
const INTERVALS: usize = 128;

/// Largest change, in units of the radius, at which an interval is not halved any more.
const TOLERANCE: f64 = 1e-9;

/// How often an interval is halved at most.
const MAX_HALVINGS: u32 = 16;

/// Nodes and weights of Gauss's rule on [−1, 1] (Abramowitz & Stegun 25.4.30, n = 8), positive half.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Why the integrals of a union of spheres cannot be computed.
#[derive(Clone, Debug, PartialEq)]
pub enum SphereUnionError {
    /// The radius is below 1e-60 m, above 1e60 m, or NaN.
    Radius {
        /// The radius (m).
        radius: f64,
    },
    /// There are too many overlaps.
    TooManyOverlaps {
        /// The number of spheres.
        balls: usize,
    },
}

impl std::fmt::Display for SphereUnionError {
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
                "the {balls} spheres overlap more than {} times, which takes too long to integrate; use fewer or \
                 smaller ones, or leave the mass in the particles",
                MAX_OVERLAPS / 2
            ),
        }
    }
}

impl std::error::Error for SphereUnionError {}

/// Volume (m³), centre (m) and second moment (m⁵) of a union of spheres of equal `radius` (m).
///
/// `centres` (m) must be finite, and at least one. Overlaps count once. The result is exact to rounding
/// where no three spheres have a point in common, else accurate to a relative 1e-6.
///
/// # Errors
/// [`SphereUnionError`] if the radius is out of range, or there are too many overlaps.
pub fn sphere_union_integrals(
    centres: &[DVec3],
    radius: f64,
) -> Result<Integrals, SphereUnionError> {
    if !SIZES.contains(&radius) {
        return Err(SphereUnionError::Radius { radius });
    }
    // in units of the radius and relative to the mean, so that a clump far from the origin loses no digits
    let origin = centres.iter().map(|&c| c / centres.len().max(1) as f64).sum::<DVec3>();
    let mut places: Vec<DVec3> = centres.iter().map(|&c| (c - origin) / radius).collect();
    places.sort_by(|a, b| order(*a, *b));
    places.dedup();

    let cells = Cells::new(&places);
    let mut caps = Vec::new();
    if cells.count_overlaps(&mut caps) > MAX_OVERLAPS {
        return Err(SphereUnionError::TooManyOverlaps { balls: centres.len() });
    }
    let mut sum = Moments::ZERO;
    for &place in &places {
        cells.find_caps(place, &mut caps);
        if are_apart(&caps) {
            sum.add_sphere(place);
            caps.iter().for_each(|cap| sum.subtract_cap(place, cap));
        } else {
            sum.add_exposed_surface(place, &caps);
        }
    }
    let centre = sum.first / sum.volume;
    let second = sum.second + outer(centre, centre) * -sum.volume;
    let r3 = radius * radius * radius;
    Ok(Integrals {
        measure: r3 * sum.volume,
        centre: origin + radius * centre,
        // exactly symmetric
        second_moment: (second + second.transpose()) * (0.5 * r3 * radius * radius),
    })
}

fn order(a: DVec3, b: DVec3) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
}

/// Volume, first and second moment, in units of the radius.
#[derive(Clone, Copy, Debug)]
struct Moments {
    volume: f64,
    first: DVec3,
    second: DMat3,
}

impl Moments {
    const ZERO: Self = Self { volume: 0.0, first: DVec3::ZERO, second: DMat3::ZERO };

    /// Adds a whole sphere.
    fn add_sphere(&mut self, place: DVec3) {
        let volume = 4.0 / 3.0 * PI;
        self.volume += volume;
        self.first += volume * place;
        self.second += DMat3::IDENTITY * (volume / 5.0) + outer(place, place) * volume;
    }

    /// Subtracts the surface integrals over a cap, in closed form.
    ///
    /// The integrals of n, n nᵀ and n nᵀ (p·n) over a cap about d follow from those of powers of n·d.
    fn subtract_cap(&mut self, place: DVec3, cap: &Cap) {
        let (d, p, h) = (cap.direction, place, cap.height);
        let area = TAU * (1.0 - h);
        let (h2, h4) = (h * h, h * h * h * h);
        let (z1, z2, z3) =
            (0.5 * TAU * (1.0 - h2), TAU / 3.0 * (1.0 - h * h2), 0.25 * TAU * (1.0 - h4));
        let (across2, across3) = (0.5 * (area - z2), 0.5 * (z1 - z3));
        let n1 = d * z1;
        let n2 = DMat3::IDENTITY * across2 + outer(d, d) * (z2 - across2);
        let dp = d.dot(p);
        let n2_along_p = (DMat3::IDENTITY * dp + outer(d, p) + outer(p, d)) * across3
            + outer(d, d) * (dp * (z3 - 3.0 * across3));
        // flux (p + n)·n = p·n + 1
        let flux = p.dot(n1) + area;
        let flux_n = n2 * p + n1;
        self.volume -= flux / 3.0;
        self.first -= (p * flux + flux_n) * 0.25;
        self.second -=
            (outer(p, p) * flux + outer(p, flux_n) + outer(flux_n, p) + n2_along_p + n2) * 0.2;
    }

    /// Adds the surface integrals over the part of a sphere outside all caps.
    fn add_exposed_surface(&mut self, place: DVec3, caps: &[Cap]) {
        let sphere = ExposedSphere { place, caps };
        for ends in interval_ends(caps).windows(2) {
            let interval = (ends[0], ends[1]);
            let found = sphere.refined(interval, sphere.integrals(interval), MAX_HALVINGS);
            self.add(&found);
        }
    }

    fn add(&mut self, other: &Self) {
        self.volume += other.volume;
        self.first += other.first;
        self.second += other.second;
    }

    /// Whether the surface integrals of a sphere at `place` are those of `other` up to the tolerance.
    fn is_close(&self, other: &Self, place: DVec3) -> bool {
        let size = 1.0 + place.length();
        let (square, cube) = (size * size, size * size * size);
        let second = (self.second - other.second).to_cols_array();
        let second = second.into_iter().fold(0.0f64, |most, x| most.max(x.abs()));
        (self.volume - other.volume).abs() <= TOLERANCE * size
            && (self.first - other.first).length() <= TOLERANCE * square
            && second <= TOLERANCE * cube
    }

    /// Adds an arc of a circle of constant z, between two angles.
    fn add_arc(&mut self, place: DVec3, z: f64, (start, end): (f64, f64), weight: f64) {
        let circle_radius = (1.0 - z * z).max(0.0).sqrt();
        // Gauss's rule of this order has an error of 1e-12 over a quarter circle
        let count = ((end - start) / FRAC_PI_2).ceil().max(1.0);
        let half = 0.5 * (end - start) / count;
        for part in 0..count as u32 {
            let middle = start + half * (2.0 * f64::from(part) + 1.0);
            for (x, arc_weight) in gauss() {
                let (sin, cos) = libm::sincos(middle + half * x);
                let normal = DVec3::new(circle_radius * cos, circle_radius * sin, z);
                let at = place + normal;
                let flux = weight * arc_weight * half * at.dot(normal);
                self.volume += flux / 3.0;
                self.first += at * (flux / 4.0);
                self.second += outer(at, at) * (flux / 5.0);
            }
        }
    }
}

/// A sphere of radius 1 and its caps.
struct ExposedSphere<'a> {
    place: DVec3,
    caps: &'a [Cap],
}

impl ExposedSphere<'_> {
    /// The surface integrals between two heights, by one application of Gauss's rule.
    fn integrals(&self, (low, high): (f64, f64)) -> Moments {
        let mut sum = Moments::ZERO;
        let mut arcs = Vec::new();
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        for (x, weight) in gauss() {
            let (sin, cos) = libm::sincos(FRAC_PI_2 * x);
            let (z, weight) = (middle + half * sin, weight * half * FRAC_PI_2 * cos);
            exposed_arcs(self.caps, z, &mut arcs);
            for &(start, end) in &arcs {
                sum.add_arc(self.place, z, (start, end), weight);
            }
        }
        sum
    }

    /// The same on both halves, and on halves of these, until they change no more.
    fn refined(&self, (low, high): (f64, f64), whole: Moments, halvings: u32) -> Moments {
        let middle = 0.5 * (low + high);
        let halves = [(low, middle), (middle, high)];
        let [below, above] = halves.map(|half| self.integrals(half));
        let mut sum = below;
        sum.add(&above);
        if halvings == 0 || sum.is_close(&whole, self.place) {
            return sum;
        }
        let mut sum = self.refined(halves[0], below, halvings - 1);
        sum.add(&self.refined(halves[1], above, halvings - 1));
        sum
    }
}

/// Whether no two caps of a sphere overlap.
fn are_apart(caps: &[Cap]) -> bool {
    let across = |cap: &Cap| (1.0 - cap.height * cap.height).max(0.0).sqrt();
    // compares the angle between the directions with the sum of the angular radii; both are at most π
    let is_apart = |a: &Cap, b: &Cap| {
        a.direction.dot(b.direction) <= a.height * b.height - across(a) * across(b)
    };
    // more caps than twelve always overlap, unless they are small
    caps.len() <= MAX_CROSSED
        && caps.iter().enumerate().all(|(i, a)| caps[i + 1..].iter().all(|b| is_apart(a, b)))
}

/// The nodes and weights of Gauss's rule on [−1, 1].
fn gauss() -> impl Iterator<Item = (f64, f64)> {
    GAUSS.into_iter().flat_map(|(x, weight)| [(-x, weight), (x, weight)])
}

/// The cap of the unit sphere inside another sphere: all u with u·direction > height.
#[derive(Clone, Copy, Debug)]
struct Cap {
    direction: DVec3,
    height: f64,
    /// The angle of the direction about z (rad), and its component perpendicular to z.
    angle: f64,
    across: f64,
}

impl Cap {
    /// The cap inside a sphere with its centre at `offset` from this one (in radii).
    fn new(offset: DVec3) -> Self {
        let distance = offset.length();
        let direction = offset / distance;
        Self {
            direction,
            height: 0.5 * distance,
            angle: libm::atan2(direction.y, direction.x),
            across: libm::hypot(direction.x, direction.y),
        }
    }
}

/// Ends of the integration intervals along z, in ascending order, from −1 to 1.
fn interval_ends(caps: &[Cap]) -> Vec<f64> {
    let mut ends = vec![-1.0, 1.0];
    for cap in caps {
        let middle = cap.direction.z * cap.height;
        let half = cap.across * (1.0 - cap.height * cap.height).max(0.0).sqrt();
        ends.extend([middle - half, middle + half]);
    }
    if caps.len() > MAX_CROSSED {
        ends.extend((1..INTERVALS).map(|i| 2.0 * i as f64 / INTERVALS as f64 - 1.0));
    } else {
        for (index, a) in caps.iter().enumerate() {
            ends.extend(caps[index + 1..].iter().flat_map(|b| rim_crossings(a, b)).flatten());
        }
    }
    ends.retain(|z| (-1.0..=1.0).contains(z));
    ends.sort_by(f64::total_cmp);
    // thinner intervals are negligible
    ends.dedup_by(|next, before| *next - *before < 1e-13);
    ends
}

/// The heights at which the rims of two caps cross.
fn rim_crossings(a: &Cap, b: &Cap) -> Option<[f64; 2]> {
    let axis = a.direction.cross(b.direction);
    let (square, cosine) = (axis.length_squared(), a.direction.dot(b.direction));
    // the point of the line of intersection of both planes nearest to the centre
    let middle = (a.direction * (a.height - b.height * cosine)
        + b.direction * (b.height - a.height * cosine))
        / square;
    let rest = 1.0 - middle.length_squared();
    let half = axis.z * (rest / square).sqrt();
    // rims that do not cross, or coincide, give NaN or infinity
    half.is_finite().then_some([middle.z - half, middle.z + half])
}

/// The arcs of the circle at height z that lie in no cap, as angles from 0 to 2π.
fn exposed_arcs(caps: &[Cap], z: f64, exposed: &mut Vec<(f64, f64)>) {
    exposed.clear();
    let circle_radius = (1.0 - z * z).max(0.0).sqrt();
    let mut covered: Vec<(f64, f64)> = Vec::with_capacity(2 * caps.len());
    for cap in caps {
        // points of the circle are in the cap where amplitude · cos(angle) exceeds the level
        let (level, amplitude) = (cap.height - z * cap.direction.z, circle_radius * cap.across);
        if level <= -amplitude {
            return;
        }
        if level < amplitude {
            let half = libm::acos(level / amplitude);
            let start = (cap.angle - half).rem_euclid(TAU);
            let end = start + 2.0 * half;
            covered.push((start, end.min(TAU)));
            if end > TAU {
                covered.push((0.0, end - TAU));
            }
        }
    }
    covered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut from = 0.0;
    for (start, end) in covered {
        if start > from {
            exposed.push((from, start));
        }
        from = end.max(from);
    }
    if from < TAU {
        exposed.push((from, TAU));
    }
}

/// Sphere centres sorted into cubic cells as wide as a sphere, so that overlapping spheres are in adjacent cells.
struct Cells(Vec<(DVec3, DVec3)>);

impl Cells {
    fn new(places: &[DVec3]) -> Self {
        let mut cells: Vec<_> = places.iter().map(|&place| (cell(place), place)).collect();
        cells.sort_by(|a, b| order(a.0, b.0).then(order(a.1, b.1)));
        Self(cells)
    }

    /// The number of overlaps, each counted from both sides. Counting stops above the limit.
    fn count_overlaps(&self, caps: &mut Vec<Cap>) -> usize {
        let mut count = 0;
        for (_, place) in &self.0 {
            self.find_caps(*place, caps);
            count += caps.len();
            if count > MAX_OVERLAPS {
                break;
            }
        }
        count
    }

    /// The caps of the sphere at `place` inside overlapping spheres, in a fixed order. The search stops above
    /// the limit.
    fn find_caps(&self, place: DVec3, caps: &mut Vec<Cap>) {
        caps.clear();
        let own = cell(place);
        let mut rows: Vec<DVec3> = (0..9)
            .map(|row| own + DVec3::new(f64::from(row / 3 - 1), f64::from(row % 3 - 1), -1.0))
            .collect();
        // far from the origin, where doubles are coarser than a sphere, adjacent rows coincide
        rows.dedup();
        for first in rows {
            let last = DVec3 { z: own.z + 1.0, ..first };
            let start = self.0.partition_point(|(cell, _)| order(*cell, first).is_lt());
            let inside = self.0[start..].iter().take_while(|(cell, _)| order(*cell, last).is_le());
            for (_, other) in inside {
                let offset = *other - place;
                let distance = offset.length();
                if distance > 0.0 && distance < 2.0 {
                    caps.push(Cap::new(offset));
                }
                if caps.len() > MAX_OVERLAPS {
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
#[path = "sphere_union_tests.rs"]
mod tests;
