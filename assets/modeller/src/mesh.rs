//! Triangle meshes: edges, areas, volume.

use glam::DVec3;

/// A triangle mesh with shared vertices, counter-clockwise as seen from outside.
#[derive(Default)]
pub struct Mesh {
    /// Vertices.
    pub points: Vec<DVec3>,
    /// Three indices into `points` per triangle.
    pub triangles: Vec<[usize; 3]>,
}

/// An edge of a watertight mesh, with `ends[0] < ends[1]`.
pub struct Edge {
    /// The two vertices.
    pub ends: [usize; 2],
    /// The triangle whose winding runs from `ends[0]` to `ends[1]`, then the one with the opposite direction.
    pub faces: [usize; 2],
}

impl Mesh {
    /// The outward normal of a triangle, with twice its area as length.
    pub fn area_vector(&self, [a, b, c]: [usize; 3]) -> DVec3 {
        let [a, b, c] = [self.points[a], self.points[b], self.points[c]];
        (b - a).cross(c - a)
    }

    /// The length of an edge.
    #[cfg(test)]
    pub fn length(&self, edge: &Edge) -> f64 {
        self.points[edge.ends[0]].distance(self.points[edge.ends[1]])
    }

    /// All edges, sorted by their vertices.
    ///
    /// # Errors
    /// If an edge is not shared by exactly two triangles in opposite directions.
    pub fn edges(&self) -> Result<Vec<Edge>, String> {
        let mut half_edges = Vec::with_capacity(3 * self.triangles.len());
        for (face, &[a, b, c]) in self.triangles.iter().enumerate() {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                half_edges.push(([from.min(to), from.max(to)], from > to, face));
            }
        }
        half_edges.sort_unstable();
        let join = |pair: &[([usize; 2], bool, usize)]| match *pair {
            [(ends, false, forward), (other, true, backward)] if ends == other => {
                Ok(Edge { ends, faces: [forward, backward] })
            }
            _ => Err(format!("edge {:?} does not join two triangles", pair[0].0)),
        };
        let edges = half_edges.chunks(2).map(join).collect::<Result<Vec<_>, _>>()?;
        match edges.windows(2).find(|pair| pair[0].ends == pair[1].ends) {
            Some(pair) => Err(format!("edge {:?} joins four triangles", pair[0].ends)),
            None => Ok(edges),
        }
    }

    /// The triangles around each vertex.
    pub fn vertex_faces(&self) -> Vec<Vec<usize>> {
        let mut vertex_faces = vec![Vec::new(); self.points.len()];
        for (face, triangle) in self.triangles.iter().enumerate() {
            for &vertex in triangle {
                vertex_faces[vertex].push(face);
            }
        }
        vertex_faces
    }

    /// Scales the mesh to the given height and centres its bounding box on the origin.
    pub fn scale_to_height(&mut self, height: f64) {
        let low = self.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = self.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (centre, scale) = (0.5 * (low + high), height / (high.y - low.y));
        for point in &mut self.points {
            *point = scale * (*point - centre);
        }
    }

    /// The enclosed volume, which is negative if the triangles face inwards.
    pub fn volume(&self) -> f64 {
        let corners = self.triangles.iter().map(|triangle| triangle.map(|c| self.points[c]));
        corners.map(|[a, b, c]| a.dot(b.cross(c))).sum::<f64>() / 6.0
    }

    /// The smallest angle of a triangle (degrees).
    #[cfg(test)]
    pub fn smallest_angle(&self, [a, b, c]: [usize; 3]) -> f64 {
        let twice_area = self.area_vector([a, b, c]).length();
        let angle = |apex: usize, from: usize, to: usize| {
            let arms = (self.points[from] - self.points[apex], self.points[to] - self.points[apex]);
            libm::atan2(twice_area, arms.0.dot(arms.1)).to_degrees()
        };
        angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
    }
}
