//! Which of the listed points touch, and the springs they had.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;

use super::contact::{Contact, Mount, PairForces, Touch};
use super::list::{self, Near, Pair, Point};
use super::mesh::{BLOCK, Known, Look, View};
use super::pose::Pose;
use crate::parallel::CHUNK;
use crate::state::pair_order;
use crate::{BodyModel, ContactKind, Model, PairSpring};

/// The contacts of the bodies of one chunk, as first bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    /// The contacts, pair by pair.
    pub contacts: Vec<Contact>,
    /// The pairs that have contacts.
    pub touching: Vec<Touching>,
    /// For each pair of the list, which of `touching` it is, or `NONE`.
    pub number: Vec<u32>,
    /// Energy (J) of springs that have come loose, by first body.
    pub released: Vec<f64>,
    /// The springs that go on.
    pub springs: Vec<PairSpring>,
    /// The first pair that is so fast that one could pass through the other in a step.
    pub too_fast: Option<TooFast>,
}

/// Two bodies that could pass through each other in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TooFast {
    /// The body whose particle it is.
    pub body: u32,
    /// Which particle.
    pub particle: u32,
    /// The other body.
    pub other: u32,
    /// How far it comes in a step (m).
    pub way: f64,
    /// How far it may come (m).
    pub limit: f64,
}

/// A pair that has no contact.
pub(super) const NONE: u32 = u32::MAX;

/// A pair of bodies in contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touching {
    /// Which pair of the list.
    pub pair: u32,
    pub first: u32,
    /// Its contacts, as a range of those of the chunk.
    pub start: u32,
    pub end: u32,
    /// What they do.
    pub forces: PairForces,
}

impl Touching {
    /// Its contacts, of those of the chunk.
    pub fn range(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// The points of a pair, with what is known of the meshes near them.
struct Listed<'a> {
    points: &'a mut [Point],
    known: &'a mut Known,
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
    /// Finds the contacts among the listed points of a chunk whose first body is number `body`.
    #[inline(always)]
    pub fn find(&mut self, near: &mut Near, moment: &Moment, body: usize) {
        self.contacts.clear();
        self.touching.clear();
        self.number.clear();
        self.number.resize(near.pairs.len(), NONE);
        self.too_fast = None;
        let mut springs = OldSprings::of_chunk(moment, body, std::mem::take(&mut self.released));
        for (number, pair) in near.pairs.iter_mut().enumerate() {
            let sides = Sides::of(moment, pair);
            if sides.travel() < pair.quiet && sides.way(pair) <= pair.limit {
                continue;
            }
            let start = self.contacts.len();
            let points = &mut near.points[pair.start as usize..pair.end as usize];
            pair.quiet = match pair.kind {
                ContactKind::Wall | ContactKind::Spheres => {
                    self.find_pair(pair, points, &sides, &mut springs)
                }
                ContactKind::FirstInSecond | ContactKind::SecondInFirst => {
                    let listed = Listed { points, known: &mut near.known };
                    self.find_at_mesh(pair, listed, &sides, &mut springs)
                }
            };
            if self.contacts.len() > start {
                self.number[number] = self.touching.len() as u32;
                self.touching.push(Touching {
                    pair: number as u32,
                    first: pair.first,
                    start: start as u32,
                    end: self.contacts.len() as u32,
                    forces: PairForces::default(),
                });
            }
        }
        springs.release_all();
        self.released = springs.released;
    }

    /// Finds the contacts of a pair; returns until when it is quiet (m of travel).
    #[inline(always)]
    fn find_pair(
        &mut self,
        pair: &Pair,
        points: &mut [Point],
        sides: &Sides,
        springs: &mut OldSprings,
    ) -> f64 {
        let (travel, way) = (sides.travel(), sides.way(pair));
        // what the lists remember is no reason to refuse a step: it is looked at anew
        let passes = |quiet: f64| way > pair.limit && travel + way > quiet;
        let mut quiet = f64::INFINITY;
        for point in points {
            if travel >= point.quiet || passes(point.quiet) {
                match sides.touch(pair, point) {
                    Ok(touch) => {
                        point.quiet = 0.0;
                        self.contacts.push(sides.contact(pair, point, touch, springs));
                    }
                    Err(gap) => point.quiet = travel + gap,
                }
                if passes(point.quiet) && self.too_fast.is_none() {
                    self.too_fast = Some(too_fast(sides.model, pair, point, way));
                }
            }
            quiet = quiet.min(point.quiet);
        }
        quiet
    }

    /// Finds the contacts of particles and a mesh; returns until when the pair is quiet (m of travel).
    #[inline(always)]
    fn find_at_mesh(
        &mut self,
        pair: &Pair,
        listed: Listed,
        sides: &Sides,
        springs: &mut OldSprings,
    ) -> f64 {
        let Listed { points, known } = listed;
        let (travel, way, exact) = (sides.travel(), sides.way(pair), sides.way(pair) > pair.limit);
        let (clock, until) = known.time(pair.listing, &sides.view(pair), travel);
        if clock < until && !exact {
            return travel + (until - clock);
        }
        // what the lists remember is no reason to refuse a step: it is looked at anew
        let passes = |quiet: f64| exact && clock + way > quiet;
        let mut look = Look { pair, known, exact };
        let mut quiet = f64::INFINITY;
        for (number, block) in points.chunks_mut(BLOCK).enumerate() {
            let mut of_block = *look.known.of_block(pair.listing, number);
            if clock >= of_block || exact {
                of_block = f64::INFINITY;
                for point in block {
                    if clock >= point.quiet || passes(point.quiet) {
                        match sides.touch_mesh(&mut look, point) {
                            Ok(touch) => {
                                point.quiet = 0.0;
                                self.contacts.push(sides.contact(pair, point, touch, springs));
                            }
                            Err(gap) => point.quiet = clock + gap,
                        }
                        if passes(point.quiet) && self.too_fast.is_none() {
                            self.too_fast = Some(too_fast(sides.model, pair, point, way));
                        }
                    }
                    of_block = of_block.min(point.quiet);
                }
                *look.known.of_block(pair.listing, number) = of_block;
            }
            quiet = quiet.min(of_block);
        }
        *look.known.of_pair(pair.listing) = quiet;
        travel + (quiet - clock)
    }

    /// The forces of all contacts with the velocities of `poses`; of a first look the totals alone.
    #[inline(always)]
    pub fn push<const FIRST: bool>(&mut self, near: &Near, poses: &[Pose]) {
        for touching in &mut self.touching {
            let pair = &near.pairs[touching.pair as usize];
            let (first, second) = ends(poses, pair);
            touching.forces = PairForces::default();
            for contact in &mut self.contacts[touching.range()] {
                contact.push::<FIRST>(&pair.law, first, second, &mut touching.forces);
            }
        }
    }

    /// Energy in the springs (J).
    pub fn elastic_energy(&self, near: &Near) -> f64 {
        let of_pair = |touching: &Touching| {
            let law = &near.pairs[touching.pair as usize].law;
            let contacts = &self.contacts[touching.range()];
            let stored = |contact: &Contact| {
                contact.weight
                    * (law.stiffness * contact.touch.depth * contact.touch.depth
                        + law.friction_spring * contact.stretch.length_squared())
            };
            0.5 * contacts.iter().map(stored).sum::<f64>()
        };
        // springs that have come loose are released at the next kick
        self.touching.iter().map(of_pair).sum::<f64>() + self.released.iter().sum::<f64>()
    }

    /// The springs that go on after the latest push.
    pub fn keep(&mut self, near: &Near, model: &Model) {
        self.springs.clear();
        for touching in &self.touching {
            let pair = &near.pairs[touching.pair as usize];
            if pair.law.friction == 0.0 {
                continue;
            }
            for contact in &self.contacts[touching.range()] {
                self.springs.push(spring(model, pair, contact));
            }
        }
    }
}

/// A pair that is too fast, with one of its points.
fn too_fast(model: &Model, pair: &Pair, point: &Point, way: f64) -> TooFast {
    let (body, other) = match pair.kind {
        ContactKind::SecondInFirst => (pair.second, pair.first),
        _ => (pair.first, pair.second),
    };
    let particle = model.bodies[body as usize].shape.particles().index_in(point.particle);
    TooFast { body, particle, other, way, limit: pair.limit }
}

/// The spring of a contact.
fn spring(model: &Model, pair: &Pair, contact: &Contact) -> PairSpring {
    let index = |body: u32, slot| model.bodies[body as usize].shape.particles().index_in(slot);
    let Pair { first, second, kind, .. } = *pair;
    let (particle, other) = match kind {
        ContactKind::Spheres => (index(first, contact.particle), index(second, contact.other)),
        ContactKind::SecondInFirst => (index(second, contact.particle), 0),
        ContactKind::Wall | ContactKind::FirstInSecond => (index(first, contact.particle), 0),
    };
    PairSpring { first, second, kind, particle, other, stretch: contact.stretch * contact.held }
}

/// What stands for a wall as second body.
static STILL: std::sync::LazyLock<Pose> = std::sync::LazyLock::new(Pose::default);

/// The bodies of a pair.
fn ends<'a>(poses: &'a [Pose], pair: &Pair) -> (&'a Pose, &'a Pose) {
    let second = if pair.kind == ContactKind::Wall { &STILL } else { &poses[pair.second as usize] };
    (&poses[pair.first as usize], second)
}

/// Two bodies where they are.
struct Sides<'a> {
    model: &'a Model,
    first: &'a Pose,
    second: &'a Pose,
    /// Time since the latest kick (s).
    since: f64,
}

impl<'a> Sides<'a> {
    fn of(moment: &Moment<'a>, pair: &Pair) -> Self {
        let (first, second) = ends(moment.poses, pair);
        Self { model: moment.model, first, second, since: moment.since }
    }

    /// How far the one can come against the other in a step (m), at most.
    fn way(&self, pair: &Pair) -> f64 {
        let Self { model, first, second, .. } = self;
        let most = first.way + second.way;
        if most <= pair.limit {
            return most;
        }
        // what both have in common does not count
        let rim = |pose: &Pose, body: u32| {
            pose.angular_velocity.length() * model.bodies[body as usize].extent
        };
        let turning = rim(first, pair.first) + rim(second, pair.second);
        model.dt * ((first.velocity - second.velocity).length() + turning)
    }

    fn travel(&self) -> f64 {
        self.first.travel + self.second.travel
    }

    /// The contact of a listed point, or how far it is from one (m).
    #[inline(always)]
    fn touch(&self, pair: &Pair, point: &Point) -> Result<Touch, f64> {
        let (model, p, q) = (self.model, self.first, self.second);
        let a = &model.bodies[pair.first as usize];
        let (at, normal, depth) = match pair.kind {
            ContactKind::Wall => {
                let wall = &model.walls[pair.second as usize];
                let place = p.place(a, point.particle);
                let depth = pair.reach + wall.depth(place);
                (place - wall.normal * pair.reach, wall.normal, depth)
            }
            ContactKind::Spheres => {
                let b = &model.bodies[pair.second as usize];
                let place = p.place(a, point.particle);
                let apart = place - q.place(b, point.other);
                let distance = apart.length_squared().sqrt();
                let depth = pair.reach - distance;
                if depth <= 0.0 {
                    return Err(-depth);
                }
                // centres at one place are pushed apart as their bodies are, or upwards
                let normal = if distance > 0.0 {
                    apart / distance
                } else {
                    (p.position - q.position).try_normalize().unwrap_or(DVec3::Y)
                };
                (place - normal * (list::radius(a) - 0.5 * depth), normal, depth)
            }
            // see `touch_mesh`
            ContactKind::FirstInSecond | ContactKind::SecondInFirst => return Err(0.0),
        };
        if depth <= 0.0 {
            return Err(-depth);
        }
        Ok(Touch { normal, depth, arm: at - p.position, other_arm: at - q.position })
    }

    /// The contact of a particle with a mesh, or how far it is from one (m), or less.
    #[inline(always)]
    fn touch_mesh(&self, look: &mut Look, point: &mut Point) -> Result<Touch, f64> {
        let [particles, mesh] = self.at_mesh(look.pair);
        let (at, out, depth) = look.touch_mesh(point, particles, mesh)?;
        let normal = if look.pair.kind == ContactKind::SecondInFirst { -out } else { out };
        let (arm, other_arm) = (at - self.first.position, at - self.second.position);
        Ok(Touch { normal, depth, arm, other_arm })
    }

    /// How the particles that may touch a mesh lie in its frame.
    fn view(&self, pair: &Pair) -> View {
        let [(body, pose), (_, other)] = self.at_mesh(pair);
        View::of(body, pose, other)
    }

    /// The body whose particles may touch a mesh, and that of the mesh.
    #[inline(always)]
    fn at_mesh(&self, pair: &Pair) -> [(&BodyModel, &Pose); 2] {
        let first = (&self.model.bodies[pair.first as usize], self.first);
        let second = (&self.model.bodies[pair.second as usize], self.second);
        if pair.kind == ContactKind::SecondInFirst { [second, first] } else { [first, second] }
    }

    /// The contact of a point that touches, with the spring that it had.
    #[inline(always)]
    fn contact(
        &self,
        pair: &Pair,
        point: &Point,
        touch: Touch,
        springs: &mut OldSprings,
    ) -> Contact {
        let other = if pair.kind == ContactKind::Spheres { point.other } else { 0 };
        let mut contact = Contact {
            touch,
            before: DVec3::ZERO,
            stretch: DVec3::ZERO,
            held: 0.0,
            weight: self.weight(pair, point),
            particle: point.particle,
            other,
        };
        // a new spring is held where it is found
        if pair.law.friction > 0.0
            && let Some(stretch) = springs.take(pair, &contact)
        {
            contact.before = stretch;
            let mount = self.mount(pair, touch.depth);
            contact.carry(&mount, self.first, self.second, self.since);
        }
        contact
    }

    /// The weight of the particle that touches.
    fn weight(&self, pair: &Pair, point: &Point) -> f64 {
        let body = match pair.kind {
            ContactKind::Spheres | ContactKind::Wall => return 1.0,
            ContactKind::FirstInSecond => pair.first,
            ContactKind::SecondInFirst => pair.second,
        };
        let particles = self.model.bodies[body as usize].shape.particles();
        if particles.is_weighted() {
            particles.weight(particles.index_in(point.particle) as usize)
        } else {
            1.0
        }
    }

    /// How the point of a contact is fixed to the bodies.
    fn mount(&self, pair: &Pair, depth: f64) -> Mount {
        let radius = |body: u32| list::radius(&self.model.bodies[body as usize]) - 0.5 * depth;
        let (offset, other_offset) = match pair.kind {
            ContactKind::Wall | ContactKind::FirstInSecond => (pair.reach, 0.0),
            ContactKind::SecondInFirst => (0.0, pair.reach),
            ContactKind::Spheres => (radius(pair.first), radius(pair.second)),
        };
        Mount { kind: pair.kind, offset, other_offset }
    }
}

/// The springs of the latest kick, taken in their order.
struct OldSprings<'a> {
    model: &'a Model,
    old: &'a [PairSpring],
    /// Energy (J) of those that have come loose, by body of the chunk.
    released: Vec<f64>,
    body: usize,
}

impl<'a> OldSprings<'a> {
    /// Those of the chunk whose first body is number `body`, none released; `released` is room.
    fn of_chunk(moment: &Moment<'a>, body: usize, mut released: Vec<f64>) -> Self {
        let before = |end: usize| moment.springs.partition_point(|s| (s.first as usize) < end);
        released.clear();
        released.resize(CHUNK, 0.0);
        let old = &moment.springs[before(body)..before(body + CHUNK)];
        Self { model: moment.model, old, released, body }
    }

    /// The stretch that a contact had at the latest kick; springs that come before it are released.
    fn take(&mut self, pair: &Pair, contact: &Contact) -> Option<DVec3> {
        while let Some((spring, rest)) = self.old.split_first() {
            match self.compare(spring, pair, contact) {
                Ordering::Less => self.release(spring),
                Ordering::Equal => {
                    self.old = rest;
                    return Some(spring.stretch);
                }
                Ordering::Greater => break,
            }
            self.old = rest;
        }
        None
    }

    fn release_all(&mut self) {
        for spring in self.old {
            self.release(spring);
        }
    }

    fn compare(&self, spring: &PairSpring, pair: &Pair, contact: &Contact) -> Ordering {
        let of_spring = pair_order(spring.first, spring.second, spring.kind);
        of_spring.cmp(&pair_order(pair.first, pair.second, pair.kind)).then_with(|| {
            let (particle, other) = slots(self.model, spring);
            (particle, other).cmp(&(contact.particle, contact.other))
        })
    }

    /// What is left in a spring is lost.
    fn release(&mut self, spring: &PairSpring) {
        let stiffness = friction_spring(self.model, spring);
        let lost = 0.5 * stiffness * spring.stretch.length_squared();
        self.released[spring.first as usize - self.body] += lost;
    }
}

/// Where the shapes keep the particles of a spring.
fn slots(model: &Model, spring: &PairSpring) -> (u32, u32) {
    let slot = |body: u32, index| model.bodies[body as usize].shape.particles().slot_of(index);
    match spring.kind {
        ContactKind::Spheres => {
            (slot(spring.first, spring.particle), slot(spring.second, spring.other))
        }
        ContactKind::SecondInFirst => (slot(spring.second, spring.particle), 0),
        ContactKind::Wall | ContactKind::FirstInSecond => (slot(spring.first, spring.particle), 0),
    }
}

/// k_t of a spring (N/m), with the weight of its particle.
fn friction_spring(model: &Model, spring: &PairSpring) -> f64 {
    let first = &model.bodies[spring.first as usize];
    if spring.kind == ContactKind::Wall {
        return first.contacts[spring.second as usize].friction_spring;
    }
    let second = &model.bodies[spring.second as usize];
    let weight = |body: &BodyModel| body.shape.particles().weight(spring.particle as usize);
    let weight = match spring.kind {
        ContactKind::FirstInSecond => weight(first),
        ContactKind::SecondInFirst => weight(second),
        ContactKind::Wall | ContactKind::Spheres => 1.0,
    };
    weight * list::law(first, second, spring.kind).friction_spring
}
