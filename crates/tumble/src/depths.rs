//! Penetration depths.

use crate::contact::BodyContacts;
use crate::contact::wall::depth_behind;
use crate::kinematics::Kinematics;
use crate::{Model, State};

/// The largest penetration depths at one time (m), 0 without contact.
///
/// Contact by springs always involves some penetration; compare these values with the size of the bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PenetrationDepths {
    /// The largest depth between two bodies.
    pub bodies: f64,
    /// The largest depth behind a wall.
    pub walls: f64,
}

impl PenetrationDepths {
    /// The depths of a state.
    pub fn new(model: &Model, state: &State) -> Self {
        Self::from_contacts(model, state, BodyContacts::default())
    }

    /// As [`PenetrationDepths::new`], reusing the neighbour lists of `contacts`.
    pub(crate) fn from_contacts(model: &Model, state: &State, mut contacts: BodyContacts) -> Self {
        let [bodies, mut walls] = contacts.max_depths(model, state);
        let bodies_and_states = model.bodies.iter().zip(&state.bodies);
        // spheres against walls are among the contacts above
        for (body, state) in
            bodies_and_states.filter(|(body, _)| body.is_free() && !body.has_spheres())
        {
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
            Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, DMat3::IDENTITY);
        Body::new(shape.unwrap()).surface(surface).position(DVec3::X * x)
    }

    /// Two spheres of radius 0.1 m, 0.199 m apart, the first 2 mm behind a wall; and a particle 4 mm behind it.
    #[test]
    fn depths_are_those_of_the_deepest_contacts() {
        let spheres = Surface::Spheres { radius: 0.1 };
        let wall = WallPlane { normal: DVec3::X, offset: 0.0 };
        let pair =
            || World::builder().wall(wall).body(ball(0.098, spheres)).body(ball(0.297, spheres));
        let depths = pair().build().unwrap().penetration_depths();
        assert!((depths.bodies - 1e-3).abs() < 1e-12, "{depths:?}");
        assert!((depths.walls - 2e-3).abs() < 1e-12, "{depths:?}");
        let bare = pair().body(ball(-4e-3, Surface::None)).build().unwrap();
        assert_eq!(bare.penetration_depths().walls, 4e-3);
        let alone = World::builder().wall(wall).body(ball(1.0, spheres)).build().unwrap();
        assert_eq!(alone.penetration_depths(), PenetrationDepths::default());
    }
}
