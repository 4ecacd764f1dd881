//! What a mesh will work as, and what to do if it does not.

use tumble::{Mesh, Shape, SignedDistance, SolidError, SurfaceError};
use tumble_io::mesh::{MeshFile, Repair, prepare};

use crate::format::{count, number};

/// Tolerances that are tried, as fractions of the size.
const TRIED: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];
/// A body larger than this (m) is probably not in metres.
const LARGE: f64 = 100.0;

/// A mesh and what the verdicts depend on.
pub struct Verdicts<'a> {
    pub file: &'a MeshFile,
    /// The mesh in metres, with its triangles put right.
    pub mesh: &'a Mesh,
    pub one_sided: bool,
    /// The factor from the unit of the file to metres.
    pub scale: f64,
    /// The longest edge of the bounding box (m).
    pub size: f64,
}

/// The count with its noun, in groups of three digits.
pub fn plural(n: usize, one: &str, many: &str) -> String {
    format!("{} {}", count(n as u64), if n == 1 { one } else { many })
}

impl Verdicts<'_> {
    /// A row for each use, and one with advice on units if there is a reason.
    pub fn rows(&self, shape: &Shape) -> Vec<(&'static str, String)> {
        let solid = self.mesh.solid_integrals();
        let surface = SignedDistance::new(self.mesh);
        let is_open = matches!(solid, Err(SolidError::Edges(_)));
        let advice = if is_open { self.advice() } else { None };
        let solid = match &solid {
            Ok(_) => "yes, with mass_model = \"solid\"".to_owned(),
            Err(error) => no(&self.solid_reason(error), advice.is_none(), instead_of_solid(error)),
        };
        let surface = match &surface {
            Ok(_) => "yes, with surface = \"mesh\"".to_owned(),
            Err(error) => {
                let instead = "use surface = \"spheres\" with a particle_radius";
                no(&self.surface_reason(error), advice.is_none(), instead)
            }
        };
        let mut rows = vec![("works as body", body(shape)), ("as solid", solid)];
        rows.push(("as surface", surface));
        rows.extend(advice.map(|key| ("what to do", format!("set {key}, which closes it"))));
        rows.extend(self.unit_advice().map(|text| ("scale", text)));
        rows
    }

    fn solid_reason(&self, error: &SolidError) -> String {
        match error {
            SolidError::Edges(_) if self.one_sided => "a part of it has only one side".to_owned(),
            SolidError::Edges(edges) if edges.open_edges == 0 => {
                plural(edges.wrongly_wound, "wrongly wound edge", "wrongly wound edges")
            }
            SolidError::Edges(edges) => {
                format!("it is open at {}", plural(edges.open_edges, "edge", "edges"))
            }
            SolidError::NoTriangles => "it has no triangles".to_owned(),
            SolidError::NoVolume => "it encloses no volume".to_owned(),
            SolidError::Impossible { .. } => {
                "parts of it enclose a negative volume: they cross themselves".to_owned()
            }
            SolidError::OutOfRange { .. } => "its size is beyond the range of numbers".to_owned(),
        }
    }

    fn surface_reason(&self, error: &SurfaceError) -> String {
        match error {
            SurfaceError::NoTriangles => "it has no triangles".to_owned(),
            SurfaceError::WronglyWound(_) if self.one_sided => {
                "a part of it has only one side".to_owned()
            }
            SurfaceError::WronglyWound(edges) => {
                plural(edges.wrongly_wound, "wrongly wound edge", "wrongly wound edges")
            }
            SurfaceError::Open { largest, largest_allowed, total, total_allowed, .. } => {
                let (what, length, allowed) = if largest > largest_allowed {
                    ("the longest rim of a hole is", largest, largest_allowed)
                } else {
                    ("the rims of its holes together are", total, total_allowed)
                };
                format!("{what} {} m, and {} m are allowed", number(*length), number(*allowed))
            }
            SurfaceError::NoVolume => "it encloses no volume".to_owned(),
            SurfaceError::OutOfRange { .. } => "its size is beyond the range of numbers".to_owned(),
        }
    }

    /// A key that closes the mesh, if there is one.
    fn advice(&self) -> Option<String> {
        let is_closed = |mesh: &Mesh| mesh.solid_integrals().is_ok();
        let of_file = &self.file.mesh;
        let size = self.size / self.scale;
        for fraction in TRIED {
            let tolerance = rounded(fraction * size);
            let welded = of_file.welded(Some(tolerance));
            if welded.collapsed > 0 && fraction > TRIED[0] {
                break;
            }
            let prepared = prepare(&welded.mesh, Repair::None).ok();
            if prepared.is_some_and(|prepared| is_closed(&prepared.mesh)) {
                return Some(if fraction == TRIED[0] && self.file.weld.is_none() {
                    "weld = true".to_owned()
                } else {
                    format!("weld = {tolerance:e}")
                });
            }
        }
        let closed = prepare(of_file, Repair::Close).ok()?;
        is_closed(&closed.mesh).then(|| "mesh_repair = \"close\"".to_owned())
    }

    fn unit_advice(&self) -> Option<String> {
        if let Some(unit) = self.file.header_unit {
            let is_set = (self.scale / unit.metres - 1.0).abs() < 1e-6;
            return (!is_set)
                .then(|| format!("the header names {}: set scale = {}", unit.name, unit.metres));
        }
        let is_large = self.scale == 1.0 && self.size > LARGE;
        is_large.then(|| {
            format!(
                "{} m is large: if the file is in millimetres, set scale = 0.001",
                number(self.size)
            )
        })
    }
}

fn body(shape: &Shape) -> String {
    match shape.principal().rotation_count() {
        3 => "yes".to_owned(),
        0 => "yes, but all particles are at one point: it cannot turn".to_owned(),
        _ => "yes, but all particles lie on a line: it cannot turn about that".to_owned(),
    }
}

/// The reason and, if nothing helps, what to do without.
fn no(reason: &str, is_final: bool, instead: &str) -> String {
    if is_final { format!("no: {reason}; {instead}") } else { format!("no: {reason}") }
}

fn instead_of_solid(error: &SolidError) -> &'static str {
    match error {
        SolidError::NoTriangles => "leave mass_model at \"particles\"",
        SolidError::OutOfRange { .. } => "set another scale",
        _ => "use mass_model = \"shell\" or \"particles\"",
    }
}

/// A power of ten, times one or two or five, that is not below a number.
fn rounded(x: f64) -> f64 {
    let exponent = x.log10().floor() as i32;
    // by way of text, so that 1e-7 is exactly that
    let steps = [("1", exponent), ("2", exponent), ("5", exponent), ("1", exponent + 1)];
    let steps = steps.map(|(digit, power)| format!("{digit}e{power}").parse().unwrap_or(x));
    steps.into_iter().find(|&step| step >= x).unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_round_numbers() {
        for (x, expected) in [(1.7e-6, 2e-6), (1e-7, 1e-7), (6e3, 1e4), (0.0, 0.0)] {
            assert_eq!(rounded(x), expected);
        }
    }
}
