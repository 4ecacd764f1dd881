//! The constant data of a body, from its description.

use std::sync::Arc;

use glam::DVec3;

use super::body::{Body, Mass};
use super::checks::check_body;
use super::description::WorldBuilder;
use super::initial_state::body_state;
use super::model_cache::ModelCache;
use super::weighted_shapes::WeightedShapes;
use crate::contact_points::SharedContactPoints;
use crate::surface::Solids;
use crate::{
    BodyModel, BodyState, BuildError, ContactLaw, DragModes, Material, MaterialOverride, Motion,
    PairMaterial, Shape, Surface,
};

/// Data shared by several bodies.
#[derive(Default)]
pub(super) struct Shared<'a> {
    solids: Solids,
    weighted_shapes: WeightedShapes,
    models: ModelCache<'a>,
    contact_points: SharedContactPoints,
}

impl WorldBuilder {
    /// The model and the initial state of a body.
    pub(super) fn model_and_state<'a>(
        &self,
        name: &str,
        body: &'a Body,
        shared: &mut Shared<'a>,
    ) -> Result<(Arc<BodyModel>, BodyState), BuildError> {
        let body_model = match shared.models.get(body) {
            Some(cached) => cached,
            None => {
                let body_model = Arc::new(self.body_model(name, body, shared)?);
                shared.models.insert(body, &body_model);
                body_model
            }
        };
        let body_state = body_state(&body_model, name, body)?;
        Ok((body_model, body_state))
    }

    /// The materials of contacts of a body: with each wall, and with other bodies.
    fn materials(&self, body: &Body) -> (Vec<Material>, Option<Material>) {
        let wall = |(_, wall): &(_, MaterialOverride)| self.material.between(*wall, body.material);
        // of contacts between bodies, only this body's part is known here
        let meets = body.surface != Surface::None;
        let own = meets.then(|| body.material.over(self.material));
        (self.walls.iter().map(wall).collect(), own)
    }

    /// The constant data of a body.
    fn body_model(
        &self,
        name: &str,
        body: &Body,
        shared: &mut Shared,
    ) -> Result<BodyModel, BuildError> {
        let refuse = |quantity, value, allowed| BuildError::Body {
            body: name.to_owned(),
            quantity,
            value,
            allowed,
        };
        if let Some((quantity, value, allowed)) = check_body(body, self.dt) {
            return Err(refuse(quantity, value, allowed));
        }
        let (quantity, value, mass) = match body.mass {
            Mass::Total(mass) => ("mass", mass, mass),
            Mass::Particle(mass) => {
                ("particle_mass", mass, mass * body.shape.particles().len() as f64)
            }
        };
        let signed_distance = shared.solids.get(name, &body.shape, body.surface)?;
        let inertia = body.shape.gyration() * mass;
        let inverse_inertia = body.shape.principal().inverse() * (1.0 / mass);
        let fits = inertia.is_finite() && inverse_inertia.is_finite();
        if !(mass > 0.0 && mass.is_finite() && value.is_finite() && fits) {
            let allowed = "a number of kg above 0, such that the inertia is finite";
            return Err(refuse(quantity, value.to_string(), allowed));
        }
        let (is_free, has_spheres) =
            (body.motion == Motion::Free, matches!(body.surface, Surface::Spheres { .. }));
        let (walls, own) = self.materials(body);
        let per_area = |material: &Material| material.collision_stiffness_per_area;
        let shape = match walls.iter().chain(&own).find_map(per_area) {
            Some(stiffness) if has_spheres => {
                let allowed = "left out for a body with spheres, which touch at points; give it a \
                               `collision_stiffness` of its own";
                return Err(refuse("collision_stiffness_per_area", stiffness.to_string(), allowed));
            }
            Some(stiffness) => shared.weighted_shapes.get(&body.shape).map_err(|error| {
                refuse("collision_stiffness_per_area", stiffness.to_string(), error.allowed())
            })?,
            None => Arc::clone(&body.shape),
        };
        let contact_points =
            (body.surface == Surface::Mesh).then(|| shared.contact_points.get(&shape));
        let area = shape.mean_area().unwrap_or_default();
        let is_point = shape.is_single_particle();
        let law = |material: Material| {
            let law = material.at_area(area).law();
            if is_point { law.of_single_particle(mass) } else { law }
        };
        let contacts: Vec<_> = walls.into_iter().map(law).collect();
        let moments = body.shape.principal().moments * mass;
        let inverse_moments = moments.to_array().map(|m| if m > 0.0 { 1.0 / m } else { 0.0 });
        Ok(BodyModel {
            shape,
            mass,
            inertia,
            inverse_inertia,
            inverse_moments: DVec3::from_array(inverse_moments),
            drag_modes: DragModes::new(&body.shape, mass).map(Box::new),
            pair_material: PairMaterial::new(
                &body.material.over(self.material).at_area(area),
                if is_free { 1.0 / mass } else { 0.0 },
            ),
            extent: extent(&body.shape, body.surface),
            has_friction: contacts.iter().any(|law| law.friction > 0.0),
            is_damped: contacts.iter().any(ContactLaw::is_damped),
            contacts,
            surface: body.surface,
            signed_distance,
            contact_points,
            motion: body.motion,
        })
    }
}

/// An upper bound on the distance of particles, spheres and mesh from the centre of mass (m).
fn extent(shape: &Shape, surface: Surface) -> f64 {
    let radius_bound = match surface {
        Surface::None => shape.radius(),
        Surface::Spheres { radius } => shape.radius() + radius,
        Surface::Mesh => {
            let vertices = shape.surface().vertices.iter();
            vertices.fold(shape.radius(), |max, vertex| max.max(vertex.length()))
        }
    };
    radius_bound * (1.0 + 1e-9)
}
