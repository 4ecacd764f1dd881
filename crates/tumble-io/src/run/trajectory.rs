//! `trajectory.csv`: one row a body a frame; `contacts.csv`: one for each body in contact.

use std::io::{self, Write};

use tumble::{World, Wrench};

/// The columns.
pub const TRAJECTORY_HEADER: &str = "time,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,lx,ly,lz";

/// Writes one row for each body. Numbers have the shortest form that reads back to the same double.
///
/// # Errors
/// Those of `out`.
pub fn write_frame(out: &mut impl Write, world: &World) -> io::Result<()> {
    for body in world.bodies() {
        let (p, q, v) = (body.position(), body.orientation(), body.velocity());
        let (w, l) = (body.angular_velocity(), body.angular_momentum());
        let numbers =
            [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z, l.x, l.y, l.z];
        write_row(out, (world.time(), body.name()), numbers)?;
    }
    Ok(())
}

/// Writes the row of one body at one time (s).
pub(crate) fn write_row<const N: usize>(
    out: &mut impl Write,
    (time, body): (f64, &str),
    numbers: [f64; N],
) -> io::Result<()> {
    let mut shortest = zmij::Buffer::new();
    write!(out, "{},{body}", shortest.format(time))?;
    for number in numbers {
        out.write_all(b",")?;
        out.write_all(shortest.format(number).as_bytes())?;
    }
    out.write_all(b"\n")
}

/// The columns of `contacts.csv`.
pub const CONTACTS_HEADER: &str = "time,body,fx,fy,fz,tx,ty,tz";

/// Writes one row for each body that touches a wall: the force of all its contacts (N) and their
/// torque about its centre of mass (N·m), world axes, as they acted in the latest step.
///
/// # Errors
/// Those of `out`.
pub fn write_contacts(out: &mut impl Write, world: &World) -> io::Result<()> {
    for (index, body) in world.bodies().enumerate() {
        let wrench = world.contact_wrench(index);
        if wrench == Wrench::default() {
            continue;
        }
        let (f, t) = (wrench.force, wrench.torque);
        write_row(out, (world.time(), body.name()), [f.x, f.y, f.z, t.x, t.y, t.z])?;
    }
    Ok(())
}
