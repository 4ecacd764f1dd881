//! What a shape knows about the surface area of its particles.

use super::sampling::Sampling;

/// Where the particles of a shape come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ParticleSource {
    /// Points without a mesh.
    Points,
    /// The vertices of the mesh.
    Vertices,
    /// An even sample of the surface.
    Surface,
    /// A lattice inside the mesh.
    Volume,
}

impl From<Sampling> for ParticleSource {
    fn from(sampling: Sampling) -> Self {
        match sampling {
            Sampling::Vertices => Self::Vertices,
            Sampling::Surface { .. } => Self::Surface,
            Sampling::Volume { .. } => Self::Volume,
        }
    }
}

/// Area weights of the particles of a shape, reduced to what contact needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AreaWeights {
    /// The mean area per particle Ā = A/N (m²).
    pub mean_area: f64,
    /// The largest Σ wᵢ |uᵢ|² over all motions with a kinetic energy of ½ J at 1 kg; `None` where all
    /// weights are 1.
    pub fastest: Option<f64>,
}
