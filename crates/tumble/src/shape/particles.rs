//! The particles of a shape, laid out for loops that run over one coordinate at a time.

use glam::DVec3;

/// Places of particles in the body frame (m), as three arrays of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Particles {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
}

impl Particles {
    /// Takes the places rᵢ (m).
    pub fn new(places: impl IntoIterator<Item = DVec3>) -> Self {
        let mut particles = Self::default();
        for place in places {
            particles.x.push(place.x);
            particles.y.push(place.y);
            particles.z.push(place.z);
        }
        particles
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// The place rᵢ of one particle in the body frame (m).
    ///
    /// # Panics
    /// When `index` is not below [`Particles::len`].
    pub fn get(&self, index: usize) -> DVec3 {
        DVec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// All places (m), in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = DVec3> + '_ {
        (0..self.len()).map(|i| self.get(i))
    }

    /// The three coordinate arrays (m), each of length [`Particles::len`].
    pub fn coordinates(&self) -> (&[f64], &[f64], &[f64]) {
        (&self.x, &self.y, &self.z)
    }
}
