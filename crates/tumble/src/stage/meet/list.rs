//! The lists of what may touch soon, made anew when a body has come too far.
//!
//! Every body has a skin. Pairs of bodies, and particles of theirs, are listed when they are nearer to each other than their
//! skins together, and the lists hold until a body has travelled its skin: nothing that touches can be missing. Within that time,
//! a pair or particle that was found to be a distance away is quiet until both bodies have travelled that far together.

use glam::DVec3;

use super::grid::{Ball, Grid};
use super::mesh::{Known, NO_PATCH, View};
use super::pose::Pose;
use crate::parallel::{self, CHUNK};
use crate::state::{PairOrder, pair_order};
use crate::{BodyModel, ContactKind, ContactLaw, Model, Surface};

/// The skin of a body as a part of the radius of its spheres, or of what stands for it.
const SKIN: f64 = 0.2;
/// The radius that stands for that of spheres, as a part of the extent of a body without.
const GRAIN: f64 = 0.1;

/// Two bodies, or a body and a wall, that may touch soon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub first: u32,
    pub second: u32,
    pub kind: ContactKind,
    /// Its points, as a range of those of the chunk.
    pub start: u32,
    pub end: u32,
    /// What is known of the particles and the mesh, by number.
    pub listing: u32,
    /// No contact until both bodies have travelled so far together (m).
    pub quiet: f64,
    /// How far apart two particles touch, or a particle and a mesh or wall (m).
    pub reach: f64,
    /// How much farther apart they are looked for (m).
    pub margin: f64,
    /// How far one may come against the other in a step without passing through it (m).
    pub limit: f64,
    /// The radii of the spheres that touch, of the first body and of the second; 0 where it is none (m).
    pub radii: [f64; 2],
    pub law: ContactLaw,
    /// Whether one of the bodies has a surface that moves along itself.
    pub has_belt: bool,
}

impl Pair {
    /// Whether it is of particles and a mesh.
    pub fn is_at_mesh(&self) -> bool {
        matches!(self.kind, ContactKind::FirstInSecond | ContactKind::SecondInFirst)
    }

    /// The second body; of a wall a number that no body has.
    #[inline(always)]
    pub fn second_body(&self) -> u32 {
        if self.kind == ContactKind::Wall { u32::MAX } else { self.second }
    }
}

/// Two particles, or a particle and a mesh or wall, that may touch soon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Which particle, by slot.
    pub particle: u32,
    /// Which particle of the other body, by slot; of a mesh, which patch of it is known.
    pub other: u32,
    /// No contact until both bodies have travelled so far together (m); of a mesh, until then on the clock of the pair.
    pub quiet: f64,
}

/// What the bodies of one chunk, as first bodies, may touch.
#[derive(Clone, Debug, Default)]
pub(super) struct Near {
    pub pairs: Vec<Pair>,
    pub points: Vec<Point>,
    /// The last chunk that the second body of a pair is in, or its own.
    pub until: usize,
    pub known: Known,
    /// Those of the list before.
    old_pairs: Vec<Pair>,
    old_points: Vec<Point>,
    old_known: Known,
    /// Room for slots of particles.
    slots: [Vec<u32>; 2],
}

/// All lists.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    /// One entry a chunk of bodies.
    pub chunks: Vec<Near>,
    /// Where each body is the second of a pair: chunk and number of the pair, in the order of first bodies.
    pub seconds: Vec<(u32, u32)>,
    /// Where the entries of each body begin in `seconds`, and an end.
    pub starts: Vec<u32>,
    grid: Grid,
    balls: Vec<Ball>,
}

/// How far a body may travel before the lists are made anew (m): at least the way of two steps, so that what one step could
/// jump over is listed.
fn skin(body: &BodyModel, pose: &Pose) -> f64 {
    (SKIN * grain(body)).max(2.0 * pose.way)
}

/// The size of the smallest features of a body that matter (m).
pub(super) fn grain(body: &BodyModel) -> f64 {
    match body.surface {
        Surface::Spheres { radius } => radius,
        _ => GRAIN * body.extent,
    }
}

/// The radius of the spheres of a body; 0 where it has none (m).
pub(super) fn radius(body: &BodyModel) -> f64 {
    if let Surface::Spheres { radius } = body.surface { radius } else { 0.0 }
}

impl Lists {
    /// Makes all lists for bodies at `poses`. What the old ones know of particles and meshes goes on.
    pub fn make(&mut self, model: &Model, poses: &mut [Pose]) {
        let bodies = &model.bodies;
        self.balls.clear();
        for (body, pose) in bodies.iter().zip(&mut *poses) {
            pose.skin = skin(body, pose);
            pose.until = pose.travel + pose.skin;
            let reach = body.extent + pose.skin;
            self.balls.push(Ball { centre: pose.position, reach, active: body.is_free() });
        }
        let (pairs, poses) = (self.grid.pairs(&self.balls), &*poses);
        self.chunks.resize_with(bodies.len().div_ceil(CHUNK), Near::default);
        parallel::each(&mut self.chunks, |index, near| {
            std::mem::swap(&mut near.pairs, &mut near.old_pairs);
            std::mem::swap(&mut near.points, &mut near.old_points);
            std::mem::swap(&mut near.known, &mut near.old_known);
            near.pairs.clear();
            near.points.clear();
            near.known.clear();
            let first = (index * CHUNK) as u32;
            let until = (first + CHUNK as u32).min(bodies.len() as u32);
            let mut pairs = &pairs[pairs.partition_point(|pair| pair[0] < first)..];
            for first in first..until {
                near.list_walls(model, poses, first);
                let count = pairs.iter().take_while(|pair| pair[0] == first).count();
                for &[_, second] in &pairs[..count] {
                    near.list_bodies(model, poses, first, second);
                }
                pairs = &pairs[count..];
            }
            let bodies = near.pairs.iter().filter(|pair| pair.kind != ContactKind::Wall);
            let seconds = bodies.map(|pair| pair.second as usize / CHUNK);
            near.until = seconds.max().unwrap_or(index).max(index);
        });
        self.turn_round(bodies.len());
    }

    /// Fills `seconds` and `starts`.
    fn turn_round(&mut self, body_count: usize) {
        self.starts.clear();
        self.starts.resize(body_count + 1, 0);
        let pairs = || {
            self.chunks.iter().enumerate().flat_map(|(chunk, near)| {
                let bodies = |pair: &&Pair| pair.kind != ContactKind::Wall;
                let pairs = near.pairs.iter().enumerate();
                pairs
                    .filter(move |(_, pair)| bodies(pair))
                    .map(move |(number, pair)| (chunk, number, pair.second))
            })
        };
        for (_, _, second) in pairs() {
            self.starts[second as usize + 1] += 1;
        }
        for body in 0..body_count {
            self.starts[body + 1] += self.starts[body];
        }
        let mut next = self.starts.clone();
        let mut seconds = std::mem::take(&mut self.seconds);
        seconds.resize(self.starts[body_count] as usize, (0, 0));
        for (chunk, number, second) in pairs() {
            let at = &mut next[second as usize];
            seconds[*at as usize] = (chunk as u32, number as u32);
            *at += 1;
        }
        self.seconds = seconds;
    }
}

impl Near {
    /// Spheres of a body and the walls; particles without spheres meet walls in [`crate::stage::contact`].
    fn list_walls(&mut self, model: &Model, poses: &[Pose], first: u32) {
        let (body, pose) = (&model.bodies[first as usize], &poses[first as usize]);
        let Surface::Spheres { radius } = body.surface else { return };
        if !body.is_free() {
            return;
        }
        for (number, (wall, law)) in model.walls.iter().zip(&body.contacts).enumerate() {
            if wall.depth(pose.position) < -(body.extent + pose.skin) {
                continue;
            }
            let start = self.points.len() as u32;
            for slot in 0..body.shape.particles().len() as u32 {
                if wall.depth(pose.place(body, slot)) > -(radius + pose.skin) {
                    self.points.push(Point { particle: slot, other: 0, quiet: 0.0 });
                }
            }
            let pair = Pair {
                first,
                second: number as u32,
                kind: ContactKind::Wall,
                start,
                end: 0,
                listing: 0,
                quiet: 0.0,
                reach: radius,
                margin: pose.skin,
                limit: f64::INFINITY,
                radii: [radius, 0.0],
                law: *law,
                has_belt: false,
            };
            self.add(pair);
        }
    }

    /// Two bodies, in each way that they can touch.
    fn list_bodies(&mut self, model: &Model, poses: &[Pose], first: u32, second: u32) {
        let at =
            |index: u32| Side { body: &model.bodies[index as usize], pose: &poses[index as usize] };
        let (a, b) = (at(first), at(second));
        for &kind in kinds(a.body, b.body) {
            let (start, key) = (self.points.len() as u32, pair_order(first, second, kind));
            let mut listing = 0;
            match kind {
                ContactKind::Wall => {}
                ContactKind::Spheres => self.list_spheres(a, b),
                ContactKind::FirstInSecond => listing = self.list_particles(a, b, key),
                ContactKind::SecondInFirst => listing = self.list_particles(b, a, key),
            }
            let (law, reach) = (law(a.body, b.body, kind), reach(a.body, b.body, kind));
            // a mesh is asked farther out, so that it need not be asked again so soon
            let margin = (a.pose.skin + b.pose.skin).max(2.0 * grain(a.body).min(grain(b.body)));
            let limit = limit(a.body, b.body, kind);
            let radii = match kind {
                ContactKind::Spheres => [radius(a.body), radius(b.body)],
                ContactKind::SecondInFirst => [0.0, reach],
                ContactKind::Wall | ContactKind::FirstInSecond => [reach, 0.0],
            };
            let has_belt = [a, b].iter().any(|side| side.pose.belt != DVec3::ZERO);
            self.add(Pair {
                first,
                second,
                kind,
                start,
                end: 0,
                listing,
                quiet: 0.0,
                reach,
                margin,
                limit,
                radii,
                law,
                has_belt,
            });
        }
    }

    /// Keeps a pair if it has points.
    fn add(&mut self, pair: Pair) {
        let end = self.points.len() as u32;
        if end > pair.start {
            self.pairs.push(Pair { end, ..pair });
        }
    }

    /// Spheres of two bodies that are near each other.
    fn list_spheres(&mut self, a: Side, b: Side) {
        let margin = a.pose.skin + b.pose.skin;
        let reach = radius(a.body) + radius(b.body);
        let travel = a.pose.travel + b.pose.travel;
        let [mut ours, mut theirs] = std::mem::take(&mut self.slots);
        a.list_near(b, reach + margin, &mut ours);
        b.list_near(a, reach + margin, &mut theirs);
        for &particle in &ours {
            let place = a.pose.place(a.body, particle);
            for &other in &theirs {
                let gap = place.distance(b.pose.place(b.body, other)) - reach;
                if gap < margin {
                    self.points.push(Point { particle, other, quiet: travel + gap });
                }
            }
        }
        self.slots = [ours, theirs];
    }

    /// Particles of `a` that are near the mesh of `b`: by leaves of the tree, since what is known of each particle from the
    /// list before is worth more than a look at it now. Returns the number of the listing.
    fn list_particles(&mut self, a: Side, b: Side, key: PairOrder) -> u32 {
        let Some(solid) = &b.body.solid else { return 0 };
        let (margin, reach) = (a.pose.skin + b.pose.skin, radius(a.body));
        let old = points_of(&self.old_pairs, &self.old_points, key);
        let view = View::of(a.body, a.pose, b.pose);
        let Some(margin) = self.known.list(&self.old_known, key, &view, margin) else {
            for point in old {
                self.points.push(self.known.carry(&self.old_known, point));
            }
            return self.known.finish(0);
        };
        let [mut slots, other] = std::mem::take(&mut self.slots);
        slots.clear();
        let mut hint = 0;
        let may_touch = |centre, radius| {
            let centre = view.way + view.turn * centre;
            !solid.outside_ball_near(centre, radius + reach + margin, &mut hint)
        };
        a.body.shape.particles().list_where(may_touch, &mut slots);
        let mut old = old.iter().peekable();
        for &particle in &slots {
            while old.next_if(|point| point.particle < particle).is_some() {}
            let point = match old.next_if(|point| point.particle == particle) {
                Some(point) => self.known.carry(&self.old_known, point),
                // who is not known is looked at soon
                None => Point { particle, other: NO_PATCH, quiet: 0.0 },
            };
            self.points.push(point);
        }
        let count = slots.len();
        self.slots = [slots, other];
        self.known.finish(count)
    }
}

/// The points of a pair in a list.
fn points_of<'a>(pairs: &[Pair], points: &'a [Point], key: PairOrder) -> &'a [Point] {
    let of_pair = |pair: &Pair| pair_order(pair.first, pair.second, pair.kind);
    match pairs.binary_search_by_key(&key, of_pair) {
        Ok(found) => &points[pairs[found].start as usize..pairs[found].end as usize],
        Err(_) => &[],
    }
}

/// A body where it is.
#[derive(Clone, Copy)]
struct Side<'a> {
    body: &'a BodyModel,
    pose: &'a Pose,
}

impl Side<'_> {
    /// The particles within `distance` (m) of the ball about the particles of another body, by slot in their order.
    fn list_near(&self, other: Side, distance: f64, slots: &mut Vec<u32>) {
        slots.clear();
        let place = self.pose.rotation.transpose() * (other.pose.position - self.pose.position);
        let reach = other.body.shape.radius() + distance;
        let particles = self.body.shape.particles();
        let near = |at: DVec3, reach: f64| at.distance_squared(place) <= reach * reach;
        particles.list_where(|centre, radius| near(centre, radius + reach), slots);
        slots.retain(|&slot| near(particles.at(slot), reach));
    }
}

/// Whether two bodies can touch in this way.
pub(crate) fn can_touch(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> bool {
    (first.is_free() || second.is_free()) && kinds(first, second).contains(&kind)
}

/// The ways in which two bodies can touch.
fn kinds(first: &BodyModel, second: &BodyModel) -> &'static [ContactKind] {
    use ContactKind::{FirstInSecond, SecondInFirst, Spheres};
    match (first.surface, second.surface) {
        (Surface::None, Surface::None) => &[],
        (Surface::Mesh, Surface::Mesh) => &[FirstInSecond, SecondInFirst],
        (Surface::Mesh, _) => &[SecondInFirst],
        (_, Surface::Mesh) => &[FirstInSecond],
        _ => &[Spheres],
    }
}

/// The law of one kind of contact between two bodies.
pub(super) fn law(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> ContactLaw {
    // of two particles, that of the body with more of them shares its mass with the others
    let many = |body: &BodyModel| body.pair_material.share;
    let turned = kind == ContactKind::Spheres && many(second) > many(first);
    if turned || kind == ContactKind::SecondInFirst {
        second.pair_material.law(&first.pair_material)
    } else {
        first.pair_material.law(&second.pair_material)
    }
}

/// How far apart particles of these bodies touch, or particles and a mesh (m).
fn reach(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> f64 {
    match kind {
        ContactKind::Wall | ContactKind::FirstInSecond => radius(first),
        ContactKind::SecondInFirst => radius(second),
        ContactKind::Spheres => radius(first) + radius(second),
    }
}

/// How far one body may come against the other in a step (m): half of what it would have to pass through.
fn limit(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> f64 {
    let thickness = |body: &BodyModel| body.solid.as_ref().map_or(0.0, |solid| solid.thickness());
    match kind {
        ContactKind::Wall => f64::INFINITY,
        ContactKind::Spheres => radius(first) + radius(second),
        ContactKind::FirstInSecond => radius(first) + 0.5 * thickness(second),
        ContactKind::SecondInFirst => radius(second) + 0.5 * thickness(first),
    }
}
