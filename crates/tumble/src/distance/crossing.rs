//! What a straight line meets of a surface: whether a segment passes through it, and how thick the solid is.

use glam::DVec3;

use super::tree::{Ray, Tree};
use super::triangle::Frame;

/// How far beside a triangle a line still meets it, in units of its longest side: no line slips between two.
const BESIDE: f64 = 1e-12;
/// How many triangles [`thickness`] asks at most.
const SAMPLE: usize = 512;
/// The part of the surface that is thinner than [`thickness`].
const THIN_PART: f64 = 0.05;
/// Nothing is thinner than this, in units of the size: parts that touch are not thin.
const TOUCHING: f64 = 1e-9;

/// Where a line from one point of a frame to another crosses the triangle, as a part of the way.
fn crossing(frame: &Frame, from: DVec3, to: DVec3) -> Option<f64> {
    let (start, end) = (frame.local(from), frame.local(to));
    // a point on the plane counts as before it
    if (start.z >= 0.0) == (end.z >= 0.0) {
        return None;
    }
    let part = start.z / (start.z - end.z);
    let place = start + (end - start) * part;
    frame.covers(place.x, place.y, BESIDE * frame.length).then_some(part)
}

/// Whether the segment between two points crosses a triangle.
pub(super) fn passes_through(tree: &Tree, from: DVec3, to: DVec3) -> bool {
    let mut found = false;
    tree.along_ray(&Ray { from, along: to - from, part: [0.0, 1.0] }, |_, frame| {
        found |= crossing(frame, from, to).is_some();
        if found { -1.0 } else { 1.0 }
    });
    found
}

/// How far it is from the middle of a face straight inwards to where one leaves the solid (m), at most `most`.
fn depth_under(tree: &Tree, slot: usize, size: f64) -> Option<f64> {
    let own = tree.frame(slot);
    let [a, b, c] = own.corners();
    let from = a + (b - a) / 3.0 + (c - a) / 3.0;
    // no solid is deeper than the diagonal of its box
    let reach = 2.0 * size;
    let to = from - own.normal * reach;
    let mut nearest = f64::INFINITY;
    let ray = Ray { from, along: to - from, part: [TOUCHING, 1.0] };
    tree.along_ray(&ray, |other, frame| {
        if other != slot
            && frame.normal.dot(own.normal) < 0.0
            && let Some(part) = crossing(frame, from, to)
            && part * reach > TOUCHING * size
        {
            nearest = nearest.min(part);
        }
        nearest
    });
    (nearest <= 1.0).then_some(nearest * reach)
}

/// The thickness (m) that all but a twentieth of the surface, by area, exceeds.
pub(super) fn thickness(tree: &Tree, sides: DVec3) -> f64 {
    let size = sides.max_element();
    let mut depths: Vec<(f64, f64)> = sample(tree)
        .into_iter()
        .filter_map(|(slot, area)| Some((depth_under(tree, slot, size)?, area)))
        .collect();
    depths.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let enough = THIN_PART * depths.iter().map(|(_, area)| area).sum::<f64>();
    let mut area = 0.0;
    for &(depth, part) in &depths {
        area += part;
        if area >= enough {
            return depth;
        }
    }
    sides.min_element()
}

/// Slots with the area (m²) that each stands for: all of them, or as many as are asked, spread evenly by area.
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
        // a large face may stand for many shares
        let due = (sum / share + 0.5).floor() - given;
        if due >= 1.0 {
            chosen.push((slot, due * share));
            given += due;
        }
    }
    chosen
}
