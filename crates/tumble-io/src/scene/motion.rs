//! What moves a body: `motion`, `oscillation` and `surface_velocity`.

use tumble::{DVec3, Oscillation, Prescribed};

use super::description::MotionScene;
use super::problem::Problem;
use super::reader::{Range, Reader};

const MOTIONS: [&str; 3] = ["free", "fixed", "prescribed"];

/// Reads how a body moves; `starts` are the keys of its motion at t = 0 with their values.
pub fn motion(reader: &Reader, starts: [(&'static str, DVec3); 2]) -> MotionScene {
    let choice = reader.choice("motion", &MOTIONS);
    let swing = reader.table("oscillation").and_then(oscillation);
    let belt = reader.vector("surface_velocity");
    // of a word that is none of these, nobody knows what goes with it
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
    let surface_velocity = belt.unwrap_or(DVec3::ZERO);
    match motion {
        "fixed" => {
            for (key, _) in starts.into_iter().filter(|(_, start)| *start != DVec3::ZERO) {
                let message = "must be zero or left out: a \"fixed\" body does not move";
                let problem = Problem::new(reader.place_of(key), reader.key(key), message);
                reader.report(problem.help("motion = \"prescribed\" keeps it for ever"));
            }
            MotionScene::Fixed { surface_velocity }
        }
        "prescribed" => {
            MotionScene::Prescribed(Prescribed { oscillation: swing, surface_velocity })
        }
        _ => MotionScene::Free,
    }
}

fn oscillation(reader: Reader) -> Option<Oscillation> {
    let amplitude = reader.vector("amplitude");
    let frequency = reader.number("frequency", Range::Positive);
    let phase = reader.number("phase", Range::Finite).unwrap_or(0.0);
    for key in ["amplitude", "frequency"] {
        if !reader.has(key) {
            let message = "is missing: an oscillation needs `amplitude`, [x, y, z] in m, and `frequency` in Hz";
            reader.problem(key, message);
        }
    }
    reader.finish();
    Some(Oscillation { amplitude: amplitude?, frequency: frequency?, phase })
}
