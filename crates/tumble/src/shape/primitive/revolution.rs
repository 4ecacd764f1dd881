//! Surfaces of revolution with evenly spread vertices.
//!
//! A profile curve is revolved about the y axis; each of its points becomes a ring of vertices. The number of
//! vertices of a ring is its circumference over the spacing, rounded to a multiple of six, so that rings near the
//! axis are not denser. A band of triangles joins two rings of any counts. The sixfold symmetry keeps the centre of
//! mass on the axis and makes it a principal axis.

use super::error::{MAX_VERTICES, PrimitiveError, check_vertex_count};
use crate::shape::mesh::Mesh;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A point of the profile: distance from the axis and height along it (m).
type Point = [f64; 2];

/// The spacing (m) that puts `segments` vertices, rounded to a multiple of six, around a circle.
fn spacing_of(segments: u32, radius: f64) -> f64 {
    let sixths = (f64::from(segments) / 6.0).round().max(1.0);
    TAU * radius / (6.0 * sixths)
}

/// The number of parts of about `spacing` in a length, at least one.
fn parts(shape: &'static str, length: f64, spacing: f64) -> Result<u32, PrimitiveError> {
    let parts = (length / spacing).round().max(1.0);
    check_vertex_count(shape, parts)?;
    Ok(parts as u32)
}

/// The number of vertices of a ring; one on the axis.
fn ring_count(radius: f64, spacing: f64) -> u32 {
    if radius == 0.0 {
        return 1;
    }
    let sixths = (TAU * radius / (6.0 * spacing)).round().max(1.0);
    6 * sixths.min(MAX_VERTICES) as u32
}

/// Revolves a profile that runs from bottom to top on its outside; an open profile must begin and end on the axis.
fn revolve(
    shape: &'static str,
    profile: &[Point],
    spacing: f64,
    is_closed: bool,
) -> Result<Mesh, PrimitiveError> {
    let counts: Vec<u32> = profile.iter().map(|&[r, _]| ring_count(r, spacing)).collect();
    revolve_rings(shape, profile, &counts, is_closed)
}

/// Revolves a profile whose rings have these numbers of vertices.
fn revolve_rings(
    shape: &'static str,
    profile: &[Point],
    counts: &[u32],
    is_closed: bool,
) -> Result<Mesh, PrimitiveError> {
    check_vertex_count(shape, counts.iter().map(|&n| f64::from(n)).sum())?;

    let mut mesh = Mesh::default();
    let mut starts = Vec::with_capacity(profile.len());
    for (&[r, y], &count) in profile.iter().zip(counts) {
        starts.push(mesh.vertices.len() as u32);
        for k in 0..count {
            // from z towards x is counter-clockwise about +y
            let (sin, cos) = libm::sincos(TAU * f64::from(k) / f64::from(count));
            mesh.vertices.push(DVec3::new(r * sin, y, r * cos));
        }
    }

    let last = profile.len() - 1;
    for lower in 0..last {
        add_band(&mut mesh, [lower, lower + 1].map(|i| (starts[i], counts[i])));
    }
    if is_closed {
        add_band(&mut mesh, [last, 0].map(|i| (starts[i], counts[i])));
    }
    Ok(mesh)
}

/// Joins two rings, given by first vertex and count, with a band of triangles.
///
/// Each triangle uses the next edge of the ring whose next edge has its midpoint first. That makes the band
/// symmetric about every plane of symmetry common to the two rings.
fn add_band(mesh: &mut Mesh, [(a, a_count), (b, b_count)]: [(u32, u32); 2]) {
    // a ring of one vertex, on the axis, has no edges
    let edges = |count: u32| if count == 1 { 0 } else { count };
    let (a_edges, b_edges) = (edges(a_count), edges(b_count));
    let (mut i, mut j) = (0, 0);
    while i < a_edges || j < b_edges {
        let at = [a + i % a_count, b + j % b_count];
        let a_middle = u64::from(2 * i + 1) * u64::from(b_count);
        let b_middle = u64::from(2 * j + 1) * u64::from(a_count);
        if j == b_edges || (i < a_edges && a_middle <= b_middle) {
            i += 1;
            mesh.triangles.push([at[0], a + i % a_count, at[1]]);
        } else {
            j += 1;
            mesh.triangles.push([at[0], b + j % b_count, at[1]]);
        }
    }
}

/// Completes a profile from its lower half: a straight line and the mirror image.
fn mirrored(
    shape: &'static str,
    mut lower: Vec<Point>,
    spacing: f64,
) -> Result<Vec<Point>, PrimitiveError> {
    let half = lower.len();
    let [r, y] = lower[half - 1];
    let n = parts(shape, -2.0 * y, spacing)?;
    lower.extend((1..n).map(|i| [r, y * (f64::from(n) - 2.0 * f64::from(i)) / f64::from(n)]));
    for i in (0..half).rev() {
        let [r, y] = lower[i];
        lower.push([r, -y]);
    }
    Ok(lower)
}

/// The lower part of a circle at height `centre`, from its pole to the angle `end` from it.
fn lower_arc(
    shape: &'static str,
    centre: f64,
    radius: f64,
    end: f64,
    spacing: f64,
) -> Result<Vec<Point>, PrimitiveError> {
    let n = parts(shape, end * radius, spacing)?;
    let mut points = vec![[0.0, centre - radius]];
    points.extend((1..=n).map(|i| {
        let (sin, cos) = libm::sincos(end * f64::from(i) / f64::from(n));
        [radius * sin, centre - radius * cos]
    }));
    Ok(points)
}

/// A cylinder around y.
pub(super) fn cylinder(radius: f64, height: f64, segments: u32) -> Result<Mesh, PrimitiveError> {
    let shape = "cylinder";
    let spacing = spacing_of(segments, radius);
    let n = parts(shape, radius, spacing)?;
    let cap =
        (0..=n).map(|i| [radius * f64::from(i) / f64::from(n), -0.5 * height]).collect::<Vec<_>>();
    revolve(shape, &mirrored(shape, cap, spacing)?, spacing, false)
}

/// A cylinder around y, of length `height`, with hemispheres at its ends.
pub(super) fn capsule(radius: f64, height: f64, segments: u32) -> Result<Mesh, PrimitiveError> {
    let shape = "capsule";
    let spacing = spacing_of(segments, radius);
    let mut cap = lower_arc(shape, -0.5 * height, radius, FRAC_PI_2, spacing)?;
    if let Some(rim) = cap.last_mut() {
        // the cosine of π/2 is not zero in doubles
        *rim = [radius, -0.5 * height];
    }
    revolve(shape, &mirrored(shape, cap, spacing)?, spacing, false)
}

/// A torus around y.
pub(super) fn torus(radius: f64, tube_radius: f64, segments: u32) -> Result<Mesh, PrimitiveError> {
    let shape = "torus";
    let spacing = spacing_of(segments, radius + tube_radius);
    let n = parts(shape, TAU * tube_radius, spacing)?.max(6);
    let profile: Vec<Point> = (0..n)
        .map(|i| {
            let (sin, cos) = libm::sincos(TAU * f64::from(i) / f64::from(n));
            [radius + tube_radius * cos, tube_radius * sin]
        })
        .collect();
    revolve(shape, &profile, spacing, true)
}

/// A tube around y with inner radii `[bottom, top]` at its ends.
///
/// All rings have the same number of vertices, so that the inner and the outer surface cannot intersect, however thin
/// the wall.
pub(super) fn tube(
    [bottom, top]: [f64; 2],
    height: f64,
    thickness: f64,
    segments: u32,
) -> Result<Mesh, PrimitiveError> {
    let shape = "tube";
    let widest = bottom.max(top) + thickness;
    let spacing = spacing_of(segments, widest);
    // the shift that puts the centre of mass of a conical wall at the origin: ∫ r y dA = 0
    let middle = |radius: f64| radius + 0.5 * thickness;
    let rise = height * (middle(top) - middle(bottom)) / (6.0 * (middle(top) + middle(bottom)));
    let (low, high) = (-0.5 * height - rise, 0.5 * height - rise);
    let corners = [[bottom + thickness, low], [top + thickness, high], [top, high], [bottom, low]];
    let mut profile = Vec::new();
    for (i, &[r, y]) in corners.iter().enumerate() {
        let [next_r, next_y] = corners[(i + 1) % 4];
        let n = parts(shape, libm::hypot(next_r - r, next_y - y), spacing)?;
        profile.extend((0..n).map(|k| {
            let part = f64::from(k) / f64::from(n);
            [r + (next_r - r) * part, y + (next_y - y) * part]
        }));
    }
    let counts = vec![ring_count(widest, spacing); profile.len()];
    revolve_rings(shape, &profile, &counts, true)
}

/// Two spheres joined by a bar along x.
pub(super) fn dumbbell(
    radius: f64,
    length: f64,
    bar_radius: f64,
    segments: u32,
) -> Result<Mesh, PrimitiveError> {
    let shape = "dumbbell";
    let spacing = spacing_of(segments, radius);
    // from the outer pole to the circle where the sphere meets the bar
    let end = PI - libm::asin(bar_radius / radius);
    let mut cap = lower_arc(shape, -0.5 * length, radius, end, spacing)?;
    if let Some(rim) = cap.last_mut() {
        let height = ((radius - bar_radius) * (radius + bar_radius)).sqrt();
        *rim = [bar_radius, height - 0.5 * length];
    }
    let mut mesh = revolve(shape, &mirrored(shape, cap, spacing)?, spacing, false)?;
    // a cyclic permutation of the axes maps y to x and keeps the winding
    for v in &mut mesh.vertices {
        *v = DVec3::new(v.y, v.z, v.x);
    }
    Ok(mesh)
}
