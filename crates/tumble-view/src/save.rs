//! The scene as it is now, to go on from.

use tumble::{Prescribed, World};
use tumble_io::scene::{BodyScene, MotionScene, Scene};

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
            let motion = at_phase(body.motion, world.time());
            let is_free = motion == MotionScene::Free;
            saved.bodies.push(BodyScene {
                name,
                motion,
                position: Some(now.position()),
                orientation: now.orientation(),
                // a swing comes on top of what a prescribed body keeps
                initial_velocity: if is_free { now.velocity() } else { body.initial_velocity },
                initial_angular_velocity: if is_free {
                    now.angular_velocity()
                } else {
                    body.initial_angular_velocity
                },
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

/// A motion that goes on from `time` (s) as one that starts there.
fn at_phase(mut motion: MotionScene, time: f64) -> MotionScene {
    if let MotionScene::Prescribed(Prescribed { oscillation: Some(swing), .. }) = &mut motion {
        let turns = (swing.frequency * time).fract();
        swing.phase = (swing.phase + std::f64::consts::TAU * turns) % std::f64::consts::TAU;
    }
    motion
}
