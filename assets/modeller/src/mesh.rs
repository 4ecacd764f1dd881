//! A triangle mesh, its edges, and the facts one can ask of it.

use glam::DVec3;

/// Triangles over shared points, counter-clockwise seen from outside.
#[derive(Default)]
pub struct Mesh {
    /// the vertices
    pub points: Vec<DVec3>,
    /// three indices into `points` each
    pub triangles: Vec<[usize; 3]>,
}

/// An edge of a closed mesh, with `ends[0] < ends[1]`.
pub struct Edge {
    /// the two vertices
    pub ends: [usize; 2],
    /// the triangle that runs along `ends`, then the one that runs against it
    pub sides: [usize; 2],
}

impl Mesh {
    /// Twice the area of a triangle, along its outward normal.
    pub fn area_vector(&self, [a, b, c]: [usize; 3]) -> DVec3 {
        let [a, b, c] = [self.points[a], self.points[b], self.points[c]];
        (b - a).cross(c - a)
    }

    /// The length of an edge.
    #[cfg(test)]
    pub fn length(&self, edge: &Edge) -> f64 {
        self.points[edge.ends[0]].distance(self.points[edge.ends[1]])
    }

    /// All edges, sorted by their ends; an error names the first edge that is not shared by
    /// exactly two triangles in opposite directions.
    pub fn edges(&self) -> Result<Vec<Edge>, String> {
        let mut halves = Vec::with_capacity(3 * self.triangles.len());
        for (side, &[a, b, c]) in self.triangles.iter().enumerate() {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                halves.push(([from.min(to), from.max(to)], from > to, side));
            }
        }
        halves.sort_unstable();
        let pair_up = |pair: &[([usize; 2], bool, usize)]| match *pair {
            [(ends, false, with), (other, true, against)] if ends == other => {
                Ok(Edge { ends, sides: [with, against] })
            }
            _ => Err(format!("edge {:?} does not join two triangles", pair[0].0)),
        };
        let edges = halves.chunks(2).map(pair_up).collect::<Result<Vec<_>, _>>()?;
        match edges.windows(2).find(|pair| pair[0].ends == pair[1].ends) {
            Some(pair) => Err(format!("edge {:?} joins four triangles", pair[0].ends)),
            None => Ok(edges),
        }
    }

    /// For each vertex, the triangles around it.
    pub fn rings(&self) -> Vec<Vec<usize>> {
        let mut rings = vec![Vec::new(); self.points.len()];
        for (side, triangle) in self.triangles.iter().enumerate() {
            for &corner in triangle {
                rings[corner].push(side);
            }
        }
        rings
    }

    /// Scales and moves the mesh so that its bounding box is `height` tall and centred.
    pub fn fit(&mut self, height: f64) {
        let low = self.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = self.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (centre, scale) = (0.5 * (low + high), height / (high.y - low.y));
        for point in &mut self.points {
            *point = scale * (*point - centre);
        }
    }

    /// The enclosed volume; negative if the triangles face inwards.
    pub fn volume(&self) -> f64 {
        let corners = self.triangles.iter().map(|triangle| triangle.map(|c| self.points[c]));
        corners.map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
    }

    /// The sharpest corner of a triangle, in degrees.
    #[cfg(test)]
    pub fn sharpest_angle(&self, [a, b, c]: [usize; 3]) -> f64 {
        let doubled = self.area_vector([a, b, c]).length();
        let corner = |apex: usize, from: usize, to: usize| {
            let arms = (self.points[from] - self.points[apex], self.points[to] - self.points[apex]);
            libm::atan2(doubled, arms.0.dot(arms.1)).to_degrees()
        };
        corner(a, b, c).min(corner(b, c, a)).min(corner(c, a, b))
    }
}
