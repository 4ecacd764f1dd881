//! Tangential springs between bodies: how they turn and stretch from one kick to the next.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;

use super::contact_lanes::{ContactLanes, LaneInput};
use super::pose::BodyPose;
use super::since_kick::SinceKick;
use crate::ContactKind;
use crate::lanes::{Vec3x8, set};

impl ContactLanes {
    /// Sets the stretch that the spring of a lane had at the latest kick (m).
    #[inline(always)]
    pub fn set_old_stretch(&mut self, lane: usize, stretch: DVec3) {
        set(&mut self.old_stretch, lane, stretch);
    }

    /// Advances the tangential springs over the flight since the latest kick.
    ///
    /// A spring turns with the contact, keeps its length, and stretches by the relative displacement of the bodies. Half of
    /// the turn comes before that displacement and half after it (Strang splitting), and the displacement is that at the
    /// velocities in the middle of the flight. So the stretch is of second order.
    ///
    /// A new spring has stretched since its bodies touched, within the flight.
    #[inline(always)]
    pub fn advance_friction<S: Simd>(
        &mut self,
        simd: S,
        input: &LaneInput,
        poses: &[BodyPose],
        since_kick: &SinceKick,
    ) {
        self.is_first_kick = since_kick.is_first;
        let n = Vec3x8::load(simd, &self.normal);
        let zero = f64x8::splat(simd, 0.0);
        let mid_flight = self.mid_flight(simd, input, poses, since_kick.duration);
        let MidFlight { velocity, closing, half_turn } = mid_flight;

        // the old stretch, turned with the contact, then into the tangent plane at its old length
        let has_spring = f64x8::simd_from(simd, input.has_spring).simd_gt(zero);
        let zeros = Vec3x8::splat(simd, DVec3::ZERO);
        let old = Vec3x8::select(has_spring, Vec3x8::load(simd, &self.old_stretch), zeros);
        let turned = turned_by(simd, turned_by(simd, old, half_turn), half_turn);
        let tangential = turned.perpendicular_to(n);
        let (old_square, new_square) = (old.dot(old), tangential.dot(tangential));
        // nothing is left of a stretch whose normal turned by a right angle
        let old =
            tangential * new_square.simd_gt(zero).select((old_square / new_square).sqrt(), zero);
        self.old_stretch = old.store();

        let depth = f64x8::simd_from(simd, self.depth);
        let duration = has_spring.select(
            f64x8::splat(simd, since_kick.duration),
            since_kick.new_contact_durations(simd, depth, closing),
        );
        let displacement = turned_by(simd, velocity * duration, half_turn);
        self.stretch = (old + displacement.perpendicular_to(n)).store();
    }

    /// How the bodies moved at the contact in the middle of the flight of duration `h` (s) since the latest kick.
    ///
    /// The place of a contact moves with the particle that touches: its centre turns with its body, and the point below it is
    /// found anew on the mesh or wall. The contact between two spheres turns with the line between their centres and, about
    /// that line, at the mean of both spins: the only rule that does not depend on which sphere is the first, and that turns
    /// the spring with both bodies where they turn as one. On a mesh or wall the contact turns with that.
    #[inline(always)]
    fn mid_flight<S: Simd>(
        &self,
        simd: S,
        input: &LaneInput,
        poses: &[BodyPose],
        h: f64,
    ) -> MidFlight<S> {
        let (half, zero) = (f64x8::splat(simd, 0.5 * h), f64x8::splat(simd, 0.0));
        let n = Vec3x8::load(simd, &self.normal);
        let depth = f64x8::simd_from(simd, self.depth);
        let drift = Vec3x8::load(simd, &input.drift_velocity);
        let omega = Vec3x8::load(simd, &input.drift_angular_velocity);
        let other_omega = Vec3x8::load(simd, &input.other_drift_angular_velocity);
        let arm = Vec3x8::load(simd, &self.arm);
        let other_arm = Vec3x8::load(simd, &self.other_arm);
        let [offset, other_offset] = self.contact_offsets(simd, depth);
        let between_bodies = other_arm - arm - drift * half;
        let back = |omega: Vec3x8<S>, centre: Vec3x8<S>| centre - omega.cross(centre) * half;
        let centre = back(omega, arm + n * offset);
        let other_centre = back(other_omega, other_arm - n * other_offset);

        // two spheres, from the line between their centres
        let is_spheres = self.is_kind(simd, ContactKind::SphereSphere);
        let approach = drift + omega.cross(centre) - other_omega.cross(other_centre);
        let line = n * (offset + other_offset) - approach * half;
        let distance = line.dot(line).sqrt();
        let one = f64x8::splat(simd, 1.0);
        let inverse = distance.simd_gt(zero).select(one / distance, zero);
        let sphere_normal = line * inverse;
        let spin = (omega + other_omega).dot(sphere_normal) * 0.5;
        let sphere_turn = sphere_normal.cross(approach) * inverse + sphere_normal * spin;
        let depth_change = is_spheres.select(offset + other_offset - distance, zero);

        // a mesh or a wall, which does not turn
        let is_mesh_point = self.is_kind(simd, ContactKind::MeshPoint);
        let mesh_turn = Vec3x8::select(is_mesh_point, omega, other_omega);
        let mesh_normal = n - mesh_turn.cross(n) * half;
        let mesh_normal = mesh_normal.divided_by(mesh_normal.dot(mesh_normal).sqrt());

        let turn = Vec3x8::select(is_spheres, sphere_turn, mesh_turn);
        let normal = Vec3x8::select(is_spheres, sphere_normal, mesh_normal);
        let by_first = centre - normal * (offset - depth_change * 0.5);
        let by_second = other_centre + normal * other_offset - between_bodies;
        let arm = Vec3x8::select(is_mesh_point, by_second, by_first);
        // of spheres from its own centre, so that the order of the bodies does not matter
        let by_sphere = other_centre + normal * (other_offset - depth_change * 0.5);
        let other_arm = Vec3x8::select(is_spheres, by_sphere, arm + between_bodies);
        let mut u = drift + (omega.cross(arm) - other_omega.cross(other_arm));
        let closing = zero - u.dot(normal);
        if self.has_surface_velocity {
            // a belt turns with its body
            let belt = Vec3x8::load(simd, &self.surface_velocity(poses));
            u += Vec3x8::select(is_spheres, belt, belt - turn.cross(belt) * half);
        }
        MidFlight { velocity: u.perpendicular_to(normal), closing, half_turn: turn * half }
    }
}

/// The motion of the bodies at eight contacts in the middle of a flight.
struct MidFlight<S: Simd> {
    /// Velocity of the first body relative to the second, along their surfaces (m/s).
    velocity: Vec3x8<S>,
    /// Speed at which the bodies approach (m/s).
    closing: f64x8<S>,
    /// Rotation vector of the contact over half of the flight (rad).
    half_turn: Vec3x8<S>,
}

/// A vector, turned by a small rotation vector: the Cayley transform, which keeps the length and is exact to second order.
#[inline(always)]
fn turned_by<S: Simd>(simd: S, vector: Vec3x8<S>, rotation: Vec3x8<S>) -> Vec3x8<S> {
    let half = rotation * f64x8::splat(simd, 0.5);
    let factor = f64x8::splat(simd, 2.0) / (half.dot(half) + 1.0);
    vector + half.cross(vector + half.cross(vector)) * factor
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::lanes::vector;

    #[test]
    fn a_turn_keeps_the_length_and_is_exact_to_second_order() {
        let (v, axis) = (DVec3::new(0.3, -0.5, 0.8), DVec3::new(2.0, 1.0, -2.0) / 3.0);
        let error = |angle: f64| {
            let turned = dispatch!(Level::new(), simd => {
                let of = |v: DVec3| Vec3x8::splat(simd, v);
                vector(&turned_by(simd, of(v), of(axis * angle)).store(), 0)
            });
            assert!((turned.length() / v.length() - 1.0).abs() < 1e-14);
            (turned - glam::DQuat::from_axis_angle(axis, angle) * v).length()
        };
        let order = libm::log2(error(0.1) / error(0.05));
        assert!((order - 3.0).abs() < 0.01, "local error of order {order}");
    }
}
