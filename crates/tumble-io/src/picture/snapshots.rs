//! Choice of the times that a picture shows.

use super::body_mesh::{BodyMesh, MIN_PIXEL_RADIUS};
use super::camera::Camera;
use super::input::Frame;

/// Smallest distance between two snapshots of a body, relative to its size in the picture.
const MIN_SEPARATION: f32 = 1.2;

/// A frame shown in a picture, and how strongly it is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Snapshot {
    /// Index of the frame.
    pub frame: usize,
    /// Blend towards the background, from 0 (full colour) to 1 (background).
    pub fade: f32,
    pub alpha: u8,
}

/// Frames to show, in order of time: the first, the last, and as many evenly spaced ones between
/// them as fit without overlap of the bodies.
///
/// If uneven spacing fits clearly more frames, as for a motion that comes to rest, the times are spaced unevenly.
pub(super) fn select_frames(frames: &[Frame], bodies: &[BodyMesh], camera: &Camera) -> Vec<usize> {
    let usable: Vec<usize> = (0..frames.len())
        .filter(|&f| {
            let has_pose = |body| frames[f].drawable_pose(body).is_some();
            frames[f].time.is_finite() && (0..bodies.len()).any(has_pose)
        })
        .collect();
    let (Some(&first), Some(&last)) = (usable.first(), usable.last()) else { return Vec::new() };
    if first == last {
        return vec![last];
    }
    let separated = |a: usize, b: usize| are_separated(&frames[a], &frames[b], bodies, camera);
    let duration = frames[last].time - frames[first].time;
    let evenly_spaced = |intervals: usize| -> Vec<usize> {
        let time = |step: usize| frames[first].time + duration * step as f64 / intervals as f64;
        let between = (1..intervals).map(|step| nearest_frame(frames, &usable, time(step)));
        [first].into_iter().chain(between).chain([last]).collect()
    };
    let max = max_intervals(bodies.len());
    let even = (1..=max).rev().map(evenly_spaced).find(|selected| {
        let mut pairs = (0..selected.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        pairs.all(|(i, j)| (i, j) == (selected.len() - 1, 0) || separated(selected[i], selected[j]))
    });
    let even = even.unwrap_or_else(|| vec![first, last]);
    let mut uneven = vec![first, last];
    for &frame in &evenly_spaced(max)[1..max] {
        if uneven.iter().all(|&other| separated(frame, other)) {
            uneven.push(frame);
        }
    }
    let prefer_uneven = uneven.len() > even.len() + usize::from(even.len() > 3);
    let mut selected = if prefer_uneven { uneven } else { even };
    selected.sort_unstable();
    selected.dedup();
    selected
}

/// Largest number of intervals between snapshots. Many bodies allow few snapshots.
fn max_intervals(bodies: usize) -> usize {
    match bodies {
        0 | 1 => 7,
        2 | 3 => 5,
        4..=8 => 3,
        _ => 1,
    }
}

fn nearest_frame(frames: &[Frame], usable: &[usize], time: f64) -> usize {
    let distance = |f: &&usize| (frames[**f].time - time).abs();
    usable.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or(0)
}

/// Whether more than half of the bodies move by about their own size in the picture between two frames.
fn are_separated(a: &Frame, b: &Frame, bodies: &[BodyMesh], camera: &Camera) -> bool {
    let has_moved = |body: usize| {
        let project = |frame: &Frame| camera.project(frame.drawable_pose(body)?.position);
        let (Some(a), Some(b)) = (project(a), project(b)) else { return true };
        let size = camera.length_in_pixels(bodies[body].rms_radius, a).max(1.5 * MIN_PIXEL_RADIUS);
        (a.x - b.x).hypot(a.y - b.y) > MIN_SEPARATION * size
    };
    let count = (0..bodies.len()).filter(|&body| has_moved(body)).count();
    2 * count > bodies.len()
}
