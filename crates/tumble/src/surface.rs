//! What other bodies meet of a body.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::{BuildError, Shape, SignedDistance, SurfaceError};

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

/// What is done about bodies that start in each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overlaps {
    /// They are refused, by name.
    #[default]
    Refuse,
    /// They are moved apart before the first step, without turning or kicking them.
    Push,
}

/// The distances to meshes, made once for all bodies of one shape.
#[derive(Debug, Default)]
pub(crate) struct Solids(BTreeMap<*const Shape, Result<Arc<SignedDistance>, SurfaceError>>);

impl Solids {
    /// The distance to the mesh of a body, if that is its surface.
    pub fn of(
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
