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

/// What a wall or a body says about its own contacts; the rest comes from the world's material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaterialOverride {
    /// Stiffness k of a particle's contact spring (N/m).
    pub collision_stiffness: Option<f64>,
}

impl MaterialOverride {
    /// These values over a material that says the rest.
    pub fn over(self, rest: Material) -> Material {
        Material {
            collision_stiffness: self.collision_stiffness.unwrap_or(rest.collision_stiffness),
        }
    }
}

impl Material {
    /// The law between a wall and a body: what only one of them says holds, and a wall is heard
    /// before a body.
    pub fn between(self, wall: MaterialOverride, body: MaterialOverride) -> Self {
        wall.over(body.over(self))
    }
}
