//! Whether a mesh bounds a solid: every edge passed as often one way as the other.

use super::Mesh;
use glam::DVec3;

/// How many faulty edges [`Closedness::first`] names at most.
const NAMED: usize = 5;

/// What is wrong with an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeFault {
    /// An odd number of triangles meets at the edge: there is a hole or a loose sheet.
    Open,
    /// The triangles at the edge could close there, but not all are wound alike.
    WronglyWound,
}

/// An edge at which a mesh does not close.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultyEdge {
    /// The vertices at its ends; of vertices at the same place, the one with the smallest index.
    pub vertices: [u32; 2],
    /// Where these vertices are (m).
    pub positions: [DVec3; 2],
    /// What is wrong.
    pub fault: EdgeFault,
}

/// How a mesh closes; made by [`Mesh::closedness`].
///
/// Vertices at equal coordinates count as one, and a triangle with two corners at one place counts as
/// none, so that seams of texture coordinates and collapsed triangles do no harm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Closedness {
    /// Triangles that count.
    pub triangles: usize,
    /// Triangles that do not: two corners coincide, or a corner is missing or not finite.
    pub ignored_triangles: usize,
    /// Edges at which an odd number of triangles meets.
    pub open_edges: usize,
    /// Edges at which an even number of triangles meets, but more pass it one way than the other.
    pub wrongly_wound: usize,
    /// Edges at which more than two triangles meet. Alone these do no harm: where two cubes touch along
    /// an edge, volume and inside are still well defined.
    pub non_manifold: usize,
    /// The first few open or wrongly wound edges, by vertex index.
    pub first: Vec<FaultyEdge>,
}

impl Closedness {
    /// Whether the mesh bounds a solid: there are triangles, and each edge is passed as often one way
    /// as the other.
    pub fn is_closed(&self) -> bool {
        self.triangles > 0 && self.open_edges == 0 && self.wrongly_wound == 0
    }

    /// Whether the mesh is closed and exactly two triangles meet at each edge.
    pub fn is_manifold(&self) -> bool {
        self.is_closed() && self.non_manifold == 0
    }
}

impl std::fmt::Display for Closedness {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.triangles == 0 {
            return write!(f, "the mesh has no triangles");
        }
        if self.is_closed() {
            return write!(f, "the mesh is closed");
        }
        write!(
            f,
            "the mesh is not closed: {} open and {} wrongly wound edges",
            self.open_edges, self.wrongly_wound
        )?;
        for (nth, edge) in self.first.iter().enumerate() {
            let [a, b] = edge.vertices;
            let [p, q] = edge.positions;
            let what = match edge.fault {
                EdgeFault::Open => "open",
                EdgeFault::WronglyWound => "wrongly wound",
            };
            write!(
                f,
                "{} {what} from vertex {a} ({}, {}, {}) to vertex {b} ({}, {}, {})",
                if nth == 0 { ";" } else { "," },
                p.x,
                p.y,
                p.z,
                q.x,
                q.y,
                q.z
            )?;
        }
        if self.open_edges + self.wrongly_wound > self.first.len() {
            write!(f, ", …")?;
        }
        Ok(())
    }
}

/// For each vertex the smallest index of a vertex at the same coordinates.
pub(crate) fn weld(vertices: &[DVec3]) -> Vec<u32> {
    // adding zero turns -0 into 0, so that equal coordinates have equal bits
    let bits = |x: f64| (x + 0.0).to_bits();
    let mut sorted: Vec<([u64; 3], u32)> =
        vertices.iter().zip(0u32..).map(|(v, i)| ([bits(v.x), bits(v.y), bits(v.z)], i)).collect();
    sorted.sort_unstable();

    // the first of each run of equal coordinates stands for the run
    let mut first_of = vec![0u32; sorted.len()];
    let mut run = None;
    for (place, index) in sorted {
        let first = match run {
            Some((same, first)) if same == place => first,
            _ => index,
        };
        run = Some((place, first));
        first_of[index as usize] = first;
    }
    first_of
}

/// All passages along edges, bucketed by the lower vertex of the edge.
struct Passages {
    /// Where the bucket of each vertex starts, and the end of the last.
    starts: Vec<usize>,
    /// Twice the upper vertex, plus one if the passage goes down.
    entries: Vec<u64>,
}

impl Passages {
    fn of(triangles: &[[u32; 3]], vertex_count: usize) -> Self {
        let edges = || triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);

        // count, then fill: a bucket sort costs one pass where a full sort costs twenty
        let mut starts = vec![0usize; vertex_count + 1];
        for (a, b) in edges() {
            starts[a.min(b) as usize + 1] += 1;
        }
        for i in 0..vertex_count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![0u64; 3 * triangles.len()];
        for (a, b) in edges() {
            let slot = &mut next[a.min(b) as usize];
            entries[*slot] = 2 * u64::from(a.max(b)) + u64::from(a > b);
            *slot += 1;
        }
        Self { starts, entries }
    }

    /// Calls `visit(lower, upper, passages up, passages down)` for each edge, by vertex index.
    fn each_edge(&mut self, mut visit: impl FnMut(u32, u32, usize, usize)) {
        for (lower, ends) in (0u32..).zip(self.starts.windows(2)) {
            let bucket = &mut self.entries[ends[0]..ends[1]];
            bucket.sort_unstable();
            for edge in bucket.chunk_by(|a, b| a / 2 == b / 2) {
                let down = edge.iter().filter(|&&e| e % 2 == 1).count();
                visit(lower, (edge[0] / 2) as u32, edge.len() - down, down);
            }
        }
    }
}

impl Mesh {
    /// The corners of a triangle (m); `None` where one is missing or not finite.
    pub(crate) fn corners(&self, triangle: [u32; 3]) -> Option<[DVec3; 3]> {
        let corner = |i: u32| self.vertices.get(i as usize).copied().filter(|v| v.is_finite());
        Some([corner(triangle[0])?, corner(triangle[1])?, corner(triangle[2])?])
    }

    /// Finds the edges at which the mesh is open, wound wrongly or not a manifold.
    ///
    /// It takes the mesh as it is: a mesh that [`Mesh::new`] would refuse is looked at without its
    /// faulty triangles. No tolerance is involved; vertices are the same where their coordinates are equal.
    pub fn closedness(&self) -> Closedness {
        let welded = weld(&self.vertices);
        let triangles: Vec<[u32; 3]> = self
            .triangles
            .iter()
            .filter(|&&t| self.corners(t).is_some())
            .map(|t| t.map(|i| welded[i as usize]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();

        let mut found = Closedness {
            triangles: triangles.len(),
            ignored_triangles: self.triangles.len() - triangles.len(),
            ..Closedness::default()
        };
        Passages::of(&triangles, welded.len()).each_edge(|lower, upper, up, down| {
            found.non_manifold += usize::from(up + down > 2);
            if up == down {
                return;
            }
            let fault = if (up + down) % 2 == 1 {
                found.open_edges += 1;
                EdgeFault::Open
            } else {
                found.wrongly_wound += 1;
                EdgeFault::WronglyWound
            };
            if found.first.len() < NAMED {
                let vertices = [lower, upper];
                let positions = vertices.map(|i| self.vertices[i as usize]);
                found.first.push(FaultyEdge { vertices, positions, fault });
            }
        });
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Mesh {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]).unwrap()
    }

    #[test]
    fn a_tetrahedron_is_a_closed_manifold() {
        let found = tetrahedron().closedness();
        assert!(found.is_manifold());
        assert_eq!(found.triangles, 4);
        assert_eq!(found.to_string(), "the mesh is closed");
    }

    #[test]
    fn a_missing_triangle_leaves_three_named_open_edges() {
        let mut mesh = tetrahedron();
        mesh.triangles.pop();
        let found = mesh.closedness();
        assert_eq!((found.open_edges, found.wrongly_wound), (3, 0));
        let named: Vec<_> = found.first.iter().map(|e| (e.vertices, e.fault)).collect();
        let open = |a, b| ([a, b], EdgeFault::Open);
        assert_eq!(named, [open(0, 2), open(0, 3), open(2, 3)]);
        assert!(
            found
                .to_string()
                .starts_with("the mesh is not closed: 3 open and 0 wrongly wound edges; open from vertex 0 (0, 0, 0) to vertex 2 (0, 1, 0)"),
            "{found}"
        );
    }

    #[test]
    fn a_turned_triangle_has_three_wrongly_wound_edges() {
        let mut mesh = tetrahedron();
        mesh.triangles[2].swap(0, 1);
        let found = mesh.closedness();
        assert_eq!((found.open_edges, found.wrongly_wound), (0, 3));
        assert!(found.to_string().contains("wrongly wound from vertex 1 (1, 0, 0)"), "{found}");
    }

    #[test]
    fn split_vertices_and_collapsed_triangles_do_no_harm() {
        let tetrahedron = tetrahedron();
        let mut soup = Mesh::default();
        for t in &tetrahedron.triangles {
            let start = soup.vertices.len() as u32;
            soup.vertices.extend(t.map(|i| tetrahedron.vertices[i as usize]));
            soup.triangles.push([start, start + 1, start + 2]);
        }
        // minus zero is zero
        soup.vertices[0].x = -0.0;
        soup.triangles.push([0, 0, 1]);
        let found = soup.closedness();
        assert!(found.is_manifold(), "{found}");
        assert_eq!((found.triangles, found.ignored_triangles), (4, 1));
    }

    #[test]
    fn two_solids_that_share_an_edge_are_closed_but_no_manifold() {
        let mut mesh = tetrahedron();
        // a point reflection through the middle of the edge 0-1 maps the edge onto itself
        let twin: Vec<DVec3> = mesh.vertices.iter().map(|v| DVec3::X - *v).collect();
        mesh.vertices.extend(twin);
        for t in mesh.triangles.clone() {
            mesh.triangles.push([t[0] + 4, t[2] + 4, t[1] + 4]);
        }
        let found = mesh.closedness();
        assert!(found.is_closed() && !found.is_manifold());
        assert_eq!(found.non_manifold, 1);
    }

    #[test]
    fn many_faults_are_counted_and_only_the_first_named() {
        let vertices = (0..30).map(|i| DVec3::new(i as f64, (i * i) as f64, 1.0)).collect();
        let triangles = (0..10).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let found = Mesh::new(vertices, triangles).unwrap().closedness();
        assert_eq!((found.open_edges, found.first.len()), (30, NAMED));
        assert!(found.to_string().ends_with(", …"));
    }

    #[test]
    fn meshes_made_by_hand_with_faults_do_not_panic() {
        let mesh = Mesh { vertices: vec![DVec3::NAN; 3], triangles: vec![[0, 1, 2], [7, 8, 9]] };
        let found = mesh.closedness();
        assert_eq!((found.triangles, found.ignored_triangles), (0, 2));
        assert!(!found.is_closed());
        assert!(!Mesh::default().closedness().is_closed());
    }
}
