//! Two bodies, or a body and a wall, as their contacts are found.

use glam::DVec3;

use super::contact::{Approach, Eight};
use super::find::Moment;
use super::list::{Pair, Point};
use super::mesh::{Look, View};
use super::pose::{self, Pose};
use crate::lanes::set;
use crate::{BodyModel, ContactKind, Model, Particles};

/// Where a particle is (m); from the other sphere to its own (m), or n; and how far apart spheres touch, or the depth (m).
pub(super) type Geometry = (DVec3, DVec3, f64);

/// Two bodies where they are.
pub(super) struct Sides<'a> {
    pub model: &'a Model,
    first: &'a Pose,
    second: &'a Pose,
    /// How far both have come together (m).
    pub travel: f64,
    /// How far the one can come against the other in a step (m), at most.
    pub way: f64,
}

impl<'a> Sides<'a> {
    #[inline(always)]
    pub fn of(moment: &Moment<'a>, pair: &Pair) -> Self {
        let first = pose::of(moment.poses, pair.first);
        let second = pose::of(moment.poses, pair.second_body());
        let travel = first.travel + second.travel;
        let sides =
            Self { model: moment.model, first, second, travel, way: first.way + second.way };
        if sides.way <= pair.limit {
            sides
        } else {
            Self { way: sides.relative_way(pair), ..sides }
        }
    }

    /// The way of the one against the other; what both have in common does not count.
    fn relative_way(&self, pair: &Pair) -> f64 {
        let Self { model, first, second, .. } = self;
        let rim = |pose: &Pose, body: u32| {
            pose.angular_velocity.length() * model.bodies[body as usize].extent
        };
        let turning = rim(first, pair.first) + rim(second, pair.second);
        model.dt * ((first.velocity - second.velocity).length() + turning)
    }

    /// Whether one body could pass through the other at a point within a step. What the lists remember of that, until when it is
    /// `quiet`, is no reason to refuse a step: it is looked at anew.
    #[inline(always)]
    pub fn passes(&self, pair: &Pair, clock: f64, quiet: f64) -> bool {
        self.way > pair.limit && clock + self.way > quiet
    }

    /// How a sphere lies to another, or to a wall.
    #[inline(always)]
    pub fn geometry(&self, pair: &Pair, point: &Point) -> Geometry {
        let (model, p, q) = (self.model, self.first, self.second);
        let place = p.place(&model.bodies[pair.first as usize], point.particle);
        if pair.kind == ContactKind::Wall {
            let wall = &model.walls[pair.second as usize];
            return (place, wall.normal, pair.reach + wall.depth(place));
        }
        let apart = place - q.place(&model.bodies[pair.second as usize], point.other);
        (place, self.apart(apart), pair.reach)
    }

    /// The particle of a pair, and the mesh: of which body, and where that is.
    fn at_mesh(&self, pair: &Pair) -> [(&BodyModel, &Pose); 2] {
        let body = |index: u32| &*self.model.bodies[index as usize];
        let (a, b) = ((body(pair.first), self.first), (body(pair.second), self.second));
        if pair.kind == ContactKind::FirstInSecond { [a, b] } else { [b, a] }
    }

    /// How the particles of the one body lie in the frame of the mesh of the other.
    pub fn view(&self, pair: &Pair) -> View {
        let [(body, pose), (_, other)] = self.at_mesh(pair);
        View::of(body, pose, other)
    }

    /// How a particle lies in a mesh that it touches, or how far it is from there (m).
    #[inline(always)]
    pub fn touch_mesh(&self, look: &mut Look, point: &mut Point) -> Result<Geometry, f64> {
        let [particle, mesh] = self.at_mesh(look.pair);
        let (place, out, depth) = look.touch_mesh(point, particle, mesh)?;
        let is_first = look.pair.kind == ContactKind::FirstInSecond;
        Ok((place, if is_first { out } else { -out }, depth))
    }

    /// Puts what a contact is found from into a lane.
    #[inline(always)]
    pub fn approach(&self, (place, apart, reach): Geometry, lane: usize, into: &mut Approach) {
        let (p, q) = (self.first, self.second);
        set(&mut into.place, lane, place);
        set(&mut into.apart, lane, apart);
        into.reach[lane] = reach;
        set(&mut into.position, lane, p.position);
        set(&mut into.other_position, lane, q.position);
        set(&mut into.drift, lane, p.drift_velocity - q.drift_velocity);
        set(&mut into.spin, lane, p.drift_spin);
        set(&mut into.other_spin, lane, q.drift_spin);
    }

    /// From the one sphere to the other. Centres at one place are pushed apart as their bodies are, or upwards.
    #[inline(always)]
    fn apart(&self, apart: DVec3) -> DVec3 {
        if apart.length_squared() > 0.0 {
            return apart;
        }
        let way = self.first.position - self.second.position;
        way.try_normalize().unwrap_or(DVec3::Y) * f64::MIN_POSITIVE.sqrt()
    }

    /// Puts the bodies, the particles and the law into a lane.
    #[inline(always)]
    pub fn take_law(&self, pair: &Pair, point: &Point, lane: usize, into: &mut Eight) {
        let index = |body: u32, slot| self.particles(body).index_in(slot);
        let Pair { first, second, kind, law, .. } = pair;
        let (particle, other) = match kind {
            ContactKind::Spheres => (index(*first, point.particle), index(*second, point.other)),
            ContactKind::SecondInFirst => (index(*second, point.particle), 0),
            ContactKind::Wall | ContactKind::FirstInSecond => (index(*first, point.particle), 0),
        };
        (into.particle[lane], into.other[lane]) = (particle, other);
        (into.first[lane], into.second[lane]) = (*first, pair.second_body());
        let weight = match kind {
            ContactKind::Spheres | ContactKind::Wall => 1.0,
            ContactKind::FirstInSecond => self.particles(*first).weight(particle as usize),
            ContactKind::SecondInFirst => self.particles(*second).weight(particle as usize),
        };
        [into.radius[lane], into.other_radius[lane]] = pair.radii;
        into.kind[lane] = f64::from(*kind as u8);
        into.stiffness[lane] = weight * law.stiffness;
        into.damping[lane] = weight * law.damping;
        into.friction[lane] = law.friction;
        into.friction_spring[lane] = weight * law.friction_spring;
        into.friction_damping[lane] = weight * law.friction_damping;
        into.has_friction |= law.friction > 0.0;
        into.has_belt |= pair.has_belt;
    }

    fn particles(&self, body: u32) -> &Particles {
        self.model.bodies[body as usize].shape.particles()
    }
}
