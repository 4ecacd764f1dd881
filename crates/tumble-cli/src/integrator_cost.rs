//! What a simulated second costs with an integrator: measured, in a bounded time.

use std::time::{Duration, Instant};

use tumble::Integrator;
use tumble_io::scene::{Scene, load_with_integrator};

/// The longest time of a measurement; the step that exceeds it is the last one.
const LONGEST: Duration = Duration::from_millis(700);

/// The cost of the first steps of a scene.
#[derive(Clone, Debug)]
pub struct Cost {
    /// Number of steps.
    pub steps: usize,
    /// Simulated time (s).
    pub simulated: f64,
    /// Time on the clock (s).
    pub clock: f64,
    /// Why the simulation stopped, if it failed.
    pub failure: Option<String>,
}

impl Cost {
    /// Seconds on the clock for each simulated second.
    pub fn seconds_per_second(&self) -> f64 {
        self.clock / self.simulated
    }
}

/// Runs a scene with another integrator and step, for its duration or for [`LONGEST`].
///
/// # Errors
/// Why it cannot run so.
pub fn measure(scene: &Scene, integrator: Integrator, dt: f64) -> Result<Cost, String> {
    let loaded = load_with_integrator(scene, integrator, dt);
    let mut world = loaded.map_err(|error| error.messages().join("; "))?.world;
    let start = Instant::now();
    let (mut steps, mut failure) = (0, None);
    while world.time() < scene.duration && start.elapsed() < LONGEST {
        if let Err(error) = world.step() {
            failure = Some(error.to_string());
            break;
        }
        steps += 1;
    }
    let (simulated, clock) = (world.time(), start.elapsed().as_secs_f64());
    if steps == 0 {
        return Err(failure.unwrap_or_else(|| "no step was taken".to_owned()));
    }
    Ok(Cost { steps, simulated, clock, failure })
}
