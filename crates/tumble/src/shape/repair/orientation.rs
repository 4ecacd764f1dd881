//! Winds each closed surface of a mesh: outer ones outwards, those of cavities inwards.

use glam::DVec3;

use super::containment::{Nesting, Surfaces};
use super::faces::Faces;
use super::shells::Shells;
use crate::shape::integrals::NEGLIGIBLE;
use crate::shape::mesh::Mesh;

/// A consistently wound mesh: the result of [`Mesh::oriented`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Oriented {
    /// The mesh; vertices and the order of triangles are unchanged.
    pub mesh: Mesh,
    /// The number of closed surfaces, small holes allowed. They are connected by edges at which two triangles meet.
    pub shells: usize,
    /// How many of them lie within an odd number of others, and so bound cavities.
    pub cavities: usize,
    /// How many of them cross another one.
    pub crossing: usize,
    /// How many closed surfaces were wound the wrong way round as a whole, and were turned.
    pub turned: usize,
    /// The number of triangles that were wound against most others of their connected surface, and were turned.
    pub rewound: usize,
    /// The number of edges at which no winding is consistent, as on a Möbius strip. Such surfaces are left as they are.
    pub one_sided: usize,
    /// The middle of the first of these edges (m).
    pub first_one_sided: Option<DVec3>,
    /// Whether there were too many surfaces in one place to find out which lie in which. All count as outer ones then.
    pub is_undecided: bool,
}

impl Mesh {
    /// Winds the triangles of each closed surface consistently: outwards, or inwards if the surface lies within an odd number of others and so
    /// bounds a cavity. Vertices at the same place count as one.
    ///
    /// Surfaces that cross each other are all outer ones. Open surfaces are wound consistently, as most of their triangles
    /// are. Surfaces without volume and one-sided ones are left as they are. Whether one surface lies in another is judged
    /// by up to 64 of its points.
    pub fn oriented(&self) -> Oriented {
        let faces = Faces::new(self);
        let shells = Shells::new(self, &faces);
        let volumes = volumes(self, &faces, &shells);
        let (nesting, is_undecided) = nesting(self, &faces, &shells);
        let is_wrong = |n: usize| {
            let sign = if nesting[n].depth % 2 == 1 { -1.0 } else { 1.0 };
            sign * volumes[n] < 0.0
        };
        let turned: Vec<bool> = (0..shells.count).map(is_wrong).collect();

        let mut mesh = self.clone();
        for (face, &index) in faces.index.iter().enumerate() {
            let is_turned = shells.of_face[face].is_some_and(|shell| turned[shell as usize]);
            if shells.rewound[face] != is_turned {
                mesh.triangles[index as usize].swap(1, 2);
            }
        }
        let count = |of: &dyn Fn(&Nesting) -> bool| nesting.iter().filter(|n| of(n)).count();
        Oriented {
            mesh,
            shells: shells.count,
            cavities: count(&|n| n.depth % 2 == 1),
            crossing: count(&|n| n.crosses),
            turned: turned.iter().filter(|&&turned| turned).count(),
            rewound: shells.rewound.iter().filter(|&&rewound| rewound).count(),
            one_sided: shells.one_sided,
            first_one_sided: shells.first_one_sided,
            is_undecided,
        }
    }
}

/// Six times the volume of each closed shell, as wound; 0 if it is that up to rounding.
fn volumes(mesh: &Mesh, faces: &Faces, shells: &Shells) -> Vec<f64> {
    let mut bounds = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; shells.count];
    let of_shells = || {
        let faces_of = (0..faces.len()).zip(&shells.of_face);
        faces_of.filter_map(|(f, shell)| Some(((*shell)? as usize, f, faces.places(mesh, f))))
    };
    for (n, _, corners) in of_shells() {
        let [low, high] = &mut bounds[n];
        for p in corners {
            (*low, *high) = (low.min(p), high.max(p));
        }
    }
    let mut sums = vec![(0.0, 0.0); shells.count];
    for (n, face, corners) in of_shells() {
        let [low, high] = bounds[n];
        let [a, b, c] = corners.map(|p| p - (0.5 * low + 0.5 * high));
        let volume = a.dot(b.cross(c));
        sums[n].0 += if shells.rewound[face] { -volume } else { volume };
        sums[n].1 += (b - a).cross(c - a).length();
    }
    let sizes = bounds.iter().map(|[low, high]| (*high - *low).max_element());
    sums.iter()
        .zip(sizes)
        .map(
            |(&(volume, area), size): (&(f64, f64), f64)| {
                if volume.abs() <= NEGLIGIBLE * size * area { 0.0 } else { volume }
            },
        )
        .collect()
}

/// Where each closed shell lies, and whether that could not be found out.
fn nesting(mesh: &Mesh, faces: &Faces, shells: &Shells) -> (Vec<Nesting>, bool) {
    let outer = vec![Nesting::default(); shells.count];
    if shells.count < 2 {
        return (outer, false);
    }
    let of_face = (0..faces.len()).zip(&shells.of_face);
    let triangles = of_face.filter_map(|(f, shell)| Some(((*shell)?, faces.places(mesh, f))));
    match Surfaces::new(shells.count, triangles).nesting() {
        Some(nesting) => (nesting, false),
        None => (outer, true),
    }
}

#[cfg(test)]
mod tests;
