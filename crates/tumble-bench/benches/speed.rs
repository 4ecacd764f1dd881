//! `cargo bench`: what `docs/benchmarks.md` is made of, as Markdown on standard output.

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use tumble::{Integrator, MassModel, Mesh, Sampling, Shape};
use tumble_bench::{Motion, Trial, machine, sphere_mesh, wall_seconds};

type Outcome = Result<(), Box<dyn Error>>;

fn main() -> Outcome {
    // `cargo test --benches` is no time to measure
    if !std::env::args().any(|arg| arg == "--bench") {
        return Ok(());
    }
    println!("{}\n", machine());
    steps()?;
    preparation()?;
    runs()
}

fn steps() -> Outcome {
    println!("## One step of one body\n");
    println!(
        "| particles | motion | integrator | loop, compiled (µs) | loop, vectors (µs) | tumble (µs) | compiled ÷ tumble | vectors ÷ tumble |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (count, motions) in [
        (8, [Motion::Flight, Motion::Bouncing].as_slice()),
        (42, &[Motion::Flight, Motion::Bouncing]),
        (4025, &[Motion::Flight, Motion::Bouncing, Motion::Rest, Motion::RoughRest]),
        (1_000_000, &[Motion::Flight, Motion::Rest, Motion::DampedRest, Motion::RoughRest]),
    ] {
        for &motion in motions {
            for integrator in [Integrator::Euler, Integrator::Splitting] {
                let times = Trial::new(count, motion, integrator)?.measure()?;
                let [compiled, vectors, tumble] = times.map(|seconds| seconds * 1e6);
                println!(
                    "| {count} | {} | {} | {} | {} | {} | {} | {} |",
                    motion.name(),
                    integrator.name(),
                    short(compiled),
                    short(vectors),
                    short(tumble),
                    short(compiled / tumble),
                    short(vectors / tumble),
                );
            }
        }
    }
    println!();
    Ok(())
}

fn preparation() -> Outcome {
    println!("## Before the first step\n\n| what | measured |\n|---|---|");
    let mesh = sphere_mesh(1000);
    let count = mesh.vertices.len();
    let start = Instant::now();
    let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Particles)?;
    let seconds = start.elapsed().as_secs_f64();
    println!("| shape of {count} particles: mass, principal axes, tree (s) | {} |", short(seconds));
    let particles = shape.particles();
    let start = Instant::now();
    let again = tumble::Particles::new(particles.iter());
    let seconds = start.elapsed().as_secs_f64();
    println!("| of that, the tree (s) | {} |", short(seconds));
    let per_particle = again.memory() as f64 / count as f64;
    println!("| particles and tree, bytes a particle | {} |", short(per_particle));
    let surface = shape.surface();
    let drawn = surface.vertices.len() * size_of::<tumble::DVec3>()
        + surface.triangles.len() * size_of::<[u32; 3]>();
    let all = per_particle + drawn as f64 / count as f64;
    println!("| with the mesh of two triangles a particle to draw | {} |", short(all));
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("sphere.obj");
    write_obj(&mesh, &path)?;
    let start = Instant::now();
    let file = tumble_io::mesh::read_mesh(&path, None)?;
    let seconds = start.elapsed().as_secs_f64();
    let vertices = file.mesh.vertices.len();
    println!(
        "| reading an OBJ of {vertices} vertices, two triangles each (s) | {} |\n",
        short(seconds)
    );
    Ok(())
}

fn write_obj(mesh: &Mesh, path: &Path) -> Outcome {
    let mut out = std::io::BufWriter::new(std::fs::File::create(path)?);
    for v in &mesh.vertices {
        writeln!(out, "v {:.9} {:.9} {:.9}", v.x, v.y, v.z)?;
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    Ok(out.flush()?)
}

fn runs() -> Outcome {
    println!("## Long runs, with all their files\n");
    println!("| scene | steps | frames | stepping (s) | everything (s) | stepping ÷ everything |");
    println!("|---|---|---|---|---|---|");
    for (scene, duration) in [("racket", 4000.0), ("task2", 4000.0), ("task2-cat", 3000.0)] {
        let run = wall_seconds(scene, duration)?;
        println!(
            "| {scene} | {} | {} | {} | {} | {} |",
            run.steps,
            run.frames,
            short(run.stepping),
            short(run.everything),
            short(run.stepping / run.everything),
        );
    }
    Ok(())
}

/// Three digits.
fn short(value: f64) -> String {
    let digits = (2 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.digits$}")
}
