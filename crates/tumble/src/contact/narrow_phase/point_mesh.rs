//! Particles, or spheres about them, of one body and the closed mesh of another.

use fearless_simd::Simd;
use glam::DVec3;

use super::lane_filler::LaneFiller;
use super::pair_poses::{PairPoses, PointGeometry};
use super::point_view::PointView;
use super::surface_point::{PointContact, SurfacePoint};
use crate::contact::chunk_contacts::Candidate;
use crate::contact::mesh_cache::{BLOCK, MeshCache, RelativePose};
use crate::contact::pair::{ListedContact, Pair};
use crate::contact::pose::BodyPose;
use crate::contact::tunnelling::TunnellingRisk;
use crate::{BodyModel, ContactKind, SignedDistance};

/// The neighbour list of a chunk.
pub(super) struct Neighbours<'a> {
    pub pairs: &'a mut [Pair],
    pub points: &'a mut [ListedContact],
    pub mesh_cache: &'a mut MeshCache,
}

/// Finds the particles of the pair with index `index` that touch the mesh; returns up to which sum of path lengths
/// there is no contact (m).
#[inline(always)]
pub(super) fn detect<S: Simd, const PREDICT: bool>(
    simd: S,
    filler: &mut LaneFiller,
    poses: &PairPoses,
    index: usize,
    neighbours: Neighbours,
) -> f64 {
    let Neighbours { pairs, points, mesh_cache } = neighbours;
    let pair = &{ pairs[index] };
    let is_fast = poses.step_displacement > pair.tunnelling_limit;
    let (particles, mesh) = particles_and_mesh(poses, pair);
    let relative_pose = RelativePose::new(particles.0, particles.1, mesh.1);
    let (path, until) = mesh_cache.advance(pair.cache, &relative_pose, poses.path);
    if path + poses.reach < until && !is_fast {
        return poses.path + (until - path);
    }
    let contact_pair = filler.begin_pair::<PREDICT>(index, pair);
    let margin =
        if is_fast { pair.search_margin.max(poses.step_displacement) } else { pair.search_margin };
    let (reach, context) = (poses.reach, filler.context);
    let ahead = context.is_solved.then_some(context.since_kick.step);
    let mut query = MeshQuery {
        pair,
        particles,
        mesh,
        mesh_cache,
        needs_distance: is_fast,
        margin,
        reach,
        ahead,
        resolves_rims: poses.model.resolves_contacts,
    };
    let mut clear_until = f64::INFINITY;
    for (block, start) in (pair.start..pair.end).step_by(BLOCK).enumerate() {
        let mut block_clear_until = *query.mesh_cache.block_clear_until(pair.cache, block);
        if path + reach >= block_clear_until || is_fast {
            block_clear_until = f64::INFINITY;
            for point_index in start..pair.end.min(start + BLOCK as u32) {
                let point = &mut points[point_index as usize];
                let mut is_full = false;
                if path + reach >= point.clear_until
                    || poses.may_tunnel(pair, path, point.clear_until)
                {
                    match query.geometry(point) {
                        Ok(geometry) => {
                            point.clear_until = 0.0;
                            let candidate = Candidate { pair: contact_pair, point: point_index };
                            is_full = filler.push(poses, pair, candidate, geometry, point);
                        }
                        Err(gap) => point.clear_until = path + gap,
                    }
                    if poses.may_tunnel(pair, path, point.clear_until) {
                        let (model, displacement) = (poses.model, poses.step_displacement);
                        let risk = TunnellingRisk::new(model, index, pair, point, displacement);
                        filler.contacts.record(risk);
                    }
                }
                block_clear_until = block_clear_until.min(point.clear_until);
                if is_full {
                    filler.flush::<S, PREDICT>(simd, pairs, points);
                }
            }
            *query.mesh_cache.block_clear_until(pair.cache, block) = block_clear_until;
        }
        clear_until = clear_until.min(block_clear_until);
    }
    *query.mesh_cache.pair_clear_until(pair.cache) = clear_until;
    poses.path + (clear_until - path)
}

type PosedBody<'a> = (&'a BodyModel, &'a BodyPose);

/// The body whose particles touch, and the body whose mesh they touch.
fn particles_and_mesh<'a>(poses: &PairPoses<'a>, pair: &Pair) -> (PosedBody<'a>, PosedBody<'a>) {
    let body = |index: u32| &*poses.model.bodies[index as usize];
    let (a, b) = ((body(pair.first), poses.first), (body(pair.second), poses.second));
    if pair.kind == ContactKind::PointMesh { (a, b) } else { (b, a) }
}

/// Distance queries of the particles of one body against the mesh of another.
struct MeshQuery<'a> {
    pair: &'a Pair,
    particles: PosedBody<'a>,
    mesh: PosedBody<'a>,
    mesh_cache: &'a mut MeshCache,
    /// Whether the distance is needed even of particles that certainly do not touch.
    needs_distance: bool,
    /// How far beyond the contact distance the mesh is searched (m).
    margin: f64,
    /// Up to which gap contacts are found (m), and how far ahead in time those of surfaces (s), for the implicit solver.
    reach: f64,
    ahead: Option<f64>,
    /// See [`PointView`].
    resolves_rims: bool,
}

impl MeshQuery<'_> {
    /// The geometry of a point that touches the mesh, or is within reach of it; otherwise a lower bound on its gap (m).
    #[inline(always)]
    fn geometry(&mut self, point: &mut ListedContact) -> Result<PointGeometry, f64> {
        let (position, contact) = self.contact(point)?;
        // from the mesh to world axes, and from the second body to the first
        let is_first = self.pair.kind == ContactKind::PointMesh;
        let on_first = |vector: DVec3| {
            let vector = self.mesh.1.rotation * vector;
            if is_first { vector } else { -vector }
        };
        Ok(PointGeometry {
            position,
            separation_or_normal: on_first(contact.outward),
            contact_distance_or_depth: contact.depth,
            weight: contact.weight,
            couple: on_first(contact.couple),
        })
    }

    /// Position of the point, and its contact in the frame of the mesh; otherwise a lower bound on the gap (m).
    fn contact(&mut self, point: &mut ListedContact) -> Result<(DVec3, PointContact), f64> {
        let (pair, (body, pose), (mesh_body, mesh_pose)) = (self.pair, self.particles, self.mesh);
        let Some(signed_distance) = &mesh_body.signed_distance else { return Err(self.margin) };
        let position = pose.particle_position(body, point.particle);
        let local = mesh_pose.rotation.transpose() * (position - mesh_pose.position);
        let points = body.contact_points.as_deref();
        let index = || body.points().index_of_slot(point.particle);
        // most bodies have no segments, and most points do not touch
        let segments = points.filter(|points| points.longest_half_segment() > 0.0);
        let half_length = segments.map_or(0.0, |points| points.half_segment(index()).length());
        let contact_distance = pair.contact_distance + half_length;
        if !self.needs_distance
            && let Some(gap) = self.cheap_gap(signed_distance, point, local, contact_distance)
        {
            return Err(gap);
        }
        let patch = self.mesh_cache.patch_mut(point);
        let nearest = signed_distance.query_cached(local, patch, contact_distance + self.margin);
        let Some(nearest) = nearest else { return Err(self.margin) };
        let depth = contact_distance - nearest.distance;
        if depth <= -self.reach {
            return Err(-depth);
        }
        let Some(points) = points else {
            return Ok((position, PointContact::plain(nearest.gradient, depth)));
        };
        let view = PointView {
            surface: SurfacePoint::new(points, body.points().index_of_slot(point.particle)),
            mesh: signed_distance,
            to_mesh: mesh_pose.rotation.transpose() * pose.rotation,
            place: local,
            contact_distance,
            resolves_rims: self.resolves_rims,
        };
        let found = match self.ahead {
            None => view.touching(&nearest),
            Some(step) => view.within((step, self.reach), &nearest, [pose, mesh_pose], position),
        };
        // 0: the next step has to look again
        let (offset, contact) = found.ok_or(0.0)?;
        Ok((position + mesh_pose.rotation * offset, contact))
    }

    /// A lower bound on the gap (m) without a search, if it proves that the particle does not touch.
    #[inline(always)]
    fn cheap_gap(
        &self,
        signed_distance: &SignedDistance,
        point: &ListedContact,
        local: DVec3,
        contact_distance: f64,
    ) -> Option<f64> {
        if let Some(patch) = self.mesh_cache.patch(point) {
            let gap = patch.lower_bound(local) - contact_distance;
            if gap > self.reach {
                return Some(gap);
            }
            // a particle that touched in the step before most likely still does
            if point.clear_until == 0.0 {
                return None;
            }
        }
        let gap = signed_distance.lower_bound(local) - contact_distance;
        (gap > self.reach).then_some(gap)
    }
}
