//! Components that meet at edges of more than two faces, and which of them form closed surfaces together.

use std::collections::BTreeSet;

use super::sets::ParitySets;

/// The most components of a group that are divided; a larger group stays one.
const MAX_MEMBERS: usize = 8;

/// The components that are uneven at an edge: each has this many more half-edges in one direction than back.
pub(super) type Uneven = Vec<(u32, i64)>;

/// For each component the lowest one of those with which it forms a closed surface. Components are divided into surfaces of as few as
/// possible, so that boxes that share a face become two. What is not closed that way stays together.
pub(super) fn closed_groups(component_count: usize, edges: &BTreeSet<Uneven>) -> Vec<u32> {
    let mut sets = ParitySets::new(component_count);
    for edge in edges {
        for pair in edge.windows(2) {
            sets.join(pair[0].0, pair[1].0, false);
        }
    }
    let mut root: Vec<u32> = (0..component_count as u32).map(|c| sets.root(c).0).collect();
    let mut by_root: Vec<(u32, u32)> = edges
        .iter()
        .flatten()
        .map(|&(component, _)| (root[component as usize], component))
        .collect();
    by_root.sort_unstable();
    by_root.dedup();
    let mut edges_by_root: Vec<(u32, &Uneven)> =
        edges.iter().map(|edge| (root[edge[0].0 as usize], edge)).collect();
    edges_by_root.sort_unstable();
    let mut edge_groups = edges_by_root.chunk_by(|a, b| a.0 == b.0);
    for members in by_root.chunk_by(|a, b| a.0 == b.0) {
        let Some(edges) = edge_groups.next() else { break };
        if members.len() <= MAX_MEMBERS {
            let members: Vec<u32> = members.iter().map(|m| m.1).collect();
            divide(&members, edges, &mut root);
        }
    }
    root
}

/// Divides the members of a group, in ascending order, into closed surfaces.
fn divide(members: &[u32], edges: &[(u32, &Uneven)], root: &mut [u32]) {
    // the sums at each edge over the members of a subset, which is a set of bits
    let is_closed = |subset: u32| {
        edges.iter().all(|(_, edge)| {
            let is_in = |component: &u32| {
                members.binary_search(component).is_ok_and(|place| subset >> place & 1 == 1)
            };
            edge.iter().filter(|(component, _)| is_in(component)).map(|e| e.1).sum::<i64>() == 0
        })
    };
    let mut left = (1u32 << members.len()) - 1;
    while left != 0 {
        let first = 1 << left.trailing_zeros();
        let subsets = (1..=left).filter(|s| s & left == *s && s & first != 0);
        let fewest = subsets.filter(|&s| is_closed(s)).min_by_key(|s| (s.count_ones(), *s));
        let taken = fewest.unwrap_or(left);
        let lowest = members[taken.trailing_zeros() as usize];
        for (place, &component) in members.iter().enumerate() {
            if taken >> place & 1 == 1 {
                root[component as usize] = lowest;
            }
        }
        left &= !taken;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_is_divided_into_the_smallest_closed_surfaces() {
        // two boxes with a common face: the rest and the face of each
        let edges = BTreeSet::from([vec![(0, 1), (1, -1), (2, 1), (3, -1)]]);
        assert_eq!(closed_groups(5, &edges), [0, 0, 2, 2, 4]);
        // a wall in a box: nothing is closed by itself but the left part with the wall
        let edges = BTreeSet::from([vec![(0, 1), (1, 1), (2, -1)]]);
        assert_eq!(closed_groups(3, &edges), [0, 1, 0]);
        let edges = BTreeSet::from([vec![(0, 1), (1, 1), (2, 1)]]);
        assert_eq!(closed_groups(3, &edges), [0, 0, 0]);
        // a large group stays one
        let edges =
            BTreeSet::from([(0..12).map(|c| (c, if c % 2 == 0 { 1 } else { -1 })).collect()]);
        assert_eq!(closed_groups(12, &edges), [0; 12]);
    }
}
