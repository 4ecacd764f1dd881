//! Choice of the view that shows the walls and the whole motion.

use super::camera::{Camera, Viewport};
use super::input::{PictureInput, View};
use super::surface;
use glam::DVec3;

/// Candidate yaw angles of the default view (rad).
const YAWS: [f64; 4] = [0.55, -0.55, 1.02, -1.02];
/// Pitch of the default view (rad).
const PITCH: f64 = 0.38;
/// A later candidate replaces an earlier one only if it is better by this factor, so that small
/// changes of the motion rarely change the view.
const MIN_IMPROVEMENT: f64 = 1.12;

/// A camera for the given view, or for the best candidate if there is none. `radii` are the
/// bounding radii of the bodies (m).
pub(super) fn fit_camera(
    input: &PictureInput,
    radii: &[f64],
    up: DVec3,
    view: Option<View>,
    viewport: Viewport,
) -> Camera {
    let (points, centres) = sample_motion(input, radii, up);
    match view {
        Some(view) => Camera::fit(&points, up, view, viewport),
        None => best_camera(&points, &centres, up, viewport),
    }
}

/// Points that must be visible, and a sparse sample of the positions of bodies (m).
fn sample_motion(input: &PictureInput, radii: &[f64], up: DVec3) -> (Vec<DVec3>, Vec<DVec3>) {
    let mut points: Vec<DVec3> = input.boundary.iter().flat_map(surface::corners).collect();
    let mut centres = Vec::new();
    let stride = (input.frames.len() * radii.len() / 100_000).max(1);
    let sparse_stride = (input.frames.len() * radii.len() / 300).max(1);
    let last = input.frames.len().saturating_sub(1);
    for (index, frame) in input.frames.iter().enumerate() {
        if !index.is_multiple_of(stride) && index != last {
            continue;
        }
        for (body, &radius) in radii.iter().enumerate() {
            let Some(pose) = frame.drawable_pose(body) else { continue };
            let (u, v) = up.any_orthonormal_pair();
            let directions = [u, -u, v, -v, up, -up];
            points.extend(directions.map(|direction| pose.position + direction * radius));
            if (index * radii.len() + body).is_multiple_of(sparse_stride) {
                centres.push(pose.position);
            }
        }
    }
    (points, centres)
}

/// The candidate in which the motion spreads out the most.
fn best_camera(points: &[DVec3], centres: &[DVec3], up: DVec3, viewport: Viewport) -> Camera {
    let cameras =
        YAWS.map(|yaw| Camera::fit(points, up, View { yaw, pitch: PITCH, zoom: 1.0 }, viewport));
    let spread = |camera: &Camera| {
        let projected: Vec<_> = centres.iter().filter_map(|&c| camera.project(c)).collect();
        let distances = projected.iter().enumerate().flat_map(|(i, a)| {
            projected[i + 1..].iter().map(move |b| f64::from((a.x - b.x).hypot(a.y - b.y)))
        });
        distances.sum::<f64>()
    };
    let spreads = cameras.each_ref().map(spread);
    let mut best = 0;
    for candidate in 1..cameras.len() {
        if spreads[candidate] > spreads[best] * MIN_IMPROVEMENT {
            best = candidate;
        }
    }
    cameras[best].clone()
}
