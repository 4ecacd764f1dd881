//! Neighbour lists: pairs of bodies, and points of theirs, that may touch soon.
//!
//! Every body has a skin. Pairs and points are listed when their distance is below the skins of both bodies together, and the
//! lists hold until a body has moved by its skin, so no contact can be missing (L. Verlet, Phys. Rev. 159 (1967) 98). Within that
//! time, a pair or point that was found at a distance is skipped until both bodies have moved by that distance together.

use glam::DVec3;

use super::broad_phase::{Ball, Grid};
use super::mesh_cache::{MeshCache, NO_PATCH, RelativePose};
use super::pair::{
    ListedContact, Pair, contact_distance, contact_kinds, contact_law, feature_size, sphere_radius,
    tunnelling_limit,
};
use super::pose::BodyPose;
use crate::parallel::{self, CHUNK};
use crate::state::PairOrder;
use crate::{BodyModel, ContactKind, Integrator, Model};

/// The skin of a body as a part of its feature size.
const SKIN: f64 = 0.2;

/// The neighbours of the bodies of one chunk, as first bodies of pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct ChunkNeighbours {
    pub pairs: Vec<Pair>,
    pub points: Vec<ListedContact>,
    /// The last chunk that holds a second body of these pairs, at least this chunk.
    pub last_chunk: usize,
    pub mesh_cache: MeshCache,
    /// Pairs, points and cache of the list before.
    old_pairs: Vec<Pair>,
    old_points: Vec<ListedContact>,
    old_mesh_cache: MeshCache,
    /// Buffers for slots of particles.
    slots: [Vec<u32>; 2],
}

/// The neighbour lists of all bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct NeighbourLists {
    /// One entry per chunk of bodies.
    pub chunks: Vec<ChunkNeighbours>,
    /// For each body as second body of pairs: chunk and index of the pair, in the order of first bodies.
    pub second_pairs: Vec<(u32, u32)>,
    /// Where the entries of each body start in `second_pairs`, and the end.
    pub second_starts: Vec<u32>,
    grid: Grid,
    balls: Vec<Ball>,
}

/// How far a body may move before the lists are rebuilt (m). It is at least the displacement in two steps, so that what
/// one step could jump over is listed.
fn skin(body: &BodyModel, pose: &BodyPose) -> f64 {
    (SKIN * feature_size(body)).max(2.0 * pose.step_displacement) + pose.reach
}

impl NeighbourLists {
    /// Builds all lists for bodies at `poses`. The caches of point–mesh pairs carry over.
    pub fn build(&mut self, model: &Model, poses: &mut [BodyPose]) {
        let bodies = &model.bodies;
        self.balls.clear();
        for (body, pose) in bodies.iter().zip(&mut *poses) {
            pose.skin = skin(body, pose);
            pose.list_valid_until = pose.path + pose.skin;
            let radius = body.extent + pose.skin;
            self.balls.push(Ball { centre: pose.position, radius, active: body.is_free() });
        }
        let (pairs, poses) = (self.grid.pairs(&self.balls), &*poses);
        self.chunks.resize_with(bodies.len().div_ceil(CHUNK), ChunkNeighbours::default);
        parallel::for_each(&mut self.chunks, |index, chunk| {
            chunk.begin();
            let first = (index * CHUNK) as u32;
            let end = (first + CHUNK as u32).min(bodies.len() as u32);
            let mut pairs = &pairs[pairs.partition_point(|pair| pair[0] < first)..];
            for first in first..end {
                chunk.add_walls(model, poses, first);
                let count = pairs.iter().take_while(|pair| pair[0] == first).count();
                for &[_, second] in &pairs[..count] {
                    if model.joints.keeps_apart(first, second) {
                        continue;
                    }
                    chunk.add_bodies(model, poses, first, second);
                }
                pairs = &pairs[count..];
            }
            let bodies = chunk.pairs.iter().filter(|pair| pair.kind != ContactKind::SphereWall);
            let second_chunks = bodies.map(|pair| pair.second as usize / CHUNK);
            chunk.last_chunk = second_chunks.max().unwrap_or(index).max(index);
        });
        self.index_second_bodies(bodies.len());
    }

    /// Fills `second_pairs` and `second_starts` by a counting sort.
    fn index_second_bodies(&mut self, body_count: usize) {
        self.second_starts.clear();
        self.second_starts.resize(body_count + 1, 0);
        let pairs = || {
            self.chunks.iter().enumerate().flat_map(|(chunk, neighbours)| {
                let is_body = |pair: &&Pair| pair.kind != ContactKind::SphereWall;
                let pairs = neighbours.pairs.iter().enumerate();
                pairs
                    .filter(move |(_, pair)| is_body(pair))
                    .map(move |(index, pair)| (chunk, index, pair.second))
            })
        };
        for (_, _, second) in pairs() {
            self.second_starts[second as usize + 1] += 1;
        }
        for body in 0..body_count {
            self.second_starts[body + 1] += self.second_starts[body];
        }
        let mut next = self.second_starts.clone();
        let mut second_pairs = std::mem::take(&mut self.second_pairs);
        second_pairs.resize(self.second_starts[body_count] as usize, (0, 0));
        for (chunk, index, second) in pairs() {
            let at = &mut next[second as usize];
            second_pairs[*at as usize] = (chunk as u32, index as u32);
            *at += 1;
        }
        self.second_pairs = second_pairs;
    }
}

impl ChunkNeighbours {
    /// Puts the lists aside and starts new ones.
    fn begin(&mut self) {
        std::mem::swap(&mut self.pairs, &mut self.old_pairs);
        std::mem::swap(&mut self.points, &mut self.old_points);
        std::mem::swap(&mut self.mesh_cache, &mut self.old_mesh_cache);
        self.pairs.clear();
        self.points.clear();
        self.mesh_cache.clear();
    }

    /// Adds the spheres of a body near walls. Particles without spheres meet walls in [`wall`](super::wall), except in the implicit
    /// solver.
    fn add_walls(&mut self, model: &Model, poses: &[BodyPose], first: u32) {
        let (body, pose) = (&model.bodies[first as usize], &poses[first as usize]);
        let is_listed = body.has_spheres() || model.integrator == Integrator::Implicit;
        if !body.is_free() || !is_listed {
            return;
        }
        let (radius, particles) = (sphere_radius(body), body.shape.particles());
        for (index, (wall, law)) in model.walls.iter().zip(&body.contacts).enumerate() {
            if wall.depth(pose.position) < -(body.extent + pose.skin) {
                continue;
            }
            let start = self.points.len() as u32;
            let [mut slots, other_slots] = std::mem::take(&mut self.slots);
            slots.clear();
            let is_near = |centre: DVec3, range: f64| {
                wall.depth(pose.position + pose.rotation * centre) > -(range + pose.skin)
            };
            particles
                .collect_slots_where(|centre, range| is_near(centre, range + radius), &mut slots);
            slots.retain(|&slot| is_near(particles.at(slot), radius));
            let point = |&particle| ListedContact { particle, other: 0, clear_until: 0.0 };
            self.points.extend(slots.iter().map(point));
            self.slots = [slots, other_slots];
            self.add_pair(Pair {
                first,
                second: index as u32,
                kind: ContactKind::SphereWall,
                start,
                end: 0,
                cache: 0,
                clear_until: 0.0,
                contact_distance: radius,
                search_margin: pose.skin,
                tunnelling_limit: f64::INFINITY,
                radii: [radius, 0.0],
                law: *law,
                has_surface_velocity: false,
            });
        }
    }

    /// Adds two bodies, once for each kind of contact that they can have.
    fn add_bodies(&mut self, model: &Model, poses: &[BodyPose], first: u32, second: u32) {
        let placed =
            |i: u32| PlacedBody { body: &model.bodies[i as usize], pose: &poses[i as usize] };
        let (a, b) = (placed(first), placed(second));
        for &kind in contact_kinds(a.body, b.body) {
            let start = self.points.len() as u32;
            let order = crate::state::pair_order(first, second, kind);
            let mut cache = 0;
            match kind {
                ContactKind::SphereWall => {}
                ContactKind::SphereSphere => self.add_sphere_points(a, b),
                ContactKind::PointMesh => cache = self.add_mesh_points(a, b, order),
                ContactKind::MeshPoint => cache = self.add_mesh_points(b, a, order),
            }
            let contact_distance = contact_distance(a.body, b.body, kind);
            // meshes are searched farther out, so that the next search is later
            let search_margin = (a.pose.skin + b.pose.skin)
                .max(2.0 * feature_size(a.body).min(feature_size(b.body)));
            let radii = match kind {
                ContactKind::SphereSphere => [sphere_radius(a.body), sphere_radius(b.body)],
                ContactKind::MeshPoint => [0.0, contact_distance],
                ContactKind::SphereWall | ContactKind::PointMesh => [contact_distance, 0.0],
            };
            let has_surface_velocity =
                [a, b].iter().any(|placed| placed.pose.surface_velocity != DVec3::ZERO);
            self.add_pair(Pair {
                first,
                second,
                kind,
                start,
                end: 0,
                cache,
                clear_until: 0.0,
                contact_distance,
                search_margin,
                tunnelling_limit: tunnelling_limit(a.body, b.body, kind),
                radii,
                law: contact_law(a.body, b.body, kind),
                has_surface_velocity,
            });
        }
    }

    /// Adds a pair whose points are the latest ones, if there are any.
    fn add_pair(&mut self, pair: Pair) {
        let end = self.points.len() as u32;
        if end > pair.start {
            self.pairs.push(Pair { end, ..pair });
        }
    }

    /// Adds the pairs of spheres of two bodies that are near each other.
    fn add_sphere_points(&mut self, a: PlacedBody, b: PlacedBody) {
        let margin = a.pose.skin + b.pose.skin;
        let contact_distance = sphere_radius(a.body) + sphere_radius(b.body);
        let path = a.pose.path + b.pose.path;
        let [mut slots_a, mut slots_b] = std::mem::take(&mut self.slots);
        a.list_near(b, contact_distance + margin, &mut slots_a);
        b.list_near(a, contact_distance + margin, &mut slots_b);
        for &particle in &slots_a {
            let position = a.pose.particle_position(a.body, particle);
            for &other in &slots_b {
                let distance = position.distance(b.pose.particle_position(b.body, other));
                let gap = distance - contact_distance;
                if gap < margin {
                    self.points.push(ListedContact { particle, other, clear_until: path + gap });
                }
            }
        }
        self.slots = [slots_a, slots_b];
    }

    /// Adds the particles of `a` that are near the mesh of `b`, leaf by leaf of the particle tree; returns the index of the
    /// pair's cache. Points of the list before keep what is known of them.
    fn add_mesh_points(&mut self, a: PlacedBody, b: PlacedBody, order: PairOrder) -> u32 {
        let Some(signed_distance) = &b.body.signed_distance else { return 0 };
        let (margin, contact_distance) = (a.pose.skin + b.pose.skin, sphere_radius(a.body));
        let old = points_of(&self.old_pairs, &self.old_points, order);
        let pose = RelativePose::new(a.body, a.pose, b.pose);
        let margin = self.mesh_cache.add_pair(&self.old_mesh_cache, order, &pose, margin);
        let Some(margin) = margin else {
            for point in old {
                self.points.push(self.mesh_cache.copy_point(&self.old_mesh_cache, point));
            }
            return self.mesh_cache.finish_pair(0);
        };
        let [mut slots, other_slots] = std::mem::take(&mut self.slots);
        slots.clear();
        let half_segment =
            a.body.contact_points.as_ref().map_or(0.0, |points| points.longest_half_segment());
        let mut hint = 0;
        let may_touch = |centre, radius| {
            let centre = pose.translation + pose.rotation * centre;
            !signed_distance.is_ball_outside_cached(
                centre,
                radius + half_segment + contact_distance + margin,
                &mut hint,
            )
        };
        a.body.points().collect_slots_where(may_touch, &mut slots);
        let mut old = old.iter().peekable();
        for &particle in &slots {
            while old.next_if(|point| point.particle < particle).is_some() {}
            let point = match old.next_if(|point| point.particle == particle) {
                Some(point) => self.mesh_cache.copy_point(&self.old_mesh_cache, point),
                None => ListedContact { particle, other: NO_PATCH, clear_until: 0.0 },
            };
            self.points.push(point);
        }
        let count = slots.len();
        self.slots = [slots, other_slots];
        self.mesh_cache.finish_pair(count)
    }
}

/// The points of one pair of a list.
fn points_of<'a>(
    pairs: &[Pair],
    points: &'a [ListedContact],
    order: PairOrder,
) -> &'a [ListedContact] {
    match pairs.binary_search_by_key(&order, Pair::order) {
        Ok(found) => &points[pairs[found].start as usize..pairs[found].end as usize],
        Err(_) => &[],
    }
}

/// A body with its pose.
#[derive(Clone, Copy)]
struct PlacedBody<'a> {
    body: &'a BodyModel,
    pose: &'a BodyPose,
}

impl PlacedBody<'_> {
    /// Lists the particles within `distance` (m) of the bounding ball of the particles of another body, by slot in order.
    fn list_near(&self, other: PlacedBody, distance: f64, slots: &mut Vec<u32>) {
        slots.clear();
        let centre = self.pose.rotation.transpose() * (other.pose.position - self.pose.position);
        let range = other.body.shape.radius() + distance;
        let particles = self.body.shape.particles();
        let is_near = |at: DVec3, range: f64| at.distance_squared(centre) <= range * range;
        particles.collect_slots_where(|centre, radius| is_near(centre, radius + range), slots);
        slots.retain(|&slot| is_near(particles.at(slot), range));
    }
}
