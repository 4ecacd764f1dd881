//! Keys that several tables share: the material's and `orientation`.

use tumble::{DQuat, Damping, MaterialOverride};

use super::reader::{Range, Reader};

/// The keys of a material, in any table that may hold them.
pub fn material(reader: &Reader) -> MaterialOverride {
    reader.only_one(&["collision_stiffness", "collision_stiffness_per_area"]);
    reader.only_one(&["collision_damping", "restitution"]);
    let dashpot = reader.number("collision_damping", Range::NotNegative).map(Damping::Dashpot);
    let restitution = reader.number("restitution", Range::UpToOne).map(Damping::Restitution);
    MaterialOverride {
        collision_stiffness: reader.number("collision_stiffness", Range::NotNegative),
        collision_stiffness_per_area: reader
            .number("collision_stiffness_per_area", Range::NotNegative),
        damping: dashpot.or(restitution),
        friction_stiffness: reader.number("friction_stiffness", Range::NotNegative),
        friction_spring: reader.number("friction_spring", Range::NotNegative),
        friction_damping: reader.number("friction_damping", Range::NotNegative),
    }
}

/// Whether this is the squared length of something normalised, to rounding. What a run wrote then
/// reads back as it was.
pub fn is_unit(length_squared: f64) -> bool {
    (length_squared - 1.0).abs() < 4.0 * f64::EPSILON
}

/// `orientation = [w, x, y, z]`; of any length but zero.
pub fn orientation(reader: &Reader) -> DQuat {
    let Some([w, x, y, z]) = reader.numbers::<4>("orientation", Range::Finite) else {
        return DQuat::IDENTITY;
    };
    let largest = [w, x, y, z].iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if largest == 0.0 {
        reader.problem("orientation", "must not be all zeros; [1, 0, 0, 0] is not turned at all");
        return DQuat::IDENTITY;
    }
    let q = DQuat::from_xyzw(x, y, z, w);
    // do not normalise twice: the bits would change
    if is_unit(q.length_squared()) { q } else { (q / largest).normalize() }
}
