//! The unit of length that the header of an STL may name.

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LengthUnit {
    /// Its name, in the plural.
    pub name: &'static str,
    /// Its length (m), the `scale` that makes metres of it.
    pub metres: f64,
}

const fn unit(name: &'static str, metres: f64) -> LengthUnit {
    LengthUnit { name, metres }
}

/// What headers call the units.
const NAMES: [(&[&str], LengthUnit); 7] = [
    (&["m", "meter", "meters", "metre", "metres"], unit("metres", 1.0)),
    (&["cm", "centimeter", "centimeters", "centimetre", "centimetres"], unit("centimetres", 0.01)),
    (&["mm", "millimeter", "millimeters", "millimetre", "millimetres"], unit("millimetres", 0.001)),
    (&["um", "micron", "microns", "micrometer", "micrometers"], unit("micrometres", 1e-6)),
    (&["in", "inch", "inches"], unit("inches", 0.0254)),
    (&["ft", "foot", "feet"], unit("feet", 0.3048)),
    (&["km", "kilometer", "kilometers", "kilometre", "kilometres"], unit("kilometres", 1000.0)),
];

/// The unit that a header names, as in `UNITS=mm`, `unit: inch` or `units in mm`.
pub(super) fn in_header(header: &[u8]) -> Option<LengthUnit> {
    let lower = String::from_utf8_lossy(header).to_ascii_lowercase();
    let mut rest = lower.as_str();
    while let Some(place) = rest.find("unit") {
        rest = &rest[place + 4..];
        let after = rest.strip_prefix('s').unwrap_or(rest);
        let first_letter = after.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(after.len());
        // `united` names no unit
        if first_letter == 0 {
            continue;
        }
        let is_assigned = after[..first_letter].contains(['=', ':']);
        let mut words = after[first_letter..].split(|c: char| !c.is_alphabetic());
        let first = words.next().and_then(named);
        // the preposition, unless it is a value
        let is_preposition = !is_assigned && first.is_some_and(|unit| unit.name == "inches");
        let found = if is_preposition { words.find_map(named) } else { first };
        if found.is_some() {
            return found;
        }
    }
    None
}

fn named(word: &str) -> Option<LengthUnit> {
    NAMES.iter().find(|(names, _)| names.contains(&word)).map(|(_, unit)| *unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_name_units_in_many_ways() {
        for (header, metres) in [
            ("UNITS=mm", 0.001),
            ("binary STL, unit: inch", 0.0254),
            ("COLOR=\u{1}\u{2}\u{3}\u{ff},MATERIAL=x UNITS=in", 0.0254),
            ("part units in mm", 0.001),
            ("Units: Centimeters  ", 0.01),
            ("unit (m)", 1.0),
            ("a unit cube, units = \"feet\"", 0.3048),
        ] {
            assert_eq!(in_header(header.as_bytes()).map(|u| u.metres), Some(metres), "{header}");
        }
        for header in
            ["", "unit cube", "united in mm", "mm", "COLOR=abcd", "unit", "units=", "units in"]
        {
            assert_eq!(in_header(header.as_bytes()), None, "{header}");
        }
        assert_eq!(
            in_header(&[0xff, b'u', b'n', b'i', b't', b'=', b'm', b'm', 0]),
            in_header(b"units=mm")
        );
    }
}
