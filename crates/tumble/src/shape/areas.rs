//! How the particles of a body share the area of its surface.

use glam::{DMat3, DVec3};

use super::body_shape::{ParticleMoments, Shape};
use super::mass::{inertia_from_second_moment, outer};
use super::{Mesh, Particles, Sampling, ShellError};
use crate::flight::DragModes;

/// Where the particles of a shape lie on its surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cover {
    /// Nothing is known of it: bare particles.
    Bare,
    /// They are the vertices of its mesh.
    Vertices,
    /// They are spread evenly over it.
    Even,
    /// They fill what it encloses.
    Volume,
}

impl From<Sampling> for Cover {
    fn from(sampling: Sampling) -> Self {
        match sampling {
            Sampling::Vertices => Self::Vertices,
            Sampling::Surface { .. } => Self::Even,
            Sampling::Volume { .. } => Self::Volume,
        }
    }
}

/// What is known of a shape whose particles share its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shares {
    /// The mean share Ā = A/N (m²).
    mean_area: f64,
    /// The largest Σ wᵢ |uᵢ|² of all motions whose kinetic energy with 1 kg is ½ J; `None` where all weigh one.
    fastest: Option<f64>,
}

/// Why the particles of a shape do not share a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaError {
    /// They were given as points, without a mesh that they belong to.
    Bare,
    /// They fill a volume.
    Volume,
    /// The mesh has no triangles with an area.
    Surface(ShellError),
}

impl AreaError {
    /// What `collision_stiffness_per_area` would have to be.
    pub(crate) fn allowed(&self) -> &'static str {
        match self {
            Self::Bare => {
                "left out: bare particles have no area to share; give the body a mesh or a shape, or \
                 its own `collision_stiffness`"
            }
            Self::Volume => {
                "left out: particles of sampling = \"volume\" lie inside and have no area to share; take \
                 \"vertices\" or \"surface\", or give the body its own `collision_stiffness`"
            }
            Self::Surface(_) => {
                "left out: the mesh has no triangles with an area to share; give the body its \
                 own `collision_stiffness`"
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
    /// The same shape, its particles weighted by their shares Aᵢ of its surface: wᵢ = Aᵢ/Ā, Ā = A/N.
    ///
    /// A vertex has a third of each triangle around it; vertices at equal coordinates share evenly, and
    /// one that is in no triangle has nothing. Particles that are sampled from a surface have A/N each,
    /// and keep the weight 1 and with it all the speed.
    ///
    /// [`WorldBuilder`](crate::WorldBuilder) gives a body this twin of its shape where any of its contacts has a stiffness per area, so that what is
    /// said of all particles stays as it is, and a body without such contacts pays nothing.
    ///
    /// # Errors
    /// [`AreaError`] where the particles do not lie on a surface.
    pub fn with_area_weights(&self) -> Result<Self, AreaError> {
        let area = match self.cover {
            Cover::Bare => return Err(AreaError::Bare),
            Cover::Volume => return Err(AreaError::Volume),
            Cover::Vertices | Cover::Even => {
                self.surface().shell_integrals().map_err(AreaError::Surface)?.measure
            }
        };
        let mean_area = area / self.particles().len() as f64;
        if self.cover == Cover::Even {
            let mut even = self.clone();
            even.shares = Some(Shares { mean_area, fastest: None });
            return Ok(even);
        }
        let weights: Vec<f64> =
            vertex_areas(self.surface()).into_iter().map(|area| area / mean_area).collect();
        Ok(self.clone().weighted(&weights, mean_area))
    }

    /// With these weights and this mean share (m²).
    pub(crate) fn weighted(mut self, weights: &[f64], mean_area: f64) -> Self {
        self.particles = self.particles.with_weights(weights);
        let moments = weighted_moments(&self.particles);
        let fastest = Some(DragModes::of_moments(&moments, self.principal(), 1.0).fastest());
        self.shares = Some(Shares { mean_area, fastest });
        self
    }

    /// The mean share Ā of a particle in the surface (m²), of a shape made by [`Shape::with_area_weights`].
    pub fn mean_area(&self) -> Option<f64> {
        self.shares.map(|shares| shares.mean_area)
    }

    /// The largest stiffness over mass, for 1 kg and springs of 1 N/m times their weights in all directions at all
    /// particles (1/kg); `None` where particles do not weigh differently.
    pub(crate) fn fastest_contact(&self) -> Option<f64> {
        self.shares.and_then(|shares| shares.fastest)
    }
}

fn weighted_moments(particles: &Particles) -> ParticleMoments {
    let (mut count, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
    for (index, r) in particles.iter().enumerate() {
        let weight = particles.weight(index);
        count += weight;
        first += r * weight;
        second += outer(r, r) * weight;
    }
    let second = inertia_from_second_moment(second);
    ParticleMoments { count, first, second, carry_mass: false }
}

/// The share of each vertex in the area of a mesh (m²).
fn vertex_areas(mesh: &Mesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize]);
        let third = (b - a).cross(c - a).length() / 6.0;
        triangle.iter().for_each(|&i| areas[i as usize] += third);
    }
    share_evenly(mesh, &mut areas);
    areas
}

/// Gives vertices at equal coordinates equal parts of what they have together.
fn share_evenly(mesh: &Mesh, areas: &mut [f64]) {
    // zero has two signs and is one place
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
    use crate::{MassModel, Primitive};

    /// A square of 1 m², of two triangles whose corners on the diagonal are there twice.
    fn seam() -> Mesh {
        let corners = [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]];
        let vertices = corners.map(|[x, z]| DVec3::new(f64::from(x), 0.0, -f64::from(z))).to_vec();
        Mesh { vertices, triangles: vec![[0, 1, 2], [3, 4, 5]] }
    }

    #[test]
    fn vertices_in_one_place_share_evenly() {
        let mut mesh = seam();
        // one that no triangle has
        mesh.vertices.push(DVec3::new(5.0, 0.0, 0.0));
        // and a corner that has no triangle where others have
        mesh.vertices.push(DVec3::new(1.0, -0.0, 0.0));
        let sixth = 1.0 / 6.0;
        let expected = [sixth, 0.5 * sixth, sixth, sixth, sixth, sixth, 0.0, 0.5 * sixth];
        for (area, expected) in vertex_areas(&mesh).into_iter().zip(expected) {
            assert!((area - expected).abs() < 1e-15, "{area} {expected}");
        }
    }

    #[test]
    fn weights_are_one_in_the_mean() {
        let size = DVec3::new(0.3, 0.2, 0.1);
        let mesh = Primitive::Box { size, divisions: 4 }.mesh().unwrap();
        let shape = Shape::of_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap();
        assert_eq!((shape.particles().weight(0), shape.mean_area()), (1.0, None));
        let weighted = shape.with_area_weights().unwrap();
        let particles = weighted.particles();
        let weights: Vec<f64> = (0..particles.len()).map(|i| particles.weight(i)).collect();
        let sum: f64 = weights.iter().sum();
        assert!((sum / particles.len() as f64 - 1.0).abs() < 1e-13);
        // the faces are of different sizes
        assert!(weights.iter().any(|&w| w < 0.7) && weights.iter().any(|&w| w > 1.2));
        let area = mesh.shell_integrals().unwrap().measure;
        let mean = weighted.mean_area().unwrap();
        assert!((mean * particles.len() as f64 / area - 1.0).abs() < 1e-14);
        // translation alone has the ratio N; no motion less
        assert!(weighted.fastest_contact().unwrap() >= sum * (1.0 - 1e-12));
    }

    #[test]
    fn sampled_surfaces_have_equal_shares() {
        let mesh = Primitive::Sphere { radius: 0.1, subdivisions: 3 }.mesh().unwrap();
        let sampling = Sampling::Surface { spacing: 0.03 };
        let shape = Shape::of_mesh(&mesh, sampling, MassModel::Particles).unwrap();
        let shared = shape.with_area_weights().unwrap();
        assert_eq!(shared.particles(), shape.particles());
        assert!(!shared.particles().is_weighted() && shared.mean_area().unwrap() > 0.0);
    }

    #[test]
    fn without_a_surface_there_is_nothing_to_share() {
        let mesh = Primitive::Sphere { radius: 0.1, subdivisions: 3 }.mesh().unwrap();
        let filled = Sampling::Volume { spacing: 0.03 };
        let of = |mesh: &Mesh, sampling| Shape::of_mesh(mesh, sampling, MassModel::Particles);
        let filled = of(&mesh, filled).unwrap();
        assert_eq!(filled.with_area_weights(), Err(AreaError::Volume));
        let bare = Shape::of_particles(&mesh.vertices).unwrap();
        assert_eq!(bare.with_area_weights(), Err(AreaError::Bare));
        let points = Mesh { triangles: Vec::new(), ..mesh };
        let error = of(&points, Sampling::Vertices).unwrap().with_area_weights().unwrap_err();
        assert_eq!(error, AreaError::Surface(ShellError::NoTriangles));
        assert!(error.to_string().contains("no triangles"), "{error}");
    }
}
