//! Even, well-shaped triangles: the isotropic remeshing of Botsch and Kobbelt (2004).
//!
//! Long edges are split, short ones collapsed, wrong diagonals flipped, and vertices slide along
//! the surface towards the middle of their neighbours, until all edges have the length wanted.
//! Each pass only touches triangles that it has not yet touched, so that what it knows of the mesh
//! stays true; no pass can open the surface or change its topology.

use crate::mesh::{Edge, Mesh};
use crate::solid::Solid;
use glam::DVec3;
use std::collections::BTreeSet;

/// The wanted edge length at a point of the surface.
pub type Spacing = fn(DVec3) -> f64;

/// Remeshes `mesh`, which lies near the surface of `solid`, to the given spacing.
pub fn remesh(mesh: &mut Mesh, solid: &Solid, spacing: Spacing) -> Result<(), String> {
    // the lattice is finer than wanted: thin it out before anything costs time
    while collapse(mesh, spacing)? > 0 {}
    for _ in 0..12 {
        split(mesh, spacing)?;
        while collapse(mesh, spacing)? > 0 {}
        flip(mesh)?;
        relax(mesh, solid, spacing);
        relax(mesh, solid, spacing);
    }
    // the count stands; now only the shapes of the triangles improve
    for _ in 0..12 {
        flip(mesh)?;
        relax(mesh, solid, spacing);
    }
    flip(mesh)
}

/// Edges with their length over the wanted length, shortest first.
fn by_length(mesh: &Mesh, spacing: Spacing) -> Result<Vec<(f64, Edge)>, String> {
    let ratio = |edge: &Edge| {
        let [a, b] = edge.ends.map(|end| mesh.points[end]);
        a.distance(b) / spacing(0.5 * (a + b))
    };
    let mut edges: Vec<_> = mesh.edges()?.into_iter().map(|edge| (ratio(&edge), edge)).collect();
    edges.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.ends.cmp(&b.1.ends)));
    Ok(edges)
}

/// Puts a vertex in the middle of edges that are too long, longest first.
fn split(mesh: &mut Mesh, spacing: Spacing) -> Result<(), String> {
    let mut touched = vec![false; mesh.triangles.len()];
    for (ratio, edge) in by_length(mesh, spacing)?.into_iter().rev() {
        if ratio < 4.0 / 3.0 || edge.sides.iter().any(|&side| touched[side]) {
            continue;
        }
        let [a, b] = edge.ends;
        let middle = mesh.points.len();
        mesh.points.push(0.5 * (mesh.points[a] + mesh.points[b]));
        for side in edge.sides {
            touched[side] = true;
            // one half keeps a and loses b, the other the reverse
            let whole = mesh.triangles[side];
            mesh.triangles[side] = whole.map(|corner| if corner == b { middle } else { corner });
            mesh.triangles.push(whole.map(|corner| if corner == a { middle } else { corner }));
        }
    }
    Ok(())
}

/// Merges the ends of edges that are too short, shortest first, and counts them.
fn collapse(mesh: &mut Mesh, spacing: Spacing) -> Result<usize, String> {
    let rings = mesh.rings();
    let mut touched = vec![false; mesh.triangles.len()];
    let mut dead = vec![false; mesh.triangles.len()];
    for (ratio, edge) in by_length(mesh, spacing)? {
        if ratio > 4.0 / 5.0 {
            break;
        }
        let [a, b] = edge.ends;
        let around = || rings[a].iter().chain(&rings[b]).copied();
        if around().any(|side| touched[side]) {
            continue;
        }
        // only the two triangles of the edge may connect both ends, else the surface would pinch
        let shared: Vec<usize> = neighbours(mesh, &rings, a)
            .intersection(&neighbours(mesh, &rings, b))
            .copied()
            .collect();
        if shared.len() != 2 || shared.iter().any(|&corner| rings[corner].len() < 5) {
            continue;
        }
        let middle = 0.5 * (mesh.points[a] + mesh.points[b]);
        let kept: Vec<usize> = around().filter(|side| !edge.sides.contains(side)).collect();
        if !kept.iter().all(|&side| survives(mesh, side, edge.ends, middle, spacing)) {
            continue;
        }
        mesh.points[a] = middle;
        for &side in &kept {
            mesh.triangles[side] = mesh.triangles[side].map(|c| if c == b { a } else { c });
        }
        edge.sides.iter().for_each(|&side| dead[side] = true);
        // the corners that lost a triangle are touched as well
        around()
            .chain(shared.iter().flat_map(|&c| rings[c].iter().copied()))
            .for_each(|side| touched[side] = true);
    }
    sweep(mesh, &dead);
    Ok(dead.iter().filter(|&&dead| dead).count() / 2)
}

/// Whether a triangle stays sound when its corner among `ends` moves to `middle`.
fn survives(mesh: &Mesh, side: usize, ends: [usize; 2], middle: DVec3, spacing: Spacing) -> bool {
    let old = mesh.triangles[side];
    let [a, b, c] =
        old.map(|corner| if ends.contains(&corner) { middle } else { mesh.points[corner] });
    let before = mesh.area_vector(old).normalize_or_zero();
    let after = (b - a).cross(c - a).normalize_or_zero();
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    before.dot(after) > 0.5 && longest < 4.0 / 3.0 * spacing(middle)
}

/// Vertices that share an edge with `vertex`.
fn neighbours(mesh: &Mesh, rings: &[Vec<usize>], vertex: usize) -> BTreeSet<usize> {
    let corners = rings[vertex].iter().flat_map(|&side| mesh.triangles[side]);
    corners.filter(|&corner| corner != vertex).collect()
}

/// Drops dead triangles and the vertices that no triangle uses.
fn sweep(mesh: &mut Mesh, dead: &[bool]) {
    let mut alive = dead.iter().map(|&dead| !dead);
    mesh.triangles.retain(|_| alive.next().unwrap_or(true));
    let used: BTreeSet<usize> = mesh.triangles.iter().flatten().copied().collect();
    let mut renamed = vec![0; mesh.points.len()];
    used.iter().enumerate().for_each(|(new, &old)| renamed[old] = new);
    mesh.points = used.iter().map(|&old| mesh.points[old]).collect();
    mesh.triangles.iter_mut().flatten().for_each(|corner| *corner = renamed[*corner]);
}

/// Turns the diagonal of a pair of triangles where the other diagonal is the Delaunay one.
fn flip(mesh: &mut Mesh) -> Result<(), String> {
    let edges = mesh.edges()?;
    let mut known: BTreeSet<[usize; 2]> = edges.iter().map(|edge| edge.ends).collect();
    let mut valence: Vec<usize> = mesh.rings().iter().map(Vec::len).collect();
    let mut touched = vec![false; mesh.triangles.len()];
    for Edge { ends: [a, b], sides: [with, against] } in edges {
        let opposite =
            |side: usize| mesh.triangles[side].iter().copied().find(|&c| c != a && c != b);
        let (Some(c), Some(d)) = (opposite(with), opposite(against)) else { continue };
        let across = [c.min(d), c.max(d)];
        let free = !touched[with] && !touched[against] && !known.contains(&across);
        if !free || valence[a] < 5 || valence[b] < 5 {
            continue;
        }
        // a negative sum of cotangents says that the two opposite angles exceed a half turn
        let bent = cotangent(mesh, c, a, b) + cotangent(mesh, d, a, b) < -1e-6;
        let old = mesh.area_vector([a, b, c]) + mesh.area_vector([a, d, b]);
        let sound = [[a, d, c], [d, b, c]].into_iter().all(|new| {
            mesh.area_vector(new).normalize_or_zero().dot(old.normalize_or_zero()) > 0.5
        });
        if bent && sound {
            mesh.triangles[with] = [a, d, c];
            mesh.triangles[against] = [d, b, c];
            touched[with] = true;
            touched[against] = true;
            known.insert(across);
            [a, b].into_iter().for_each(|end| valence[end] -= 1);
            [c, d].into_iter().for_each(|end| valence[end] += 1);
        }
    }
    Ok(())
}

/// The cotangent of the angle at `apex` towards two other vertices.
fn cotangent(mesh: &Mesh, apex: usize, a: usize, b: usize) -> f64 {
    let arms = [a, b].map(|end| mesh.points[end] - mesh.points[apex]);
    arms[0].dot(arms[1]) / arms[0].cross(arms[1]).length().max(1e-12)
}

/// Moves every vertex along the surface to the weighted middle of its triangles, then back onto
/// the surface.
fn relax(mesh: &mut Mesh, solid: &Solid, spacing: Spacing) {
    let rings = mesh.rings();
    let slid: Vec<DVec3> = (0..mesh.points.len())
        .map(|vertex| {
            let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
            for &side in &rings[vertex] {
                let triangle = mesh.triangles[side];
                let middle = triangle.map(|c| mesh.points[c]).into_iter().sum::<DVec3>() / 3.0;
                // triangles pull in proportion to how much larger than wanted they are
                let wanted = spacing(middle);
                let weight = mesh.area_vector(triangle).length() / (wanted * wanted);
                sum += weight * middle;
                weights += weight;
            }
            let point = mesh.points[vertex];
            let normal = solid.gradient(point).normalize_or(DVec3::Y);
            let pull = sum / weights.max(1e-12) - point;
            let slide = pull - pull.dot(normal) * normal;
            solid.project(point + slide)
        })
        .collect();
    mesh.points = slid;
}
