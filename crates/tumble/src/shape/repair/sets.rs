//! Disjoint sets with a parity: which faces belong together, and which of them are wound alike.

/// Disjoint sets of the numbers below some count (union–find). Each number has a parity relative to the root of its set.
pub(super) struct ParitySets {
    parent: Vec<u32>,
    /// The parity relative to the parent.
    odd: Vec<bool>,
}

impl ParitySets {
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect(), odd: vec![false; count] }
    }

    /// The root of a number's set, and whether the number has the other parity.
    pub fn root(&mut self, number: u32) -> (u32, bool) {
        let (mut at, mut odd) = (number, false);
        while self.parent[at as usize] != at {
            odd ^= self.odd[at as usize];
            at = self.parent[at as usize];
        }
        // path compression; the parity of each number on the way is that of what is left of the way
        let (root, mut rest, mut at_now) = (at, odd, number);
        while self.parent[at_now as usize] != root && at_now != root {
            let (next, step) = (self.parent[at_now as usize], self.odd[at_now as usize]);
            self.parent[at_now as usize] = root;
            self.odd[at_now as usize] = rest;
            rest ^= step;
            at_now = next;
        }
        (root, odd)
    }

    /// Joins two sets so that the numbers have equal or different parity. False if they are in one set already and
    /// their parity is not that.
    pub fn join(&mut self, a: u32, b: u32, differ: bool) -> bool {
        let ((root_a, odd_a), (root_b, odd_b)) = (self.root(a), self.root(b));
        if root_a == root_b {
            return (odd_a ^ odd_b) == differ;
        }
        // the lower number is the root, so that the result does not depend on the order of the calls
        let (low, high) = (root_a.min(root_b), root_a.max(root_b));
        self.parent[high as usize] = low;
        self.odd[high as usize] = odd_a ^ odd_b ^ differ;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parity_follows_the_path_and_contradictions_are_found() {
        let mut sets = ParitySets::new(6);
        assert!(sets.join(0, 1, true) && sets.join(1, 2, true) && sets.join(4, 5, false));
        assert_eq!((sets.root(2), sets.root(1)), ((0, false), (0, true)));
        assert!(!sets.join(0, 2, true) && sets.join(0, 2, false));
        assert!(sets.join(5, 2, true));
        assert_eq!((sets.root(4), sets.root(3)), ((0, true), (3, false)));
    }

    #[test]
    fn long_chains_are_followed_without_recursion() {
        let mut sets = ParitySets::new(100_001);
        for i in (0..100_000).rev() {
            assert!(sets.join(i, i + 1, true));
        }
        assert_eq!(sets.root(100_000), (0, false));
        assert_eq!(sets.root(99_999), (0, true));
    }
}
