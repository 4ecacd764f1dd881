//! Intersection of rays with a surface: whether a segment crosses it, and the thickness of the solid.

use glam::DVec3;

use super::tree::{Ray, Tree};
use super::triangle::Frame;

/// Tolerance outside a triangle in units of its longest edge, so that no line passes between two triangles.
const TOLERANCE: f64 = 1e-12;
/// The maximum number of triangles at which [`thickness`] is sampled.
const SAMPLE: usize = 512;
/// The quantiles that [`thickness`] returns, by area.
const QUANTILES: [f64; 2] = [0.05, 0.5];
/// Smaller depths, in units of the size, are ignored: they belong to parts that touch.
const TOUCHING: f64 = 1e-9;

/// The parameter in 0..1 at which the segment between two points crosses a triangle.
fn crossing(frame: &Frame, from: DVec3, to: DVec3) -> Option<f64> {
    let (start, end) = (frame.local(from), frame.local(to));
    // a point on the plane counts as in front of it
    if (start.z >= 0.0) == (end.z >= 0.0) {
        return None;
    }
    let part = start.z / (start.z - end.z);
    let place = start + (end - start) * part;
    frame.covers(place.x, place.y, TOLERANCE * frame.length).then_some(part)
}

/// Whether the segment between two points crosses a triangle.
pub(super) fn intersects_segment(tree: &Tree, from: DVec3, to: DVec3) -> bool {
    let mut found = false;
    tree.along_ray(&Ray { from, along: to - from, part: [0.0, 1.0] }, |_, frame| {
        found |= crossing(frame, from, to).is_some();
        if found { -1.0 } else { 1.0 }
    });
    found
}

/// The depth (m) of the solid below the centroid of a face, along the inward normal.
fn depth_below(tree: &Tree, slot: usize, size: f64) -> Option<f64> {
    let own = tree.frame(slot);
    let [a, b, c] = own.corners();
    let from = a + (b - a) / 3.0 + (c - a) / 3.0;
    depth_along(tree, (from, own.normal), Some(slot), size)
}

/// The depth (m) of the solid below a point of its surface, against the `outward` direction.
pub(super) fn depth_along(
    tree: &Tree,
    (from, outward): (DVec3, DVec3),
    own: Option<usize>,
    size: f64,
) -> Option<f64> {
    // longer than the diagonal of the box
    let length = 2.0 * size;
    let to = from - outward * length;
    let mut nearest = f64::INFINITY;
    let ray = Ray { from, along: to - from, part: [TOUCHING, 1.0] };
    tree.along_ray(&ray, |other, frame| {
        if Some(other) != own
            && frame.normal.dot(outward) < 0.0
            && let Some(part) = crossing(frame, from, to)
            && part * length > TOUCHING * size
        {
            nearest = nearest.min(part);
        }
        nearest
    });
    (nearest <= 1.0).then_some(nearest * length)
}

/// The thickness of the solid (m): the 5 % quantile and the median of the depth below the surface, by area.
pub(super) fn thickness(tree: &Tree, sides: DVec3) -> [f64; 2] {
    let size = sides.max_element();
    let mut depths: Vec<(f64, f64)> = sample(tree)
        .into_iter()
        .filter_map(|(slot, area)| Some((depth_below(tree, slot, size)?, area)))
        .collect();
    depths.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let all = depths.iter().map(|(_, area)| area).sum::<f64>();
    QUANTILES.map(|quantile| {
        let mut area = 0.0;
        let found = depths.iter().find(|(_, part)| {
            area += part;
            area >= quantile * all
        });
        found.map_or(sides.min_element(), |(depth, _)| *depth)
    })
}

/// Slots with the area (m²) that each represents: all, or [`SAMPLE`] of them spread evenly by area.
fn sample(tree: &Tree) -> Vec<(usize, f64)> {
    let mut all = Vec::with_capacity(tree.count());
    let mut total = 0.0;
    tree.each_slot(|slot, _| {
        let area = tree.frame(slot).area();
        total += area;
        all.push((slot, area));
    });
    if all.len() <= SAMPLE {
        return all;
    }
    let share = total / SAMPLE as f64;
    let mut chosen = Vec::with_capacity(SAMPLE);
    let (mut sum, mut given) = (0.0, 0.0);
    for (slot, area) in all {
        sum += area;
        // a large face may represent several shares
        let due = (sum / share + 0.5).floor() - given;
        if due >= 1.0 {
            chosen.push((slot, due * share));
            given += due;
        }
    }
    chosen
}
