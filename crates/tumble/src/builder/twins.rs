//! Shapes whose particles are weighted by their areas, one for each shape that needs it.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::{AreaError, Shape};

/// The twins made so far, by the address of the shape; bodies that share a shape share its twin. Nothing runs over
/// this map, so that no result depends on addresses.
#[derive(Debug, Default)]
pub(super) struct Twins(BTreeMap<*const Shape, Result<Arc<Shape>, AreaError>>);

impl Twins {
    /// The twin of a shape, which outlives this.
    ///
    /// # Errors
    /// [`AreaError`] where the particles do not lie on a surface.
    pub fn of(&mut self, shape: &Arc<Shape>) -> Result<Arc<Shape>, AreaError> {
        // made by hand already
        if shape.mean_area().is_some() {
            return Ok(Arc::clone(shape));
        }
        let made = || shape.with_area_weights().map(Arc::new);
        self.0.entry(Arc::as_ptr(shape)).or_insert_with(made).clone()
    }
}
