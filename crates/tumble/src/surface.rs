//! What other bodies meet of a body.

/// How a body meets other bodies. Walls meet its particles whatever this says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Surface {
    /// Nothing meets it but the surfaces of others, and those its particles.
    #[default]
    None,
    /// Its closed mesh: particles and spheres of others are pushed out of it.
    Mesh,
    /// A sphere about each of its particles.
    Spheres {
        /// Radius of each sphere (m), above 0.
        radius: f64,
    },
}
