//! Bodies and motions that are timed.

use tumble::{Body, DVec3, Damping, Integrator, Material, Mesh, Shape, WallBox, World};

use crate::{PlainLoop, Style, side_by_side};

/// Evenly spread points on a sphere of the given radius (m).
pub fn fibonacci_sphere(count: usize, radius: f64) -> Vec<DVec3> {
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

/// What the body does while it is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// It never comes near a wall.
    Flight,
    /// It is thrown and bounces in the arena for three seconds, again and again.
    Bouncing,
    /// It rests on the floor, 5.7 % of its particles in contact.
    Rest,
    /// As [`Motion::Rest`], with dashpots.
    DampedRest,
    /// As [`Motion::DampedRest`], with friction.
    RoughRest,
}

impl Motion {
    /// What the table calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Bouncing => "bouncing",
            Self::Rest => "rest",
            Self::DampedRest => "rest, dashpots",
            Self::RoughRest => "rest, dashpots and friction",
        }
    }
}

/// A sphere of `rings` rings of as many vertices each, and two triangles a vertex (m).
pub fn sphere_mesh(rings: u32) -> Mesh {
    let around = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(rings);
    let place = |ring: u32, i: u32| {
        let (y, r) = (0.5 * (around(ring) + around(1) / 2.0)).sin_cos();
        let (sine, cosine) = around(i).sin_cos();
        DVec3::new(y * cosine, r, y * sine) * RADIUS
    };
    let index = |ring: u32, i: u32| ring * rings + i % rings;
    let all = || (0..rings).flat_map(move |ring| (0..rings).map(move |i| (ring, i)));
    let vertices = all().map(|(ring, i)| place(ring, i)).collect();
    let quad = |(ring, i): (u32, u32)| {
        let [a, b] = [index(ring, i), index(ring, i + 1)];
        let [c, d] = [index((ring + 1) % rings, i), index((ring + 1) % rings, i + 1)];
        [[a, b, c], [b, d, c]]
    };
    Mesh { vertices, triangles: all().flat_map(quad).collect() }
}

/// A world, and the plain loops that do the same.
#[derive(Debug)]
pub struct Trial {
    world: World,
    restart: u64,
    rests: bool,
}

const RADIUS: f64 = 0.3;

impl Trial {
    /// A sphere of `count` particles, 1 kg in all, that moves as said.
    ///
    /// # Errors
    /// What the world says of it.
    pub fn new(
        count: usize,
        motion: Motion,
        integrator: Integrator,
    ) -> Result<Self, Box<dyn std::error::Error>> {
        let places = fibonacci_sphere(count, RADIUS);
        let shape = Shape::from_particles(&places)?;
        let mass = 1.0;
        let rests = !matches!(motion, Motion::Flight | Motion::Bouncing);
        let cap = RADIUS * (1.0 - 0.114);
        let depths: f64 = places.iter().map(|p| (-p.y - cap).max(0.0)).sum();
        let stiffness =
            if rests && depths > 0.0 { 9.8 * mass / depths } else { 1e4 / count as f64 };
        let damped = matches!(motion, Motion::DampedRest | Motion::RoughRest);
        let material = Material {
            collision_stiffness: stiffness,
            damping: if damped { Damping::Restitution(0.5) } else { Damping::Dashpot(0.0) },
            friction_stiffness: if motion == Motion::RoughRest { 0.5 } else { 0.0 },
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
        let restart = if motion == Motion::Bouncing { 3000 } else { u64::MAX };
        Ok(Self { world, restart, rests })
    }

    /// Times one step of the loop as compiled, of the loop in vectors, and of the world (s), in turns.
    ///
    /// # Errors
    /// When a step fails, or a body that is to rest does not.
    pub fn measure(&mut self) -> Result<[f64; 3], Box<dyn std::error::Error>> {
        let mut failed = Ok(());
        let mut compiled = looped(PlainLoop::of(&self.world, Style::Compiled), self.restart);
        let mut vectors = looped(PlainLoop::of(&self.world, Style::Vectors), self.restart);
        let (world, restart) = (&mut self.world, self.restart);
        let start = world.state().clone();
        let mut stepped = |steps: u64| {
            for _ in 0..steps {
                let stepped = world.step();
                if failed.is_ok() {
                    failed = stepped.map_err(|error| error.to_string());
                }
                if world.state().step % restart == 0 {
                    // it was a state of this world before
                    let _ = world.restore(start.clone());
                }
            }
        };
        let times = side_by_side([&mut compiled, &mut vectors, &mut stepped]);
        failed?;
        if self.rests && self.world.energy().elastic == 0.0 {
            return Err("the body has left the floor".into());
        }
        Ok(times)
    }

    /// The world, as it is now.
    pub fn world(&self) -> &World {
        &self.world
    }
}

/// The loop, from the start again every `restart` steps.
fn looped(mut plain: PlainLoop, restart: u64) -> impl FnMut(u64) {
    let (start, mut done) = (plain.state, 0);
    move |steps| {
        for _ in 0..steps {
            plain.step();
            done += 1;
            if done % restart == 0 {
                plain.state = start;
            }
        }
    }
}
