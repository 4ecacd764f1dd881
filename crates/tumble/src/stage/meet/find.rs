//! Which of the listed points touch, and what they do.

use fearless_simd::Simd;
use glam::DVec3;

use super::contact::{Approach, Couple, Eight, Losses};
use super::list::{Near, Pair, Point};
use super::mesh::{BLOCK, Known, Look};
use super::pose::Pose;
use super::sides::{Geometry, Sides};
use super::springs::OldSprings;
use crate::lanes::{LANES, vector};
use crate::{ContactKind, Model, PairSpring};

/// The contacts of the bodies of one chunk, as first bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    /// The points that were looked at, pair by pair; what is beyond the number in use is room.
    eights: Vec<Eight>,
    in_use: usize,
    /// The pairs with such points.
    pub touching: Vec<Touching>,
    /// Their losses, after the latest push that was no first look.
    pub losses: Vec<Losses>,
    /// For each pair of the list, which of `touching` it is if it has a contact, or `NONE`.
    pub number: Vec<u32>,
    /// Energy (J) of springs that have come loose, by body of the chunk.
    pub released: Vec<f64>,
    /// The springs that go on after the latest push.
    pub springs: Vec<PairSpring>,
    /// The first two bodies that could pass through each other in a step.
    pub too_fast: Option<TooFast>,
    /// Room for points that may touch.
    candidates: Vec<Candidate>,
    /// Room for what eight of them are found from.
    approach: Approach,
}

/// Room for the contacts of a chunk, and for their springs.
pub(super) type ContactRoom = (Vec<Eight>, Vec<PairSpring>);

/// Marks a pair without contact.
pub(super) const NONE: u32 = u32::MAX;

/// Two bodies that move so fast against each other that one could pass through the other in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TooFast {
    /// Which pair of the list.
    pair: u32,
    /// The body whose particle it is.
    pub body: u32,
    /// Which particle, by index.
    pub particle: u32,
    pub other: u32,
    /// How far the one may come against the other in a step (m).
    pub way: f64,
    /// How far it may (m).
    pub limit: f64,
}

/// A point that may touch.
#[derive(Clone, Copy, Debug, Default)]
struct Candidate {
    /// Which of [`Found::touching`] its pair is.
    touching: u32,
    /// Which point of the list.
    point: u32,
}

/// A pair whose points were looked at, and what its contacts do.
#[derive(Clone, Debug)]
pub(super) struct Touching {
    /// Which pair of the list.
    pub pair: u32,
    /// The first body.
    pub first: u32,
    /// The total of its forces: springs and dashpots, normal and tangential.
    pub forces: Couple,
}

/// What contacts are found from.
#[derive(Clone, Copy)]
pub(super) struct Moment<'a> {
    pub model: &'a Model,
    pub poses: &'a [Pose],
    /// All springs so far.
    pub springs: &'a [PairSpring],
    /// Time since the latest kick (s).
    pub since: f64,
}

impl Found {
    /// Finds the contacts among the listed points of a chunk whose first body is number `body`, and their forces. `FIRST` is that
    /// of [`Eight::push`].
    #[inline(always)]
    pub fn find<S: Simd, const FIRST: bool>(
        &mut self,
        simd: S,
        near: &mut Near,
        moment: &Moment,
        body: usize,
    ) {
        self.in_use = 0;
        self.springs.clear();
        self.touching.clear();
        self.losses.clear();
        self.number.clear();
        self.number.resize(near.pairs.len(), NONE);
        self.too_fast = None;
        let springs = OldSprings::of_chunk(moment, body, std::mem::take(&mut self.released));
        let mut search = Search::new(self, moment, springs);
        let Near { pairs, points, known, .. } = near;
        for number in 0..pairs.len() {
            let pair = &pairs[number];
            let sides = Sides::of(moment, pair);
            if sides.travel < pair.quiet && sides.way <= pair.limit {
                continue;
            }
            search.number = number;
            if pair.is_at_mesh() {
                // springs are taken in the order of pairs: what was collected comes first
                search.look::<S, FIRST>(simd, pairs, points);
                let lists = Listed { pairs, points, known };
                pairs[number].quiet = search.ask_mesh::<S, FIRST>(simd, &sides, lists);
                continue;
            }
            search.begin::<FIRST>(pair);
            pairs[number].quiet = search.collect(pair, &sides, points);
        }
        search.look::<S, FIRST>(simd, pairs, points);
        search.settle::<S, FIRST>(simd, pairs, points);
        search.springs.release_all();
        self.released = search.springs.released;
    }

    /// The forces of all contacts with the velocities of `poses`, and the springs that go on.
    #[inline(always)]
    pub fn push<S: Simd>(&mut self, simd: S, near: &Near, poses: &[Pose]) {
        for touching in &mut self.touching {
            touching.forces = Couple::default();
        }
        self.losses.clear();
        self.losses.resize(self.touching.len(), Losses::default());
        self.springs.clear();
        for number in 0..self.in_use {
            let Self { eights, touching, losses, .. } = self;
            eights[number].push::<S, false>(simd, poses, touching, losses);
            self.keep(number, &near.pairs);
        }
    }

    /// Takes room that another chunk no longer needs, if it has none of its own.
    pub fn take_room(&mut self, room: &mut Vec<ContactRoom>) {
        if self.eights.is_empty()
            && let Some(room) = room.pop()
        {
            (self.eights, self.springs) = room;
        }
    }

    /// Gives up its contacts and springs, which are pushed and written down, as room for another chunk.
    pub fn give_room(&mut self) -> ContactRoom {
        self.in_use = 0;
        (std::mem::take(&mut self.eights), std::mem::take(&mut self.springs))
    }

    /// Energy in the springs (J).
    pub fn elastic_energy(&self) -> f64 {
        // contact by contact: how they come to be in lanes is up to the lists
        let contacts = self.eights[..self.in_use]
            .iter()
            .flat_map(|eight| eight.in_contact().map(move |lane| (eight, lane)));
        let held: f64 = contacts.map(|(eight, lane)| eight.elastic_energy(lane)).sum();
        // springs that have come loose are released at the next kick
        held + self.released.iter().sum::<f64>()
    }

    /// Calls `visit` with the pair, the normal and the depth (m) of each contact.
    pub fn each_contact(&self, near: &Near, mut visit: impl FnMut(&Pair, DVec3, f64)) {
        for eight in &self.eights[..self.in_use] {
            for lane in eight.in_contact() {
                let pair = self.touching[eight.touching[lane] as usize].pair;
                let normal = vector(&eight.normal, lane);
                visit(&near.pairs[pair as usize], normal, eight.depth[lane]);
            }
        }
    }

    /// Takes note of bodies that are too fast, if they are the first of the list.
    fn warn(&mut self, too_fast: TooFast) {
        if self.too_fast.is_none_or(|known| too_fast.pair < known.pair) {
            self.too_fast = Some(too_fast);
        }
    }

    /// Writes down the springs of eight contacts after the latest push.
    #[inline(always)]
    fn keep(&mut self, number: usize, pairs: &[Pair]) {
        let eight = &self.eights[number];
        for lane in eight.in_contact().filter(|&lane| eight.friction[lane] > 0.0) {
            let pair = self.touching[eight.touching[lane] as usize].pair;
            let mut spring = eight.spring(lane, &pairs[pair as usize]);
            spring.stretch = eight.kept(lane);
            self.springs.push(spring);
        }
    }
}

/// The search for the contacts of a chunk, eight at a time.
struct Search<'a> {
    moment: &'a Moment<'a>,
    found: &'a mut Found,
    springs: OldSprings<'a>,
    /// What the lists have to know of those that are being looked at, and how many there are.
    waiting: Waiting,
    count: usize,
    /// The pair that the list is at.
    number: usize,
}

/// What is listed, while points near meshes are looked at.
struct Listed<'a> {
    pairs: &'a mut [Pair],
    points: &'a mut [Point],
    known: &'a mut Known,
}

/// What is known of the points in the lanes, besides what they are found from.
#[derive(Default)]
struct Waiting {
    /// How far both bodies have come together (m).
    travel: [f64; LANES],
    /// How far one may come against the other in a step (m).
    way: [f64; LANES],
}

impl<'a> Search<'a> {
    fn new(found: &'a mut Found, moment: &'a Moment<'a>, springs: OldSprings<'a>) -> Self {
        Self { moment, found, springs, waiting: Waiting::default(), count: 0, number: 0 }
    }

    /// Goes on to a pair.
    #[inline(always)]
    fn begin<const FIRST: bool>(&mut self, pair: &Pair) {
        let forces = Couple::default();
        let pair = Touching { pair: self.number as u32, first: pair.first, forces };
        self.found.touching.push(pair);
        if !FIRST {
            self.found.losses.push(Losses::default());
        }
    }

    /// Takes note of the points of two spheres, or of spheres and a wall, that may touch; returns until when the others are
    /// quiet (m of travel). Without a branch for each point: none could be foretold.
    #[inline(always)]
    fn collect(&mut self, pair: &Pair, sides: &Sides, points: &[Point]) -> f64 {
        let touching = self.found.touching.len() as u32 - 1;
        let candidates = &mut self.found.candidates;
        let mut count = candidates.len();
        let range = pair.start as usize..pair.end as usize;
        candidates.resize(count + range.len(), Candidate::default());
        let mut quiet = f64::INFINITY;
        for (index, point) in (pair.start..).zip(&points[range]) {
            let is_quiet =
                sides.travel < point.quiet && !sides.passes(pair, sides.travel, point.quiet);
            candidates[count] = Candidate { touching, point: index };
            count += usize::from(!is_quiet);
            quiet = quiet.min(if is_quiet { point.quiet } else { f64::INFINITY });
        }
        candidates.truncate(count);
        quiet
    }

    /// Takes all points that were collected into lanes.
    #[inline(always)]
    fn look<S: Simd, const FIRST: bool>(
        &mut self,
        simd: S,
        pairs: &mut [Pair],
        points: &mut [Point],
    ) {
        let mut candidates = std::mem::take(&mut self.found.candidates);
        for &candidate in &candidates {
            let number = self.found.touching[candidate.touching as usize].pair as usize;
            let (pair, point) = (&pairs[number], &points[candidate.point as usize]);
            let sides = Sides::of(self.moment, pair);
            let geometry = sides.geometry(pair, point);
            if self.ask(&sides, pair, candidate, geometry, point) == LANES {
                self.settle::<S, FIRST>(simd, pairs, points);
            }
        }
        candidates.clear();
        self.found.candidates = candidates;
    }

    /// Takes the particles of a body that touch the mesh of another into lanes; returns until when the pair is quiet (m of travel).
    #[inline(always)]
    fn ask_mesh<S: Simd, const FIRST: bool>(
        &mut self,
        simd: S,
        sides: &Sides,
        lists: Listed,
    ) -> f64 {
        let Listed { pairs, points, known } = lists;
        let pair = &pairs[self.number];
        let exact = sides.way > pair.limit;
        let (clock, until) = known.time(pair.listing, &sides.view(pair), sides.travel);
        if clock < until && !exact {
            return sides.travel + (until - clock);
        }
        let pair = &{ *pair };
        self.begin::<FIRST>(pair);
        let touching = self.found.touching.len() as u32 - 1;
        let margin = if exact { pair.margin.max(sides.way) } else { pair.margin };
        let mut look = Look { pair, known, exact, margin };
        let mut quiet = f64::INFINITY;
        for (number, start) in (pair.start..pair.end).step_by(BLOCK).enumerate() {
            let mut of_block = *look.known.of_block(pair.listing, number);
            if clock >= of_block || exact {
                of_block = f64::INFINITY;
                for index in start..pair.end.min(start + BLOCK as u32) {
                    let point = &mut points[index as usize];
                    let mut is_full = false;
                    if clock >= point.quiet || sides.passes(pair, clock, point.quiet) {
                        match sides.touch_mesh(&mut look, point) {
                            Ok(touch) => {
                                point.quiet = 0.0;
                                let candidate = Candidate { touching, point: index };
                                is_full = self.ask(sides, pair, candidate, touch, point) == LANES;
                            }
                            Err(gap) => point.quiet = clock + gap,
                        }
                        self.watch(sides, pair, clock, point);
                    }
                    of_block = of_block.min(point.quiet);
                    if is_full {
                        self.settle::<S, FIRST>(simd, pairs, points);
                    }
                }
                *look.known.of_block(pair.listing, number) = of_block;
            }
            quiet = quiet.min(of_block);
        }
        *look.known.of_pair(pair.listing) = quiet;
        sides.travel + (quiet - clock)
    }

    /// Takes note of a particle that could pass through a mesh within a step.
    #[inline(always)]
    fn watch(&mut self, sides: &Sides, pair: &Pair, clock: f64, point: &Point) {
        if sides.passes(pair, clock, point.quiet) {
            self.found.warn(TooFast::of(sides.model, self.number, pair, point, sides.way));
        }
    }

    /// Takes a point of a pair, with its geometry, into the next lane; returns how many are in use.
    #[inline(always)]
    fn ask(
        &mut self,
        sides: &Sides,
        pair: &Pair,
        candidate: Candidate,
        geometry: Geometry,
        point: &Point,
    ) -> usize {
        let lane = self.count;
        let Found { eights, in_use, approach, .. } = &mut *self.found;
        if eights.len() == *in_use {
            eights.push(Eight::default());
        }
        let eight = &mut eights[*in_use];
        self.waiting.travel[lane] = sides.travel;
        // meshes are watched by a clock of their own
        self.waiting.way[lane] = if pair.is_at_mesh() { 0.0 } else { sides.way };
        eight.touching[lane] = candidate.touching;
        eight.point[lane] = candidate.point;
        if lane == 0 {
            (eight.has_friction, eight.has_belt) = (false, false);
        }
        sides.take_law(pair, point, lane, eight);
        sides.approach(geometry, lane, approach);
        self.count = lane + 1;
        self.count
    }

    /// Looks at what the lanes hold, and goes on to the next eight.
    #[inline(always)]
    fn settle<S: Simd, const FIRST: bool>(
        &mut self,
        simd: S,
        pairs: &mut [Pair],
        points: &mut [Point],
    ) {
        let count = std::mem::take(&mut self.count);
        if count == 0 {
            return;
        }
        let Moment { poses, since, .. } = *self.moment;
        let Found { eights, in_use, approach, .. } = &mut *self.found;
        let eight = &mut eights[*in_use];
        eight.count = count;
        eight.touch(simd, approach);
        for lane in 0..count {
            self.settle_lane(lane, pairs, points);
        }
        let Found { eights, in_use, approach, touching, losses, .. } = &mut *self.found;
        let eight = &mut eights[*in_use];
        *in_use += 1;
        eight.depth[count..].fill(0.0);
        if eight.has_friction {
            eight.carry(simd, approach, poses, since);
        }
        eight.push::<S, FIRST>(simd, poses, touching, losses);
        if !FIRST {
            self.found.keep(self.found.in_use - 1, pairs);
        }
    }

    /// Tells the lists what was found in a lane, and finds the spring that was there.
    #[inline(always)]
    fn settle_lane(&mut self, lane: usize, pairs: &mut [Pair], points: &mut [Point]) {
        let Found { eights, in_use, touching, number, approach, .. } = &mut *self.found;
        let eight = &mut eights[*in_use];
        let of_list = touching[eight.touching[lane] as usize].pair as usize;
        let (pair, point) = (&mut pairs[of_list], &mut points[eight.point[lane] as usize]);
        let (travel, way) = (self.waiting.travel[lane], self.waiting.way[lane]);
        approach.known[lane] = 0.0;
        if eight.depth[lane] > 0.0 {
            point.quiet = 0.0;
            number[of_list] = eight.touching[lane];
            if eight.friction[lane] > 0.0
                && let Some(stretch) = self.springs.take(&eight.spring(lane, pair))
            {
                eight.remember(lane, stretch);
                approach.known[lane] = 1.0;
            }
        } else {
            point.quiet = travel - eight.depth[lane];
            eight.depth[lane] = 0.0;
        }
        // of a mesh the whole pair tells
        if !pair.is_at_mesh() {
            pair.quiet = pair.quiet.min(point.quiet);
        }
        if way > pair.limit && travel + way > point.quiet {
            self.found.warn(TooFast::of(self.moment.model, of_list, pair, point, way));
        }
    }
}

impl TooFast {
    /// A pair of the list, with one of its points, one body of which may come so far against the other in a step (m).
    #[cold]
    fn of(model: &Model, number: usize, pair: &Pair, point: &Point, way: f64) -> Self {
        let (body, other) = match pair.kind {
            ContactKind::SecondInFirst => (pair.second, pair.first),
            _ => (pair.first, pair.second),
        };
        let particle = model.bodies[body as usize].shape.particles().index_in(point.particle);
        Self { pair: number as u32, body, particle, other, way, limit: pair.limit }
    }
}
