//! The half-edges of a set of triangles, by edge.

/// An edge of one face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct EdgeOfFace {
    /// The higher vertex of the edge.
    pub upper: u32,
    /// The face, as an index into the triangles.
    pub face: u32,
    /// Whether the face runs through the edge from the higher vertex to the lower.
    pub is_descending: bool,
}

/// All half-edges, in buckets by the lower vertex of the edge, sorted by the higher vertex and by face.
pub(crate) struct EdgeTable {
    /// The start of the bucket of each vertex, and the end of the last.
    starts: Vec<usize>,
    entries: Vec<EdgeOfFace>,
}

impl EdgeTable {
    /// The table of triangles whose corners differ and are below `vertex_count`.
    pub fn new(triangles: &[[u32; 3]], vertex_count: usize) -> Self {
        let edges = || {
            (0u32..)
                .zip(triangles)
                .flat_map(|(face, &[a, b, c])| [(face, a, b), (face, b, c), (face, c, a)])
        };
        // a bucket sort: count, then fill
        let mut starts = vec![0usize; vertex_count + 1];
        for (_, a, b) in edges() {
            starts[a.min(b) as usize + 1] += 1;
        }
        for i in 0..vertex_count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![EdgeOfFace::default(); 3 * triangles.len()];
        for (face, a, b) in edges() {
            let slot = &mut next[a.min(b) as usize];
            entries[*slot] = EdgeOfFace { upper: a.max(b), face, is_descending: a > b };
            *slot += 1;
        }
        for ends in starts.windows(2) {
            entries[ends[0]..ends[1]].sort_unstable();
        }
        Self { starts, entries }
    }

    /// Each edge with its lower vertex, in order of vertex index.
    pub fn edges(&self) -> impl Iterator<Item = (u32, &[EdgeOfFace])> {
        (0u32..).zip(self.starts.windows(2)).flat_map(|(lower, ends)| {
            let bucket = &self.entries[ends[0]..ends[1]];
            bucket.chunk_by(|a, b| a.upper == b.upper).map(move |edge| (lower, edge))
        })
    }
}

/// How many more of these half-edges run from the lower vertex to the higher than back.
pub(crate) fn net_direction(edge: &[EdgeOfFace]) -> i64 {
    edge.iter().map(|half| if half.is_descending { -1 } else { 1 }).sum()
}
