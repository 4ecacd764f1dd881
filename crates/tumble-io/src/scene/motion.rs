//! Motion of a body: `motion`, `oscillation` and `surface_velocity`.

use tumble::{DVec3, Oscillation, Prescribed};

use super::description::MotionScene;
use super::problem::Problem;
use super::reader::{Range, Reader};

const MOTIONS: [&str; 3] = ["free", "fixed", "prescribed"];

/// Reads the motion of a body; `initial` are the keys and values of its velocities at t = 0.
pub fn motion(reader: &Reader, initial: [(&'static str, DVec3); 2]) -> MotionScene {
    let choice = reader.choice("motion", &MOTIONS);
    let oscillation = reader.table("oscillation").and_then(read_oscillation);
    let surface_velocity = reader.vector("surface_velocity");
    // with an invalid value, the other keys cannot be checked
    if choice.is_none() && reader.has("motion") {
        return MotionScene::Free;
    }
    let motion = choice.unwrap_or("free");
    if reader.has("oscillation") && motion != "prescribed" {
        let message = format!("only goes with motion = \"prescribed\", but this body is {motion}");
        reader.problem("oscillation", message);
    }
    if reader.has("surface_velocity") && motion == "free" {
        let message = "only goes with motion = \"fixed\" or \"prescribed\": a free body would not keep its place";
        reader.problem("surface_velocity", message);
    }
    let surface_velocity = surface_velocity.unwrap_or(DVec3::ZERO);
    match motion {
        "fixed" => {
            for (key, _) in initial.into_iter().filter(|(_, start)| *start != DVec3::ZERO) {
                let message = "must be zero or left out: a \"fixed\" body does not move";
                let problem = Problem::new(reader.place_of(key), reader.key(key), message);
                reader.report(problem.help("motion = \"prescribed\" keeps it for ever"));
            }
            MotionScene::Fixed { surface_velocity }
        }
        "prescribed" => MotionScene::Prescribed(Prescribed { oscillation, surface_velocity }),
        _ => MotionScene::Free,
    }
}

fn read_oscillation(reader: Reader) -> Option<Oscillation> {
    let amplitude = reader.vector("amplitude");
    let frequency = reader.number("frequency", Range::Positive);
    let phase = reader.number("phase", Range::Finite).unwrap_or(0.0);
    for key in ["amplitude", "frequency"] {
        let message =
            "is missing: an oscillation needs `amplitude`, [x, y, z] in m, and `frequency` in Hz";
        reader.need(key, message);
    }
    reader.finish();
    Some(Oscillation { amplitude: amplitude?, frequency: frequency?, phase })
}
