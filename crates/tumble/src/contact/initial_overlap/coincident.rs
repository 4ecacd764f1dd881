//! Overlaps that contact detection would miss, or whose neighbour lists would be too large.
//!
//! Contact sees particles and what they touch. Bodies at the same place may have no particle inside each other, and many such
//! bodies have so many pairs that their lists would fill the memory. So these are found first.

use std::cmp::Ordering;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::overlap::{MAX_INTENDED_DEPTH, MAX_NAMED, Overlap};
use crate::contact::broad_phase::{Ball, Grid};
use crate::contact::pair::{feature_size, thickness};
use crate::{BodyModel, BodyState, Model, State, Surface};

/// More bodies than this with their centres within one feature size is treated as a mistake.
const MAX_CLUSTER: usize = 1000;

fn is_deep(model: &Model, Overlap { first, second, depth }: Overlap) -> bool {
    let size = |body: u32| feature_size(&model.bodies[body as usize]);
    depth > MAX_INTENDED_DEPTH * size(first).min(size(second))
}

/// Bodies of one shape at exactly one position and orientation, each paired with the next of them; and neighbours within
/// clusters of bodies.
pub(super) fn coincident_bodies(model: &Model, state: &State) -> Vec<Overlap> {
    let has_surface = |&body: &usize| model.bodies[body].surface != Surface::None;
    let mut order: Vec<usize> = (0..model.bodies.len()).filter(has_surface).collect();
    let pose = |body: &BodyState| {
        let ([x, y, z], [a, b, c, d]) = (body.position.to_array(), body.orientation.to_array());
        // adding zero turns -0 into 0
        [x, y, z, a, b, c, d].map(|number| number + 0.0)
    };
    let compare = |&a: &usize, &b: &usize| {
        let poses = pose(&state.bodies[a]).into_iter().zip(pose(&state.bodies[b]));
        let by_pose = poses.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne());
        let shape = |body: usize| Arc::as_ptr(&model.bodies[body].shape);
        by_pose.unwrap_or(Ordering::Equal).then_with(|| shape(a).cmp(&shape(b)))
    };
    order.sort_by(compare);
    let pairs = order.windows(2).filter(|pair| {
        let [a, b] = [&model.bodies[pair[0]], &model.bodies[pair[1]]];
        compare(&pair[0], &pair[1]).is_eq()
            && a.surface == b.surface
            && (a.is_free() || b.is_free())
    });
    let overlap = |pair: &[usize]| {
        let depth = thickness(&model.bodies[pair[0]]);
        Overlap { first: pair[0] as u32, second: pair[1] as u32, depth }
    };
    let mut overlaps: Vec<Overlap> = pairs.map(overlap).collect();
    for cluster in clusters(model, state) {
        overlaps.extend(cluster.windows(2).take(MAX_NAMED).map(overlap));
    }
    overlaps
}

/// Groups of more than [`MAX_CLUSTER`] bodies whose centres are within one cell of their feature size.
fn clusters(model: &Model, state: &State) -> Vec<Vec<usize>> {
    let cell = |index: usize| {
        let size = feature_size(&model.bodies[index]);
        // far from the origin, or for tiny sizes, cells are as coarse as the numbers are
        (state.bodies[index].position / size).to_array().map(|x| x.floor() as i64)
    };
    let has_surface = |&body: &usize| model.bodies[body].surface != Surface::None;
    let bodies = (0..model.bodies.len()).filter(has_surface);
    let mut cells: Vec<_> = bodies.map(|i| (cell(i), i)).collect();
    cells.sort_unstable();
    let clusters = cells.chunk_by(|a, b| a.0 == b.0).filter(|cell| cell.len() > MAX_CLUSTER);
    clusters.map(|cell| cell.iter().map(|&(_, index)| index).collect()).collect()
}

/// Bodies with meshes where the centre of mass of one is inside both.
pub(super) fn containing_centres(model: &Model, state: &State) -> Vec<Overlap> {
    let balls = model.bodies.iter().zip(&state.bodies).map(|(body, state)| Ball {
        centre: state.position,
        radius: body.extent,
        active: body.is_free(),
    });
    let balls: Vec<_> = balls.collect();
    // depth of each centre of mass in its own body
    let own_depth = |body: &Arc<BodyModel>| depth(body, DVec3::ZERO);
    let own_depths: Vec<_> = model.bodies.iter().map(own_depth).collect();
    let common_depth = |centre: u32, other: u32| {
        if own_depths[centre as usize] <= 0.0 {
            return 0.0;
        }
        let [a, b] = [centre, other].map(|body| &state.bodies[body as usize]);
        let local = DMat3::from_quat(b.orientation).transpose() * (a.position - b.position);
        depth(&model.bodies[other as usize], local).min(own_depths[centre as usize])
    };
    let mut grid = Grid::default();
    let pairs = grid.pairs(&balls).iter();
    let overlaps = pairs.map(|&[a, b]| {
        let depth = common_depth(a, b).max(common_depth(b, a));
        Overlap { first: a, second: b, depth }
    });
    overlaps.filter(|&overlap| is_deep(model, overlap)).take(MAX_NAMED).collect()
}

/// Depth of a point of the body frame inside the mesh of the body (m); 0 outside.
fn depth(body: &BodyModel, point: DVec3) -> f64 {
    let nearest = body.signed_distance.as_ref().and_then(|distance| distance.query(point, 0, 0.0));
    nearest.map_or(0.0, |nearest| -nearest.distance)
}
