//! Time per step of one body among walls, compared with the plain loops.

use tumble::{Body, DVec3, Damping, Integrator, Material, Mesh, Shape, WallBox, World};

use crate::plain_loop::{LoopStyle, PlainLoop};
use crate::timing::time_in_turns;

/// Radius of the body (m).
const RADIUS: f64 = 0.3;

/// `count` evenly distributed points on a sphere of the given radius (m).
///
/// The points lie on a Fibonacci spiral.
fn fibonacci_sphere(count: usize, radius: f64) -> Vec<DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count)
        .map(|i| {
            let y = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
            let (sine, cosine) = (golden * i as f64).sin_cos();
            let ring = (1.0 - y * y).sqrt();
            DVec3::new(ring * cosine, y, ring * sine) * radius
        })
        .collect()
}

/// The motion of the body while it is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Free flight far from every wall, without gravity.
    Flight,
    /// Bouncing in the arena with drag; restarted every three seconds of simulated time.
    Bouncing,
    /// At rest on the floor, with 5.7 % of the particles in contact.
    Rest,
    /// As [`Motion::Rest`], with contact dashpots.
    RestWithDashpots,
    /// As [`Motion::RestWithDashpots`], with friction.
    RestWithFriction,
}

impl Motion {
    /// The name in the table of results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Bouncing => "bouncing",
            Self::Rest => "rest",
            Self::RestWithDashpots => "rest, dashpots",
            Self::RestWithFriction => "rest, dashpots and friction",
        }
    }
}

/// A sphere of radius 0.3 m: `rings` rings of `rings` vertices each, and two triangles per vertex.
pub fn sphere_mesh(rings: u32) -> Mesh {
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(rings);
    let position = |ring: u32, i: u32| {
        let (y, r) = (0.5 * (angle(ring) + angle(1) / 2.0)).sin_cos();
        let (sine, cosine) = angle(i).sin_cos();
        DVec3::new(y * cosine, r, y * sine) * RADIUS
    };
    let index = |ring: u32, i: u32| ring * rings + i % rings;
    let all = || (0..rings).flat_map(move |ring| (0..rings).map(move |i| (ring, i)));
    let vertices = all().map(|(ring, i)| position(ring, i)).collect();
    let quad = |(ring, i): (u32, u32)| {
        let [a, b] = [index(ring, i), index(ring, i + 1)];
        let [c, d] = [index((ring + 1) % rings, i), index((ring + 1) % rings, i + 1)];
        [[a, b, c], [b, d, c]]
    };
    Mesh { vertices, triangles: all().flat_map(quad).collect() }
}

/// A world with one body, and the plain loops that it is compared with.
#[derive(Debug)]
pub struct SingleBodyBenchmark {
    world: World,
    /// Steps after which the motion restarts.
    restart_interval: u64,
    at_rest: bool,
}

impl SingleBodyBenchmark {
    /// Creates the benchmark for a sphere of `count` particles and 1 kg.
    ///
    /// # Errors
    /// If the shape or the world cannot be built.
    pub fn new(
        count: usize,
        motion: Motion,
        integrator: Integrator,
    ) -> Result<Self, Box<dyn std::error::Error>> {
        let positions = fibonacci_sphere(count, RADIUS);
        let shape = Shape::from_particles(&positions)?;
        let mass = 1.0;
        let at_rest = !matches!(motion, Motion::Flight | Motion::Bouncing);
        let cap = RADIUS * (1.0 - 0.114);
        let depths: f64 = positions.iter().map(|p| (-p.y - cap).max(0.0)).sum();
        let stiffness =
            if at_rest && depths > 0.0 { 9.8 * mass / depths } else { 1e4 / count as f64 };
        let damped = matches!(motion, Motion::RestWithDashpots | Motion::RestWithFriction);
        let material = Material {
            collision_stiffness: stiffness,
            damping: if damped { Damping::Restitution(0.5) } else { Damping::Dashpot(0.0) },
            friction_stiffness: if motion == Motion::RestWithFriction { 0.5 } else { 0.0 },
            ..Material::default()
        };
        let drag = if motion == Motion::Bouncing { mass / count as f64 } else { 0.0 };
        let mut body = Body::new(shape).mass(mass);
        body = match motion {
            Motion::Flight => body
                .position(DVec3::Y * 1e9)
                .velocity(DVec3::Y)
                .angular_velocity(DVec3::new(1.0, 5.0, 2.0)),
            Motion::Bouncing => body
                .position(DVec3::ZERO)
                .velocity(DVec3::new(4.0, 2.0, 3.0))
                .angular_velocity(DVec3::new(0.0, 10.0, 0.0)),
            _ => body.position(DVec3::Y * (cap - 1.0)),
        };
        let world = World::builder()
            .dt(1e-3)
            .integrator(integrator)
            .gravity(if motion == Motion::Flight { DVec3::ZERO } else { DVec3::Y * -9.8 })
            .velocity_damping_stiffness(drag)
            .material(material)
            .box_walls(&WallBox::arena())
            .body(body)
            .build()?;
        let restart_interval = if motion == Motion::Bouncing { 3000 } else { u64::MAX };
        Ok(Self { world, restart_interval, at_rest })
    }

    /// Times a step of the compiled loop, of the vectorised loop and of the world, in turns (s).
    ///
    /// # Errors
    /// If a step fails, or if a body that should be at rest has left the floor.
    pub fn measure(&mut self) -> Result<[f64; 3], Box<dyn std::error::Error>> {
        let mut outcome = Ok(());
        let mut compiled = step_with_restarts(
            PlainLoop::from_world(&self.world, LoopStyle::Compiled),
            self.restart_interval,
        );
        let mut vectors = step_with_restarts(
            PlainLoop::from_world(&self.world, LoopStyle::Vectors),
            self.restart_interval,
        );
        let (world, restart_interval) = (&mut self.world, self.restart_interval);
        let start = world.state().clone();
        let mut step_world = |steps: u64| {
            for _ in 0..steps {
                let result = world.step();
                if outcome.is_ok() {
                    outcome = result.map_err(|error| error.to_string());
                }
                if world.state().step % restart_interval == 0 {
                    // cannot fail: the state comes from this world
                    let _ = world.restore(start.clone());
                }
            }
        };
        let times = time_in_turns([&mut compiled, &mut vectors, &mut step_world]);
        outcome?;
        if self.at_rest && self.world.energy().elastic == 0.0 {
            return Err("the body has left the floor".into());
        }
        Ok(times)
    }
}

/// A function that steps the loop and returns it to its initial state every `restart_interval` steps.
fn step_with_restarts(mut plain_loop: PlainLoop, restart_interval: u64) -> impl FnMut(u64) {
    let (start, mut done) = (plain_loop.state, 0);
    move |steps| {
        for _ in 0..steps {
            plain_loop.step();
            done += 1;
            if done % restart_interval == 0 {
                plain_loop.state = start;
            }
        }
    }
}
