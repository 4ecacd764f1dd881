//! Appearance of bodies in pictures, on the page and in exports.

use std::borrow::Cow;

use tumble::{BodyModel, DVec3, Mesh, Motion, Primitive, Surface};

/// Up to this number, spheres are drawn with a fine mesh.
const MAX_FINE_SPHERES: usize = 60;
/// Up to this number, spheres are drawn with a coarse mesh; above it, each is a dot.
const MAX_COARSE_SPHERES: usize = 20_000;

/// The surface to draw, in the body frame (m): the mesh of the body, or the spheres about its particles if it has none. Empty
/// for bare particles.
pub(crate) fn surface_of(body: &BodyModel) -> Cow<'_, Mesh> {
    let own = body.shape.surface();
    match body.surface {
        Surface::Spheres { radius } if own.triangles.is_empty() => {
            let spheres = spheres(body.shape.particles().iter(), radius);
            spheres.map_or(Cow::Borrowed(own), Cow::Owned)
        }
        _ => Cow::Borrowed(own),
    }
}

/// The radius of the spheres about the particles of a body (m), if it has any.
pub(crate) fn particle_radius(body: &BodyModel) -> Option<f64> {
    match body.surface {
        Surface::Spheres { radius } => Some(radius),
        _ => None,
    }
}

/// Whether the motion of a body is prescribed. Such a body may enclose others, so it is drawn see-through.
pub(crate) fn is_kinematic(body: &BodyModel) -> bool {
    body.motion != Motion::Free
}

/// Colour of kinematic bodies: red, green, blue from 0 to 255.
pub(crate) const KINEMATIC_COLOUR: [f32; 3] = [150.0, 154.0, 160.0];

/// Balls about the places; `None` of very many, and where there is no ball of that radius.
fn spheres(places: impl ExactSizeIterator<Item = DVec3>, radius: f64) -> Option<Mesh> {
    let subdivisions = match places.len() {
        n if n <= MAX_FINE_SPHERES => 2,
        ..=MAX_COARSE_SPHERES => 1,
        _ => return None,
    };
    let ball = Primitive::Sphere { radius, subdivisions }.mesh().ok()?;
    let mut all = Mesh::default();
    for (index, place) in (0..).zip(places) {
        let first = index * ball.vertices.len() as u32;
        all.vertices.extend(ball.vertices.iter().map(|&vertex| place + vertex));
        all.triangles.extend(ball.triangles.iter().map(|corners| corners.map(|i| first + i)));
    }
    Some(all)
}
