//! Whether a mesh is watertight: every edge has as many half-edges in one direction as in the other.

use glam::DVec3;

use super::mesh::Mesh;
use super::repair::{EdgeTable, net_direction};

/// The maximum length of [`Watertightness::first`].
const MAX_LISTED: usize = 5;

/// What is wrong with an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeFault {
    /// An odd number of triangles meets at the edge: it bounds a hole or a loose sheet.
    Open,
    /// An even number of triangles meets at the edge, but their windings are inconsistent.
    WronglyWound,
}

/// An edge at which a mesh is not closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultyEdge {
    /// The vertices at its ends; of coincident vertices, the one with the lowest index.
    pub vertices: [u32; 2],
    /// The positions of these vertices (m).
    pub positions: [DVec3; 2],
    /// What is wrong.
    pub fault: EdgeFault,
}

/// The result of [`Mesh::watertightness`]: whether a mesh is watertight, and where it is not.
///
/// Coincident vertices count as one, and triangles with two coincident corners are ignored. Texture seams
/// and degenerate triangles therefore do not make a mesh open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Watertightness {
    /// The number of triangles that count.
    pub triangles: usize,
    /// The number of ignored triangles: two corners coincide, or a corner is missing or not finite.
    pub ignored_triangles: usize,
    /// The number of edges at which an odd number of triangles meets.
    pub open_edges: usize,
    /// The number of edges with an even number of triangles, but more half-edges in one direction.
    pub wrongly_wound: usize,
    /// The number of edges at which more than two triangles meet. Such a mesh may still be watertight:
    /// where two cubes touch along an edge, the enclosed volume is well defined.
    pub non_manifold: usize,
    /// The first few faulty edges, by vertex index.
    pub first: Vec<FaultyEdge>,
}

impl Watertightness {
    /// Whether the mesh is watertight: it has triangles, and each edge has as many half-edges in one
    /// direction as in the other.
    pub fn is_closed(&self) -> bool {
        self.triangles > 0 && self.open_edges == 0 && self.wrongly_wound == 0
    }

    /// Whether the mesh is watertight and exactly two triangles meet at each edge.
    pub fn is_manifold(&self) -> bool {
        self.is_closed() && self.non_manifold == 0
    }
}

impl std::fmt::Display for Watertightness {
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
            let separator = if nth == 0 { ";" } else { "," };
            let (p, q) = (short(p), short(q));
            write!(f, "{separator} {what} from vertex {a} {p} to vertex {b} {q}")?;
        }
        if self.open_edges + self.wrongly_wound > self.first.len() {
            write!(f, ", …")?;
        }
        Ok(())
    }
}

/// A point with the digits by which it can be found.
pub(super) fn short(place: DVec3) -> String {
    let [x, y, z] = place.to_array().map(|x| {
        // adding zero turns −0 into 0
        let x = x + 0.0;
        let is_usual = x == 0.0 || (1e-3..1e6).contains(&x.abs());
        let text = if is_usual { format!("{x:.6}") } else { format!("{x:.4e}") };
        let (digits, exponent) = text.split_at(text.find('e').unwrap_or(text.len()));
        format!("{}{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
    });
    format!("({x}, {y}, {z})")
}

/// For each vertex, the lowest index of the vertices at the same coordinates.
pub(crate) fn weld(vertices: &[DVec3]) -> Vec<u32> {
    // adding zero turns −0 into 0, so that equal coordinates have equal bits
    let bits = |x: f64| (x + 0.0).to_bits();
    let mut sorted: Vec<([u64; 3], u32)> =
        vertices.iter().zip(0u32..).map(|(v, i)| ([bits(v.x), bits(v.y), bits(v.z)], i)).collect();
    sorted.sort_unstable();

    // the first of each run of equal coordinates represents the run
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

impl Mesh {
    /// The corners of a triangle (m); `None` if one is missing or not finite.
    pub(crate) fn corners(&self, triangle: [u32; 3]) -> Option<[DVec3; 3]> {
        let corner = |i: u32| self.vertices.get(i as usize).copied().filter(|v| v.is_finite());
        Some([corner(triangle[0])?, corner(triangle[1])?, corner(triangle[2])?])
    }

    /// Finds the edges at which the mesh is open, wrongly wound or not manifold.
    ///
    /// Triangles that [`Mesh::new`] would refuse are ignored. There is no tolerance: vertices coincide if
    /// their coordinates are equal.
    pub fn watertightness(&self) -> Watertightness {
        let welded = weld(&self.vertices);
        let triangles: Vec<[u32; 3]> = self
            .triangles
            .iter()
            .filter(|&&t| self.corners(t).is_some())
            .map(|t| t.map(|i| welded[i as usize]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();

        let mut found = Watertightness {
            triangles: triangles.len(),
            ignored_triangles: self.triangles.len() - triangles.len(),
            ..Watertightness::default()
        };
        for (lower, edge) in EdgeTable::new(&triangles, welded.len()).edges() {
            found.non_manifold += usize::from(edge.len() > 2);
            if net_direction(edge) == 0 {
                continue;
            }
            let fault = if edge.len() % 2 == 1 {
                found.open_edges += 1;
                EdgeFault::Open
            } else {
                found.wrongly_wound += 1;
                EdgeFault::WronglyWound
            };
            if found.first.len() < MAX_LISTED {
                let vertices = [lower, edge[0].upper];
                let positions = vertices.map(|i| self.vertices[i as usize]);
                found.first.push(FaultyEdge { vertices, positions, fault });
            }
        }
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
        let found = tetrahedron().watertightness();
        assert!(found.is_manifold());
        assert_eq!(found.triangles, 4);
        assert_eq!(found.to_string(), "the mesh is closed");
    }

    #[test]
    fn a_missing_triangle_leaves_three_open_edges() {
        let mut mesh = tetrahedron();
        mesh.triangles.pop();
        let found = mesh.watertightness();
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
    fn places_are_short() {
        let place = DVec3::new(0.1 + 0.2, 1.2e-17, -1234567.0);
        assert_eq!(short(place), "(0.3, 1.2e-17, -1.2346e6)");
        assert_eq!(short(DVec3::new(10.0, 100.5, -0.0)), "(10, 100.5, 0)");
    }

    #[test]
    fn a_flipped_triangle_has_three_wrongly_wound_edges() {
        let mut mesh = tetrahedron();
        mesh.triangles[2].swap(0, 1);
        let found = mesh.watertightness();
        assert_eq!((found.open_edges, found.wrongly_wound), (0, 3));
        assert!(found.to_string().contains("wrongly wound from vertex 1 (1, 0, 0)"), "{found}");
    }

    #[test]
    fn duplicate_vertices_and_degenerate_triangles_do_not_open_a_mesh() {
        let tetrahedron = tetrahedron();
        let mut soup = Mesh::default();
        for t in &tetrahedron.triangles {
            let start = soup.vertices.len() as u32;
            soup.vertices.extend(t.map(|i| tetrahedron.vertices[i as usize]));
            soup.triangles.push([start, start + 1, start + 2]);
        }
        // −0 equals 0
        soup.vertices[0].x = -0.0;
        soup.triangles.push([0, 0, 1]);
        let found = soup.watertightness();
        assert!(found.is_manifold(), "{found}");
        assert_eq!((found.triangles, found.ignored_triangles), (4, 1));
    }

    #[test]
    fn two_solids_that_share_an_edge_are_closed_but_not_manifold() {
        let mut mesh = tetrahedron();
        // a point reflection through the middle of the edge 0-1 maps the edge onto itself
        let reflected: Vec<DVec3> = mesh.vertices.iter().map(|v| DVec3::X - *v).collect();
        mesh.vertices.extend(reflected);
        for t in mesh.triangles.clone() {
            mesh.triangles.push([t[0] + 4, t[2] + 4, t[1] + 4]);
        }
        let found = mesh.watertightness();
        assert!(found.is_closed() && !found.is_manifold());
        assert_eq!(found.non_manifold, 1);
    }

    #[test]
    fn all_faulty_edges_are_counted_and_the_first_few_listed() {
        let vertices = (0..30).map(|i| DVec3::new(i as f64, (i * i) as f64, 1.0)).collect();
        let triangles = (0..10).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let found = Mesh::new(vertices, triangles).unwrap().watertightness();
        assert_eq!((found.open_edges, found.first.len()), (30, MAX_LISTED));
        assert!(found.to_string().ends_with(", …"));
    }

    #[test]
    fn invalid_meshes_do_not_panic() {
        let mesh = Mesh { vertices: vec![DVec3::NAN; 3], triangles: vec![[0, 1, 2], [7, 8, 9]] };
        let found = mesh.watertightness();
        assert_eq!((found.triangles, found.ignored_triangles), (0, 2));
        assert!(!found.is_closed());
        assert!(!Mesh::default().watertightness().is_closed());
    }
}
