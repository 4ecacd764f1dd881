//! The problem of a scene without `dt` whose contacts are unstable with the default.
//!
//! There is no `dt` to point at, so the problem is reported at the key that makes the contacts so fast.

use tumble::Material;

use super::body::MASS_KEYS;
use super::problem::Problem;
use super::reader::{Range, Reader};

const STIFFNESS_KEYS: [&str; 2] = ["collision_stiffness", "collision_stiffness_per_area"];

/// The default `dt` (s), the critical step (s), and the name of the body that determines it.
pub struct Unstable<'a> {
    pub dt: f64,
    pub critical: f64,
    pub body: &'a str,
}

/// The problem at the key that causes it. `body` reads the table of the body.
pub fn problem(top: &Reader, body: Option<&Reader>, unstable: &Unstable) -> Problem {
    let walls = top.tables("wall");
    let shared: Vec<_> = top.table("collision").into_iter().chain(top.table("box")).collect();
    let tables: Vec<&Reader> = body.into_iter().chain(&walls).chain(&shared).collect();
    let (reader, key, cause) = if let Some((reader, key)) = stiffest(&tables) {
        (reader, key, "makes contact stiff")
    } else {
        let reader = body.unwrap_or(top);
        let key = MASS_KEYS.into_iter().find(|key| reader.has(key)).unwrap_or("");
        (
            reader,
            key,
            if key.is_empty() { "has stiff contacts for its mass" } else { "makes the body light" },
        )
    };
    let Unstable { dt, critical, body } = unstable;
    let enough = rounded_down(*critical);
    let message = format!(
        "{cause}: the default `dt` of {dt} s is too long for contact of body \"{body}\", which is stable only up to \
         {critical:.3e} s; add the line `dt = {enough:e}`, keep it with `integrator = \"implicit\"`, or insist with --force"
    );
    Problem::new(reader.place_of(key), reader.key(key), message)
}

/// The table and key of the largest stiffness, if it is above the default.
fn stiffest<'a, 'b>(tables: &[&'a Reader<'b>]) -> Option<(&'a Reader<'b>, &'static str)> {
    let mut largest = Material::default().collision_stiffness;
    let mut found = None;
    for &table in tables {
        for key in STIFFNESS_KEYS {
            // one per area cannot be compared: it counts as the larger one
            let stiffness = match table.number(key, Range::NotNegative) {
                Some(_) if key != STIFFNESS_KEYS[0] => f64::INFINITY,
                Some(stiffness) => stiffness,
                None => continue,
            };
            if stiffness > largest {
                (largest, found) = (stiffness, Some((table, key)));
            }
        }
    }
    found
}

/// The number, rounded down to two digits.
fn rounded_down(x: f64) -> f64 {
    let text = format!("{x:.1e}");
    let near: f64 = text.parse().unwrap_or(x);
    if near <= x {
        return near;
    }
    // formatting has rounded up
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits: f64 = digits.parse().unwrap_or(1.0);
    let less = if digits > 1.0 { digits - 0.1 } else { 0.99 };
    format!("{less:.2}e{exponent}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_down_to_two_digits() {
        for (x, rounded) in
            [(1.26e-4, 1.2e-4), (1.24e-4, 1.2e-4), (9.99e-7, 9.9e-7), (0.00104, 1e-3)]
        {
            assert_eq!(rounded_down(x), rounded);
        }
        assert_eq!(rounded_down(0.99999), 0.99);
        assert_eq!(rounded_down(2.0), 2.0);
    }
}
