//! The particles of a shape, stored in an order that keeps neighbours together.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;

use super::tree::{self, Moments, Node, Subtree};
use crate::lanes::{LANES, Vec3x8};

/// Positions of particles in the body frame (m).
///
/// The *index* of a particle is its place in the input. Internally, particles are stored in *slots*, in
/// the order of the leaves of a tree. A node of the tree is a contiguous range of slots, so that sums over
/// a node read memory sequentially.
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
    /// The nodes of the tree, in preorder.
    nodes: Vec<Node>,
    /// Weights by slot, padded with zeros like the coordinates; empty where all weights are 1.
    weights: Vec<f64>,
    /// The weighted moments of each node; empty where all weights are 1.
    weighted: Vec<Moments>,
}

impl Particles {
    /// Particles at the positions rᵢ (m).
    pub fn new(places: impl IntoIterator<Item = DVec3>) -> Self {
        let places: Vec<DVec3> = places.into_iter().collect();
        let (index, nodes) = tree::build(&places);
        let mut slot = vec![0; index.len()];
        for (at, &i) in index.iter().enumerate() {
            slot[i as usize] = at as u32;
        }
        let column = |axis: usize| {
            let mut column: Vec<f64> = index.iter().map(|&i| places[i as usize][axis]).collect();
            column.resize(column.len().next_multiple_of(LANES), 0.0);
            column
        };
        let (weights, weighted) = (Vec::new(), Vec::new());
        Self { x: column(0), y: column(1), z: column(2), index, slot, nodes, weights, weighted }
    }

    /// The same particles with weights wᵢ, in the order of the input, finite and not negative. Contact
    /// forces on a particle are multiplied by its weight. Slots and tree do not change.
    pub(crate) fn with_weights(mut self, weights: &[f64]) -> Self {
        debug_assert_eq!(weights.len(), self.len());
        self.weights = self.index.iter().map(|&i| weights[i as usize]).collect();
        let places: Vec<DVec3> = (0..self.index.len() as u32).map(|slot| self.at(slot)).collect();
        self.weighted = tree::weighted_moments(&self.nodes, &places, &self.weights);
        self.weights.resize(self.x.len(), 0.0);
        self
    }

    /// The number of particles.
    pub fn len(&self) -> usize {
        self.index.len()
    }

    /// Whether there are no particles.
    pub fn is_empty(&self) -> bool {
        self.index.is_empty()
    }

    /// The position rᵢ of one particle in the body frame (m).
    ///
    /// # Panics
    /// If `index` is not below [`Particles::len`].
    pub fn get(&self, index: usize) -> DVec3 {
        self.at(self.slot[index])
    }

    /// All positions (m), in the order of the input.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = DVec3> + '_ {
        self.slot.iter().map(|&slot| self.at(slot))
    }

    /// The weight wᵢ by which the contact forces of one particle are multiplied.
    ///
    /// It is the particle's surface area over the mean area where stiffness is per area, else 1. The mean
    /// over all particles is 1.
    ///
    /// # Panics
    /// If `index` is not below [`Particles::len`].
    pub fn weight(&self, index: usize) -> f64 {
        let slot = self.slot[index];
        if self.is_weighted() { self.weights[slot as usize] } else { 1.0 }
    }

    /// Whether the particles have weights other than 1.
    pub fn is_weighted(&self) -> bool {
        !self.weights.is_empty()
    }

    /// Heap memory of the particles and their tree (bytes).
    pub fn memory(&self) -> usize {
        size_of::<f64>() * (3 * self.x.capacity() + self.weights.capacity())
            + size_of::<u32>() * (self.index.capacity() + self.slot.capacity())
            + size_of::<Node>() * self.nodes.capacity()
            + size_of::<Moments>() * self.weighted.capacity()
    }

    /// Appends the slots of all particles, in order, except those inside a bounding sphere (centre and
    /// radius, m) for which `may_matter` is false.
    pub(crate) fn collect_slots_where(
        &self,
        mut may_matter: impl FnMut(DVec3, f64) -> bool,
        slots: &mut Vec<u32>,
    ) {
        if self.is_empty() {
            return;
        }
        let mut stack = vec![Subtree::root(&self.nodes)];
        while let Some(subtree) = stack.pop() {
            let (centre, radius) = self.nodes[subtree.node as usize].bounding_sphere();
            if !may_matter(centre, radius) {
                continue;
            }
            if let Some([left, right]) = subtree.children() {
                stack.extend([right, left]);
                continue;
            }
            let start = subtree.first_leaf * tree::LEAF_SIZE as u32;
            slots.extend(start..(start + tree::LEAF_SIZE as u32).min(self.len() as u32));
        }
    }

    /// The position of the particle in a slot (m).
    pub(crate) fn at(&self, slot: u32) -> DVec3 {
        let slot = slot as usize;
        DVec3::new(self.x[slot], self.y[slot], self.z[slot])
    }

    /// The index of the particle in a slot.
    pub(crate) fn index_of_slot(&self, slot: u32) -> u32 {
        self.index[slot as usize]
    }

    /// The slot of the particle with this index.
    pub(crate) fn slot_of_index(&self, index: u32) -> u32 {
        self.slot[index as usize]
    }

    /// The nodes of the tree.
    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The weighted moments of a node. The particles must have weights.
    #[inline(always)]
    pub(super) fn weighted_moments(&self, subtree: Subtree) -> &Moments {
        &self.weighted[subtree.node as usize]
    }

    /// The weights of the particles of a group. The particles must have weights.
    #[inline(always)]
    pub(super) fn weights<S: Simd>(&self, simd: S, group: &Group<S>) -> f64x8<S> {
        let weights = self.weights.as_chunks().0;
        f64x8::simd_from(simd, weights[group.first as usize / LANES])
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

    /// The particles of a subtree, in groups of [`LANES`] consecutive slots.
    #[inline(always)]
    pub(super) fn groups<S: Simd>(
        &self,
        simd: S,
        subtree: Subtree,
    ) -> impl Iterator<Item = Group<S>> {
        let start = subtree.first_leaf as usize * tree::LEAF_GROUPS;
        // the last leaf may have fewer groups
        let end = (start + subtree.leaves as usize * tree::LEAF_GROUPS).min(self.x.len() / LANES);
        (start..end).map(
            #[inline(always)]
            move |group| self.group(simd, group),
        )
    }
}

/// The particles in [`LANES`] consecutive slots.
pub(super) struct Group<S: Simd> {
    /// The first slot.
    pub first: u32,
    /// The positions (m).
    pub place: Vec3x8<S>,
    /// The number of slots that hold a particle.
    pub count: usize,
}
