//! A cache of body models, so that identical bodies share one.

use std::collections::VecDeque;
use std::sync::Arc;

use super::body::Body;
use crate::BodyModel;

/// The number of models kept. Identical bodies usually follow each other, or are a mixture of a few kinds.
const CAPACITY: usize = 16;

/// The most recently used body models.
#[derive(Debug, Default)]
pub(super) struct ModelCache<'a>(VecDeque<(&'a Body, Arc<BodyModel>)>);

impl<'a> ModelCache<'a> {
    /// The model of a body with the same constant data, if it is in the cache.
    pub fn get(&mut self, body: &Body) -> Option<Arc<BodyModel>> {
        let index = self.0.iter().rposition(|(cached, _)| has_same_model(cached, body))?;
        let entry = self.0.remove(index)?;
        let model = Arc::clone(&entry.1);
        self.0.push_back(entry);
        Some(model)
    }

    /// Adds a model and drops the least recently used one if the cache is full.
    pub fn insert(&mut self, body: &'a Body, model: &Arc<BodyModel>) {
        if self.0.len() == CAPACITY {
            self.0.pop_front();
        }
        self.0.push_back((body, Arc::clone(model)));
    }
}

/// Whether the constant data of two bodies are the same.
fn has_same_model(one: &Body, other: &Body) -> bool {
    Arc::ptr_eq(&one.shape, &other.shape)
        && one.mass == other.mass
        && one.material == other.material
        && one.surface == other.surface
        && one.motion == other.motion
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DVec3, MaterialOverride, Motion, Prescribed, Primitive, Shape, Surface, World};

    #[test]
    fn bodies_that_differ_only_in_initial_state_and_name_share_a_model() {
        let mesh = Primitive::from_name("tetrahedron").unwrap().mesh().unwrap();
        let shape = Arc::new(Shape::with_surface(&mesh.vertices, mesh.clone()).unwrap());
        let body = || Body::new(shape.clone()).mass(2.0);
        let stiff =
            MaterialOverride { friction_stiffness: Some(0.1), ..MaterialOverride::default() };
        let others = [
            body().mass(3.0),
            body().particle_mass(2.0),
            body().surface(Surface::Mesh),
            body().motion(Motion::Prescribed(Prescribed::default())),
            body().material(stiff),
            Body::new(Arc::new((*shape).clone())).mass(2.0),
        ];
        let moved = body().position(DVec3::X * 4.0).velocity(DVec3::Y).name("moved");
        let mut builder = World::builder().body(body());
        for (index, other) in others.into_iter().enumerate() {
            builder = builder.body(other.position(DVec3::Z * (1.0 + 2.0 * index as f64)));
        }
        let world = builder.body(moved).build().unwrap();
        let bodies = &world.model().bodies;
        assert!(Arc::ptr_eq(&bodies[0], bodies.last().unwrap()));
        for (index, body) in bodies.iter().enumerate().take(bodies.len() - 1) {
            assert!(bodies[..index].iter().all(|other| !Arc::ptr_eq(body, other)), "{index}");
        }
        assert_eq!(world.model().names[1..3], ["body 1", "body 2"]);
        assert_eq!(world.body(bodies.len() - 1).name(), "moved");
    }
}
