//! The report on a finished run.

use std::path::Path;

use tumble_io::on_one_line;
use tumble_io::plot::EnergyRow;
use tumble_io::run::{FinishedRun, RunFolder, Summary};

use crate::format::{columns, count, number};

/// The summary of a run as two columns.
pub fn report(finished: &FinishedRun, folder: &RunFolder) -> String {
    let (s, e) = (&finished.summary, &finished.energy);
    let dissipated = e.drag + e.dashpot + e.slip + e.joint_friction;
    // gravitational energy has an arbitrary zero, so that the total is no scale for the residual
    let scale = e.kinetic + e.elastic + dissipated;
    // where nothing moves there is only rounding
    let is_rounding = s.energy_residual.abs() <= 1e-12 * (scale + e.gravitational.abs());
    let relative = if is_rounding { 0.0 } else { s.energy_residual / scale };
    let share = if relative.is_finite() {
        format!(" ({relative:+.2e} of kinetic + elastic + dissipated energy)")
    } else {
        String::new()
    };
    let mut rows = vec![
        ("scene", bodies_of(s)),
        ("integrator", integrator(s)),
        ("steps", format!("{} in {} s", steps(finished), number(s.wall_seconds))),
        ("speed", format!("{} steps/s", count(s.steps_per_second as u64))),
        (
            "time",
            format!("{} s{}", number(s.time), if s.interrupted { " (stopped early)" } else { "" }),
        ),
        ("energy", format!("{} J at the start", number(s.energy_start))),
        (
            "",
            format!(
                "{} J kinetic, {} J gravitational, {} J elastic at the end",
                number(e.kinetic),
                number(e.gravitational),
                number(e.elastic)
            ),
        ),
        ("", format!("{} J dissipated{}", number(dissipated), work(e))),
        ("residual", format!("{} J{share}", number(s.energy_residual))),
    ];
    rows.extend(solver(s).map(|text| ("solver", text)));
    rows.extend([
        ("deepest contact", format!("{} m during the run", number(s.max_depth))),
        ("", final_depths(s)),
        ("results", shown(folder.path())),
        ("animation", shown(&folder.path().join("motion.html"))),
    ]);
    rows.extend(finished.notes.iter().map(|note| ("note", note.clone())));
    let others = has_slow_contacts(&s.integrator, s.wall_seconds, s.body_depth_end);
    rows.extend(others.then(|| ("hint", compare_integrators(folder))));
    let warnings = warnings(s, relative).into_iter().chain(finished.warnings.iter().cloned());
    rows.extend(warnings.map(|warning| ("warning", warning)));
    columns(&rows)
}

/// What springs of joints hold, and what was put in, as far as there is any.
fn work(energy: &EnergyRow) -> String {
    let parts = [
        (energy.spring, "in the springs of joints"),
        (energy.motor, "put in by motors"),
        (energy.work, "put in by prescribed motions and loads"),
    ];
    let parts = parts.into_iter().filter(|(value, _)| *value != 0.0);
    parts.map(|(value, what)| format!(", {} J {what}", number(value))).collect()
}

/// Steps that take longer than this (s) are worth a comparison.
const LONG: f64 = 20.0;

/// Whether another integrator may save time: the steps took long, and bodies lie on each other at the end.
fn has_slow_contacts(integrator: &str, seconds: f64, body_depth: f64) -> bool {
    integrator == "splitting" && seconds > LONG && body_depth > 0.0
}

fn compare_integrators(folder: &RunFolder) -> String {
    let scene = shown(&folder.path().join("scene.toml"));
    format!(
        "`tumble info {scene}` measures what this would cost with `implicit`, whose steps may be longer"
    )
}

/// The path, in one line.
fn shown(path: &Path) -> String {
    on_one_line(&path.display().to_string())
}

fn bodies_of(s: &Summary) -> String {
    let plural = if s.bodies == 1 { "body" } else { "bodies" };
    let particles = if s.particles == 1 { "particle" } else { "particles" };
    let name = on_one_line(&s.scene);
    format!("{name}, {} {plural}, {} {particles}", s.bodies, count(s.particles))
}

fn integrator(s: &Summary) -> String {
    let critical = s.critical_dt.map_or(String::new(), |critical| {
        format!(", {} of the critical {} s", number(s.dt / critical), number(critical))
    });
    format!("{}, dt = {} s{critical}", s.integrator, number(s.dt))
}

/// What the implicit solver did; nothing with another integrator.
fn solver(s: &Summary) -> Option<String> {
    let solver = s.solver.as_ref()?;
    let per_step = solver.iterations as f64 / s.steps.max(1) as f64;
    let lost = if solver.energy_numerical < 0.0 { "gained by" } else { "lost to" };
    let energy = number(solver.energy_numerical.abs());
    let iterations = number(per_step);
    Some(format!("{iterations} iterations per step, {energy} J {lost} the implicit solution"))
}

/// All steps of the run and, if it was resumed, how many of them were taken now.
fn steps(finished: &FinishedRun) -> String {
    let all = count(finished.summary.steps);
    if finished.steps_here == finished.summary.steps {
        return all;
    }
    format!("{all}, the last {}", count(finished.steps_here))
}

fn final_depths(s: &Summary) -> String {
    let walls = format!("{} m with a wall", number(s.wall_depth_end));
    if s.bodies == 1 {
        return format!("{walls} at the end");
    }
    format!("{} m between bodies, {walls} at the end", number(s.body_depth_end))
}

/// Reasons not to trust the results.
fn warnings(s: &Summary, relative_residual: f64) -> Vec<String> {
    let mut warnings = Vec::new();
    let is_explicit = s.integrator != "implicit";
    if let Some(critical) = s.critical_dt.filter(|&critical| is_explicit && s.dt > critical) {
        let critical = number(critical);
        warnings.push(format!("dt is above the critical {critical} s: contacts are unstable"));
    }
    if let Some(solver) = s.solver.as_ref().filter(|solver| solver.steps_not_converged > 0) {
        let count = count(solver.steps_not_converged);
        warnings.push(format!("the solver did not converge in {count} steps: use a smaller dt"));
    }
    if relative_residual.abs() > 0.01 {
        let remedy = if s.integrator == "euler" {
            "use integrator = \"splitting\" or a smaller dt"
        } else if s.bodies == 1 {
            "use a smaller dt or set energy_tolerance"
        } else {
            "use a smaller dt"
        };
        let percent = 100.0 * relative_residual;
        warnings.push(format!("the residual is {percent:+.2} % of the energy: {remedy}"));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_long_runs_with_bodies_in_contact_get_the_hint() {
        assert!(has_slow_contacts("splitting", 100.0, 1e-6));
        let others =
            [("splitting", 5.0, 1e-6), ("splitting", 100.0, 0.0), ("implicit", 100.0, 1e-6)];
        assert!(others.iter().all(|&(name, time, depth)| !has_slow_contacts(name, time, depth)));
    }
}
