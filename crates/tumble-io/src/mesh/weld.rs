//! Which vertices of a file are merged.

use tumble::Welded;

/// Whether vertices are merged, and within which distance.
///
/// Equal vertices are one in any case but [`Weld::Never`]. Vertices at open edges are merged within a tolerance; see
/// [`tumble::Mesh::welded`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weld {
    /// Each vertex of the file stays one.
    Never,
    /// Within 1e-6 of the diagonal of the mesh, or less where triangles would collapse.
    Auto,
    /// Within this distance, in the unit of the file; 0 for equal vertices only.
    Within(f64),
}

impl From<bool> for Weld {
    fn from(welds: bool) -> Self {
        if welds { Self::Auto } else { Self::Never }
    }
}

/// What was merged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WeldReport {
    /// The tolerance, in the unit of the file.
    pub tolerance: f64,
    /// The number of vertices that were equal to an earlier one.
    pub equal: usize,
    /// The number of other vertices that were within the tolerance of an earlier one, at open edges.
    pub near: usize,
    /// The number of triangles with two corners at one point, which were left out.
    pub collapsed: usize,
}

impl From<&Welded> for WeldReport {
    fn from(found: &Welded) -> Self {
        let &Welded { tolerance, equal, near, collapsed, .. } = found;
        Self { tolerance, equal, near, collapsed }
    }
}
