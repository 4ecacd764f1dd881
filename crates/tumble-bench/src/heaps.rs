//! Heaps of clumps at rest, from small to large: what a body costs whatever their number, and what a second thread brings.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};
use tumble::{
    Body, BodyState, DMat3, DQuat, DVec3, Damping, Material, Mesh, Shape, Surface, WallBox, World,
};

use crate::rounds::median;

/// Radius of a sphere of a clump: eight of them on the corners of a cube, each touching three others (m).
const RADIUS: f64 = 0.05;
/// 1000 kg/m³.
const MASS: f64 = 8000.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS * RADIUS * RADIUS;
/// Distance of two clumps at the start (m).
const PITCH: f64 = 0.28;
/// Clumps along an edge at the start of the heap that larger ones are put together of.
const EDGE: usize = 10;
/// Until then that heap has come to rest (s).
const SETTLED: f64 = 2.0;
const DT: f64 = 1e-4;
/// Steps after heaps are put side by side, at rest and without friction springs, until they are timed.
const SETTLING: usize = 100;
const ROUNDS: usize = 9;
/// Body-steps of a turn, at least.
const TURN: usize = 200_000;

/// What heaps of one size cost.
#[derive(Clone, Copy, Debug)]
pub struct HeapCost {
    /// How many clumps there are.
    pub clumps: usize,
    /// Friction springs between bodies, and between bodies and walls, a clump.
    pub springs: f64,
    /// Time a clump and step, on one thread (ns).
    pub alone: f64,
    /// The same on two.
    pub together: f64,
    /// How much faster two threads are: the median of the rounds.
    pub gain: f64,
    /// Memory that the world took, a clump (bytes); NaN where that cannot be told.
    pub memory: f64,
}

/// Measures heaps of 1000 clumps times each of `tiles`, all in turns.
///
/// # Errors
/// What a world or a pool of threads could not be made of.
pub fn heaps(tiles: &[usize]) -> Result<Vec<HeapCost>, Box<dyn Error>> {
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = [pool(1)?, pool(2)?];
    let tile = settled(&pools[1])?;
    let mut worlds = Vec::new();
    for &tiles in tiles {
        let before = memory();
        let mut world = tiled(&tile, tiles)?;
        step(&mut world, SETTLING, &pools[1])?;
        // a small heap is made of what the first one has left
        worlds.push((world, if tiles > 1 { memory() - before } else { f64::NAN }));
    }
    let mut times = vec![[const { Vec::new() }; 3]; worlds.len()];
    for _ in 0..ROUNDS {
        for ((world, _), [alone, together, gain]) in worlds.iter_mut().zip(&mut times) {
            let steps = (TURN / world.body_count()).max(2);
            let [one, two] = [step(world, steps, &pools[0])?, step(world, steps, &pools[1])?];
            alone.push(one);
            together.push(two);
            gain.push(one / two);
        }
    }
    let costs = worlds.iter().zip(times).map(|((world, memory), [alone, together, gain])| {
        let clumps = world.body_count();
        HeapCost {
            clumps,
            springs: world.state().pair_springs.len() as f64 / clumps as f64,
            alone: median(alone),
            together: median(together),
            gain: median(gain),
            memory: memory / clumps as f64,
        }
    });
    Ok(costs.collect())
}

/// Steps a world; returns the time a body and step (ns).
fn step(world: &mut World, steps: usize, pool: &ThreadPool) -> Result<f64, Box<dyn Error>> {
    let start = Instant::now();
    pool.install(|| (0..steps).try_for_each(|_| world.step()))?;
    Ok(1e9 * start.elapsed().as_secs_f64() / (steps * world.body_count()) as f64)
}

/// The bodies of a heap of 1000 clumps that has come to rest.
fn settled(pool: &ThreadPool) -> Result<Vec<BodyState>, Box<dyn Error>> {
    let mut start = Vec::new();
    for number in 0..EDGE * EDGE * EDGE {
        let cell = [number % EDGE, number / EDGE % EDGE, number / EDGE / EDGE];
        let position = DVec3::from_array(cell.map(|i| (i as f64 + 0.5) * PITCH));
        // turned at random, by an additive sequence
        let turn =
            [0.0, 1.0, 2.0, 3.0].map(|k| ((number + 1) as f64 * (0.6180339887 + 0.1 * k)).sin());
        let orientation = DQuat::from_array(turn).normalize();
        start.push(BodyState { position, orientation, ..BodyState::default() });
    }
    let mut world = world(start.into_iter(), DVec3::new(1.0, 1.0, 1.0))?;
    step(&mut world, (SETTLED / DT) as usize, pool)?;
    Ok(world.state().bodies.clone())
}

/// Heaps side by side, in rows.
fn tiled(tile: &[BodyState], tiles: usize) -> Result<World, Box<dyn Error>> {
    let across = (tiles as f64).sqrt().ceil() as usize;
    let width = EDGE as f64 * PITCH;
    let place = |number: usize| DVec3::new((number % across) as f64, 0.0, (number / across) as f64);
    let bodies = (0..tiles).flat_map(|number| {
        let way = place(number) * width;
        tile.iter().map(move |body| BodyState { position: body.position + way, ..*body })
    });
    let rows = tiles.div_ceil(across);
    world(bodies, DVec3::new(across as f64, 1.0, rows as f64))
}

/// Clumps in a box that is open at the top, its edges in units of that of the smallest heap.
fn world(bodies: impl Iterator<Item = BodyState>, edges: DVec3) -> Result<World, Box<dyn Error>> {
    let corners = [-RADIUS, RADIUS];
    let corners: Vec<DVec3> =
        (0..8).map(|i| DVec3::new(corners[i & 1], corners[i >> 1 & 1], corners[i >> 2])).collect();
    // of a unit of mass: 2 R² for where a sphere is, 2/5 R² for the sphere itself
    let inertia = DMat3::IDENTITY * (2.4 * RADIUS * RADIUS);
    let shape = Shape::from_distribution(&corners, Mesh::default(), DVec3::ZERO, inertia)?;
    let shape = Arc::new(shape);
    let material = Material {
        collision_stiffness: 1e6,
        damping: Damping::Dashpot(150.0 * MASS),
        friction_stiffness: 0.5,
        friction_damping: Some(75.0 * MASS),
        ..Material::default()
    };
    let mut builder = World::builder().dt(DT).material(material).box_walls(&WallBox {
        min: DVec3::ZERO,
        max: edges * (EDGE as f64 * PITCH),
        orientation: DQuat::IDENTITY,
        open: [false, false, false, true, false, false],
    });
    for state in bodies {
        let body = Body::new(shape.clone()).mass(MASS).surface(Surface::Spheres { radius: RADIUS });
        let body = body.position(state.position).orientation(state.orientation);
        builder = builder.body(body);
    }
    Ok(builder.build()?)
}

/// Memory in use by this process (bytes); NaN where the system does not tell.
fn memory() -> f64 {
    let pages = || {
        let text = std::fs::read_to_string("/proc/self/statm").ok()?;
        text.split_whitespace().nth(1)?.parse::<f64>().ok()
    };
    pages().map_or(f64::NAN, |pages| pages * rustix::param::page_size() as f64)
}
