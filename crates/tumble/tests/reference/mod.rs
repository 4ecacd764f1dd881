//! A reference implementation of the basic system, as a plain loop over particles.
//!
//! It follows the equations line by line and is not optimised.

use tumble::{BodyState, DMat3, DQuat, DVec3, WallPlane};

/// One body, with its particles and everything that acts on it.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Particles in the body frame, centre of mass at the origin (m).
    pub r: Vec<DVec3>,
    /// Mass of a particle (kg).
    pub m: f64,
    /// Gravity (m/s²).
    pub g: DVec3,
    /// Drag coefficient (N·s/m).
    pub c: f64,
    /// Stiffness (N/m).
    pub k: f64,
    /// Walls.
    pub walls: Vec<WallPlane>,
}

impl Reference {
    /// One step of h seconds.
    pub fn step(&self, s: &mut BodyState, h: f64) {
        // 1: mass properties
        let mass = self.m * self.r.len() as f64;
        let mut inertia = DMat3::ZERO;
        for r in &self.r {
            let outer = DMat3::from_cols(*r * r.x, *r * r.y, *r * r.z);
            inertia += (DMat3::from_diagonal(DVec3::splat(r.dot(*r))) - outer) * self.m;
        }
        let inverse_inertia = inertia.inverse();

        let omega = world_omega(s, inverse_inertia);
        let rotation = matrix(s.orientation);
        let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        for r in &self.r {
            // 7, of the step before: where the particle is and how it moves
            let arm = rotation * *r;
            let x = s.position + arm;
            let v = s.velocity + omega.cross(arm);
            // 2: gravity
            let mut f = self.m * self.g;
            // 8: drag
            f -= self.c * v;
            // 9: walls
            for wall in &self.walls {
                let depth = wall.offset - wall.normal.dot(x);
                if depth > 0.0 {
                    f += self.k * depth * wall.normal;
                }
            }
            // 3 and 4: total force and torque
            force += f;
            torque += (x - s.position).cross(f);
        }
        // 5: velocity, then position
        s.velocity += force / mass * h;
        s.position += s.velocity * h;
        // 6: quaternion, with ω of the start of the step
        let spin = DQuat::from_xyzw(omega.x, omega.y, omega.z, 0.0) * s.orientation;
        s.orientation = (s.orientation + spin * (0.5 * h)).normalize();
        // 7: angular momentum; ω and particles follow at the start of the next step
        s.angular_momentum += torque * h;
    }
}

/// ω = R I₀⁻¹ Rᵀ L.
fn world_omega(s: &BodyState, inverse_inertia: DMat3) -> DVec3 {
    let rotation = matrix(s.orientation);
    (rotation * inverse_inertia * rotation.transpose()) * s.angular_momentum
}

/// The rotation matrix of a unit quaternion, written out.
fn matrix(q: DQuat) -> DMat3 {
    let (w, x, y, z) = (q.w, q.x, q.y, q.z);
    DMat3::from_cols(
        DVec3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
        DVec3::new(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
        DVec3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
}
