//! `[[joint]]`, key by key.

use tumble::{DVec3, Joint, JointKind, Motor};

use super::description::JointScene;
use super::problem::Problem;
use super::reader::{Range, Reader};

/// The keys that say which bodies a joint is between; exactly one is needed.
const BODIES_KEYS: [&str; 2] = ["between", "chain"];

/// Reads joint number `index`; `None` if it lacks what is needed.
pub fn joint(reader: Reader, index: usize) -> Option<JointScene> {
    let names = JointKind::ALL.map(JointKind::name);
    let kind = reader.choice("kind", &names);
    reader.need("kind", "is missing: \"ball\", \"hinge\", \"slider\", \"weld\", \"distance\", \"rope\" or \"spring\"");
    let kind = kind.and_then(|name| JointKind::ALL.into_iter().find(|kind| kind.name() == name));
    let chain = reader.string("chain").map(str::to_owned);
    let between = reader.pair_of_names("between");
    if reader.only_one(&BODIES_KEYS).is_none() {
        let message = "needs `between = [\"NAME\", \"NAME\"]`, the names of two bodies or of a body and \"world\"";
        let problem = Problem::new(reader.place_of(""), reader.key(""), message);
        reader.missing(&BODIES_KEYS, problem);
    }
    let at = reader.point_or_pair("at");
    if chain.is_none() {
        reader.need("at", "is missing: where the joint acts, [x, y, z] in world coordinates at the start; \"distance\", \"rope\" and \"spring\" need a point for each body, [[x, y, z], [x, y, z]]");
    } else if reader.has("at") {
        reader.problem("at", "does not go with `chain`, whose joints are at the centres of the bodies or half way between them");
    }
    if let (Some(kind), Some([a, b])) = (kind, at)
        && kind.has_length()
        && a == b
    {
        reader.problem("at", format!("must hold a point for each body, [[x, y, z], [x, y, z]], since a {} joins two points", kind.name()));
    }
    let axis = reader.vector("axis");
    match kind {
        Some(kind) if kind.has_axis() => {
            reader.need("axis", "is missing: the direction of the axis, [x, y, z]");
        }
        Some(_) if reader.has("axis") => {
            reader.problem("axis", "only goes with kind = \"hinge\" or \"slider\"");
        }
        _ => {}
    }
    let name = reader.string("name").map_or_else(|| format!("joint {index}"), str::to_owned);
    if name.contains(char::is_control) || name.is_empty() {
        reader.problem(
            "name",
            "must not be empty, nor contain line breaks or other control characters",
        );
    }
    let number = |key| reader.number(key, Range::NotNegative);
    let joint = Joint {
        name: Some(name),
        kind: kind.unwrap_or(JointKind::Ball),
        between: between.unwrap_or_default(),
        at: at.unwrap_or_default(),
        axis: axis.unwrap_or(DVec3::ZERO),
        limits: reader.numbers::<2>("limits", Range::Any),
        motor: reader.table("motor").and_then(motor),
        friction: number("friction").unwrap_or(0.0),
        stiffness: number("stiffness").unwrap_or(0.0),
        rest: reader.number("rest", Range::Finite).unwrap_or(0.0),
        damping: number("damping").unwrap_or(0.0),
        length: number("length"),
        until: reader.number("until", Range::Any),
        contact: reader.switch("contact").unwrap_or(false),
    };
    reader.finish();
    kind.map(|_| JointScene { joint, chain })
}

fn motor(reader: Reader) -> Option<Motor> {
    let effort = reader.number("effort", Range::PositiveOrInfinite).unwrap_or(f64::INFINITY);
    let speed = reader.number("speed", Range::Finite);
    let target = reader.number("target", Range::Finite);
    let stiffness = reader.number("stiffness", Range::NotNegative);
    let damping = reader.number("damping", Range::NotNegative);
    let motor = match reader.only_one(&["speed", "target"]) {
        Some("speed") => {
            for key in ["stiffness", "damping"].into_iter().filter(|key| reader.has(key)) {
                reader.problem(key, "only goes with `target`");
            }
            speed.map(|speed| Motor::Speed { speed, effort })
        }
        Some(_) => {
            reader.need(
                "stiffness",
                "is missing: the torque or force per rad or m away from `target`",
            );
            let (stiffness, damping) = (stiffness.unwrap_or(0.0), damping.unwrap_or(0.0));
            target.map(|target| Motor::Position { target, stiffness, damping, effort })
        }
        None => {
            let message = "needs `speed` (rad/s or m/s) or `target` (rad or m)";
            let problem = Problem::new(reader.place_of(""), reader.key(""), message);
            reader.missing(&["speed", "target"], problem);
            None
        }
    };
    reader.finish();
    motor
}
