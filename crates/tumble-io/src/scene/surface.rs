//! The contact surface of a body: `surface` and `particle_radius`.

use tumble::Surface;

use super::description::Geometry;
use super::problem::Problem;
use super::reader::{Range, Reader};

const SURFACES: [&str; 3] = ["none", "mesh", "spheres"];

/// Reads `surface` and `particle_radius` of a body. Without a valid geometry it does not check whether the body has a mesh.
pub fn surface(reader: &Reader, geometry: Option<&Geometry>) -> Surface {
    let choice = reader.choice("surface", &SURFACES);
    let radius = reader.number("particle_radius", Range::Positive);
    let has_radius = reader.has("particle_radius");
    match choice {
        // an invalid value has been reported; without a value the radius implies spheres
        None if reader.has("surface") => Surface::None,
        None => radius.map_or(Surface::None, |radius| Surface::Spheres { radius }),
        Some("spheres") => {
            if !has_radius {
                let message = "\"spheres\" needs `particle_radius`, the radius of the sphere about each particle (m)";
                reader.problem("surface", message);
            }
            radius.map_or(Surface::None, |radius| Surface::Spheres { radius })
        }
        Some("mesh") => {
            if has_radius {
                misplaced(reader, "its mesh is what others meet, and its particles are points");
            }
            if matches!(geometry, Some(Geometry::Particles(_))) {
                let message = "cannot be \"mesh\": bare `particles` have none";
                let problem =
                    Problem::new(reader.place_of("surface"), reader.key("surface"), message);
                let help = "give `particle_radius` (m) and leave `surface` out for spheres about the particles, \
                            or take a `mesh` or a `shape`";
                reader.report(problem.help(help));
            }
            Surface::Mesh
        }
        Some(_) => {
            if has_radius {
                misplaced(reader, "with \"none\", no other body meets its particles");
            }
            Surface::None
        }
    }
}

fn misplaced(reader: &Reader, why: &str) {
    let message = format!("only goes with surface = \"spheres\": {why}");
    reader.problem("particle_radius", message);
}
