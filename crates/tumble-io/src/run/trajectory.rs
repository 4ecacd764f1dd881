//! `trajectory.csv`, one row per body and frame; `contacts.csv`, one row per frame and body in contact.

use std::io::{self, Write};

use tumble::Wrench;

use crate::page::BodyFrame;

/// Columns of `trajectory.csv`.
pub const TRAJECTORY_HEADER: &str = "time,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,lx,ly,lz";

/// Writes the rows of one frame at `time` (s) to `trajectory.csv`.
pub(super) fn write_frame(
    out: &mut impl Write,
    time: f64,
    names: &[String],
    bodies: &[BodyFrame],
) -> io::Result<()> {
    for (name, body) in names.iter().zip(bodies) {
        let (p, q, v) = (body.position, body.orientation, body.velocity);
        let (w, l) = (body.angular_velocity, body.angular_momentum);
        let numbers =
            [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z, l.x, l.y, l.z];
        write_row(out, (time, Some(name)), &numbers)?;
    }
    Ok(())
}

/// Columns of `contacts.csv`.
pub const CONTACTS_HEADER: &str = "time,body,fx,fy,fz,tx,ty,tz";

/// Writes the rows of one frame at `time` (s) to `contacts.csv`, one for each body in contact.
///
/// A row holds the total force (N) of all contacts of the body, with walls and with other bodies,
/// and their torque about its centre of mass (N·m), in world axes, as applied in the latest step.
pub(super) fn write_contacts(
    out: &mut impl Write,
    time: f64,
    names: &[String],
    bodies: &[BodyFrame],
) -> io::Result<()> {
    for (name, body) in names.iter().zip(bodies) {
        if body.contact != Wrench::default() {
            let (f, t) = (body.contact.force, body.contact.torque);
            write_row(out, (time, Some(name)), &[f.x, f.y, f.z, t.x, t.y, t.z])?;
        }
    }
    Ok(())
}

/// Writes a row: the time (s), the name of the body if given, and the numbers.
///
/// Numbers have the shortest decimal form that parses to the same double.
pub(crate) fn write_row(
    out: &mut impl Write,
    (time, body): (f64, Option<&str>),
    numbers: &[f64],
) -> io::Result<()> {
    let mut shortest = zmij::Buffer::new();
    out.write_all(shortest.format(time).as_bytes())?;
    if let Some(body) = body {
        out.write_all(b",")?;
        out.write_all(body.as_bytes())?;
    }
    for &number in numbers {
        out.write_all(b",")?;
        out.write_all(shortest.format(number).as_bytes())?;
    }
    out.write_all(b"\n")
}
