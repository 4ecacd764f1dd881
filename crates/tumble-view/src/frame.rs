//! One moment, as pages get it.

use tumble::World;
use tumble_io::page::{BodyFrame, encode_frame};
use tumble_io::run::ledger_row;

use crate::Session;

/// The record of the session's present moment, as in the frames of `motion.html`.
pub fn record(session: &Session) -> Vec<u8> {
    let world = session.world();
    let row = ledger_row(world.time(), &world.energy(), session.baseline());
    let mut record = Vec::new();
    encode_frame(&mut record, world.state().step, &row, BodyFrame::all(world));
    record
}

/// Whether a page could draw the present moment: after a failed step it may be beyond numbers.
pub fn is_drawable(world: &World) -> bool {
    world.bodies().all(|body| body.position().is_finite() && body.orientation().is_finite())
}
