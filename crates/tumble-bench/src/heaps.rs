//! Heaps of clumps at rest in several sizes: time and memory per body, and the speedup of a second thread.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};
use tumble::{
    Body, BodyState, DMat3, DQuat, DVec3, Damping, Integrator, Material, Mesh, Shape, Surface, WallBox,
    World,
};

use crate::timing::median;

/// Radius of the spheres of a clump (m). Eight of them sit on the corners of a cube; each touches three others.
const RADIUS: f64 = 0.05;
/// Mass of a clump (kg) at a density of 1000 kg/m³.
const MASS: f64 = 8000.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS * RADIUS * RADIUS;
/// Distance between neighbouring clumps of the initial lattice (m).
const SPACING: f64 = 0.28;
/// Clumps along each edge of the initial lattice of a tile, the heap that larger heaps are tiled from.
const TILE_EDGE: usize = 10;
/// Simulated time after which a tile is at rest (s).
const SETTLING_TIME: f64 = 2.0;
/// The integrators and their time steps (s). The first one lets the tile come to rest.
const METHODS: [(Integrator, f64); 2] = [(Integrator::Splitting, 1e-4), (Integrator::Implicit, 1e-3)];
/// Untimed steps after tiling: the tiles start at rest, but without friction springs, and `implicit` divides its first steps.
const SETTLING_STEPS: usize = 200;
/// Number of rounds of each measurement.
const ROUNDS: usize = 9;
/// Minimum number of body-steps per turn.
const BODY_STEPS_PER_TURN: usize = 200_000;

/// Time and memory per clump of a heap of one size, with one integrator.
#[derive(Clone, Copy, Debug)]
pub struct HeapCost {
    /// The integrator.
    pub integrator: Integrator,
    /// Its time step (s).
    pub dt: f64,
    /// Number of clumps.
    pub clumps: usize,
    /// Friction springs between bodies, and between spheres and walls, per clump.
    pub springs_per_clump: f64,
    /// Wall-clock time per clump and step on one thread (ns).
    pub one_thread: f64,
    /// Wall-clock time per clump and step on two threads (ns).
    pub two_threads: f64,
    /// Time on one thread over time on two; the median over the rounds.
    pub speedup: f64,
    /// Iterations of the solver in a step; NaN without a solver.
    pub iterations_per_step: f64,
    /// Memory of the world per clump (bytes); NaN if it cannot be measured.
    pub memory_per_clump: f64,
}

/// Measures heaps of `1000 * n` clumps for each `n` of `tile_counts` with each integrator, all in turns.
///
/// # Errors
/// If a world or a thread pool cannot be created, or a step fails.
pub fn measure_heaps(tile_counts: &[usize]) -> Result<Vec<HeapCost>, Box<dyn Error>> {
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = [pool(1)?, pool(2)?];
    let tile = settled_tile(&pools[1])?;
    let mut heaps = Vec::new();
    for method in METHODS {
        for &tiles in tile_counts {
            heaps.push(Heap::new(&tile, tiles, method, &pools[1])?);
        }
    }
    for _ in 0..ROUNDS {
        for heap in &mut heaps {
            heap.measure(&pools)?;
        }
    }
    Ok(heaps.into_iter().map(Heap::cost).collect())
}

/// A heap at rest and its measurements so far.
struct Heap {
    world: World,
    integrator: Integrator,
    /// Memory of the world (bytes).
    memory: f64,
    /// Steps and iterations of the solver before the first measurement.
    start: (u64, u64),
    one_thread: Vec<f64>,
    two_threads: Vec<f64>,
    speedup: Vec<f64>,
}

impl Heap {
    fn new(
        tile: &[BodyState],
        tiles: usize,
        method: (Integrator, f64),
        pool: &ThreadPool,
    ) -> Result<Self, Box<dyn Error>> {
        let before = resident_memory();
        let mut world = tiled_world(tile, tiles, method)?;
        time_steps(&mut world, SETTLING_STEPS, pool)?;
        // a heap of one tile reuses the memory that the tile itself has freed
        let memory = if tiles > 1 { resident_memory() - before } else { f64::NAN };
        let start = (world.state().step, world.state().totals.iterations);
        let [one_thread, two_threads, speedup] = [const { Vec::new() }; 3];
        let integrator = method.0;
        Ok(Self { world, integrator, memory, start, one_thread, two_threads, speedup })
    }

    /// Times some steps on one thread, then as many on two.
    fn measure(&mut self, pools: &[ThreadPool; 2]) -> Result<(), Box<dyn Error>> {
        let steps = (BODY_STEPS_PER_TURN / self.world.body_count()).max(2);
        let one = time_steps(&mut self.world, steps, &pools[0])?;
        let two = time_steps(&mut self.world, steps, &pools[1])?;
        self.one_thread.push(one);
        self.two_threads.push(two);
        self.speedup.push(one / two);
        Ok(())
    }

    fn cost(self) -> HeapCost {
        let (clumps, state) = (self.world.body_count(), self.world.state());
        let steps = (state.step - self.start.0) as f64;
        let iterations = (state.totals.iterations - self.start.1) as f64 / steps;
        let has_solver = self.integrator == Integrator::Implicit;
        HeapCost {
            integrator: self.integrator,
            dt: self.world.dt(),
            clumps,
            springs_per_clump: state.pair_springs.len() as f64 / clumps as f64,
            one_thread: median(self.one_thread),
            two_threads: median(self.two_threads),
            speedup: median(self.speedup),
            iterations_per_step: if has_solver { iterations } else { f64::NAN },
            memory_per_clump: self.memory / clumps as f64,
        }
    }
}

/// Takes `steps` steps; returns the wall-clock time per body and step (ns).
fn time_steps(world: &mut World, steps: usize, pool: &ThreadPool) -> Result<f64, Box<dyn Error>> {
    let start = Instant::now();
    pool.install(|| (0..steps).try_for_each(|_| world.step()))?;
    Ok(1e9 * start.elapsed().as_secs_f64() / (steps * world.body_count()) as f64)
}

/// The bodies of a heap of 1000 clumps at rest.
fn settled_tile(pool: &ThreadPool) -> Result<Vec<BodyState>, Box<dyn Error>> {
    let mut start = Vec::new();
    for number in 0..TILE_EDGE.pow(3) {
        let cell =
            [number % TILE_EDGE, number / TILE_EDGE % TILE_EDGE, number / TILE_EDGE / TILE_EDGE];
        let position = DVec3::from_array(cell.map(|i| (i as f64 + 0.5) * SPACING));
        // quasi-random orientations from an additive recurrence
        let components =
            [0.0, 1.0, 2.0, 3.0].map(|k| ((number + 1) as f64 * (0.6180339887 + 0.1 * k)).sin());
        let orientation = DQuat::from_array(components).normalize();
        start.push(BodyState { position, orientation, ..BodyState::default() });
    }
    let mut world = clump_world(start.into_iter(), DVec3::ONE, METHODS[0])?;
    time_steps(&mut world, (SETTLING_TIME / world.dt()) as usize, pool)?;
    Ok(world.state().bodies.clone())
}

/// A world of copies of the tile, side by side in rows.
fn tiled_world(
    tile: &[BodyState],
    tiles: usize,
    method: (Integrator, f64),
) -> Result<World, Box<dyn Error>> {
    let columns = (tiles as f64).sqrt().ceil() as usize;
    let width = TILE_EDGE as f64 * SPACING;
    let cell =
        |number: usize| DVec3::new((number % columns) as f64, 0.0, (number / columns) as f64);
    let bodies = (0..tiles).flat_map(|number| {
        let offset = cell(number) * width;
        tile.iter().map(move |body| BodyState { position: body.position + offset, ..*body })
    });
    let rows = tiles.div_ceil(columns);
    clump_world(bodies, DVec3::new(columns as f64, 1.0, rows as f64), method)
}

/// Clumps in a box that is open at the top. `edges` are its edge lengths in units of the width of a tile.
fn clump_world(
    bodies: impl Iterator<Item = BodyState>,
    edges: DVec3,
    (integrator, dt): (Integrator, f64),
) -> Result<World, Box<dyn Error>> {
    let corners = [-RADIUS, RADIUS];
    let corners: Vec<DVec3> =
        (0..8).map(|i| DVec3::new(corners[i & 1], corners[i >> 1 & 1], corners[i >> 2])).collect();
    // per unit mass: 2 R² from the positions of the spheres and 2/5 R² from each sphere about its centre
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
    let walls = WallBox {
        min: DVec3::ZERO,
        max: edges * (TILE_EDGE as f64 * SPACING),
        orientation: DQuat::IDENTITY,
        open: [false, false, false, true, false, false],
    };
    let builder = World::builder().dt(dt).integrator(integrator);
    let mut builder = builder.material(material).box_walls(&walls);
    for state in bodies {
        let body = Body::new(shape.clone()).mass(MASS).surface(Surface::Spheres { radius: RADIUS });
        let body = body.position(state.position).orientation(state.orientation);
        builder = builder.body(body);
    }
    Ok(builder.build()?)
}

/// Resident memory of this process (bytes); NaN if the system does not report it.
fn resident_memory() -> f64 {
    let pages = || {
        let text = std::fs::read_to_string("/proc/self/statm").ok()?;
        text.split_whitespace().nth(1)?.parse::<f64>().ok()
    };
    pages().map_or(f64::NAN, |pages| pages * rustix::param::page_size() as f64)
}
