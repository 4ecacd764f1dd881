//! `trajectory.csv`, one row per body and frame; `contacts.csv`, one row per frame and body in contact.

use std::borrow::Cow;
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
        out.write_all(csv_field(body).as_bytes())?;
    }
    write_numbers(out, numbers)
}

/// Writes the numbers at the end of a row, each after a comma.
pub(super) fn write_numbers(out: &mut impl Write, numbers: &[f64]) -> io::Result<()> {
    let mut shortest = zmij::Buffer::new();
    for &number in numbers {
        out.write_all(b",")?;
        out.write_all(shortest.format(number).as_bytes())?;
    }
    out.write_all(b"\n")
}

/// A text as a field of CSV (RFC 4180): in quotes, with doubled quotes, if it would not be one field
/// without them.
pub(super) fn csv_field(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\r', '\n']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::csv_reader::{parse_contact, parse_trajectory};

    #[test]
    fn a_name_reads_back_as_it_was_written() {
        let names = [
            "ball",
            "",
            "a, b",
            "the \"big\" one",
            "\"",
            "\"\"",
            ",",
            "a\r\nb",
            "=1+1",
            "'x'",
            "ä ☃",
            "\",\"",
            "a\"",
        ];
        for name in names {
            let mut row = Vec::new();
            write_row(&mut row, (0.5, Some(name)), &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
            let row = String::from_utf8(row).unwrap();
            let (time, read, numbers) = parse_contact(row.strip_suffix('\n').unwrap()).unwrap();
            assert_eq!((time, &*read, numbers), (0.5, name, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        }
    }

    #[test]
    fn a_row_with_a_wrong_quote_is_no_row() {
        for name in ["\"a", "\"a\"b", "\"a\"\"", "\"", "\"a\"b\""] {
            let row = format!("0.5,{name},1.0,2.0,3.0,4.0,5.0,6.0");
            assert_eq!(parse_contact(&row), None, "{row}");
            assert_eq!(parse_trajectory(&row), None, "{row}");
        }
        // a quote within an unquoted field was never written, but is no mistake in a comma-free name
        assert!(parse_contact("0.5,a\"b,1.0,2.0,3.0,4.0,5.0,6.0").is_some());
    }
}
