//! The surface area of each vertex, and particles weighted by it.

use glam::DVec3;

use super::area_weights::{AreaWeights, ParticleSource};
use super::body_shape::Shape;
use super::integrals::ShellError;
use super::mass::diagonalise;
use super::mesh::Mesh;
use super::moments::{MassScaledForm, ParticleMoments};
/// Why the particles of a shape have no surface area.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaError {
    /// They were given as points without a mesh.
    Bare,
    /// They fill a volume.
    Volume,
    /// The mesh has no triangles with an area.
    Surface(ShellError),
}

impl AreaError {
    /// What is allowed for `collision_stiffness_per_area`, as the end of a sentence "must be …".
    pub(crate) fn allowed(&self) -> &'static str {
        match self {
            Self::Bare => {
                "left out: bare particles have no area; give the body a mesh or a shape, or \
                 its own `collision_stiffness`"
            }
            Self::Volume => {
                "left out: particles of sampling = \"volume\" lie inside and have no area; use \
                 \"vertices\" or \"surface\", or give the body its own `collision_stiffness`"
            }
            Self::Surface(_) => {
                "left out: the mesh has no triangles with an area; give the body its own \
                 `collision_stiffness`"
            }
        }
    }
}

impl std::fmt::Display for AreaError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a stiffness per area must be {}", self.allowed())?;
        match self {
            Self::Surface(error) => write!(f, " ({error})"),
            _ => Ok(()),
        }
    }
}

impl std::error::Error for AreaError {}

impl Shape {
    /// A copy of the shape with particles weighted by their surface areas Aᵢ: wᵢ = Aᵢ/Ā, Ā = A/N.
    ///
    /// The area of a vertex is a third of each triangle around it. Vertices at equal coordinates share
    /// their area equally, and a vertex in no triangle has none. Particles sampled from a surface have
    /// equal areas A/N and keep the weight 1.
    ///
    /// [`WorldBuilder`](crate::WorldBuilder) uses this copy for bodies with a stiffness per area in any
    /// of their contacts; other bodies keep the unweighted shape, which is faster.
    ///
    /// # Errors
    /// [`AreaError`] if the particles do not lie on a surface.
    pub fn with_area_weights(&self) -> Result<Self, AreaError> {
        let area = match self.particle_source {
            ParticleSource::Points => return Err(AreaError::Bare),
            ParticleSource::Volume => return Err(AreaError::Volume),
            ParticleSource::Vertices | ParticleSource::Surface => {
                self.surface().shell_integrals().map_err(AreaError::Surface)?.measure
            }
        };
        let mean_area = area / self.particles().len() as f64;
        if self.particle_source == ParticleSource::Surface {
            let mut unweighted = self.clone();
            unweighted.area_weights = Some(AreaWeights { mean_area, fastest: None });
            return Ok(unweighted);
        }
        let weights: Vec<f64> =
            vertex_areas(self.surface()).into_iter().map(|area| area / mean_area).collect();
        Ok(self.clone().weighted(&weights, mean_area))
    }

    /// The shape with these particle weights and this mean area (m²).
    pub(crate) fn weighted(mut self, weights: &[f64], mean_area: f64) -> Self {
        self.particles = self.particles.with_weights(weights);
        let moments = ParticleMoments::weighted(&self.particles);
        let (rates, _) = diagonalise(MassScaledForm::new(&moments, self.principal(), 1.0).matrix);
        let fastest = Some(rates.iter().fold(0.0, |m: f64, &rate| m.max(rate)));
        self.area_weights = Some(AreaWeights { mean_area, fastest });
        self
    }

    /// The mean surface area per particle Ā (m²), for a shape made by [`Shape::with_area_weights`].
    pub fn mean_area(&self) -> Option<f64> {
        self.area_weights.map(|weights| weights.mean_area)
    }

    /// The largest stiffness over mass (1/kg) of the body at 1 kg, with springs of 1 N/m times their weights
    /// in all directions at all particles; `None` where all weights are 1.
    pub(crate) fn fastest_contact(&self) -> Option<f64> {
        self.area_weights.and_then(|weights| weights.fastest)
    }
}

/// The surface area of each vertex of a mesh (m²).
fn vertex_areas(mesh: &Mesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize]);
        let third = (b - a).cross(c - a).length() / 6.0;
        triangle.iter().for_each(|&i| areas[i as usize] += third);
    }
    average_coincident(mesh, &mut areas);
    areas
}

/// Replaces the areas of vertices at equal coordinates by their mean.
fn average_coincident(mesh: &Mesh, areas: &mut [f64]) {
    // adding zero turns −0 into 0
    let place = |i: &u32| (mesh.vertices[*i as usize] + DVec3::ZERO).to_array();
    let mut order: Vec<u32> = (0..areas.len() as u32).collect();
    order.sort_unstable_by(|i, j| {
        let axes = place(i).into_iter().zip(place(j));
        let by_place = axes.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne());
        by_place.unwrap_or_else(|| i.cmp(j))
    });
    for same in order.chunk_by(|i, j| place(i) == place(j)) {
        if same.len() > 1 {
            let together: f64 = same.iter().map(|&i| areas[i as usize]).sum();
            same.iter().for_each(|&i| areas[i as usize] = together / same.len() as f64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MassModel, Primitive, Sampling};

    /// A square of 1 m² made of two triangles, with duplicate vertices on the diagonal.
    fn square_with_seam() -> Mesh {
        let corners = [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]];
        let vertices = corners.map(|[x, z]| DVec3::new(f64::from(x), 0.0, -f64::from(z))).to_vec();
        Mesh { vertices, triangles: vec![[0, 1, 2], [3, 4, 5]] }
    }

    #[test]
    fn coincident_vertices_have_equal_areas() {
        let mut mesh = square_with_seam();
        // a vertex of no triangle
        mesh.vertices.push(DVec3::new(5.0, 0.0, 0.0));
        // a vertex of no triangle that coincides with a corner
        mesh.vertices.push(DVec3::new(1.0, -0.0, 0.0));
        let sixth = 1.0 / 6.0;
        let expected = [sixth, 0.5 * sixth, sixth, sixth, sixth, sixth, 0.0, 0.5 * sixth];
        for (area, expected) in vertex_areas(&mesh).into_iter().zip(expected) {
            assert!((area - expected).abs() < 1e-15, "{area} {expected}");
        }
    }

    #[test]
    fn the_mean_weight_is_one() {
        let size = DVec3::new(0.3, 0.2, 0.1);
        let mesh = Primitive::Box { size, divisions: 4 }.mesh().unwrap();
        let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap();
        assert_eq!((shape.particles().weight(0), shape.mean_area()), (1.0, None));
        let weighted = shape.with_area_weights().unwrap();
        let particles = weighted.particles();
        let weights: Vec<f64> = (0..particles.len()).map(|i| particles.weight(i)).collect();
        let sum: f64 = weights.iter().sum();
        assert!((sum / particles.len() as f64 - 1.0).abs() < 1e-13);
        // the triangles differ in size
        assert!(weights.iter().any(|&w| w < 0.7) && weights.iter().any(|&w| w > 1.2));
        let area = mesh.shell_integrals().unwrap().measure;
        let mean = weighted.mean_area().unwrap();
        assert!((mean * particles.len() as f64 / area - 1.0).abs() < 1e-14);
        // for translation the ratio is N, and the largest is no less
        assert!(weighted.fastest_contact().unwrap() >= sum * (1.0 - 1e-12));
    }

    #[test]
    fn particles_of_a_sampled_surface_keep_unit_weights() {
        let mesh = Primitive::Sphere { radius: 0.1, subdivisions: 3 }.mesh().unwrap();
        let sampling = Sampling::Surface { spacing: 0.03 };
        let shape = Shape::from_mesh(&mesh, sampling, MassModel::Particles).unwrap();
        let shared = shape.with_area_weights().unwrap();
        assert_eq!(shared.particles(), shape.particles());
        assert!(!shared.particles().is_weighted() && shared.mean_area().unwrap() > 0.0);
    }

    #[test]
    fn particles_without_a_surface_have_no_area() {
        let mesh = Primitive::Sphere { radius: 0.1, subdivisions: 3 }.mesh().unwrap();
        let filled = Sampling::Volume { spacing: 0.03 };
        let of = |mesh: &Mesh, sampling| Shape::from_mesh(mesh, sampling, MassModel::Particles);
        let filled = of(&mesh, filled).unwrap();
        assert_eq!(filled.with_area_weights(), Err(AreaError::Volume));
        let bare = Shape::from_particles(&mesh.vertices).unwrap();
        assert_eq!(bare.with_area_weights(), Err(AreaError::Bare));
        let points = Mesh { triangles: Vec::new(), ..mesh };
        let error = of(&points, Sampling::Vertices).unwrap().with_area_weights().unwrap_err();
        assert_eq!(error, AreaError::Surface(ShellError::NoTriangles));
        assert!(error.to_string().contains("no triangles"), "{error}");
    }
}
