//! A bounding volume tree over triangles. A node has up to four children; a leaf is a group of up to four triangles.

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;

use super::triangle::{Frame, Group, WIDTH};

/// Capacity of the traversal stack: three entries per level, and a tree of 2³² triangles has 16 levels.
pub(super) const STACK_SIZE: usize = 64;
/// Marks a child that is a group.
pub(super) const LEAF: u32 = 1 << 31;
/// Margin of a triangle's box in units of its longest edge. It exceeds the rounding of distances, so that the result
/// does not depend on the order of the search.
const SLACK: f64 = 1e-13;

/// The boxes of up to four children (m); missing children have boxes at infinity.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Node {
    low: [[f64; WIDTH]; 3],
    high: [[f64; WIDTH]; 3],
    /// Nodes, or groups with [`LEAF`] added.
    pub child: [u32; WIDTH],
}

/// A box (m).
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub low: DVec3,
    pub high: DVec3,
}

impl Extent {
    /// The empty box.
    pub const NONE: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// The bounding box of both.
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Whether a point is in the box.
    #[inline(always)]
    pub fn contains(&self, point: DVec3) -> bool {
        self.low.max(point).min(self.high) == point
    }

    /// The distance from a point outside (m), or zero.
    #[inline(always)]
    pub fn distance(&self, point: DVec3) -> f64 {
        (self.low - point).max(point - self.high).max(DVec3::ZERO).length()
    }
}

/// A triangle during construction of the tree.
struct Item {
    centre: DVec3,
    bounds: Extent,
    /// Index in the mesh.
    index: u32,
    frame: Frame,
}

/// A ray segment: the points `from` + t `along` for t in `part`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub from: DVec3,
    pub along: DVec3,
    /// The range of t.
    pub part: [f64; 2],
}

/// The tree.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    pub groups: Vec<Group>,
    /// The number of triangles.
    count: usize,
}

impl Tree {
    /// Builds a tree of at least one triangle, given with their indices in the mesh.
    pub fn build(triangles: impl Iterator<Item = (u32, Frame)>) -> Self {
        let mut items: Vec<Item> =
            triangles.map(|(index, frame)| Item::new(index, frame)).collect();
        let groups = items.len().div_ceil(WIDTH);
        let mut tree = Self {
            nodes: Vec::with_capacity(groups / 2 + 1),
            groups: Vec::with_capacity(groups),
            count: items.len(),
        };
        tree.add_node(&mut items);
        tree
    }

    /// Adds a node for the items and its subtree.
    fn add_node(&mut self, items: &mut [Item]) -> u32 {
        let here = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let (left, right) = split(items);
        let ((a, b), (c, d)) = (split(left), split(right));
        let parts = [a, b, c, d].into_iter().filter(|part| !part.is_empty());
        for (lane, part) in parts.enumerate() {
            let bounds = part.iter().fold(Extent::NONE, |all, item| all.union(item.bounds));
            let child =
                if part.len() <= WIDTH { self.add_group(part) | LEAF } else { self.add_node(part) };
            self.nodes[here].set(lane, bounds, child);
        }
        here as u32
    }

    fn add_group(&mut self, items: &mut [Item]) -> u32 {
        // a fixed order within the group, since the selection leaves it open
        items.sort_unstable_by_key(|item| item.index);
        let members: Vec<(u32, Frame)> =
            items.iter().map(|item| (item.index, item.frame)).collect();
        self.groups.push(Group::new(&members));
        self.groups.len() as u32 - 1
    }

    /// Calls `visit(slot, index in the mesh)` for each triangle, by slot.
    pub fn each_slot(&self, mut visit: impl FnMut(usize, u32)) {
        for (group, members) in self.groups.iter().enumerate() {
            for (lane, &index) in members.index.iter().enumerate() {
                // padding repeats the first triangle
                if lane == 0 || index != members.index[0] {
                    visit(group * WIDTH + lane, index);
                }
            }
        }
    }

    /// The number of slots; some may be unused.
    pub fn slots(&self) -> usize {
        self.groups.len() * WIDTH
    }

    /// The number of triangles.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The square root of the mean area of the triangles (m).
    pub fn mean_triangle_size(&self) -> f64 {
        let mut area = 0.0;
        self.each_slot(|slot, _| area += self.frame(slot).area());
        (area / self.count as f64).sqrt()
    }

    /// The triangle in a slot.
    #[inline(always)]
    pub fn frame(&self, slot: usize) -> Frame {
        self.groups[slot / WIDTH].frame(slot % WIDTH)
    }

    /// The index in the mesh of the triangle in a slot.
    #[inline(always)]
    pub fn index(&self, slot: usize) -> u32 {
        self.groups[slot / WIDTH].index[slot % WIDTH]
    }

    /// Heap memory in use (bytes).
    pub fn memory(&self) -> usize {
        size_of::<Node>() * self.nodes.capacity() + size_of::<Group>() * self.groups.capacity()
    }

    /// Calls `hit(slot, frame)` for each triangle whose box the ray may intersect. `hit` returns the new upper end of
    /// the range of t.
    pub fn along_ray(&self, ray: &Ray, mut hit: impl FnMut(usize, &Frame) -> f64) {
        let mut end = ray.part[1];
        let mut stack = [0u32; STACK_SIZE];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let child = stack[count];
            if child & LEAF != 0 {
                let group = (child & !LEAF) as usize;
                for lane in 0..WIDTH {
                    end = end.min(hit(group * WIDTH + lane, &self.groups[group].frame(lane)));
                }
                continue;
            }
            let node = &self.nodes[child as usize];
            for (lane, &child) in node.child.iter().enumerate() {
                if node.intersects(lane, ray, end) {
                    stack[count] = child;
                    count += 1;
                }
            }
        }
    }

    /// The generalised winding number: the sum of the solid angles of all triangles over 4π. It is one inside a closed
    /// mesh, zero outside, and in between near holes.
    ///
    /// Source: A. Jacobson, L. Kavan and O. Sorkine-Hornung, ACM Trans. Graph. 32 (2013) 33.
    pub fn winding(&self, point: DVec3) -> f64 {
        let mut sum = 0.0;
        self.each_slot(|slot, _| sum += self.frame(slot).solid_angle(point));
        sum / (4.0 * std::f64::consts::PI)
    }
}

/// Splits items across the longest side of the box of their centres; all groups are full but the last.
fn split(items: &mut [Item]) -> (&mut [Item], &mut [Item]) {
    let groups = items.len().div_ceil(WIDTH);
    if groups < 2 {
        return items.split_at_mut(items.len());
    }
    let (low, high) =
        items.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), i| {
            (low.min(i.centre), high.max(i.centre))
        });
    let axis = (high - low).max_position();
    let middle = groups.div_ceil(2) * WIDTH;
    // ties are broken by index, so that the order is the same on every machine
    items.select_nth_unstable_by(middle, |a, b| {
        a.centre[axis].total_cmp(&b.centre[axis]).then(a.index.cmp(&b.index))
    });
    items.split_at_mut(middle)
}

impl Item {
    fn new(index: u32, frame: Frame) -> Self {
        let [a, b, c] = frame.corners();
        let slack = DVec3::splat(SLACK * frame.length);
        let bounds = Extent { low: a.min(b).min(c) - slack, high: a.max(b).max(c) + slack };
        Self { centre: 0.5 * bounds.low + 0.5 * bounds.high, bounds, index, frame }
    }
}

impl Node {
    const EMPTY: Self = Self {
        low: [[f64::INFINITY; WIDTH]; 3],
        high: [[f64::NEG_INFINITY; WIDTH]; 3],
        child: [0; WIDTH],
    };

    fn set(&mut self, lane: usize, bounds: Extent, child: u32) {
        for axis in 0..3 {
            self.low[axis][lane] = bounds.low[axis];
            self.high[axis][lane] = bounds.high[axis];
        }
        self.child[lane] = child;
    }

    /// The squared distances (m²) of the boxes from a point.
    #[inline(always)]
    pub fn squared<S: Simd>(&self, simd: S, point: [f64x4<S>; 3]) -> [f64; WIDTH] {
        let x = self.beyond(simd, point, 0);
        let y = self.beyond(simd, point, 1);
        let z = self.beyond(simd, point, 2);
        (x * x + y * y + z * z).into()
    }

    /// The distance of a point from the boxes along an axis (m).
    #[inline(always)]
    fn beyond<S: Simd>(&self, simd: S, point: [f64x4<S>; 3], axis: usize) -> f64x4<S> {
        let below = f64x4::simd_from(simd, self.low[axis]) - point[axis];
        let above = point[axis] - f64x4::simd_from(simd, self.high[axis]);
        below.max(above).max(f64x4::splat(simd, 0.0))
    }

    /// Whether the box of a child may intersect a ray.
    fn intersects(&self, lane: usize, ray: &Ray, end: f64) -> bool {
        let [mut from, mut to] = [ray.part[0], end];
        for axis in 0..3 {
            let (low, high) = (self.low[axis][lane], self.high[axis][lane]);
            let (start, along) = (ray.from[axis], ray.along[axis]);
            if along == 0.0 {
                if start < low || start > high {
                    return false;
                }
                continue;
            }
            let (a, b) = ((low - start) / along, (high - start) / along);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        // missing boxes are at infinity; the slack covers rounding
        let slack = 1e-12 * from.abs().max(to.abs());
        self.low[0][lane] <= self.high[0][lane] && from <= to + slack
    }
}
