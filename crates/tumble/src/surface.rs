//! Surfaces for contact between bodies.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::{BuildError, Shape, SignedDistance, SurfaceError};

/// The collision surface of a body for contact with other bodies. Walls always act on its particles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Surface {
    /// No surface: its particles collide with the surfaces of other bodies.
    #[default]
    None,
    /// The closed mesh of the body: particles and spheres of other bodies are pushed out of it.
    Mesh,
    /// A sphere at each particle: a clump.
    Spheres {
        /// Radius of each sphere (m), above 0.
        radius: f64,
    },
}

/// The treatment of bodies that overlap initially.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overlaps {
    /// They are refused with an error.
    #[default]
    Refuse,
    /// They are translated apart before the first step; orientations and velocities do not change.
    Push,
}

/// Signed distances to meshes, one per shape, by the address of the shape.
#[derive(Debug, Default)]
pub(crate) struct Solids(BTreeMap<*const Shape, Result<Arc<SignedDistance>, SurfaceError>>);

impl Solids {
    /// The signed distance to the mesh of a body, if that is its surface.
    pub fn get(
        &mut self,
        body: &str,
        shape: &Arc<Shape>,
        surface: Surface,
    ) -> Result<Option<Arc<SignedDistance>>, BuildError> {
        if surface != Surface::Mesh {
            return Ok(None);
        }
        let make = || SignedDistance::new(shape.surface()).map(Arc::new);
        match self.0.entry(Arc::as_ptr(shape)).or_insert_with(make) {
            Ok(solid) => Ok(Some(Arc::clone(solid))),
            Err(error) => {
                Err(BuildError::Surface { body: body.to_owned(), error: Box::new(error.clone()) })
            }
        }
    }
}
