//! What a contact is made of.

/// The law of a contact between a particle and a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Stiffness k of a particle's contact spring (N/m).
    pub collision_stiffness: f64,
}

impl Default for Material {
    /// k = 1e4 N/m, as in the basic system.
    fn default() -> Self {
        Self { collision_stiffness: 1e4 }
    }
}
