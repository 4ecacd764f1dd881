//! How large a scene the viewer accepts.

use std::collections::BTreeSet;
use std::sync::Arc;

use tumble::World;

/// Frames of more bodies would be too large to send sixty times a second.
const MAX_BODIES: usize = 20_000;
/// Most vertices, triangles and particles of all distinct shapes together.
const MAX_POINTS: usize = 8_000_000;

/// Checks that a browser page can show the world.
///
/// # Errors
/// Which limit the world exceeds.
pub fn check_capacity(world: &World) -> Result<(), String> {
    let count = world.body_count();
    if count > MAX_BODIES {
        return Err(format!(
            "the viewer shows at most {MAX_BODIES} bodies, but the scene has {count}; \
             use fewer `copies`, or use `tumble run`"
        ));
    }
    let mut counted = BTreeSet::new();
    let mut points = 0;
    for body in world.bodies() {
        let shape = &body.model().shape;
        // bodies of the same geometry share one shape, which is sent once
        if counted.insert(Arc::as_ptr(shape)) {
            let surface = shape.surface();
            points += surface.vertices.len() + surface.triangles.len() + shape.particles().len();
        }
    }
    if points > MAX_POINTS {
        return Err(format!(
            "the viewer shows at most {MAX_POINTS} vertices, triangles and particles, but the shapes \
             have {points}; use coarser shapes, or use `tumble run`"
        ));
    }
    Ok(())
}
