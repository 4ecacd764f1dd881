//! The particles of a shape, in an order that keeps neighbours together.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;

use super::tree::{self, Branch, Moments, Node};
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
    /// What they weigh, by slot, padded with zeros as the coordinates are; empty where each weighs one.
    weights: Vec<f64>,
    /// The moments of each node with these weights, or empty too.
    weighted: Vec<Moments>,
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
        let (weights, weighted) = (Vec::new(), Vec::new());
        Self { x: along(0), y: along(1), z: along(2), index, slot, nodes, weights, weighted }
    }

    /// The same particles, each with its weight wᵢ (in the order of the input), 0 or more and finite: what
    /// contact does to a particle counts wᵢ times. Slots and tree stay as they are.
    pub(crate) fn with_weights(mut self, weights: &[f64]) -> Self {
        debug_assert_eq!(weights.len(), self.len());
        self.weights = self.index.iter().map(|&i| weights[i as usize]).collect();
        let places: Vec<DVec3> = (0..self.index.len() as u32).map(|slot| self.at(slot)).collect();
        self.weighted = tree::weigh(&self.nodes, &places, &self.weights);
        self.weights.resize(self.x.len(), 0.0);
        self
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

    /// How often the contact forces of one particle count, wᵢ: its share of the surface over the mean share
    /// where stiffness is per area, else 1. The mean over all particles is 1.
    ///
    /// # Panics
    /// When `index` is not below [`Particles::len`].
    pub fn weight(&self, index: usize) -> f64 {
        let slot = self.slot[index];
        if self.is_weighted() { self.weights[slot as usize] } else { 1.0 }
    }

    /// Whether they have weights; else each weighs one.
    pub fn is_weighted(&self) -> bool {
        !self.weights.is_empty()
    }

    /// Memory that they and their tree take (bytes).
    pub fn memory(&self) -> usize {
        size_of::<f64>() * (3 * self.x.capacity() + self.weights.capacity())
            + size_of::<u32>() * (self.index.capacity() + self.slot.capacity())
            + size_of::<Node>() * self.nodes.capacity()
            + size_of::<Moments>() * self.weighted.capacity()
    }

    /// Appends the slots of all particles but those in balls (centre and radius, m) that `may_matter` says no of, in
    /// their order.
    pub(crate) fn list_where(
        &self,
        mut may_matter: impl FnMut(DVec3, f64) -> bool,
        slots: &mut Vec<u32>,
    ) {
        if self.is_empty() {
            return;
        }
        let mut branches = vec![Branch::root(&self.nodes)];
        while let Some(branch) = branches.pop() {
            let (centre, radius) = self.nodes[branch.node as usize].ball();
            if !may_matter(centre, radius) {
                continue;
            }
            if let Some([left, right]) = branch.children() {
                branches.extend([right, left]);
                continue;
            }
            let start = branch.first * tree::LEAF as u32;
            slots.extend(start..(start + tree::LEAF as u32).min(self.len() as u32));
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

    /// The moments of a node of particles that weigh.
    #[inline(always)]
    pub(super) fn weighted(&self, branch: Branch) -> &Moments {
        &self.weighted[branch.node as usize]
    }

    /// What the particles of a group weigh, where they do.
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
