//! What a body looks like in pictures, on the page and in exports.

use std::borrow::Cow;

use tumble::{BodyModel, DVec3, Mesh, Motion, Primitive, Surface};

/// Up to so many spheres are drawn finely, …
const FINE: usize = 60;
/// … up to so many coarsely; of more, each is a dot.
const COARSE: usize = 20_000;

/// The surface to draw, in the body frame (m): its own, or the spheres about its particles if it has none. Empty
/// where bare particles are all there is to see.
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

/// Whether something other than forces moves a body: it may stand around the others, so one looks through it.
pub(crate) fn is_driven(body: &BodyModel) -> bool {
    body.motion != Motion::Free
}

/// The colour of bodies that are driven, red, green, blue from 0 to 255.
pub(crate) const DRIVEN: [f32; 3] = [150.0, 154.0, 160.0];

/// Balls about the places; `None` of very many, and where there is no ball of that radius.
fn spheres(places: impl ExactSizeIterator<Item = DVec3>, radius: f64) -> Option<Mesh> {
    let subdivisions = match places.len() {
        n if n <= FINE => 2,
        ..=COARSE => 1,
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
