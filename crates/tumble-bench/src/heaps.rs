//! Heaps of clumps at rest in several sizes: time and memory per body, and the speedup of a second thread.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};
use tumble::{
    Body, BodyState, DMat3, DQuat, DVec3, Damping, Integrator, Material, Mesh, Shape, State,
    Surface, WallBox, World,
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
/// Simulated time for which tiles, side by side, come to rest again (s): the walls that they rested on have gone.
const TILED_SETTLING_TIME: f64 = 0.8;
/// Their integrator and its time step (s), the quickest of all.
const TILED_SETTLING: Method = (Integrator::Implicit, 1.0 / 240.0);
/// The integrators that are measured, and their time steps (s).
const METHODS: [Method; 2] = [(Integrator::Splitting, 1e-4), (Integrator::Implicit, 1e-3)];
/// Untimed steps of a new world, which starts without friction springs; `implicit` divides the first ones.
const FIRST_STEPS: usize = 100;
/// Number of rounds of each measurement.
const ROUNDS: usize = 9;
/// Minimum number of body-steps per turn.
const BODY_STEPS_PER_TURN: usize = 200_000;

/// An integrator and its time step (s).
type Method = (Integrator, f64);

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
    for &tiles in tile_counts {
        heaps.extend(heaps_of_size(&tile, tiles, &pools[1])?);
    }
    // the sizes of one integrator together
    heaps.sort_by_key(|heap| heap.integrator == Integrator::Implicit);
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
    /// Every measurement starts from this state: the iterations of a solver become fewer while a heap comes to rest, and
    /// large heaps are measured for fewer steps.
    start: State,
    iterations_per_step: f64,
    one_thread: Vec<f64>,
    two_threads: Vec<f64>,
    speedup: Vec<f64>,
}

impl Heap {
    fn new(
        bodies: &[BodyState],
        edges: DVec3,
        method: Method,
        pool: &ThreadPool,
    ) -> Result<Self, Box<dyn Error>> {
        let mut world = clump_world(bodies, edges, method)?;
        time_steps(&mut world, FIRST_STEPS, pool)?;
        let start = world.state().clone();
        let [one_thread, two_threads, speedup] = [const { Vec::new() }; 3];
        let integrator = method.0;
        Ok(Self {
            world,
            integrator,
            memory: f64::NAN,
            start,
            iterations_per_step: f64::NAN,
            one_thread,
            two_threads,
            speedup,
        })
    }

    /// Times some steps on one thread, then the same steps on two.
    fn measure(&mut self, pools: &[ThreadPool; 2]) -> Result<(), Box<dyn Error>> {
        let one = self.time_from_start(&pools[0])?;
        let two = self.time_from_start(&pools[1])?;
        self.one_thread.push(one);
        self.two_threads.push(two);
        self.speedup.push(one / two);
        Ok(())
    }

    /// Wall-clock time per clump and step (ns).
    fn time_from_start(&mut self, pool: &ThreadPool) -> Result<f64, Box<dyn Error>> {
        let steps = (BODY_STEPS_PER_TURN / self.world.body_count()).max(2);
        self.world.restore(self.start.clone())?;
        // the first step collects the neighbours again
        time_steps(&mut self.world, 1, pool)?;
        let iterations = self.world.state().totals.iterations;
        let time = time_steps(&mut self.world, steps, pool)?;
        let iterations = self.world.state().totals.iterations - iterations;
        if self.integrator == Integrator::Implicit {
            self.iterations_per_step = iterations as f64 / steps as f64;
        }
        Ok(time)
    }

    fn cost(self) -> HeapCost {
        let (clumps, state) = (self.world.body_count(), self.world.state());
        HeapCost {
            integrator: self.integrator,
            dt: self.world.dt(),
            clumps,
            springs_per_clump: state.pair_springs.len() as f64 / clumps as f64,
            one_thread: median(self.one_thread),
            two_threads: median(self.two_threads),
            speedup: median(self.speedup),
            iterations_per_step: self.iterations_per_step,
            memory_per_clump: self.memory / clumps as f64,
        }
    }
}

/// Copies of the tile at rest, a heap for each of [`METHODS`].
fn heaps_of_size(
    tile: &[BodyState],
    tiles: usize,
    pool: &ThreadPool,
) -> Result<Vec<Heap>, Box<dyn Error>> {
    let (bodies, edges) = tiled(tile, tiles);
    let before = resident_memory();
    let mut explicit = clump_world(&bodies, edges, METHODS[0])?;
    time_steps(&mut explicit, 2, pool)?;
    let between = resident_memory();
    let mut settling = clump_world(&bodies, edges, TILED_SETTLING)?;
    settle(&mut settling, TILED_SETTLING_TIME, pool)?;
    let memory = [between - before, resident_memory() - between];
    let bodies = settling.state().bodies.clone();
    drop((explicit, settling));
    let mut heaps = Vec::new();
    for (method, memory) in METHODS.into_iter().zip(memory) {
        let mut heap = Heap::new(&bodies, edges, method, pool)?;
        // a heap of one tile reuses the memory that the tile itself has freed
        heap.memory = if tiles > 1 { memory } else { f64::NAN };
        heaps.push(heap);
    }
    Ok(heaps)
}

/// Takes steps for a simulated time (s).
fn settle(world: &mut World, time: f64, pool: &ThreadPool) -> Result<(), Box<dyn Error>> {
    let steps = (time / world.dt()).round() as usize;
    time_steps(world, steps, pool)?;
    Ok(())
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
    let mut world = clump_world(&start, DVec3::ONE, METHODS[0])?;
    settle(&mut world, SETTLING_TIME, pool)?;
    Ok(world.state().bodies.clone())
}

/// The bodies of copies of the tile, side by side in rows, and the edges of their box in units of the width of a tile.
fn tiled(tile: &[BodyState], tiles: usize) -> (Vec<BodyState>, DVec3) {
    // no empty cell, into which the heap would flow
    let columns = (1..=tiles).rfind(|n| tiles.is_multiple_of(*n) && n * n <= tiles).unwrap_or(1);
    let width = TILE_EDGE as f64 * SPACING;
    let cell =
        |number: usize| DVec3::new((number % columns) as f64, 0.0, (number / columns) as f64);
    let bodies = (0..tiles).flat_map(|number| {
        let offset = cell(number) * width;
        tile.iter().map(move |body| BodyState { position: body.position + offset, ..*body })
    });
    (bodies.collect(), DVec3::new(columns as f64, 1.0, (tiles / columns) as f64))
}

/// Clumps in a box that is open at the top. `edges` are its edge lengths in units of the width of a tile.
fn clump_world(
    bodies: &[BodyState],
    edges: DVec3,
    (integrator, dt): Method,
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
