//! The particles of a shape, in an order that keeps neighbours together.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;

use super::tree::{self, Branch, Node};
use crate::lanes::{LANES, Vec3x8};

/// Places of particles in the body frame (m).
///
/// A particle's *index* counts in the order of the input. Inside, particles lie in *slots*, in the order of
/// the leaves of a tree: any node of it is a run of slots, and sums over a run read memory in a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Particles {
    /// Coordinates by slot, padded with zeros to whole groups of [`LANES`].
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// The index of the particle in each slot.
    index: Vec<u32>,
    /// The slot of each index.
    slot: Vec<u32>,
    /// The tree over them, from the root down, each left child right after its parent.
    nodes: Vec<Node>,
}

impl Particles {
    /// Takes the places rᵢ (m).
    pub fn new(places: impl IntoIterator<Item = DVec3>) -> Self {
        let places: Vec<DVec3> = places.into_iter().collect();
        let (index, nodes) = tree::build(&places);
        let mut slot = vec![0; index.len()];
        for (at, &i) in index.iter().enumerate() {
            slot[i as usize] = at as u32;
        }
        let along = |axis: usize| {
            let mut column: Vec<f64> = index.iter().map(|&i| places[i as usize][axis]).collect();
            column.resize(column.len().next_multiple_of(LANES), 0.0);
            column
        };
        Self { x: along(0), y: along(1), z: along(2), index, slot, nodes }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.index.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.index.is_empty()
    }

    /// The place rᵢ of one particle in the body frame (m).
    ///
    /// # Panics
    /// When `index` is not below [`Particles::len`].
    pub fn get(&self, index: usize) -> DVec3 {
        self.at(self.slot[index])
    }

    /// All places (m), in the order of the input.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = DVec3> + '_ {
        self.slot.iter().map(|&slot| self.at(slot))
    }

    /// Memory that they and their tree take (bytes).
    pub fn memory(&self) -> usize {
        3 * size_of::<f64>() * self.x.capacity()
            + size_of::<u32>() * (self.index.capacity() + self.slot.capacity())
            + size_of::<Node>() * self.nodes.capacity()
    }

    /// Appends the slots of all particles within `distance` (m) of a place, in their order.
    pub(crate) fn list_within(&self, place: DVec3, distance: f64, slots: &mut Vec<u32>) {
        if self.is_empty() {
            return;
        }
        let near = |at: DVec3| at.distance_squared(place) <= distance * distance;
        let mut branches = vec![Branch::root(&self.nodes)];
        while let Some(branch) = branches.pop() {
            if self.nodes[branch.node as usize].distance(place) > distance {
                continue;
            }
            if let Some([left, right]) = branch.children() {
                branches.extend([right, left]);
                continue;
            }
            let start = branch.first * tree::LEAF as u32;
            let end = (start + tree::LEAF as u32).min(self.len() as u32);
            slots.extend((start..end).filter(|&slot| near(self.at(slot))));
        }
    }

    /// The place in a slot (m).
    pub(crate) fn at(&self, slot: u32) -> DVec3 {
        let slot = slot as usize;
        DVec3::new(self.x[slot], self.y[slot], self.z[slot])
    }

    /// The index of the particle in a slot.
    pub(crate) fn index_in(&self, slot: u32) -> u32 {
        self.index[slot as usize]
    }

    /// The slot of a particle.
    pub(crate) fn slot_of(&self, index: u32) -> u32 {
        self.slot[index as usize]
    }

    /// The tree.
    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    #[inline(always)]
    fn group<S: Simd>(&self, simd: S, group: usize) -> Group<S> {
        let first = group * LANES;
        let (x, y, z) = (self.x.as_chunks().0, self.y.as_chunks().0, self.z.as_chunks().0);
        let place = Vec3x8 {
            x: f64x8::simd_from(simd, x[group]),
            y: f64x8::simd_from(simd, y[group]),
            z: f64x8::simd_from(simd, z[group]),
        };
        Group { first: first as u32, place, count: (self.len() - first).min(LANES) }
    }

    /// The particles under a branch, in groups of neighbouring slots.
    #[inline(always)]
    pub(super) fn groups<S: Simd>(
        &self,
        simd: S,
        branch: Branch,
    ) -> impl Iterator<Item = Group<S>> {
        let start = branch.first as usize * tree::GROUPS;
        // the last leaf may have fewer groups
        let end = (start + branch.leaves as usize * tree::GROUPS).min(self.x.len() / LANES);
        (start..end).map(
            #[inline(always)]
            move |group| self.group(simd, group),
        )
    }
}

/// Neighbouring slots.
pub(super) struct Group<S: Simd> {
    /// The first of them.
    pub first: u32,
    /// The places in them (m).
    pub place: Vec3x8<S>,
    /// How many of them hold a particle.
    pub count: usize,
}
