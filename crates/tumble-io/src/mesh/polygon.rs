//! Triangulation of polygons and strips.

use glam::{DVec2, DVec3};

/// The largest number of corner tests for all concave polygons of one file (about a second).
const CLIP_BUDGET: u64 = 200_000_000;

/// Collects faces of any size. Each is a fan at first; when all vertices are known, [`Faces::finish`]
/// cuts concave ones by ear clipping instead.
#[derive(Default)]
pub(super) struct Faces {
    triangles: Vec<[u32; 3]>,
    /// First triangle and number of triangles of each face that has more than one.
    fans: Vec<(u32, u32)>,
    /// Number of faces so far, of any size.
    pub(super) count: usize,
}

impl Faces {
    /// Adds a face; a face of fewer than three corners has no triangles.
    pub(super) fn push(&mut self, corners: &[u32]) {
        self.count += 1;
        // most faces are triangles
        if let &[a, b, c] = corners {
            self.triangles.push([a, b, c]);
            return;
        }
        let first = self.triangles.len();
        let pairs = corners.windows(2).skip(1);
        self.triangles.extend(pairs.map(|pair| [corners[0], pair[0], pair[1]]));
        if corners.len() > 3 {
            self.fans.push((first as u32, (corners.len() - 2) as u32));
        }
    }

    /// Adds a triangle strip; every second triangle is reversed, so that all have the same winding.
    pub(super) fn push_strip(&mut self, strip: &[u32]) {
        for (i, t) in strip.windows(3).enumerate() {
            self.push(&if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] });
        }
    }

    /// Number of triangles so far.
    pub(super) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Reverses the winding of all triangles from the given one on.
    pub(super) fn reverse_from(&mut self, first: usize) {
        self.triangles[first..].iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }

    /// The triangles, in the order of the faces. Every index must be within `vertices`.
    pub(super) fn finish(mut self, vertices: &[DVec3]) -> Vec<[u32; 3]> {
        let mut clipper = Clipper { budget: CLIP_BUDGET, ..Default::default() };
        for (first, count) in self.fans {
            let fan = first as usize..first as usize + count as usize;
            clipper.improve(&mut self.triangles[fan], vertices);
        }
        self.triangles
    }
}

/// Ear clipping. The buffers are kept from polygon to polygon.
#[derive(Default)]
struct Clipper {
    budget: u64,
    corners: Vec<u32>,
    points: Vec<DVec2>,
    ring: Vec<usize>,
    ears: Vec<[u32; 3]>,
}

impl Clipper {
    /// Replaces a fan by an ear-clipped triangulation if its polygon is concave and simple. Otherwise the fan stays: its signed volume is
    /// correct in any case.
    fn improve(&mut self, fan: &mut [[u32; 3]], vertices: &[DVec3]) {
        // the corners, from the fan
        self.corners.clear();
        self.corners.extend(&fan[0][..2]);
        self.corners.extend(fan.iter().map(|t| t[2]));

        // the polygon in its plane, counter-clockwise
        self.flatten(vertices);
        let n = self.points.len();
        let convex = (0..n).all(|i| {
            turn(self.points[i], self.points[(i + 1) % n], self.points[(i + 2) % n]) >= 0.0
        });
        if convex {
            return;
        }

        // cut ears until a triangle is left
        self.ears.clear();
        self.ring.clear();
        self.ring.extend(0..n);
        while self.ring.len() > 3 {
            let Some(ear) = (0..self.ring.len()).find(|&i| self.is_ear(i)) else { return };
            self.ears.push(self.corner(ear).map(|i| self.corners[i]));
            self.ring.remove(ear);
        }
        self.ears.push(self.corner(1).map(|i| self.corners[i]));
        fan.copy_from_slice(&self.ears);
    }

    /// Projects the polygon along the axis nearest to its normal (Newell).
    fn flatten(&mut self, vertices: &[DVec3]) {
        let at = |i: u32| vertices[i as usize];
        let origin = at(self.corners[0]);
        let following = self.corners[1..].iter().chain(&self.corners[..1]);
        let normal: DVec3 = self
            .corners
            .iter()
            .zip(following)
            .map(|(&a, &b)| (at(a) - origin).cross(at(b) - origin))
            .sum();

        // drop the axis nearest to the normal, preserving the orientation
        let size = normal.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let flip = if normal[axis] < 0.0 { -1.0 } else { 1.0 };
        self.points.clear();
        self.points.extend(self.corners.iter().map(|&i| {
            let p = at(i) - origin;
            DVec2::new(p[u] * flip, p[v])
        }));
    }

    /// The ring's corner `i` between its neighbours, as positions in `corners`.
    fn corner(&self, i: usize) -> [usize; 3] {
        let n = self.ring.len();
        [self.ring[(i + n - 1) % n], self.ring[i], self.ring[(i + 1) % n]]
    }

    /// Whether the triangle at corner `i` is an ear: it is convex and contains no other corner.
    fn is_ear(&mut self, i: usize) -> bool {
        let [a, b, c] = self.corner(i).map(|k| self.points[k]);
        let cost = self.ring.len() as u64;
        if self.budget < cost || turn(a, b, c).is_nan() || turn(a, b, c) <= 0.0 {
            return false;
        }
        self.budget -= cost;
        !self.ring.iter().map(|&k| self.points[k]).any(|p| {
            p != a
                && p != b
                && p != c
                && turn(a, b, p) >= 0.0
                && turn(b, c, p) >= 0.0
                && turn(c, a, p) >= 0.0
        })
    }
}

/// Twice the signed area of a triangle: positive for a left turn.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}
