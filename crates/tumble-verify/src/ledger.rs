//! The account of every joule on every built-in scene.

use tumble::{Integrator, Surface};
use tumble_io::scene::{BUILTIN, LoadOptions, load_builtin};

use crate::check::{Case, Check, Outcome};

pub(crate) const SCENES: Case = Case {
    name: "ledger",
    about: "every built-in scene: kinetic, gravitational and elastic energy and all losses add up; less well under \
            the basic system's euler, whose rotation gains energy",
    run: scenes,
    slow: true,
};

fn scenes() -> Outcome {
    let mut checks = Vec::new();
    for scene in BUILTIN {
        let Some(loaded) = load_builtin(scene.name, &LoadOptions::default()) else { continue };
        let loaded = loaded?;
        let many = loaded.scene.bodies.iter().any(|body| body.surface != Surface::None);
        let bound = match loaded.scene.integrator {
            Integrator::Euler => 0.5,
            // thousands of contacts begin and end within a step
            Integrator::Splitting if many => 5e-3,
            Integrator::Splitting => 1e-3,
        };
        let (steps, mut world) = (loaded.scene.step_count(), loaded.world);
        let start = world.energy();
        let (mut worst, mut in_play) = (0.0f64, start.kinetic + start.elastic);
        while world.state().step < steps {
            world.step()?;
            let energy = world.energy();
            worst = worst.max((energy.total() - start.total()).abs());
            // what contacts have turned into heat went through them once, too: a drum turns over far more
            // than its grains ever have at a time
            let lost = if many { energy.drag + energy.dashpot + energy.slip } else { 0.0 };
            in_play = in_play.max(energy.kinetic + energy.elastic).max(lost);
        }
        let relative = worst / in_play;
        let quantity = format!("residual of {}, relative", scene.name);
        checks.push(Check::error(quantity, relative, bound, ""));
    }
    Ok(checks)
}
