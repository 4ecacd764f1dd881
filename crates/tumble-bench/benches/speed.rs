//! `cargo bench --bench speed`: steps of one body, preparation and complete runs; writes Markdown to standard output.

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use tumble::{Integrator, MassModel, Mesh, Sampling, Shape};
use tumble_bench::{Motion, SingleBodyBenchmark, describe_machine, sphere_mesh, time_run};

type BenchResult = Result<(), Box<dyn Error>>;

fn main() -> BenchResult {
    // do not measure under `cargo test --benches`
    if !std::env::args().any(|arg| arg == "--bench") {
        return Ok(());
    }
    println!("{}\n", describe_machine());
    benchmark_steps()?;
    benchmark_preparation()?;
    benchmark_runs()
}

fn benchmark_steps() -> BenchResult {
    println!("## One step of one body\n");
    println!(
        "| particles | motion | integrator | loop, compiled (µs) | loop, vectors (µs) | tumble (µs) | compiled ÷ tumble | vectors ÷ tumble |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (count, motions) in [
        (8, [Motion::Flight, Motion::Bouncing].as_slice()),
        (42, &[Motion::Flight, Motion::Bouncing]),
        (4025, &[Motion::Flight, Motion::Bouncing, Motion::Rest, Motion::RestWithFriction]),
        (
            1_000_000,
            &[Motion::Flight, Motion::Rest, Motion::RestWithDashpots, Motion::RestWithFriction],
        ),
    ] {
        for &motion in motions {
            for integrator in [Integrator::Euler, Integrator::Splitting] {
                let times = SingleBodyBenchmark::new(count, motion, integrator)?.measure()?;
                let [compiled, vectors, tumble] = times.map(|seconds| seconds * 1e6);
                println!(
                    "| {count} | {} | {} | {} | {} | {} | {} | {} |",
                    motion.name(),
                    integrator.name(),
                    three_digits(compiled),
                    three_digits(vectors),
                    three_digits(tumble),
                    three_digits(compiled / tumble),
                    three_digits(vectors / tumble),
                );
            }
        }
    }
    println!();
    Ok(())
}

fn benchmark_preparation() -> BenchResult {
    println!("## Before the first step\n\n| what | measured |\n|---|---|");
    let mesh = sphere_mesh(1000);
    let count = mesh.vertices.len();
    let start = Instant::now();
    let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Particles)?;
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "| shape of {count} particles: mass, principal axes, tree (s) | {} |",
        three_digits(seconds)
    );
    let particles = shape.particles();
    let start = Instant::now();
    let rebuilt = tumble::Particles::new(particles.iter());
    let seconds = start.elapsed().as_secs_f64();
    println!("| of that, the tree (s) | {} |", three_digits(seconds));
    let per_particle = rebuilt.memory() as f64 / count as f64;
    println!("| particles and tree, bytes per particle | {} |", three_digits(per_particle));
    let surface = shape.surface();
    let mesh_bytes = surface.vertices.len() * size_of::<tumble::DVec3>()
        + surface.triangles.len() * size_of::<[u32; 3]>();
    let total = per_particle + mesh_bytes as f64 / count as f64;
    println!(
        "| with the surface mesh for drawing, two triangles per particle | {} |",
        three_digits(total)
    );
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("sphere.obj");
    write_obj(&mesh, &path)?;
    let start = Instant::now();
    let file = tumble_io::mesh::read_mesh(&path, None)?;
    let seconds = start.elapsed().as_secs_f64();
    let vertices = file.mesh.vertices.len();
    println!(
        "| reading an OBJ of {vertices} vertices, two triangles per vertex (s) | {} |\n",
        three_digits(seconds)
    );
    Ok(())
}

fn write_obj(mesh: &Mesh, path: &Path) -> BenchResult {
    let mut out = std::io::BufWriter::new(std::fs::File::create(path)?);
    for v in &mesh.vertices {
        writeln!(out, "v {:.9} {:.9} {:.9}", v.x, v.y, v.z)?;
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    Ok(out.flush()?)
}

fn benchmark_runs() -> BenchResult {
    println!("## Long runs, output files included\n");
    println!("| scene | steps | frames | stepping (s) | total (s) | stepping ÷ total |");
    println!("|---|---|---|---|---|---|");
    for (scene, duration) in [("racket", 4000.0), ("task2", 4000.0), ("task2-cat", 3000.0)] {
        let run = time_run(scene, duration)?;
        println!(
            "| {scene} | {} | {} | {} | {} | {} |",
            run.steps,
            run.frames,
            three_digits(run.stepping),
            three_digits(run.total),
            three_digits(run.stepping / run.total),
        );
    }
    Ok(())
}

/// Formats a number with three significant digits.
fn three_digits(value: f64) -> String {
    let digits = (2 - value.abs().max(1e-9).log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.digits$}")
}
