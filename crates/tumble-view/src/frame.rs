//! One moment, as pages get it: little-endian numbers, the ledger first, then every body.

use tumble::World;

use crate::Session;

/// Bytes before the bodies: time, step and the eight columns of the ledger, as doubles.
const START: usize = 80;
/// Bytes of one body: 22 floats.
const BODY: usize = 88;

/// The record of the session's present moment; see `docs/formats.md`.
pub fn record(session: &Session) -> Vec<u8> {
    let world = session.world();
    let mut record = Vec::with_capacity(START + BODY * world.body_count());
    let (energy, residual) = session.ledger();
    let doubles = [
        world.time(),
        world.state().step as f64,
        energy.kinetic,
        energy.gravitational,
        energy.elastic,
        energy.drag,
        energy.dashpot,
        energy.slip,
        energy.total(),
        residual,
    ];
    doubles.iter().for_each(|x| record.extend(x.to_le_bytes()));
    (0..world.body_count()).for_each(|index| body(world, index, &mut record));
    record
}

fn body(world: &World, index: usize, record: &mut Vec<u8>) {
    let body = world.body(index);
    let contact = world.contact_wrench(index);
    let q = body.orientation();
    let mut put = |numbers: &[f64]| {
        numbers.iter().for_each(|&x| record.extend((x as f32).to_le_bytes()));
    };
    put(&body.position().to_array());
    put(&[q.w, q.x, q.y, q.z]);
    for vector in [
        body.velocity(),
        body.angular_velocity(),
        body.angular_momentum(),
        contact.force,
        contact.torque,
    ] {
        put(&vector.to_array());
    }
}

/// Whether a page could draw the present moment: after a failed step it may be beyond numbers.
pub fn is_drawable(world: &World) -> bool {
    world.bodies().all(|body| body.position().is_finite() && body.orientation().is_finite())
}
