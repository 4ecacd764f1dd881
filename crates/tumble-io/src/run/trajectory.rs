//! `trajectory.csv`: one row a body a frame.

use std::io::{self, Write};

use tumble::World;

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
pub(crate) fn write_row(
    out: &mut impl Write,
    (time, body): (f64, &str),
    numbers: [f64; 16],
) -> io::Result<()> {
    write!(out, "{time:?},{body}")?;
    for number in numbers {
        write!(out, ",{number:?}")?;
    }
    writeln!(out)
}
