//! `contact_points.csv`: one row per frame and contact.

use std::io::{self, Write};

use tumble::{Contact, ContactPartner};

use super::trajectory::{csv_field, write_numbers};

/// Columns of `contact_points.csv`.
pub const CONTACT_POINTS_HEADER: &str = "time,body,other,px,py,pz,nx,ny,nz,depth,fx,fy,fz";

/// The names of what rows are about, in the order of the world.
pub(super) struct RowNames {
    /// Those of the bodies.
    pub bodies: Vec<String>,
    /// Those of the walls.
    pub walls: Vec<String>,
    /// Those of the joints.
    pub joints: Vec<String>,
}

/// Writes the rows of one frame at `time` (s) to `contact_points.csv`, one for each contact of the latest step.
pub(super) fn write_contact_points(
    out: &mut impl Write,
    time: f64,
    names: &RowNames,
    contacts: &[Contact],
) -> io::Result<()> {
    let mut shortest = zmij::Buffer::new();
    for contact in contacts {
        let other = match contact.other {
            ContactPartner::Body(body) => names.bodies.get(body),
            ContactPartner::Wall(wall) => names.walls.get(wall),
        };
        let name = |name: Option<&String>| csv_field(name.map_or("", String::as_str)).into_owned();
        let (body, other) = (name(names.bodies.get(contact.body)), name(other));
        write!(out, "{},{body},{other}", shortest.format(time))?;
        let (p, n, f) = (contact.point, contact.normal, contact.force);
        write_numbers(out, &[p.x, p.y, p.z, n.x, n.y, n.z, contact.depth, f.x, f.y, f.z])?;
    }
    Ok(())
}
