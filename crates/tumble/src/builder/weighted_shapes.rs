//! Shapes with area weights, one for each shape that needs it.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::{AreaError, Shape};

/// The weighted shapes made so far, by the address of the original. The map is never iterated, so that no result
/// depends on addresses.
#[derive(Debug, Default)]
pub(super) struct WeightedShapes(BTreeMap<*const Shape, Result<Arc<Shape>, AreaError>>);

impl WeightedShapes {
    /// The weighted copy of a shape. The shape must outlive this map.
    ///
    /// # Errors
    /// [`AreaError`] if the particles do not lie on a surface.
    pub fn get(&mut self, shape: &Arc<Shape>) -> Result<Arc<Shape>, AreaError> {
        // the caller has already weighted it
        if shape.mean_area().is_some() {
            return Ok(Arc::clone(shape));
        }
        let make = || shape.with_area_weights().map(Arc::new);
        self.0.entry(Arc::as_ptr(shape)).or_insert_with(make).clone()
    }
}
