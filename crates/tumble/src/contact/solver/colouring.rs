//! Colours: groups of one colour share no free body, so that they can be solved side by side.

use super::bodies::SolverBody;
use super::groups::Group;

/// Colours that are told apart by one bit each; groups that find none of them free get one of their own each.
const COLOURS: u32 = 64;

/// The groups of each colour.
#[derive(Clone, Debug, Default)]
pub(super) struct Colouring {
    /// The colours that the groups of each body have so far, one bit each.
    used: Vec<u64>,
    /// Colour of each group.
    colours: Vec<u32>,
    /// Colour and number of contacts of each group, and its index: buffer of the sort.
    keys: Vec<(u64, u32)>,
    /// The groups, colour by colour, those with more contacts first.
    pub order: Vec<u32>,
    /// Where the colours begin in `order`, and the end.
    pub starts: Vec<u32>,
}

impl Colouring {
    /// Gives each group the first colour that no group before it has that shares a free body with it.
    pub fn colour(&mut self, groups: &[Group], bodies: &[SolverBody]) {
        self.used.clear();
        self.used.resize(bodies.len(), 0);
        self.colours.clear();
        let mut count = 0;
        let mut extra = COLOURS;
        for group in groups {
            let free =
                [group.first, group.second].map(|body| bodies[body as usize].inverse_mass > 0.0);
            let used_by = |body: u32, is_free| if is_free { self.used[body as usize] } else { 0 };
            let used = used_by(group.first, free[0]) | used_by(group.second, free[1]);
            let colour = used.trailing_ones();
            if colour < COLOURS {
                for (body, is_free) in [group.first, group.second].into_iter().zip(free) {
                    if is_free {
                        self.used[body as usize] |= 1 << colour;
                    }
                }
                self.colours.push(colour);
                count = count.max(colour + 1);
            } else {
                self.colours.push(extra);
                extra += 1;
            }
        }
        self.sort(groups, if extra > COLOURS { extra } else { count });
    }

    /// Sorts the groups by colour, by their number of contacts, and by their index.
    fn sort(&mut self, groups: &[Group], count: u32) {
        let Self { colours, keys, order, starts, .. } = self;
        let group_keys = groups.iter().zip(&*colours).zip(0..).map(|((group, &colour), index)| {
            (u64::from(colour) << 32 | u64::from(u32::MAX - group.len()), index)
        });
        keys.clear();
        keys.extend(group_keys);
        // a stable sort would allocate
        keys.sort_unstable();
        order.clear();
        order.extend(keys.iter().map(|&(_, group)| group));
        starts.clear();
        starts.extend(
            (0..=count).map(|colour| {
                keys.partition_point(|&(key, _)| key >> 32 < u64::from(colour)) as u32
            }),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(first: u32, second: u32, len: u32) -> Group {
        Group {
            first,
            second,
            start: 0,
            end: len,
            damping_ratio: 0.0,
            asked_damping_ratio: 0.0,
            friction_damping_factor: 0.0,
        }
    }

    #[test]
    fn groups_of_one_colour_share_no_free_body() {
        // 100 bodies on one free body, each on the next, all on one that is not free
        let mut bodies = vec![SolverBody { inverse_mass: 1.0, ..SolverBody::default() }; 102];
        bodies[101].inverse_mass = 0.0;
        let on_one = (1..=100).map(|body| group(0, body, body % 3));
        let on_next = (1..100).map(|body| group(body, body + 1, 1));
        let on_fixed = (0..=100).map(|body| group(body, 101, 2));
        let groups: Vec<Group> = on_one.chain(on_next).chain(on_fixed).collect();
        let mut colouring = Colouring::default();
        colouring.colour(&groups, &bodies);
        let mut seen = vec![false; groups.len()];
        for range in colouring.starts.windows(2) {
            let mut touched = vec![false; bodies.len()];
            let mut longest = u32::MAX;
            for &index in &colouring.order[range[0] as usize..range[1] as usize] {
                let group = groups[index as usize];
                assert!(!std::mem::replace(&mut seen[index as usize], true));
                assert!(group.len() <= longest);
                longest = group.len();
                for body in [group.first, group.second].map(|body| body as usize) {
                    let was_touched = std::mem::replace(&mut touched[body], true);
                    assert!(!was_touched || bodies[body].inverse_mass == 0.0);
                }
            }
        }
        assert!(seen.into_iter().all(|seen| seen));
    }
}
