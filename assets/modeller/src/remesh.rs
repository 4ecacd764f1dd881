//! Isotropic remeshing after Botsch and Kobbelt (2004).
//!
//! Long edges are split, short edges collapsed, edges flipped to be Delaunay, and vertices relaxed along the surface,
//! until all edges have about the target length. A pass changes each triangle at most once, so the adjacency that it
//! computes at its start stays valid. No pass opens the surface or changes its topology.

use crate::mesh::{Edge, Mesh};
use crate::solid::Solid;
use glam::DVec3;
use std::collections::BTreeSet;

/// The target edge length at a point of the surface.
pub type Spacing = fn(DVec3) -> f64;

/// Remeshes `mesh`, which lies near the surface of `solid`, to the given spacing.
///
/// # Errors
/// If the mesh is not watertight.
pub fn remesh(mesh: &mut Mesh, solid: &Solid, spacing: Spacing) -> Result<(), String> {
    // the initial mesh is finer than the target: coarsen it first to save time
    while collapse(mesh, spacing)? > 0 {}
    for _ in 0..12 {
        split(mesh, spacing)?;
        while collapse(mesh, spacing)? > 0 {}
        flip(mesh)?;
        relax(mesh, solid, spacing);
        relax(mesh, solid, spacing);
    }
    // improve the shapes of the triangles with a fixed number of vertices
    for _ in 0..12 {
        flip(mesh)?;
        relax(mesh, solid, spacing);
    }
    flip(mesh)
}

/// All edges with the ratio of their length to the target length, shortest first.
fn edges_by_length(mesh: &Mesh, spacing: Spacing) -> Result<Vec<(f64, Edge)>, String> {
    let ratio = |edge: &Edge| {
        let [a, b] = edge.ends.map(|end| mesh.points[end]);
        a.distance(b) / spacing(0.5 * (a + b))
    };
    let mut edges: Vec<_> = mesh.edges()?.into_iter().map(|edge| (ratio(&edge), edge)).collect();
    edges.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.ends.cmp(&b.1.ends)));
    Ok(edges)
}

/// Splits edges that are too long at their midpoints, longest first.
fn split(mesh: &mut Mesh, spacing: Spacing) -> Result<(), String> {
    let mut changed = vec![false; mesh.triangles.len()];
    for (ratio, edge) in edges_by_length(mesh, spacing)?.into_iter().rev() {
        if ratio < 4.0 / 3.0 || edge.faces.iter().any(|&face| changed[face]) {
            continue;
        }
        let [a, b] = edge.ends;
        let middle = mesh.points.len();
        mesh.points.push(0.5 * (mesh.points[a] + mesh.points[b]));
        for face in edge.faces {
            changed[face] = true;
            // one half keeps a, the other keeps b
            let whole = mesh.triangles[face];
            mesh.triangles[face] = whole.map(|vertex| if vertex == b { middle } else { vertex });
            mesh.triangles.push(whole.map(|vertex| if vertex == a { middle } else { vertex }));
        }
    }
    Ok(())
}

/// Collapses edges that are too short, shortest first; returns their number.
fn collapse(mesh: &mut Mesh, spacing: Spacing) -> Result<usize, String> {
    let vertex_faces = mesh.vertex_faces();
    let mut changed = vec![false; mesh.triangles.len()];
    let mut removed = vec![false; mesh.triangles.len()];
    for (ratio, edge) in edges_by_length(mesh, spacing)? {
        if ratio > 4.0 / 5.0 {
            break;
        }
        let [a, b] = edge.ends;
        let adjacent = || vertex_faces[a].iter().chain(&vertex_faces[b]).copied();
        if adjacent().any(|face| changed[face]) {
            continue;
        }
        // the ends may share only the two vertices opposite the edge, otherwise the surface becomes non-manifold
        let shared: Vec<usize> = neighbours(mesh, &vertex_faces, a)
            .intersection(&neighbours(mesh, &vertex_faces, b))
            .copied()
            .collect();
        if shared.len() != 2 || shared.iter().any(|&v| vertex_faces[v].len() < 5) {
            continue;
        }
        let middle = 0.5 * (mesh.points[a] + mesh.points[b]);
        let remaining: Vec<usize> = adjacent().filter(|face| !edge.faces.contains(face)).collect();
        if !remaining.iter().all(|&face| stays_valid(mesh, face, edge.ends, middle, spacing)) {
            continue;
        }
        mesh.points[a] = middle;
        for &face in &remaining {
            mesh.triangles[face] = mesh.triangles[face].map(|c| if c == b { a } else { c });
        }
        edge.faces.iter().for_each(|&face| removed[face] = true);
        // the opposite vertices lose a triangle, so the triangles around them count as changed too
        adjacent()
            .chain(shared.iter().flat_map(|&c| vertex_faces[c].iter().copied()))
            .for_each(|face| changed[face] = true);
    }
    remove_triangles(mesh, &removed);
    Ok(removed.iter().filter(|&&removed| removed).count() / 2)
}

/// Whether a triangle keeps its orientation and does not get too long when its vertex among `ends` moves to `middle`.
fn stays_valid(
    mesh: &Mesh,
    face: usize,
    ends: [usize; 2],
    middle: DVec3,
    spacing: Spacing,
) -> bool {
    let old = mesh.triangles[face];
    let [a, b, c] =
        old.map(|vertex| if ends.contains(&vertex) { middle } else { mesh.points[vertex] });
    let before = mesh.area_vector(old).normalize_or_zero();
    let after = (b - a).cross(c - a).normalize_or_zero();
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    before.dot(after) > 0.5 && longest < 4.0 / 3.0 * spacing(middle)
}

/// Vertices that share an edge with `vertex`.
fn neighbours(mesh: &Mesh, vertex_faces: &[Vec<usize>], vertex: usize) -> BTreeSet<usize> {
    let vertices = vertex_faces[vertex].iter().flat_map(|&face| mesh.triangles[face]);
    vertices.filter(|&other| other != vertex).collect()
}

/// Removes the marked triangles, and the vertices that no triangle uses any more.
fn remove_triangles(mesh: &mut Mesh, removed: &[bool]) {
    let mut retained = removed.iter().map(|&removed| !removed);
    mesh.triangles.retain(|_| retained.next().unwrap_or(true));
    let used: BTreeSet<usize> = mesh.triangles.iter().flatten().copied().collect();
    let mut new_index = vec![0; mesh.points.len()];
    used.iter().enumerate().for_each(|(new, &old)| new_index[old] = new);
    mesh.points = used.iter().map(|&old| mesh.points[old]).collect();
    mesh.triangles.iter_mut().flatten().for_each(|vertex| *vertex = new_index[*vertex]);
}

/// Flips edges that are not Delaunay.
fn flip(mesh: &mut Mesh) -> Result<(), String> {
    let edges = mesh.edges()?;
    let mut existing: BTreeSet<[usize; 2]> = edges.iter().map(|edge| edge.ends).collect();
    let mut valence: Vec<usize> = mesh.vertex_faces().iter().map(Vec::len).collect();
    let mut changed = vec![false; mesh.triangles.len()];
    for Edge { ends: [a, b], faces: [forward, backward] } in edges {
        let opposite =
            |face: usize| mesh.triangles[face].iter().copied().find(|&c| c != a && c != b);
        let (Some(c), Some(d)) = (opposite(forward), opposite(backward)) else { continue };
        let flipped = [c.min(d), c.max(d)];
        let free = !changed[forward] && !changed[backward] && !existing.contains(&flipped);
        if !free || valence[a] < 5 || valence[b] < 5 {
            continue;
        }
        // a negative sum of cotangents means that the opposite angles add up to more than π
        let not_delaunay = cotangent(mesh, c, a, b) + cotangent(mesh, d, a, b) < -1e-6;
        let old = mesh.area_vector([a, b, c]) + mesh.area_vector([a, d, b]);
        let keeps_orientation = [[a, d, c], [d, b, c]].into_iter().all(|new| {
            mesh.area_vector(new).normalize_or_zero().dot(old.normalize_or_zero()) > 0.5
        });
        if not_delaunay && keeps_orientation {
            mesh.triangles[forward] = [a, d, c];
            mesh.triangles[backward] = [d, b, c];
            changed[forward] = true;
            changed[backward] = true;
            existing.insert(flipped);
            [a, b].into_iter().for_each(|end| valence[end] -= 1);
            [c, d].into_iter().for_each(|end| valence[end] += 1);
        }
    }
    Ok(())
}

/// The cotangent of the angle at `apex` between `a` and `b`.
fn cotangent(mesh: &Mesh, apex: usize, a: usize, b: usize) -> f64 {
    let sides = [a, b].map(|end| mesh.points[end] - mesh.points[apex]);
    sides[0].dot(sides[1]) / sides[0].cross(sides[1]).length().max(1e-12)
}

/// Moves every vertex tangentially to the weighted centroid of its triangles, then projects it onto the surface.
fn relax(mesh: &mut Mesh, solid: &Solid, spacing: Spacing) {
    let vertex_faces = mesh.vertex_faces();
    let relaxed: Vec<DVec3> = (0..mesh.points.len())
        .map(|vertex| {
            let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
            for &face in &vertex_faces[vertex] {
                let triangle = mesh.triangles[face];
                let middle = triangle.map(|c| mesh.points[c]).into_iter().sum::<DVec3>() / 3.0;
                // weight by the area relative to the target
                let target = spacing(middle);
                let weight = mesh.area_vector(triangle).length() / (target * target);
                sum += weight * middle;
                weights += weight;
            }
            let point = mesh.points[vertex];
            let normal = solid.gradient(point).normalize_or(DVec3::Y);
            let displacement = sum / weights.max(1e-12) - point;
            let tangential = displacement - displacement.dot(normal) * normal;
            solid.project(point + tangential)
        })
        .collect();
    mesh.points = relaxed;
}
