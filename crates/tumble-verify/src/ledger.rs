//! The energy ledger of every built-in scene.

use tumble::{Integrator, Surface};
use tumble_io::scene::{BUILTIN, LoadOptions, load_builtin};

use crate::check::{Case, Check, Outcome};

pub(crate) const SCENES: Case = Case {
    name: "ledger",
    description: "In every built-in scene the sum of kinetic, gravitational and elastic energy and all losses is constant. The residual is \
            relative to the largest kinetic and elastic energy of the run, or, where bodies collide, to the losses if they are \
            larger. Under `euler` it is larger, because the rotation gains energy.",
    run: scenes,
    slow: true,
};

fn scenes() -> Outcome {
    let mut checks = Vec::new();
    for scene in BUILTIN {
        let Some(loaded) = load_builtin(scene.name, &LoadOptions::default()) else { continue };
        let loaded = loaded?;
        let bodies_collide = loaded.scene.bodies.iter().any(|body| body.surface != Surface::None);
        let bound = match loaded.scene.integrator {
            Integrator::Euler => 0.5,
            // thousands of contacts begin and end within a step
            Integrator::Splitting if bodies_collide => 5e-3,
            Integrator::Splitting => 1e-3,
            Integrator::Implicit => 1e-2,
        };
        let (step_count, mut world) = (loaded.scene.step_count(), loaded.world);
        let start = world.energy();
        let (mut residual, mut scale) = (0.0f64, start.kinetic + start.elastic);
        while world.state().step < step_count {
            world.step()?;
            let energy = world.energy();
            residual = residual.max((energy.total() - start.total()).abs());
            // Energy that contacts have dissipated passed through them too. In a scene like the drum the
            // losses are far larger than the energy of the grains at any one time.
            let dissipated =
                if bodies_collide { energy.drag + energy.dashpot + energy.slip } else { 0.0 };
            scale = scale.max(energy.kinetic + energy.elastic).max(dissipated);
        }
        let quantity = format!("residual of {}, relative", scene.name);
        checks.push(Check::error(quantity, residual / scale, bound, ""));
    }
    Ok(checks)
}
