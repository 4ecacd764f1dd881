//! What counts as an overlap.

/// Two bodies that overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Overlap {
    pub first: u32,
    pub second: u32,
    /// Depth (m).
    pub depth: f64,
}

/// An overlap deeper than this part of the feature size is taken for a mistake.
pub(super) const MAX_INTENDED_DEPTH: f64 = 0.1;

/// Number of overlapping pairs that are named.
pub(super) const MAX_NAMED: usize = 100;
