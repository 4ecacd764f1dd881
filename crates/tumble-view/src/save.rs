//! The present state, written as a scene file.

use tumble::{Prescribed, World};
use tumble_io::on_one_line;
use tumble_io::scene::{BodyScene, JointScene, MotionScene, Scene};

use crate::scene_edit::load;

/// The scene as TOML, with the present pose and velocity of every body and copies written one by one.
///
/// Friction springs and the energy ledger cannot be expressed in a scene: a run from the result starts without
/// stretched springs and with an empty ledger.
///
/// # Errors
/// Why a run cannot start from the present state.
pub fn to_toml(scene: &Scene, world: &World) -> Result<String, String> {
    let mut bodies = world.bodies();
    let mut saved = scene.clone();
    let (model, state) = (world.model(), world.state());
    let joints = model.joints.list.iter().enumerate();
    let joints = joints.map(|(index, joint)| joint.description(&model.names, state, index));
    saved.joints = joints.map(|joint| JointScene { joint, chain: None }).collect();
    saved.loads = scene.loads.iter().map(|load| load.clone().from_time(world.time())).collect();
    saved.bodies = Vec::with_capacity(world.body_count());
    for body in &scene.bodies {
        for name in body.names() {
            let Some(state) = bodies.next() else { break };
            let motion = from_time(body.motion, world.time());
            let is_free = motion == MotionScene::Free;
            saved.bodies.push(BodyScene {
                name,
                motion,
                position: Some(state.position()),
                orientation: state.orientation(),
                // of a prescribed body the scene holds the constant part; an oscillation is added to it
                initial_velocity: if is_free {
                    Some(state.velocity())
                } else {
                    body.initial_velocity
                },
                initial_angular_velocity: if is_free {
                    Some(state.angular_velocity())
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
    // a line break in the name would end the comment
    let name = on_one_line(&scene.name);
    let text = format!("# The scene \"{name}\" as it was at t = {time} s.\n{scene_text}");
    load(scene, text.clone(), Vec::new())
        .map_err(|error| format!("a run cannot start from this state: {error}"))?;
    Ok(text)
}

/// The motion whose t = 0 is `time` (s) of the given one: the phase of an oscillation moves on.
fn from_time(mut motion: MotionScene, time: f64) -> MotionScene {
    if let MotionScene::Prescribed(Prescribed { oscillation: Some(oscillation), .. }) = &mut motion
    {
        let turns = (oscillation.frequency * time).fract();
        oscillation.phase =
            (oscillation.phase + std::f64::consts::TAU * turns) % std::f64::consts::TAU;
    }
    motion
}
