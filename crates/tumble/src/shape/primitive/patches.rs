//! Shapes with axis-aligned faces, assembled from rectangular grids: the box and the T-handle.

use super::error::{PrimitiveError, check_vertex_count};
use crate::shape::mesh::Mesh;
use crate::shape::watertight::weld;
use glam::DVec3;

/// Divides the interval from `from` to `to` into equal parts, with exact ends.
///
/// A symmetric interval gives exactly symmetric values.
fn divide(from: f64, to: f64, parts: u32) -> Vec<f64> {
    let n = f64::from(parts);
    let place = |i: u32| {
        if i == 0 {
            from
        } else if i == parts {
            to
        } else {
            (from * f64::from(parts - i) + to * f64::from(i)) / n
        }
    };
    (0..=parts).map(place).collect()
}

/// The number of parts of about `spacing` in a length, at least one.
fn parts(length: f64, spacing: f64) -> u32 {
    (length / spacing).round().max(1.0) as u32
}

/// Adds a grid in the plane where coordinate `axis` equals `place`; `us` and `vs` are the grid lines along the
/// next two axes, cyclically.
fn add_patch(soup: &mut Mesh, axis: usize, place: f64, outward: f64, [us, vs]: [&[f64]; 2]) {
    let start = soup.vertices.len() as u32;
    for &u in us {
        for &v in vs {
            let mut vertex = DVec3::ZERO;
            vertex[axis] = place;
            vertex[(axis + 1) % 3] = u;
            vertex[(axis + 2) % 3] = v;
            soup.vertices.push(vertex);
        }
    }

    // u × v points along the axis; a face with the opposite normal has the opposite winding
    let row = vs.len() as u32;
    for i in 0..us.len() as u32 - 1 {
        for j in 0..row - 1 {
            let [a, b] = [start + i * row + j, start + (i + 1) * row + j];
            for [p, q, r] in [[a, b, b + 1], [a, b + 1, a + 1]] {
                soup.triangles.push(if outward > 0.0 { [p, q, r] } else { [p, r, q] });
            }
        }
    }
}

/// Merges coincident vertices and numbers them by first appearance.
fn merged(soup: &Mesh) -> Mesh {
    let first_of = weld(&soup.vertices);
    let mut number = vec![0u32; first_of.len()];
    let mut mesh = Mesh::default();
    for (index, &first) in first_of.iter().enumerate() {
        if first as usize == index {
            number[index] = mesh.vertices.len() as u32;
            mesh.vertices.push(soup.vertices[index]);
        } else {
            // the first of the coincident vertices already has its number
            number[index] = number[first as usize];
        }
    }
    mesh.triangles = soup.triangles.iter().map(|t| t.map(|i| number[i as usize])).collect();
    mesh
}

/// A box centred at the origin, each edge divided into `divisions` parts.
pub(super) fn cuboid(size: DVec3, divisions: u32) -> Result<Mesh, PrimitiveError> {
    let n = f64::from(divisions);
    check_vertex_count("box", 6.0 * n * n + 2.0)?;

    let half = 0.5 * size;
    let lines = [0, 1, 2].map(|axis| divide(-half[axis], half[axis], divisions));
    let mut soup = Mesh::default();
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        for side in [-1.0, 1.0] {
            add_patch(&mut soup, axis, side * half[axis], side, [&lines[u], &lines[v]]);
        }
    }
    Ok(merged(&soup))
}

/// A T of square cross-section with its centre of mass at the origin.
pub(super) fn t_handle(
    length: f64,
    width: f64,
    thickness: f64,
    divisions: u32,
) -> Result<Mesh, PrimitiveError> {
    let spacing = thickness / f64::from(divisions);
    let handle = width - thickness;
    let cells = (length + handle) / spacing + 4.0;
    check_vertex_count("t-handle", 4.0 * cells * f64::from(divisions))?;

    // heights above the handle's lower end; the centre is that of two rectangles of equal thickness
    let (bar_y, handle_y) = (handle + 0.5 * thickness, 0.5 * handle);
    let centre = (length * bar_y + handle * handle_y) / (length + handle);
    let bottom = -centre;
    let joint = handle - centre;
    let top = width - centre;

    // grid lines; those of bar and handle agree at the joint
    let (end, side) = (0.5 * length, 0.5 * thickness);
    let arm = parts(end - side, spacing);
    let left = divide(-end, -side, arm);
    let middle = divide(-side, side, divisions);
    let right = divide(side, end, arm);
    let bar_x = [&left[..], &middle[1..], &right[1..]].concat();
    let handle_lines = divide(bottom, joint, parts(handle, spacing));
    let bar_lines = divide(joint, top, divisions);
    let depth = divide(-side, side, divisions);

    let mut soup = Mesh::default();
    // front and back
    for s in [-1.0, 1.0] {
        add_patch(&mut soup, 2, s * side, s, [&bar_x, &bar_lines]);
        add_patch(&mut soup, 2, s * side, s, [&middle, &handle_lines]);
    }
    // the bar's ends and the handle's sides
    for s in [-1.0, 1.0] {
        add_patch(&mut soup, 0, s * end, s, [&bar_lines, &depth]);
        add_patch(&mut soup, 0, s * side, s, [&handle_lines, &depth]);
    }
    // the top; and from below the handle's end and the two arms
    add_patch(&mut soup, 1, top, 1.0, [&depth, &bar_x]);
    add_patch(&mut soup, 1, bottom, -1.0, [&depth, &middle]);
    add_patch(&mut soup, 1, joint, -1.0, [&depth, &left]);
    add_patch(&mut soup, 1, joint, -1.0, [&depth, &right]);
    Ok(merged(&soup))
}
