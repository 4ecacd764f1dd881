//! Triangles that fill a closed path.

use glam::{DVec2, DVec3};

/// The most tests of a vertex against an ear, for one path.
const MAX_TESTS: usize = 100_000_000;

/// Fills a path in a plane by cutting off ears. The triangles run around as the path does, seen against `normal`; they index the
/// path. `None` if the path crosses or touches itself, or is too intricate.
pub(super) fn fill_planar(places: &[DVec3], normal: DVec3) -> Option<Vec<[usize; 3]>> {
    if normal == DVec3::ZERO {
        return None;
    }
    let across = normal.any_orthonormal_vector();
    let up = normal.cross(across);
    let flat: Vec<DVec2> = places.iter().map(|p| DVec2::new(p.dot(across), p.dot(up))).collect();
    let turn = |a: usize, b: usize, c: usize| (flat[b] - flat[a]).perp_dot(flat[c] - flat[a]);
    let n = flat.len();
    let mut before: Vec<usize> = (0..n).map(|i| (i + n - 1) % n).collect();
    let mut after: Vec<usize> = (0..n).map(|i| (i + 1) % n).collect();
    // only vertices at which the path turns outwards can lie in an ear
    let reflex: Vec<usize> = (0..n).filter(|&i| turn(before[i], i, after[i]) <= 0.0).collect();
    let mut is_left = vec![true; n];
    let (mut left, mut at, mut misses, mut tests) = (n, 0, 0, 0);
    let mut triangles = Vec::with_capacity(n.saturating_sub(2));
    while left > 3 {
        let (a, c) = (before[at], after[at]);
        let is_ear = turn(a, at, c) > 0.0 && {
            tests += reflex.len();
            !reflex.iter().any(|&p| {
                is_left[p] && p != a && p != at && p != c && {
                    let sides = [turn(a, at, p), turn(at, c, p), turn(c, a, p)];
                    sides.iter().all(|&s| s >= 0.0)
                }
            })
        };
        if is_ear {
            triangles.push([a, at, c]);
            (after[a], before[c]) = (c, a);
            is_left[at] = false;
            (left, misses) = (left - 1, 0);
            // to the vertex after the next, so that a round hole is not filled by a fan of needles
            at = after[c];
        } else {
            (misses, at) = (misses + 1, c);
        }
        if misses > left || tests > MAX_TESTS {
            return None;
        }
    }
    let (a, c) = (before[at], after[at]);
    (turn(a, at, c) > 0.0).then(|| triangles.push([a, at, c]))?;
    Some(triangles)
}

/// Fills a short path in space with the triangles of the least area, by dynamic programming over its parts.
/// Source: G. Barequet and M. Sharir, "Filling gaps in the boundary of a polyhedron" (1995).
pub(super) fn fill_least_area(places: &[DVec3]) -> Vec<[usize; 3]> {
    let n = places.len();
    let area = |a: usize, b: usize, c: usize| {
        (places[b] - places[a]).cross(places[c] - places[a]).length()
    };
    // the least area between vertices i and k, and the vertex at which it is divided
    let mut least = vec![vec![(0.0, 0usize); n]; n];
    for length in 2..n {
        for i in 0..n - length {
            let k = i + length;
            let through = |m: usize| (least[i][m].0 + least[m][k].0 + area(i, m, k), m);
            let first = through(i + 1);
            least[i][k] = (i + 2..k).map(through).fold(first, |a, b| if b.0 < a.0 { b } else { a });
        }
    }
    let mut triangles = Vec::with_capacity(n.saturating_sub(2));
    let mut open = vec![(0, n - 1)];
    while let Some((i, k)) = open.pop() {
        if k - i >= 2 {
            let m = least[i][k].1;
            triangles.push([i, m, k]);
            open.extend([(i, m), (m, k)]);
        }
    }
    triangles
}

/// Whether a point lies within a path in a plane with this normal.
pub(super) fn is_within(places: &[DVec3], normal: DVec3, point: DVec3) -> bool {
    let across = normal.any_orthonormal_vector();
    let up = normal.cross(across);
    let flat = |p: DVec3| DVec2::new((p - point).dot(across), (p - point).dot(up));
    let ends = places.iter().zip(places.iter().cycle().skip(1));
    let crossings = ends
        .map(|(&a, &b)| (flat(a), flat(b)))
        .filter(|(a, b)| (a.y > 0.0) != (b.y > 0.0) && a.x - a.y * (b.x - a.x) / (b.y - a.y) > 0.0);
    crossings.count() % 2 == 1
}
