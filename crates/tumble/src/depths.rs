//! How deep bodies are in what they touch.

use crate::contact::BodyContacts;
use crate::contact::wall::depth_behind;
use crate::kinematics::Kinematics;
use crate::{Model, State};

/// The deepest contacts at one moment (m); 0 where nothing touches. With springs for contact nothing is ever quite outside of what
/// it touches: whether that matters is told by comparing these with the size of the bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactDepths {
    /// Between two bodies.
    pub bodies: f64,
    /// Behind a wall.
    pub walls: f64,
}

impl ContactDepths {
    /// Those of a state.
    pub fn of(model: &Model, state: &State) -> Self {
        Self::with(model, state, BodyContacts::default())
    }

    /// As [`ContactDepths::of`]; reuses the neighbour lists of `contacts`.
    pub(crate) fn with(model: &Model, state: &State, mut contacts: BodyContacts) -> Self {
        let [bodies, mut walls] = contacts.max_depths(model, state);
        let bare = model.bodies.iter().zip(&state.bodies);
        for (body, state) in bare.filter(|(body, _)| body.is_free() && !body.has_spheres()) {
            let kinematics = Kinematics::new(body, state);
            let deepest = model.walls.iter().map(|wall| depth_behind(&kinematics, wall));
            walls = deepest.fold(walls, f64::max);
        }
        Self { bodies, walls }
    }
}

#[cfg(test)]
mod tests {
    use crate::*;

    fn ball(x: f64, surface: Surface) -> Body {
        let shape =
            Shape::of_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, DMat3::IDENTITY);
        Body::new(shape.unwrap()).surface(surface).position(DVec3::X * x)
    }

    /// Two balls of 0.1 m, 0.199 m apart, the first 2 mm behind a wall; and a particle 4 mm behind it.
    #[test]
    fn depths_are_those_of_the_deepest() {
        let spheres = Surface::Spheres { radius: 0.1 };
        let wall = WallPlane { normal: DVec3::X, offset: 0.0 };
        let pair =
            || World::builder().wall(wall).body(ball(0.098, spheres)).body(ball(0.297, spheres));
        let depths = pair().build().unwrap().contact_depths();
        assert!((depths.bodies - 1e-3).abs() < 1e-12, "{depths:?}");
        assert!((depths.walls - 2e-3).abs() < 1e-12, "{depths:?}");
        let bare = pair().body(ball(-4e-3, Surface::None)).build().unwrap();
        assert_eq!(bare.contact_depths().walls, 4e-3);
        let alone = World::builder().wall(wall).body(ball(1.0, spheres)).build().unwrap();
        assert_eq!(alone.contact_depths(), ContactDepths::default());
    }
}
