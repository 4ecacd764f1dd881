//! `[[load]]` and `[central_gravity]`, key by key.

use tumble::{CentralGravity, DVec3, Load, LoadAxes, LoadCourse};

use super::problem::Problem;
use super::reader::{Range, Reader};

/// Keys that say how a load changes in time; only one may be given.
const COURSE_KEYS: [&str; 2] = ["frequency", "table"];
/// Keys of which a load needs one at least.
const FORCE_KEYS: [&str; 3] = ["force", "torque", "table"];

/// Reads a load. Invalid values are replaced by defaults.
pub fn load(reader: Reader) -> Load {
    let body = reader.string("body").unwrap_or_default().to_owned();
    reader.need("body", "is missing: the name of the body that the load acts on");
    if !FORCE_KEYS.iter().any(|key| reader.has(key)) {
        let message = "needs `force = [x, y, z]` (N), `torque = [x, y, z]` (N·m) or `table`";
        let problem = Problem::new(reader.place_of(""), reader.key(""), message);
        reader.missing(&FORCE_KEYS, problem);
    }
    let vector = |key| reader.vector(key).unwrap_or(DVec3::ZERO);
    let frequency = reader.number("frequency", Range::NotNegative);
    let phase = reader.number("phase", Range::Finite);
    let table = reader.rows::<4>("table", "[t, fx, fy, fz]");
    let course = match reader.only_one(&COURSE_KEYS) {
        Some("table") => {
            if reader.has("force") {
                reader.problem("force", "does not go with `table`, which gives the force");
            }
            let rows = table.unwrap_or_default().into_iter();
            LoadCourse::Table(rows.map(|[t, x, y, z]| (t, DVec3::new(x, y, z))).collect())
        }
        Some(_) => LoadCourse::Periodic {
            frequency: frequency.unwrap_or(0.0),
            phase: phase.unwrap_or(0.0),
        },
        None => LoadCourse::Constant,
    };
    if reader.has("phase") && !reader.has("frequency") {
        reader.problem("phase", "only goes with `frequency`");
    }
    let load = Load {
        body,
        force: vector("force"),
        torque: vector("torque"),
        at: vector("at"),
        axes: match reader.choice("axes", &["world", "body"]) {
            Some("body") => LoadAxes::Body,
            _ => LoadAxes::World,
        },
        course,
    };
    reader.finish();
    load
}

/// Reads the gravity of a mass at a fixed place.
pub fn central_gravity(reader: Reader) -> Option<CentralGravity> {
    let gm = reader.number("gm", Range::Positive);
    reader.need("gm", "is missing: the gravitational constant times the mass (m³/s²)");
    let at = reader.vector("at").unwrap_or(DVec3::ZERO);
    reader.finish();
    gm.map(|gm| CentralGravity { gm, at })
}
