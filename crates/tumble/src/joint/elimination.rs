//! Direct solution of the equations of all joints: block elimination along the graph of joints.
//!
//! The matrix S = G M⁻¹ Gᵀ has a block for each joint, and one for each two joints of the same free body. Its elimination needs
//! few further blocks if joints with few neighbours come first (minimum degree: W. F. Tinney & J. W. Walker, Proc. IEEE 55 (1967)
//! 1801): none in a tree of bodies with two joints each, so that a chain costs time linear in its length.
//!
//! A row that depends on earlier ones leaves nothing of its pivot. It is left out: the others already hold what it would.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use super::rows::{MAX_ROWS, RowValues};

/// A pivot below this part of its diagonal element is that of a dependent row.
const DEPENDENT: f64 = 1e-10;

/// A block of the matrix.
pub(crate) type Block = [[f64; MAX_ROWS]; MAX_ROWS];

/// The order of elimination, and where its results go.
#[derive(Clone, Debug, Default)]
pub(crate) struct Elimination {
    /// Joints in the order of their elimination.
    pub order: Vec<u32>,
    /// For each of them where its blocks begin in `blocks`, and the end.
    starts: Vec<u32>,
    /// Blocks below the diagonal: the place of the later joint in the order.
    later: Vec<u32>,
    /// Pairs of joints whose bodies couple them: the earlier and the later one, and their block.
    pub couplings: Vec<Coupling>,
    /// Where each update of the elimination goes: for each joint, its blocks in pairs; a block, or a diagonal where the two are one.
    targets: Vec<u32>,
}

/// Two joints that act on the same free body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupling {
    /// The joint that is eliminated later: its rows are those of the block.
    pub later: u32,
    pub earlier: u32,
    pub block: u32,
    /// Which body of either joint it is.
    pub sides: [u8; 2],
}

/// A diagonal block as L D Lᵀ.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pivots {
    /// L, below its diagonal of ones.
    lower: Block,
    /// D; 0 of rows that are left out.
    pub diagonal: RowValues,
    /// 1/D, 0 likewise.
    inverse: RowValues,
}

/// The matrix, and its elimination.
#[derive(Clone, Debug, Default)]
pub(crate) struct Matrix {
    /// Diagonal blocks, by place in the order.
    pub diagonal: Vec<Block>,
    /// Those after the elimination.
    pub pivots: Vec<Pivots>,
    /// Blocks B below the diagonal; after the elimination B L⁻ᵀ.
    pub blocks: Vec<Block>,
}

impl Elimination {
    /// For joints that act on these free bodies.
    pub fn new(joints: &[[Option<u32>; 2]]) -> Self {
        let mut neighbours = vec![BTreeSet::new(); joints.len()];
        let mut of_body = BTreeMap::<u32, Vec<(u32, u8)>>::new();
        for (joint, bodies) in (0u32..).zip(joints) {
            for (side, body) in (0u8..).zip(bodies) {
                if let Some(body) = body {
                    of_body.entry(*body).or_default().push((joint, side));
                }
            }
        }
        for joints in of_body.values() {
            for &(a, _) in joints {
                neighbours[a as usize].extend(joints.iter().map(|(b, _)| *b).filter(|b| *b != a));
            }
        }
        let mut elimination = Self::default();
        elimination.eliminate(neighbours);
        elimination.couple(&of_body.into_values().collect::<Vec<_>>());
        elimination
    }

    /// Orders the joints by their number of neighbours, and lists all blocks and updates.
    fn eliminate(&mut self, mut neighbours: Vec<BTreeSet<u32>>) {
        let count = neighbours.len();
        let mut queue: BinaryHeap<_> =
            (0..count).map(|joint| Reverse((neighbours[joint].len(), joint as u32))).collect();
        let mut place = vec![u32::MAX; count];
        let mut columns: Vec<Vec<u32>> = Vec::with_capacity(count);
        while let Some(Reverse((degree, joint))) = queue.pop() {
            let index = joint as usize;
            // an entry may be out of date
            if place[index] != u32::MAX || degree != neighbours[index].len() {
                continue;
            }
            place[index] = self.order.len() as u32;
            self.order.push(joint);
            let column: Vec<u32> = std::mem::take(&mut neighbours[index]).into_iter().collect();
            for &a in &column {
                let of = &mut neighbours[a as usize];
                of.remove(&joint);
                of.extend(column.iter().filter(|b| **b != a));
                queue.push(Reverse((of.len(), a)));
            }
            columns.push(column);
        }
        self.starts.push(0);
        for column in columns {
            let mut later: Vec<u32> = column.iter().map(|&joint| place[joint as usize]).collect();
            later.sort_unstable();
            self.later.extend(later);
            self.starts.push(self.later.len() as u32);
        }
        for place in 0..count {
            let column = self.column(place);
            for b in column.clone() {
                for a in column.start..=b {
                    let (row, column) = (self.later[b], self.later[a]);
                    let target = if a == b { row } else { self.block(column, row) };
                    self.targets.push(target);
                }
            }
        }
    }

    /// The blocks below the diagonal at a place in the order.
    fn column(&self, place: usize) -> std::ops::Range<usize> {
        self.starts[place] as usize..self.starts[place + 1] as usize
    }

    /// The block of two joints by their places, the earlier one first. They are neighbours.
    fn block(&self, earlier: u32, later: u32) -> u32 {
        let column = self.column(earlier as usize);
        let within = self.later[column.clone()].partition_point(|&place| place < later);
        (column.start + within) as u32
    }

    /// Lists the blocks to which the matrix contributes; `bodies` holds the joints of each body, and the side on which it is.
    fn couple(&mut self, bodies: &[Vec<(u32, u8)>]) {
        let mut places = vec![0; self.order.len()];
        for (place, &joint) in (0..).zip(&self.order) {
            places[joint as usize] = place;
        }
        for joints in bodies {
            for (index, &(a, a_side)) in joints.iter().enumerate() {
                for &(b, b_side) in &joints[..index] {
                    let in_order = places[a as usize] < places[b as usize];
                    let [(earlier, e_side), (later, l_side)] = if in_order {
                        [(a, a_side), (b, b_side)]
                    } else {
                        [(b, b_side), (a, a_side)]
                    };
                    let block = self.block(places[earlier as usize], places[later as usize]);
                    self.couplings.push(Coupling {
                        later,
                        earlier,
                        block,
                        sides: [l_side, e_side],
                    });
                }
            }
        }
    }

    /// The number of blocks below the diagonal.
    pub fn block_count(&self) -> usize {
        self.later.len()
    }

    /// Eliminates. Rows without a diagonal element are left out.
    ///
    /// It works with the triangular factors of the blocks: with their inverses, rounding errors of rows of large mobility would hide that
    /// others are dependent.
    pub fn factor(&self, matrix: &mut Matrix) {
        let mut targets = self.targets.iter();
        let Matrix { diagonal, pivots, blocks } = matrix;
        let originals: Vec<RowValues> =
            diagonal.iter().map(|block| std::array::from_fn(|row| block[row][row])).collect();
        pivots.clear();
        for place in 0..self.order.len() {
            let own = Pivots::new(&diagonal[place], &originals[place]);
            pivots.push(own);
            let column = self.column(place);
            for b in column.clone() {
                blocks[b] = own.reduced(&blocks[b]);
                let scaled = own.divided(&blocks[b]);
                for a in column.start..=b {
                    let update = product_with_transpose(&scaled, &blocks[a]);
                    let Some(&target) = targets.next() else { return };
                    let target = if a == b {
                        &mut diagonal[target as usize]
                    } else {
                        &mut blocks[target as usize]
                    };
                    subtract(target, &update);
                }
            }
        }
    }

    /// Solves S x = `values`, in place; `values` are by joint. Rows that are left out get 0.
    pub fn solve(&self, matrix: &Matrix, values: &mut [RowValues]) {
        let Matrix { pivots, blocks, .. } = matrix;
        for (place, &joint) in self.order.iter().enumerate() {
            let y = pivots[place].forward(&values[joint as usize]);
            values[joint as usize] = y;
            for at in self.column(place) {
                let later = &mut values[self.order[self.later[at] as usize] as usize];
                let update = times(&blocks[at], &y);
                later.iter_mut().zip(update).for_each(|(value, update)| *value -= update);
            }
        }
        for (place, &joint) in self.order.iter().enumerate().rev() {
            let mut y = values[joint as usize];
            let own = &pivots[place];
            for at in self.column(place) {
                let later = values[self.order[self.later[at] as usize] as usize];
                for (column, value) in y.iter_mut().enumerate() {
                    let sum: f64 =
                        (0..MAX_ROWS).map(|row| blocks[at][row][column] * later[row]).sum();
                    *value -= sum * own.inverse[column];
                }
            }
            values[joint as usize] = own.backward(y);
        }
    }
}

impl Pivots {
    /// Those of a symmetric block; `original` is its diagonal before the elimination of others.
    fn new(block: &Block, original: &RowValues) -> Self {
        let mut pivots = Self::default();
        let Self { lower, diagonal, inverse } = &mut pivots;
        for row in 0..MAX_ROWS {
            for column in 0..row {
                let sum: f64 =
                    (0..column).map(|k| lower[row][k] * lower[column][k] * diagonal[k]).sum();
                lower[row][column] = (block[row][column] - sum) * inverse[column];
            }
            let sum: f64 = (0..row).map(|k| lower[row][k] * lower[row][k] * diagonal[k]).sum();
            let pivot = block[row][row] - sum;
            if pivot > DEPENDENT * original[row] {
                (diagonal[row], inverse[row]) = (pivot, 1.0 / pivot);
            }
        }
        pivots
    }

    /// B L⁻ᵀ, 0 in the columns of rows that are left out.
    fn reduced(&self, block: &Block) -> Block {
        let mut reduced = *block;
        for row in &mut reduced {
            for column in 0..MAX_ROWS {
                let sum: f64 = (0..column).map(|k| row[k] * self.lower[column][k]).sum();
                row[column] = if self.diagonal[column] > 0.0 { row[column] - sum } else { 0.0 };
            }
        }
        reduced
    }

    /// W D⁻¹.
    fn divided(&self, block: &Block) -> Block {
        block.map(|row| std::array::from_fn(|column| row[column] * self.inverse[column]))
    }

    /// D⁻¹ L⁻¹ y.
    fn forward(&self, y: &RowValues) -> RowValues {
        let mut z = RowValues::default();
        for row in 0..MAX_ROWS {
            let sum: f64 = (0..row).map(|k| self.lower[row][k] * z[k]).sum();
            z[row] = if self.diagonal[row] > 0.0 { y[row] - sum } else { 0.0 };
        }
        std::array::from_fn(|row| z[row] * self.inverse[row])
    }

    /// L⁻ᵀ y, 0 in rows that are left out.
    fn backward(&self, mut y: RowValues) -> RowValues {
        for row in (0..MAX_ROWS).rev() {
            let sum: f64 = (row + 1..MAX_ROWS).map(|k| self.lower[k][row] * y[k]).sum();
            y[row] = if self.diagonal[row] > 0.0 { y[row] - sum } else { 0.0 };
        }
        y
    }
}

fn product_with_transpose(a: &Block, b: &Block) -> Block {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| (0..MAX_ROWS).map(|k| a[row][k] * b[column][k]).sum())
    })
}

fn subtract(from: &mut Block, what: &Block) {
    for (from, what) in from.iter_mut().zip(what) {
        from.iter_mut().zip(what).for_each(|(from, what)| *from -= what);
    }
}

fn times(a: &Block, x: &RowValues) -> RowValues {
    std::array::from_fn(|row| (0..MAX_ROWS).map(|k| a[row][k] * x[k]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from −1 to 1.
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        /// Not far from `scale` times the identity, so that the matrix is well conditioned.
        fn block(&mut self, scale: f64) -> Block {
            std::array::from_fn(|row| {
                let diagonal = |column| if row == column { scale } else { 0.0 };
                std::array::from_fn(|column| diagonal(column) + 0.1 * self.next())
            })
        }
    }

    /// Gradients of each joint for its bodies, and the matrix that they make.
    fn system(joints: &[[Option<u32>; 2]]) -> (Elimination, Vec<[Block; 2]>, Matrix) {
        let mut random = Random(joints.len() as u64);
        let gradients: Vec<_> =
            joints.iter().map(|_| [random.block(1.0), random.block(-0.6)]).collect();
        let elimination = Elimination::new(joints);
        let mut matrix = Matrix::default();
        for &joint in &elimination.order {
            let mut block = Block::default();
            for (gradient, body) in gradients[joint as usize].iter().zip(joints[joint as usize]) {
                if body.is_some() {
                    subtract(&mut block, &product_with_transpose(gradient, gradient));
                }
            }
            matrix.diagonal.push(block.map(|row| row.map(|x| -x)));
        }
        matrix.blocks = vec![Block::default(); elimination.block_count()];
        for Coupling { later, earlier, block, sides: [a, b] } in &elimination.couplings {
            let [a, b] = [
                &gradients[*later as usize][usize::from(*a)],
                &gradients[*earlier as usize][usize::from(*b)],
            ];
            let mut product = product_with_transpose(a, b);
            product.iter_mut().flatten().for_each(|x| *x = -*x);
            subtract(&mut matrix.blocks[*block as usize], &product);
        }
        (elimination, gradients, matrix)
    }

    /// G Gᵀ x, by bodies.
    fn multiplied(
        joints: &[[Option<u32>; 2]],
        g: &[[Block; 2]],
        x: &[RowValues],
    ) -> Vec<RowValues> {
        let mut bodies = BTreeMap::<u32, RowValues>::new();
        let sides = || {
            joints.iter().enumerate().flat_map(|(joint, bodies)| {
                let of_side =
                    move |(side, body): (usize, &Option<u32>)| body.map(|body| (joint, side, body));
                bodies.iter().enumerate().filter_map(of_side).collect::<Vec<_>>()
            })
        };
        for (joint, side, body) in sides() {
            let sum = bodies.entry(body).or_default();
            for (row, x) in g[joint][side].iter().zip(&x[joint]) {
                sum.iter_mut().zip(row).for_each(|(sum, g)| *sum += g * x);
            }
        }
        let mut product = vec![RowValues::default(); joints.len()];
        for (joint, side, body) in sides() {
            let update = times(&g[joint][side], &bodies[&body]);
            product[joint].iter_mut().zip(update).for_each(|(sum, x)| *sum += x);
        }
        product
    }

    #[test]
    fn chains_trees_stars_and_loops_are_solved() {
        let chain: Vec<[Option<u32>; 2]> =
            (0..40u32).map(|k| [Some(k), k.checked_sub(1)]).collect();
        let tree: Vec<_> = (0..40).map(|k| [Some(k), (k > 0).then(|| (k - 1) / 3)]).collect();
        let star: Vec<_> = (1..12).map(|k| [Some(k), Some(0)]).collect();
        // a row of bodies whose ends are joined
        let ring: Vec<_> = (0..20).map(|k| [Some(k), Some((k + 1) % 20)]).collect();
        let mut ladder: Vec<_> = (0..15).map(|k| [Some(k), Some(k + 1)]).collect();
        ladder.extend((0..5).map(|k| [Some(3 * k + 40), Some(3 * k)]));
        for joints in [chain, tree, star, ring, ladder] {
            let (elimination, gradients, mut matrix) = system(&joints);
            elimination.factor(&mut matrix);
            let mut random = Random(7);
            let expected: Vec<RowValues> =
                joints.iter().map(|_| std::array::from_fn(|_| random.next())).collect();
            let mut x = multiplied(&joints, &gradients, &expected);
            elimination.solve(&matrix, &mut x);
            let back = multiplied(&joints, &gradients, &x);
            let wanted = multiplied(&joints, &gradients, &expected);
            for (found, wanted) in back.iter().flatten().zip(wanted.iter().flatten()) {
                assert!((found - wanted).abs() < 1e-8, "{found} {wanted}");
            }
        }
    }

    #[test]
    fn a_chain_and_a_tree_of_bodies_with_two_joints_have_no_further_blocks() {
        let chain: Vec<_> = (0..1000u32).map(|k| [Some(k), k.checked_sub(1)]).collect();
        assert_eq!(Elimination::new(&chain).block_count(), 999);
    }
}
