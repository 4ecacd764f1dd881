//! Lattice points inside a closed mesh.
//!
//! For each column of the lattice, a line along z counts its signed crossings with the triangles. A point is inside if
//! the count below it is not zero. Whether a line crosses a triangle is decided in the xy plane, by the winding number
//! of the triangle's edges about the line. Both triangles of an edge compute the same bits, so the total count of a
//! closed mesh is zero for every line, even through edges and vertices, and only points within rounding of the surface
//! can be misclassified.
//! Source of the winding number: D. Sunday, "Inclusion of a point in a polygon" (2001).

use super::error::{SampleError, check_point_count};
use crate::shape::integrals::Bounds;
use crate::shape::mesh::Mesh;
use glam::{DVec2, DVec3};

/// A point closer to the surface than this fraction of the spacing (or of the mesh, if smaller) counts as outside.
const ON_SURFACE: f64 = 1e-6;

/// Slope of the lines' offsets; irrational, so that no line lies in a wall at a simple angle.
const SLOPE: f64 = 0.618_033_988_749_894_8;

/// Offsets of the four lines of a column. A point is inside if it is inside on all four lines, so that points on a
/// wall on any side count as outside.
const LINES: [DVec2; 4] = [
    DVec2::new(-1.0, -SLOPE),
    DVec2::new(1.0, -SLOPE),
    DVec2::new(-1.0, SLOPE),
    DVec2::new(1.0, SLOPE),
];

/// A cubic lattice centred at the origin.
struct Lattice {
    spacing: f64,
    /// Points within this distance (m) of the surface count as outside.
    offset: f64,
    /// The number of layers along each axis.
    counts: [i64; 3],
}

impl Lattice {
    /// The lattice with the number of layers that best fits each edge of the bounds. The outermost layers lie inside by
    /// at least a quarter of the spacing.
    fn new(bounds: &Bounds, spacing: f64) -> Self {
        let edges = (bounds.max - bounds.min).to_array();
        // the tolerance makes the count independent of rounding
        let counts = edges.map(|e| ((e / spacing + 0.5 + 1e-9).floor() as i64).max(1));
        Self { spacing, offset: ON_SURFACE * spacing.min(bounds.size()), counts }
    }

    /// Coordinate of a layer (m).
    fn at(&self, axis: usize, layer: i64) -> f64 {
        0.5 * (2 * layer - (self.counts[axis] - 1)) as f64 * self.spacing
    }

    /// The first layer at or above a coordinate (m), up to an error of one.
    fn layer_above(&self, axis: usize, coordinate: f64) -> i64 {
        let layer = coordinate / self.spacing + 0.5 * (self.counts[axis] - 1) as f64;
        (layer.ceil() as i64).clamp(0, self.counts[axis])
    }

    /// The layers between two coordinates, with one more at each end.
    fn layers(&self, axis: usize, low: f64, high: f64) -> std::ops::Range<i64> {
        let first = (self.layer_above(axis, low) - 1).max(0);
        first..(self.layer_above(axis, high) + 1).min(self.counts[axis])
    }
}

/// A crossing of a line with the surface.
#[derive(Clone, Copy)]
struct Crossing {
    /// The layers of the column along y and x.
    column: [i64; 2],
    z: f64,
    /// The index of the line in the column.
    line: u8,
    /// 1 where the line leaves a solid wound outwards, −1 where it enters.
    sign: i8,
}

/// The winding number of a triangle's edges about a point of the xy plane, and the height of the triangle there.
fn crossing([a, b, c]: [DVec3; 3], foot: DVec2) -> Option<(i8, f64)> {
    let mut winding = 0;
    // the points of the edges at the y of the point; there are two or none
    let mut level = [DVec3::ZERO; 2];
    let mut count = 0;
    for (p, q) in [(a, b), (b, c), (c, a)] {
        if (p.y > foot.y) == (q.y > foot.y) {
            continue;
        }
        // from the lower end, so that both triangles of the edge compute the same bits
        let (low, high) = if p.y < q.y { (p, q) } else { (q, p) };
        let left = (high.x - low.x) * (foot.y - low.y) - (high.y - low.y) * (foot.x - low.x);
        if left > 0.0 {
            winding += if p.y < q.y { 1 } else { -1 };
        }
        level[count % 2] = low + (high - low) * ((foot.y - low.y) / (high.y - low.y));
        count += 1;
    }
    if winding == 0 {
        return None;
    }

    // interpolated between the two edges; the height in a vertical triangle is limited to them
    let [p, q] = level;
    let part = (foot.x - p.x) / (q.x - p.x);
    let part = if part.is_nan() { 0.5 } else { part.clamp(0.0, 1.0) };
    Some((winding, p.z + part * (q.z - p.z)))
}

/// Adds all crossings of a triangle with the lines through the lattice's columns.
fn add_crossings(found: &mut Vec<Crossing>, lattice: &Lattice, triangle: [DVec3; 3]) {
    let [a, b, c] = triangle;
    let offset = lattice.offset;
    let rows = lattice.layers(1, a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
    for row in rows {
        let y = lattice.at(1, row);
        // an oblique thin triangle fills little of its bounding box, so each row has its own extent
        let Some((low, high)) = extent_of_row(triangle, y, offset) else { continue };
        for layer in lattice.layers(0, low, high) {
            let foot = DVec2::new(lattice.at(0, layer), y);
            for (line, direction) in LINES.iter().enumerate() {
                if let Some((sign, z)) = crossing(triangle, foot + offset * *direction) {
                    found.push(Crossing { column: [row, layer], z, line: line as u8, sign });
                }
            }
        }
    }
}

/// Bounds along x of the part of a triangle within `offset` of `y`; they may be too wide.
fn extent_of_row(triangle: [DVec3; 3], y: f64, offset: f64) -> Option<(f64, f64)> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (p, q) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (triangle[i], triangle[j])) {
        let (bottom, top) = if p.y < q.y { (p, q) } else { (q, p) };
        if bottom.y > y + offset || top.y < y - offset {
            continue;
        }
        for level in [y - offset, y + offset] {
            let t = ((level - bottom.y) / (top.y - bottom.y)).clamp(0.0, 1.0);
            // an edge along x has no parameter; take both ends
            for t in if t.is_nan() { [0.0, 1.0] } else { [t, t] } {
                let x = bottom.x + t * (top.x - bottom.x);
                (low, high) = (low.min(x), high.max(x));
            }
        }
    }
    (low <= high).then_some((low, high))
}

/// Adds the lattice points of one column, whose crossings are sorted by height: those above the entry of the last line
/// and below the exit of the first.
fn fill_column(points: &mut Vec<DVec3>, lattice: &Lattice, column: &[Crossing]) {
    let Some(&Crossing { column: [row, layer], .. }) = column.first() else { return };
    let (x, y) = (lattice.at(0, layer), lattice.at(1, row));
    let mut counts = [0i64; LINES.len()];
    let mut entered = None;
    for crossing in column {
        counts[usize::from(crossing.line)] += i64::from(crossing.sign);
        if !counts.contains(&0) {
            // where parts overlap, later entries are ignored
            entered.get_or_insert(crossing.z);
            continue;
        }
        let Some(bottom) = entered.take() else { continue };
        for k in lattice.layers(2, bottom, crossing.z) {
            let z = lattice.at(2, k);
            if z > bottom + lattice.offset && z < crossing.z - lattice.offset {
                points.push(DVec3::new(x, y, z));
            }
        }
    }
}

/// The lattice points inside the mesh, relative to the centre of its bounds.
fn fill(mesh: &Mesh, bounds: &Bounds, spacing: f64) -> Vec<DVec3> {
    let lattice = Lattice::new(bounds, spacing);
    let centre = bounds.centre();
    let mut crossings = Vec::new();
    for corners in mesh.triangles.iter().filter_map(|&t| mesh.corners(t)) {
        add_crossings(&mut crossings, &lattice, corners.map(|v| v - centre));
    }
    crossings.sort_unstable_by(|p, q| {
        p.column
            .cmp(&q.column)
            .then(p.z.total_cmp(&q.z))
            .then(p.line.cmp(&q.line))
            .then(p.sign.cmp(&q.sign))
    });
    let mut points = Vec::new();
    for column in crossings.chunk_by(|p, q| p.column == q.column) {
        fill_column(&mut points, &lattice, column);
    }
    points
}

/// Refuses too many points or lines before any work is done.
fn check_size(mesh: &Mesh, volume: f64, spacing: f64, size: f64) -> Result<(), SampleError> {
    // the projected area along z, in units of the spacing, is the number of lines that cross the mesh
    let (mut projected_area, mut rows) = (0.0, 0.0);
    for corners in mesh.triangles.iter().filter_map(|&t| mesh.corners(t)) {
        let [a, b, c] = corners.map(|v| v / spacing);
        projected_area += 0.25 * (b - a).cross(c - a).z.abs();
        rows += 0.05 * (a.y.max(b.y).max(c.y) - a.y.min(b.y).min(c.y));
    }
    check_point_count(spacing, volume / spacing / spacing / spacing, 3.0, size)?;
    check_point_count(spacing, projected_area, 2.0, size)?;
    check_point_count(spacing, rows, 1.0, size)
}

/// Samples the inside of the mesh with a cubic lattice.
pub(super) fn volume(mesh: &Mesh, spacing: f64) -> Result<Vec<DVec3>, SampleError> {
    let volume = mesh.solid_integrals().map_err(SampleError::Open)?.measure;
    let Some(bounds) = mesh.bounds() else { return Err(SampleError::NoSurface) };
    let size = bounds.size();
    check_size(mesh, volume, spacing, size)?;

    let mut points = fill(mesh, &bounds, spacing);
    if points.is_empty() {
        // the centre of the bounds may be outside a non-convex mesh: search for a finer spacing with points inside
        let mut finer = 0.5 * spacing.min(size);
        while check_size(mesh, volume, finer, size).is_ok() {
            if !fill(mesh, &bounds, finer).is_empty() {
                return Err(SampleError::NoPoints { spacing, would_do: Some(finer) });
            }
            finer *= 0.5;
        }
        return Err(SampleError::NoPoints { spacing, would_do: None });
    }
    for point in &mut points {
        *point += bounds.centre();
    }
    Ok(points)
}
