//! The scene as it is now, to go on from.

use tumble::World;
use tumble_io::scene::{BodyScene, Scene};

use crate::setting::load;

/// The scene as TOML, with every body where it is and as fast as it is now, copies one by one.
///
/// What a scene cannot say is lost: friction springs hold anew from where particles are, and the ledger
/// starts again.
///
/// # Errors
/// Why a run could not start from it.
pub fn to_toml(scene: &Scene, world: &World) -> Result<String, String> {
    let mut bodies = world.bodies();
    let mut saved = scene.clone();
    saved.bodies = Vec::with_capacity(world.body_count());
    for body in &scene.bodies {
        for name in body.names() {
            let Some(now) = bodies.next() else { break };
            saved.bodies.push(BodyScene {
                name,
                position: Some(now.position()),
                orientation: now.orientation(),
                initial_velocity: now.velocity(),
                initial_angular_velocity: now.angular_velocity(),
                copies: None,
                ..body.clone()
            });
        }
    }
    let text = saved.to_toml();
    let scene_text = text.split_once('\n').map_or("", |(_, rest)| rest);
    let time = world.time();
    let text = format!("# The scene \"{}\" as it was at t = {time} s.\n{scene_text}", scene.name);
    load(scene, text.clone(), Vec::new())
        .map_err(|why| format!("a run could not start from here: {why}"))?;
    Ok(text)
}
