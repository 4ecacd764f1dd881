//! One frame, as it is sent to pages.

use tumble::World;
use tumble_io::page::{WorldFrame, encode_frame};
use tumble_io::run::energy_row;

use crate::Session;

/// The session's present state as a binary record, in the format of the frames of `motion.html`.
pub fn record(session: &Session) -> Vec<u8> {
    let world = session.world();
    let row = energy_row(world.time(), &world.energy(), session.reference_energy());
    let mut record = Vec::new();
    encode_frame(&mut record, world.state().step, &row, &WorldFrame::new(world));
    record
}

/// Whether all positions and orientations are finite; after a failed step they may not be.
pub fn is_drawable(world: &World) -> bool {
    world.bodies().all(|body| body.position().is_finite() && body.orientation().is_finite())
}
