//! Line 9: walls push back every particle that is behind them.

use glam::{DMat3, DVec3};

use crate::{BodyModel, BodyState, Material, Model, Particles, Scratch, State, WallPlane, Wrench};

/// Adds up fᵢ = k δᵢ n over the particles behind each wall, δᵢ their depth.
pub fn contact(model: &Model, state: &State, scratch: &mut Scratch) {
    for ((body, state), forces) in model.bodies.iter().zip(&state.bodies).zip(&mut scratch.forces) {
        let rotation = DMat3::from_quat(state.orientation);
        for (wall, material) in model.walls.iter().zip(&body.contacts) {
            let Some(carried) = CarriedWall::near(wall, body, state, rotation) else { continue };
            let depths = carried.depths(body.shape.particles());
            forces.contact += carried.spring_wrench(&depths, material, wall, rotation);
            forces.max_depth = forces.max_depth.max(depths.deepest);
        }
    }
}

/// Energy ½ k Σ δᵢ² stored in the contact springs of one body (J).
pub(crate) fn elastic_energy(model: &Model, body: &BodyModel, state: &BodyState) -> f64 {
    let rotation = DMat3::from_quat(state.orientation);
    let mut energy = 0.0;
    for (wall, material) in model.walls.iter().zip(&body.contacts) {
        if let Some(carried) = CarriedWall::near(wall, body, state, rotation) {
            let depths = carried.depths(body.shape.particles());
            energy += 0.5 * material.collision_stiffness * depths.sum_of_squares;
        }
    }
    energy
}

/// A wall seen from the body frame: δᵢ = d_b − n_b·rᵢ, and no particle is rotated.
struct CarriedWall {
    normal: DVec3,
    offset: f64,
}

/// Sums over the particles behind a wall.
struct Depths {
    /// Σ δᵢ (m).
    sum: f64,
    /// Σ δᵢ rᵢ (m²).
    moment: DVec3,
    /// Σ δᵢ² (m²).
    sum_of_squares: f64,
    /// max δᵢ (m).
    deepest: f64,
}

impl CarriedWall {
    /// The wall in the body frame, n_b = Rᵀ n and d_b = d − n·x; `None` where it is out of reach.
    fn near(wall: &WallPlane, body: &BodyModel, state: &BodyState, r: DMat3) -> Option<Self> {
        let offset = wall.depth(state.position);
        // the farthest particle is not behind the wall: none is
        if offset < -body.shape.radius() * (1.0 + 1e-9) {
            return None;
        }
        Some(Self { normal: r.transpose() * wall.normal, offset })
    }

    /// The depths of all particles, summed in a fixed order: eight lanes, then their sum.
    fn depths(&self, particles: &Particles) -> Depths {
        const LANES: usize = 8;
        let (x, y, z) = particles.coordinates();
        let mut lanes = [[0.0f64; LANES]; 6];
        let mut at = 0;
        while at < x.len() {
            let end = (at + LANES).min(x.len());
            for (lane, i) in (at..end).enumerate() {
                let behind = self.normal.x * x[i] + self.normal.y * y[i] + self.normal.z * z[i];
                let depth = (self.offset - behind).max(0.0);
                lanes[0][lane] += depth;
                lanes[1][lane] += depth * x[i];
                lanes[2][lane] += depth * y[i];
                lanes[3][lane] += depth * z[i];
                lanes[4][lane] += depth * depth;
                lanes[5][lane] = lanes[5][lane].max(depth);
            }
            at = end;
        }
        let sum = |lane: [f64; LANES]| lane.iter().sum::<f64>();
        Depths {
            sum: sum(lanes[0]),
            moment: DVec3::new(sum(lanes[1]), sum(lanes[2]), sum(lanes[3])),
            sum_of_squares: sum(lanes[4]),
            deepest: lanes[5].iter().fold(0.0, |m, &d| m.max(d)),
        }
    }

    /// F = k Σ δᵢ n and τ = R (k Σ δᵢ rᵢ × n_b).
    fn spring_wrench(
        &self,
        depths: &Depths,
        material: &Material,
        wall: &WallPlane,
        rotation: DMat3,
    ) -> Wrench {
        let k = material.collision_stiffness;
        Wrench {
            force: k * depths.sum * wall.normal,
            torque: rotation * (k * depths.moment.cross(self.normal)),
        }
    }
}
