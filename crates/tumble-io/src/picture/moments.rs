//! Which times a picture shows.

use super::Frame;

/// At most so many times in one picture.
const MOST: usize = 8;

/// Frames to show, in the order of time: the first, the last, and evenly spaced ones between them
/// unless the bodies would stand in each other's way.
pub(super) fn choose(frames: &[Frame], radii: &[f64], scale: f64) -> Vec<usize> {
    let usable: Vec<usize> = (0..frames.len())
        .filter(|&f| {
            frames[f].time.is_finite() && (0..radii.len()).any(|b| frames[f].pose(b).is_some())
        })
        .collect();
    let (Some(&first), Some(&last)) = (usable.first(), usable.last()) else { return Vec::new() };
    if first == last {
        return vec![last];
    }
    let mut chosen = vec![first, last];
    // later ones first: the end of a motion at rest would otherwise hide under its own past
    for step in (1..count(radii, scale)).rev() {
        let part = step as f64 / count(radii, scale) as f64;
        let time = frames[first].time + part * (frames[last].time - frames[first].time);
        let nearest = nearest(frames, &usable, time);
        if chosen.iter().all(|&other| apart(&frames[nearest], &frames[other], radii, scale)) {
            chosen.push(nearest);
        }
    }
    chosen.sort_unstable();
    chosen
}

/// How many spans the time is cut into: the fewer, the more of the picture a body fills.
fn count(radii: &[f64], scale: f64) -> usize {
    let bodies = radii.len().max(1);
    let size: f64 = radii.iter().map(|r| (r / scale) * (r / scale)).sum();
    let room = (0.75 / size.max(1e-9)) as usize;
    let crowd = match bodies {
        1 => MOST - 1,
        2 | 3 => 5,
        4..=8 => 3,
        _ => 1,
    };
    crowd.min(room).max(1)
}

fn nearest(frames: &[Frame], usable: &[usize], time: f64) -> usize {
    let distance = |f: &&usize| (frames[**f].time - time).abs();
    usable.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or(0)
}

/// Whether most bodies moved by about their own size between two frames.
fn apart(a: &Frame, b: &Frame, radii: &[f64], scale: f64) -> bool {
    let moved = |body: usize| {
        let (Some(a), Some(b)) = (a.pose(body), b.pose(body)) else { return true };
        a.position.distance(b.position) > radii[body].max(0.012 * scale) * 0.9
    };
    let count = (0..radii.len()).filter(|&body| moved(body)).count();
    2 * count > radii.len()
}
