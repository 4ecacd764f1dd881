//! Loads: given forces and torques.

use crate::{Batch, BodyView, Wrench};

/// Sets the loads on every body, at the middle of a step of length `h` (s).
pub fn load(batch: &mut Batch, h: f64) {
    let Batch { model, time, first, bodies, forces, .. } = batch;
    if model.loads.is_empty() {
        return;
    }
    let bodies = model.bodies[*first..].iter().zip(&**bodies).zip(&model.names[*first..]);
    for ((index, ((body, state), name)), forces) in (*first..).zip(bodies).zip(&mut **forces) {
        [forces.load, forces.central_gravity] = if body.is_free() {
            let view = BodyView::new(name, body, state);
            model.loads.wrenches(index, &view, *time + 0.5 * h)
        } else {
            [Wrench::default(); 2]
        };
    }
}
