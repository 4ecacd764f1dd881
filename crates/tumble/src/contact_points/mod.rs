//! The points at which a body with a mesh surface touches other bodies.
//!
//! They are its particles, and more where its mesh is coarse:
//!
//! - each sharp convex edge, which touches at its deepest point (after M. Macklin et al., Proc. ACM Comput. Graph. Interact.
//!   Tech. 3 (2020) 5);
//! - on each large face, fixed points inside it, which carry faces whose edges are flush.
//!
//! Each knows the normals of its own surface. A point inside another body can leave only through a face that opposes one of
//! them. Particles carry mass and drag and meet walls; contact points do not.

mod builder;
mod vertex_normals;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use crate::{Particles, Shape};

#[cfg(test)]
pub(crate) use self::builder::contact_points;

/// The largest number of normals kept per point.
pub(crate) const MOST_NORMALS: usize = 6;

/// The contact points of a shape with a mesh surface.
///
/// The *index* of a point is that of its particle, or follows after all particles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactPoints {
    /// The particles and all further points; `None` where the particles suffice.
    refined: Option<Particles>,
    /// Number of particles.
    particle_count: usize,
    /// For each further point, half of its segment (m); zero for a point that does not move.
    half_segments: Vec<DVec3>,
    /// The longest of them (m).
    longest_half: f64,
    /// Where the normals of each point start in `normals`, and the end.
    normal_starts: Vec<u32>,
    /// Unit normals of the faces around each point.
    normals: Vec<DVec3>,
    /// For each point, the distance from the rim of a face over which its force fades (m).
    fade: Vec<f64>,
    /// The largest sum of weights on one side of the body, in units of the number of particles.
    load: f64,
}

impl ContactPoints {
    /// All points, with their weights.
    pub(crate) fn points<'a>(&'a self, shape: &'a Shape) -> &'a Particles {
        self.refined.as_ref().unwrap_or(shape.particles())
    }

    /// Half of the segment that a point stands for (m), zero where it is only a point.
    pub(crate) fn half_segment(&self, index: u32) -> DVec3 {
        let further = (index as usize).checked_sub(self.particle_count);
        further.and_then(|at| self.half_segments.get(at)).copied().unwrap_or_default()
    }

    /// How far a point may be from its place in [`Self::points`] (m).
    pub(crate) fn longest_half_segment(&self) -> f64 {
        self.longest_half
    }

    /// Normals of the faces around a point; none for a particle that is not on the surface.
    pub(crate) fn normals(&self, index: u32) -> &[DVec3] {
        match self.normal_starts.get(index as usize..index as usize + 2) {
            Some(&[start, end]) => &self.normals[start as usize..end as usize],
            _ => &[],
        }
    }

    /// Over which distance from the rim of a face the force at a point fades (m).
    pub(crate) fn fade(&self, index: u32) -> f64 {
        self.fade.get(index as usize).copied().unwrap_or_default()
    }

    /// The number of points in addition to the particles.
    pub fn added(&self) -> usize {
        self.half_segments.len()
    }

    /// The largest sum of weights of the points that a face of another body can touch at once, in units of the number of
    /// particles; at least 1.
    pub(crate) fn load(&self) -> f64 {
        self.load.max(1.0)
    }
}

/// The contact points of shapes, by the address of the shape.
#[derive(Debug, Default)]
pub(crate) struct SharedContactPoints(BTreeMap<*const Shape, Arc<ContactPoints>>);

impl SharedContactPoints {
    /// The contact points of a shape. The shape must outlive this map.
    pub fn get(&mut self, shape: &Arc<Shape>) -> Arc<ContactPoints> {
        let make = || Arc::new(builder::contact_points(shape));
        Arc::clone(self.0.entry(Arc::as_ptr(shape)).or_insert_with(make))
    }
}
