//! Bodies that are alike share what is constant about them.

use std::collections::VecDeque;
use std::sync::Arc;

use super::Body;
use crate::BodyModel;

/// Bodies that are alike are mostly described one after the other, or as a mixture of a few kinds.
const KINDS: usize = 16;

/// The latest kinds of bodies.
#[derive(Debug, Default)]
pub(super) struct Kinds<'a>(VecDeque<(&'a Body, Arc<BodyModel>)>);

impl<'a> Kinds<'a> {
    /// What was made for a body like this one, if that is not long ago.
    pub fn find(&mut self, body: &Body) -> Option<Arc<BodyModel>> {
        let known = self.0.iter().rposition(|(kind, _)| is_like(kind, body))?;
        let kind = self.0.remove(known)?;
        let made = Arc::clone(&kind.1);
        self.0.push_back(kind);
        Some(made)
    }

    /// Takes note of what was made for a body.
    pub fn keep(&mut self, body: &'a Body, made: &Arc<BodyModel>) {
        if self.0.len() == KINDS {
            self.0.pop_front();
        }
        self.0.push_back((body, Arc::clone(made)));
    }
}

/// Whether all that is constant about one body is the same of the other.
fn is_like(one: &Body, other: &Body) -> bool {
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

    /// Bodies that differ in where they are, how fast they start and what they are called are alike; those that differ in anything else
    /// are not, and get their own.
    #[test]
    fn alike_is_what_differs_in_its_start_alone() {
        let mesh = Primitive::named("tetrahedron").unwrap().mesh().unwrap();
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
