//! The touch: bodies that stick from the moment when they touch, between two kicks.

use tumble::{
    Body, DVec3, Damping, Material, Motion as BodyMotion, Prescribed, Primitive, Shape, World,
};

use super::{Motion, order_check};
use crate::check::{Case, Error, Outcome};
use crate::setup::{FLOOR, ball, mesh_body, step_until};

pub(crate) const CASE: Case = Case {
    name: "order at touch",
    description: "A particle, and a ball, are thrown at a plane, a wall or a mesh, and stick from the moment when they touch. The closed form are two \
            harmonic motions. The order between dt/2 and dt/4 of the mean error over 32 distances.",
    run,
    slow: false,
};

const STIFFNESS: f64 = 1e4;
const SPRING: f64 = 2.0 / 7.0 * STIFFNESS;
const SPEED: f64 = 0.5;
const SLIDING: f64 = 0.3;
const RADIUS: f64 = 0.1;
/// Time in contact at the comparison (s); the contact lasts π/ω, ω = 100 rad/s.
const CONTACT: f64 = 0.018;
const DISTANCES: u32 = 32;

/// What is thrown, and whether the plane is a mesh, which comes first.
#[derive(Clone, Copy)]
struct Setting {
    is_ball: bool,
    mesh: Option<bool>,
}

impl Setting {
    fn simulated(&self, dt: f64, gap: f64, time: f64) -> Result<Motion, Error> {
        let material = Material {
            collision_stiffness: STIFFNESS,
            damping: Damping::Dashpot(0.0),
            friction_stiffness: 1e9,
            friction_damping: Some(0.0),
            ..Material::default()
        };
        let body = if self.is_ball {
            ball(RADIUS, 1.0)?.position(DVec3::Y * (RADIUS + gap))
        } else {
            Body::new(Shape::from_particles(&[DVec3::ZERO])?).mass(1.0).position(DVec3::Y * gap)
        };
        let body = body.velocity(DVec3::new(SLIDING, -SPEED, 0.0));
        let world = World::builder().gravity(DVec3::ZERO).dt(dt).material(material);
        let slab = mesh_body(Primitive::Box { size: DVec3::new(6.0, 0.5, 6.0), divisions: 1 })?
            .position(DVec3::Y * -0.25)
            .motion(BodyMotion::Prescribed(Prescribed::default()));
        let (world, index) = match self.mesh {
            None => (world.wall(FLOOR).body(body), 0),
            Some(true) => (world.body(slab).body(body), 1),
            Some(false) => (world.body(body).body(slab), 0),
        };
        let mut world = world.build()?;
        step_until(&mut world, time)?;
        Ok(Motion::of(&world, index, RADIUS))
    }

    /// The closed form: ξ' = u and u' = −ω_t² ξ, with ω_t² = k_t (1/M + R²/I); the impulse −M (u − u₀)/(1 + M R²/I).
    fn exact(&self, gap: f64, time: f64) -> Motion {
        let lever = if self.is_ball { 3.5 } else { 1.0 };
        let (omega, omega_t) = (STIFFNESS.sqrt(), (SPRING * lever).sqrt());
        let t = time - gap / SPEED;
        let (u, stretch) =
            (SLIDING * libm::cos(omega_t * t), SLIDING / omega_t * libm::sin(omega_t * t));
        let velocity_change = (u - SLIDING) / lever;
        let distance = (stretch - SLIDING * t) / lever + SLIDING * time;
        let rest = if self.is_ball { RADIUS } else { 0.0 };
        // the force acts at −R y, so M R²/I of the change of velocity turns the ball
        let spin = if self.is_ball { velocity_change * 2.5 } else { 0.0 };
        Motion {
            position: DVec3::new(distance, rest - SPEED / omega * libm::sin(omega * t), 0.0),
            velocity: DVec3::new(SLIDING + velocity_change, -SPEED * libm::cos(omega * t), 0.0),
            rim_velocity: DVec3::Z * spin,
        }
    }
}

fn run() -> Outcome {
    let mut checks = Vec::new();
    for is_ball in [false, true] {
        for mesh in [None, Some(false), Some(true)] {
            let setting = Setting { is_ball, mesh };
            let coarse = 5e-4;
            let error = |dt: f64| -> Result<f64, Error> {
                let mut sum = 0.0;
                for i in 0..DISTANCES {
                    // distances that differ by a part of the coarsest step
                    let delay = coarse * (3.0 + (f64::from(i) + 0.5) / f64::from(DISTANCES));
                    let (gap, time) = (SPEED * delay, coarse * 4.0 + CONTACT);
                    let found = setting.simulated(dt, gap, time)?;
                    let exact = setting.exact(gap, time);
                    sum += found.squared_difference(&exact, STIFFNESS.sqrt());
                }
                Ok((sum / f64::from(DISTANCES)).sqrt())
            };
            let name = match (is_ball, mesh) {
                (true, None) => "ball, wall",
                (false, None) => "particle, wall",
                (true, Some(false)) => "ball, mesh",
                (false, Some(false)) => "particle, mesh",
                (true, Some(true)) => "ball, mesh first",
                (false, Some(true)) => "particle, mesh first",
            };
            checks.push(order_check(name.to_owned(), coarse, error)?);
        }
    }
    Ok(checks)
}
