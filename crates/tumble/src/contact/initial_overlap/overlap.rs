//! What counts as an overlap.

/// Two bodies that overlap: the first, the second, and the depth (m).
pub(crate) type Overlap = (u32, u32, f64);

/// An overlap deeper than this part of the feature size is taken for a mistake.
pub(super) const INTENDED_DEPTH: f64 = 0.1;

/// Number of overlapping pairs that are named.
pub(super) const MAX_NAMED: usize = 100;
