//! Lattice points inside a closed mesh.
//!
//! A line along z runs through each column of the lattice and counts, signed, the triangles that it crosses: a
//! point with a count other than zero below it is inside. Whether a line crosses a triangle is itself counted in
//! the plane: how often the triangle's edges pass to the right of the line's foot. Each edge gives both of its
//! triangles the same answer, whatever it rounds to, so the count above a closed mesh is zero for every line, through
//! edges and vertices too, and rounding misplaces no point but those within rounding of the surface.
//! Source of the counting in the plane: D. Sunday, "Inclusion of a point in a polygon" (2001), winding number.

use super::{SampleError, affordable};
use crate::shape::Mesh;
use crate::shape::integrals::Bounds;
use glam::{DVec2, DVec3};

/// A point nearer to the surface than this part of the spacing (or of the mesh, if that is smaller) is on it, and so outside.
const ON_SURFACE: f64 = 1e-6;

/// Slope of the lines' offsets; irrational, so that none lies in a wall at a simple angle.
const SLOPE: f64 = 0.618_033_988_749_894_8;

/// The lines through one column: a point is inside if it is for all four, whichever side a wall lies.
const LINES: [DVec2; 4] = [
    DVec2::new(-1.0, -SLOPE),
    DVec2::new(1.0, -SLOPE),
    DVec2::new(-1.0, SLOPE),
    DVec2::new(1.0, SLOPE),
];

/// A cubic lattice centred at the origin.
struct Lattice {
    spacing: f64,
    /// How near (m) to the surface is on it.
    offset: f64,
    /// Layers along each axis.
    counts: [i64; 3],
}

impl Lattice {
    /// As many layers as best fit each edge of the bounds; the outermost lie inside by a quarter spacing or more.
    fn new(bounds: &Bounds, spacing: f64) -> Self {
        let edges = (bounds.max - bounds.min).to_array();
        // half a layer more or less is no matter for rounding
        let counts = edges.map(|e| ((e / spacing + 0.5 + 1e-9).floor() as i64).max(1));
        Self { spacing, offset: ON_SURFACE * spacing.min(bounds.size()), counts }
    }

    /// Coordinate of a layer (m).
    fn at(&self, axis: usize, layer: i64) -> f64 {
        0.5 * (2 * layer - (self.counts[axis] - 1)) as f64 * self.spacing
    }

    /// The first layer at or above a coordinate (m), give or take one.
    fn layer_above(&self, axis: usize, coordinate: f64) -> i64 {
        let layer = coordinate / self.spacing + 0.5 * (self.counts[axis] - 1) as f64;
        (layer.ceil() as i64).clamp(0, self.counts[axis])
    }

    /// Layers that can lie between two coordinates, and one more at each end.
    fn layers(&self, axis: usize, low: f64, high: f64) -> std::ops::Range<i64> {
        let first = (self.layer_above(axis, low) - 1).max(0);
        first..(self.layer_above(axis, high) + 1).min(self.counts[axis])
    }
}

/// Where a line through a column crosses the surface.
#[derive(Clone, Copy)]
struct Crossing {
    /// Layers along y and x.
    column: [i64; 2],
    z: f64,
    /// Which of the column's lines.
    line: u8,
    /// 1 where the line leaves a solid that is wound outwards, -1 where it enters.
    sign: i8,
}

/// A triangle and a point in the plane: how often, signed, its edges go round the point, and the height of the
/// triangle there.
fn crossing([a, b, c]: [DVec3; 3], foot: DVec2) -> Option<(i8, f64)> {
    let mut turns = 0;
    // where the edges are level with the foot; either two are, or none
    let mut level = [DVec3::ZERO; 2];
    let mut count = 0;
    for (p, q) in [(a, b), (b, c), (c, a)] {
        if (p.y > foot.y) == (q.y > foot.y) {
            continue;
        }
        // taken from the lower end, so that both triangles at the edge compute the same bits
        let (low, high) = if p.y < q.y { (p, q) } else { (q, p) };
        let left = (high.x - low.x) * (foot.y - low.y) - (high.y - low.y) * (foot.x - low.x);
        if left > 0.0 {
            turns += if p.y < q.y { 1 } else { -1 };
        }
        level[count % 2] = low + (high - low) * ((foot.y - low.y) / (high.y - low.y));
        count += 1;
    }
    if turns == 0 {
        return None;
    }

    // between the two edges; a triangle that stands upright has no one height, but none beyond its edges
    let [p, q] = level;
    let part = (foot.x - p.x) / (q.x - p.x);
    let part = if part.is_nan() { 0.5 } else { part.clamp(0.0, 1.0) };
    Some((turns, p.z + part * (q.z - p.z)))
}

/// Adds all crossings of a triangle with the lines through the lattice's columns.
fn add_crossings(found: &mut Vec<Crossing>, lattice: &Lattice, triangle: [DVec3; 3]) {
    let [a, b, c] = triangle;
    let offset = lattice.offset;
    let rows = lattice.layers(1, a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
    for row in rows {
        let y = lattice.at(1, row);
        // a thin triangle that lies askew fills little of its bounding box, so ask each row for its own extent
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

/// From where to where along x a triangle can reach at heights within `offset` of `y`; generous.
fn extent_of_row(triangle: [DVec3; 3], y: f64, offset: f64) -> Option<(f64, f64)> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (p, q) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (triangle[i], triangle[j])) {
        let (bottom, top) = if p.y < q.y { (p, q) } else { (q, p) };
        if bottom.y > y + offset || top.y < y - offset {
            continue;
        }
        for level in [y - offset, y + offset] {
            let t = ((level - bottom.y) / (top.y - bottom.y)).clamp(0.0, 1.0);
            // a level edge has no parameter, and counts whole
            for t in if t.is_nan() { [0.0, 1.0] } else { [t, t] } {
                let x = bottom.x + t * (top.x - bottom.x);
                (low, high) = (low.min(x), high.max(x));
            }
        }
    }
    (low <= high).then_some((low, high))
}

/// The lattice points of one column, whose crossings are sorted by height: those between where all lines have
/// entered and where the first leaves.
fn fill_column(points: &mut Vec<DVec3>, lattice: &Lattice, column: &[Crossing]) {
    let Some(&Crossing { column: [row, layer], .. }) = column.first() else { return };
    let (x, y) = (lattice.at(0, layer), lattice.at(1, row));
    let mut counts = [0i64; LINES.len()];
    let mut entered = None;
    for crossing in column {
        counts[usize::from(crossing.line)] += i64::from(crossing.sign);
        if !counts.contains(&0) {
            // a crossing within the solid, where parts overlap, changes nothing
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

/// Lattice points inside the mesh, relative to the centre of its bounds.
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

/// Refuses before any work what would take too many points or lines.
fn check_size(mesh: &Mesh, volume: f64, spacing: f64, size: f64) -> Result<(), SampleError> {
    // the shadow along z, in units of the spacing, tells how many lines cross the mesh
    let (mut shadow, mut rows) = (0.0, 0.0);
    for corners in mesh.triangles.iter().filter_map(|&t| mesh.corners(t)) {
        let [a, b, c] = corners.map(|v| v / spacing);
        shadow += 0.25 * (b - a).cross(c - a).z.abs();
        rows += 0.05 * (a.y.max(b.y).max(c.y) - a.y.min(b.y).min(c.y));
    }
    affordable(spacing, volume / spacing / spacing / spacing, 3.0, size)?;
    affordable(spacing, shadow, 2.0, size)?;
    affordable(spacing, rows, 1.0, size)
}

/// The points inside the mesh of a cubic lattice.
pub(super) fn volume(mesh: &Mesh, spacing: f64) -> Result<Vec<DVec3>, SampleError> {
    let volume = mesh.solid_integrals().map_err(SampleError::Open)?.measure;
    let Some(bounds) = mesh.bounds() else { return Err(SampleError::NoSurface) };
    let size = bounds.size();
    check_size(mesh, volume, spacing, size)?;

    let mut points = fill(mesh, &bounds, spacing);
    if points.is_empty() {
        // the centre of the bounds may lie outside a bent mesh: look for a spacing that finds its inside
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
