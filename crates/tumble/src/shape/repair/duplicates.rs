//! Triangles that are there more than once.
//!
//! Copies with the same winding count once. A triangle with a copy of the other winding is a sheet without
//! thickness, as where two boxes share a face: both go, which changes neither the enclosed volume nor whether the mesh is closed. Where
//! a whole surface is there twice, once each way (two-sided faces), one of each stays if what is left is closed.

use super::edges::EdgeTable;
use super::faces::Faces;
use super::sets::ParitySets;
use crate::shape::mesh::Mesh;

/// A mesh without duplicate triangles: the result of [`Mesh::without_duplicates`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deduplicated {
    /// The mesh; all its vertices are kept.
    pub mesh: Mesh,
    /// The number of triangles that were copies of another with the same winding, and were left out.
    pub copies: usize,
    /// The number of triangles left out because they have a counterpart with the other winding.
    pub opposite: usize,
}

/// What becomes of a face.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fate {
    /// It is the only one with its corners.
    Single,
    /// There is one with the other winding, of a higher index.
    FirstOfPair,
    /// There is one with the other winding, of a lower index.
    SecondOfPair,
    /// There is one with the same winding, of a lower index.
    Copy,
}

impl Mesh {
    /// Leaves out triangles that have the same corners as another one; vertices at the same place count as one.
    ///
    /// Of triangles with the same winding, the first stays. Of two with opposite winding, both go; but where a whole
    /// connected surface consists of such pairs, the first of each stays if they form a closed surface, and both stay
    /// if not.
    pub fn without_duplicates(&self) -> Deduplicated {
        let faces = Faces::new(self);
        let mut fates = fates(&faces);
        let copies = fates.iter().filter(|&&fate| fate == Fate::Copy).count();
        if fates.contains(&Fate::SecondOfPair) {
            settle_pairs(&faces, self.vertices.len(), &mut fates);
        }
        let mut dropped = vec![false; self.triangles.len()];
        for (&index, &fate) in faces.index.iter().zip(&fates) {
            dropped[index as usize] = fate != Fate::Single;
        }
        let all = dropped.iter().filter(|&&dropped| dropped).count();
        let kept = self.triangles.iter().zip(dropped).filter(|(_, dropped)| !dropped);
        let triangles = kept.map(|(&triangle, _)| triangle).collect();
        let mesh = Mesh { vertices: self.vertices.clone(), triangles };
        Deduplicated { mesh, copies, opposite: all - copies }
    }
}

fn fates(faces: &Faces) -> Vec<Fate> {
    let mut sorted: Vec<([u32; 3], bool, u32)> = (0u32..)
        .zip(&faces.corners)
        .map(|(face, &[a, b, c])| {
            let mut corners = [a, b, c];
            corners.sort_unstable();
            // an even permutation of the sorted corners
            let is_even = [[a, b, c], [b, c, a], [c, a, b]].contains(&corners);
            (corners, is_even, face)
        })
        .collect();
    sorted.sort_unstable();
    let mut fates = vec![Fate::Single; faces.len()];
    for same in sorted.chunk_by(|a, b| a.0 == b.0) {
        let mut firsts: Vec<u32> = Vec::new();
        for alike in same.chunk_by(|a, b| a.1 == b.1) {
            alike[1..].iter().for_each(|&(.., face)| fates[face as usize] = Fate::Copy);
            firsts.push(alike[0].2);
        }
        if let [a, b] = firsts[..] {
            fates[a.min(b) as usize] = Fate::FirstOfPair;
            fates[a.max(b) as usize] = Fate::SecondOfPair;
        }
    }
    fates
}

/// Decides for each pair whether the first or both stay: these become single.
fn settle_pairs(faces: &Faces, vertex_count: usize, fates: &mut [Fate]) {
    let table = EdgeTable::new(&faces.corners, vertex_count);
    let mut sets = ParitySets::new(faces.len());
    for (_, edge) in table.edges() {
        edge[1..].iter().for_each(|half| {
            sets.join(edge[0].face, half.face, false);
        });
    }
    // of each connected surface: whether it consists of pairs, and whether half of them close it
    let mut all_pairs = vec![true; faces.len()];
    let mut closed = vec![true; faces.len()];
    for face in 0..faces.len() as u32 {
        let root = sets.root(face).0 as usize;
        all_pairs[root] &= fates[face as usize] != Fate::Single;
    }
    for (_, edge) in table.edges() {
        let firsts = edge.iter().filter(|half| fates[half.face as usize] == Fate::FirstOfPair);
        let root = sets.root(edge[0].face).0 as usize;
        closed[root] &= firsts.count() % 2 == 0;
    }
    for face in 0..faces.len() as u32 {
        let root = sets.root(face).0 as usize;
        let fate = &mut fates[face as usize];
        let stays = match *fate {
            Fate::FirstOfPair => all_pairs[root],
            Fate::SecondOfPair => all_pairs[root] && !closed[root],
            Fate::Single | Fate::Copy => false,
        };
        if stays {
            *fate = Fate::Single;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::test_meshes::{cube, cuboid, inside_out, joined};
    use super::*;

    fn check(mesh: &Mesh, triangles: usize, copies: usize, opposite: usize) -> Mesh {
        let found = mesh.without_duplicates();
        let counts = (found.mesh.triangles.len(), found.copies, found.opposite);
        assert_eq!(counts, (triangles, copies, opposite));
        assert_eq!(found.mesh.without_duplicates().mesh, found.mesh, "done once and for all");
        found.mesh
    }

    #[test]
    fn a_cube_that_is_there_several_times_is_one_cube() {
        let one = cube(DVec3::ZERO);
        let twice = joined(&one, &one);
        assert_eq!(check(&twice, 12, 12, 0).solid_integrals().unwrap().measure, 1.0);
        check(&joined(&twice, &one), 12, 24, 0);
        // two-sided faces
        let both_ways = check(&joined(&one, &inside_out(&one)), 12, 0, 12);
        assert_eq!(both_ways.solid_integrals().unwrap().measure, 1.0);
        check(&joined(&twice, &inside_out(&one)), 12, 12, 12);
        check(&one, 12, 0, 0);
    }

    #[test]
    fn the_face_between_two_cubes_goes() {
        // the faces have the same diagonal: one is the mirror image of the other
        let one = cube(DVec3::ZERO);
        let mut other = inside_out(&one);
        other.vertices.iter_mut().for_each(|v| v.x = 1.0 - v.x);
        let mesh = check(&joined(&one, &other), 20, 0, 4);
        assert!(mesh.watertightness().is_manifold());
        assert_eq!(mesh.solid_integrals().unwrap().measure, 2.0);
    }

    #[test]
    fn sheets_without_thickness_go_from_solids_but_stay_by_themselves() {
        let sheet = Mesh {
            vertices: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2], [2, 1, 0]],
        };
        check(&sheet, 2, 0, 0);
        // a fin at an edge of the cube
        let mut fin = cuboid(DVec3::splat(0.5), DVec3::ONE);
        fin.vertices.push(DVec3::new(-1.0, -1.0, 0.5));
        fin.triangles.extend([[0, 8, 4], [4, 8, 0]]);
        assert!(check(&fin, 12, 0, 2).watertightness().is_manifold());
    }
}
