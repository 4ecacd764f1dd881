//! What a page needs to know before the first frame.

use std::collections::BTreeSet;
use std::sync::Arc;

use tumble::World;
use tumble_io::page::Head;

use crate::Session;
use crate::parameters::parameters;

/// More bodies than this would make frames too large to be sent sixty times a second.
const MOST_BODIES: usize = 20_000;
/// More vertices, triangles and particles than this in all shapes together are more than a page can bear.
const MOST_POINTS: usize = 8_000_000;

/// The head of a live session as JSON, as in `motion.html` but for what can be changed.
pub fn json(session: &Session) -> String {
    let mut head = Head::of(session.scene(), session.world());
    head.live = true;
    head.parameters = parameters(session.next_scene());
    head.to_json()
}

/// Whether a page could bear it.
///
/// # Errors
/// What there is too much of.
pub fn can_be_shown(world: &World) -> Result<(), String> {
    let count = world.body_count();
    if count > MOST_BODIES {
        return Err(format!(
            "the viewer shows at most {MOST_BODIES} bodies, the scene has {count}; \
             take fewer `copies`, or use `tumble run`"
        ));
    }
    let mut known = BTreeSet::new();
    let mut points = 0;
    for body in world.bodies() {
        let shape = &body.model().shape;
        // bodies that look alike share their shape
        if known.insert(Arc::as_ptr(shape)) {
            let surface = shape.surface();
            points += surface.vertices.len() + surface.triangles.len() + shape.particles().len();
        }
    }
    if points > MOST_POINTS {
        return Err(format!(
            "the viewer shows at most {MOST_POINTS} vertices, triangles and particles, the shapes \
             have {points}; take coarser shapes, or use `tumble run`"
        ));
    }
    Ok(())
}
