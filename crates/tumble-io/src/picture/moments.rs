//! Which times a picture shows.

use super::Frame;
use super::camera::Camera;
use super::figure::{Figure, LEAST_RADIUS};

/// Bodies that stand nearer than so many times their spread in the picture hide one another.
const GAP: f32 = 1.2;

/// Frames to show, in the order of time: the first, the last, and evenly spaced ones between them
/// as long as the bodies do not stand in their own way.
pub(super) fn choose(frames: &[Frame], figures: &[Figure], camera: &Camera) -> Vec<usize> {
    let usable: Vec<usize> = (0..frames.len())
        .filter(|&f| {
            frames[f].time.is_finite() && (0..figures.len()).any(|b| frames[f].pose(b).is_some())
        })
        .collect();
    let (Some(&first), Some(&last)) = (usable.first(), usable.last()) else { return Vec::new() };
    if first == last {
        return vec![last];
    }
    let apart = |a: usize, b: usize| apart(&frames[a], &frames[b], figures, camera);
    let span = frames[last].time - frames[first].time;
    let spaced = |spans: usize| -> Vec<usize> {
        let time = |step: usize| frames[first].time + span * step as f64 / spans as f64;
        let between = (1..spans).map(|step| nearest(frames, &usable, time(step)));
        [first].into_iter().chain(between).chain([last]).collect()
    };
    let most = most_spans(figures.len());
    // without gaps in time, as many as find room
    let even = (1..=most).rev().map(spaced).find(|chosen| {
        let pairs = (0..chosen.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        pairs
            .into_iter()
            .all(|(i, j)| (i, j) == (chosen.len() - 1, 0) || apart(chosen[i], chosen[j]))
    });
    let even = even.unwrap_or_else(|| vec![first, last]);
    // a motion that comes to rest: drop what would hide its end
    let mut uneven = vec![first, last];
    for &frame in &spaced(most)[1..most] {
        if uneven.iter().all(|&other| apart(frame, other)) {
            uneven.push(frame);
        }
    }
    let short_of_times = uneven.len() > even.len() + usize::from(even.len() > 3);
    let mut chosen = if short_of_times { uneven } else { even };
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// How many spans the time is cut into at most.
fn most_spans(bodies: usize) -> usize {
    match bodies {
        0 | 1 => 7,
        2 | 3 => 5,
        4..=8 => 3,
        _ => 1,
    }
}

fn nearest(frames: &[Frame], usable: &[usize], time: f64) -> usize {
    let distance = |f: &&usize| (frames[**f].time - time).abs();
    usable.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or(0)
}

/// Whether most bodies moved by about their own size, as seen, between two frames.
fn apart(a: &Frame, b: &Frame, figures: &[Figure], camera: &Camera) -> bool {
    let moved = |body: usize| {
        let place = |frame: &Frame| camera.project(frame.pose(body)?.position);
        let (Some(a), Some(b)) = (place(a), place(b)) else { return true };
        let size = camera.pixels(figures[body].spread, a).max(1.5 * LEAST_RADIUS);
        (a.x - b.x).hypot(a.y - b.y) > GAP * size
    };
    let count = (0..figures.len()).filter(|&body| moved(body)).count();
    2 * count > figures.len()
}
