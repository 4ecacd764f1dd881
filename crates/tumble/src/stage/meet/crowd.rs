//! Bodies that start in each other although contact does not say so, or says it too often.
//!
//! Contact knows particles and what they touch. Bodies that were put at one place by mistake may have no particle in each other, and so
//! many pairs that lists of them would fill the memory. So they are looked for first.

use std::cmp::Ordering;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::grid::{Ball, Grid};
use super::list;
use super::start::{DEEP, Overlap};
use crate::{BodyModel, BodyState, Model, State, Surface};

/// So many pairs are named; whoever put more there by mistake did it by one mistake.
pub(super) const MOST: usize = 100;

/// Whether a depth (m) is one that contact alone would not make.
fn is_deep(model: &Model, (first, second, depth): Overlap) -> bool {
    let grain = |body: u32| list::grain(&model.bodies[body as usize]);
    depth > DEEP * grain(first).min(grain(second))
}

/// Bodies of one shape at exactly one place, turned alike: each with the next of them.
pub(super) fn at_one_place(model: &Model, state: &State) -> Vec<Overlap> {
    let solid = |&body: &usize| model.bodies[body].surface != Surface::None;
    let mut order: Vec<usize> = (0..model.bodies.len()).filter(solid).collect();
    let place = |body: &BodyState| {
        let ([x, y, z], [a, b, c, d]) = (body.position.to_array(), body.orientation.to_array());
        // adding zero turns -0 into 0
        [x, y, z, a, b, c, d].map(|number| number + 0.0)
    };
    let compare = |&a: &usize, &b: &usize| {
        let places = place(&state.bodies[a]).into_iter().zip(place(&state.bodies[b]));
        let of_places = places.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne());
        let shape = |body: usize| Arc::as_ptr(&model.bodies[body].shape);
        of_places.unwrap_or(Ordering::Equal).then_with(|| shape(a).cmp(&shape(b)))
    };
    order.sort_by(compare);
    let pairs = order.windows(2).filter(|pair| {
        let [a, b] = [&model.bodies[pair[0]], &model.bodies[pair[1]]];
        compare(&pair[0], &pair[1]).is_eq()
            && a.surface == b.surface
            && (a.is_free() || b.is_free())
    });
    let pair = |pair: &[usize]| (pair[0] as u32, pair[1] as u32, thickness(&model.bodies[pair[0]]));
    let mut found: Vec<Overlap> = pairs.map(pair).collect();
    for crowd in crowds(model, state) {
        found.extend(crowd.windows(2).take(MOST).map(pair));
    }
    found
}

/// More bodies than this with their centres within a tenth of their size have no room there.
const CROWD: usize = 1000;

/// Bodies in crowds, however they are turned: their pairs would fill the memory.
fn crowds(model: &Model, state: &State) -> Vec<Vec<usize>> {
    let cell = |index: usize| {
        let size = list::grain(&model.bodies[index]);
        // far away, or of no size, cells are as coarse as numbers are
        (state.bodies[index].position / size).to_array().map(|x| x.floor() as i64)
    };
    let solid = |&body: &usize| model.bodies[body].surface != Surface::None;
    let mut cells: Vec<_> = (0..model.bodies.len()).filter(solid).map(|i| (cell(i), i)).collect();
    cells.sort_unstable();
    let crowds = cells.chunk_by(|a, b| a.0 == b.0).filter(|cell| cell.len() > CROWD);
    crowds.map(|cell| cell.iter().map(|&(_, index)| index).collect()).collect()
}

/// How thick a body is (m).
fn thickness(body: &BodyModel) -> f64 {
    body.solid.as_ref().map_or(2.0 * list::radius(body), |solid| solid.thickness())
}

/// Bodies with meshes where the centre of mass of the one is within both.
pub(super) fn around_a_centre(model: &Model, state: &State) -> Vec<Overlap> {
    let balls = model.bodies.iter().zip(&state.bodies).map(|(body, state)| Ball {
        centre: state.position,
        reach: body.extent,
        active: body.is_free(),
    });
    let balls: Vec<_> = balls.collect();
    // how deep each centre is in its own body
    let own = |body: &Arc<BodyModel>| depth(body, DVec3::ZERO);
    let own: Vec<_> = model.bodies.iter().map(own).collect();
    let within = |centre: u32, other: u32| {
        if own[centre as usize] <= 0.0 {
            return 0.0;
        }
        let [a, b] = [centre, other].map(|body| &state.bodies[body as usize]);
        let inward = DMat3::from_quat(b.orientation).transpose() * (a.position - b.position);
        depth(&model.bodies[other as usize], inward).min(own[centre as usize])
    };
    let mut grid = Grid::default();
    let pairs = grid.pairs(&balls).iter();
    let overlaps = pairs.map(|&[a, b]| (a, b, within(a, b).max(within(b, a))));
    overlaps.filter(|&overlap| is_deep(model, overlap)).take(MOST).collect()
}

/// How deep a place of its frame is in the mesh of a body (m); 0 outside.
fn depth(body: &BodyModel, place: DVec3) -> f64 {
    let nearest = body.solid.as_ref().and_then(|solid| solid.query(place, 0, 0.0));
    nearest.map_or(0.0, |nearest| -nearest.distance)
}
