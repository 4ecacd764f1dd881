//! Models the mesh `assets/cat.obj`: a sitting cat.
//!
//! `cargo run -p tumble-modeller` writes the file. Its bytes are the same on every machine, because the program uses
//! only basic arithmetic, square roots and the `libm` crate.

mod cat;
mod mesh;
mod obj;
mod polygonise;
mod remesh;
mod solid;
#[cfg(test)]
mod tests;

use glam::DVec3;
use mesh::Mesh;
use solid::Solid;
use std::process::ExitCode;

const USAGE: &str = "usage: tumble-modeller [--out FILE] [--check]

  --out FILE  output file (default: assets/cat.obj of this source tree)
  --check     write nothing; fail if FILE differs from the model";

fn main() -> ExitCode {
    match run(std::env::args().skip(1)) {
        Ok(message) => {
            println!("{message}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// Carries out the command line; returns the message to print.
fn run(mut arguments: impl Iterator<Item = String>) -> Result<String, String> {
    let mut out = concat!(env!("CARGO_MANIFEST_DIR"), "/../cat.obj").to_string();
    let mut check = false;
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--out" => out = arguments.next().ok_or(USAGE)?,
            "--check" => check = true,
            "--help" | "-h" => return Ok(USAGE.to_string()),
            _ => return Err(format!("unknown argument {argument}\n{USAGE}")),
        }
    }

    let solid = cat::solid();
    let mesh = build_mesh(&solid)?;
    let text = obj::to_obj(&mesh, &solid);
    let counts = format!(
        "{} vertices, {} triangles, volume {:.4}",
        mesh.points.len(),
        mesh.triangles.len(),
        mesh.volume()
    );
    if check {
        let existing = std::fs::read_to_string(&out).map_err(|error| format!("{out}: {error}"))?;
        if existing != text {
            return Err(format!(
                "{out} differs from the model; `cargo run -p tumble-modeller` writes it again"
            ));
        }
        return Ok(format!("{out} is up to date: {counts}"));
    }
    std::fs::write(&out, text).map_err(|error| format!("{out}: {error}"))?;
    Ok(format!("{out}: {counts}"))
}

/// Triangulates a solid: a mesh two units tall, its bounding box centred on the origin.
fn build_mesh(solid: &Solid) -> Result<Mesh, String> {
    let (low, high) = (DVec3::new(-1.0, -0.1, -1.1), DVec3::new(1.0, 2.3, 1.1));
    let mut mesh = polygonise::polygonise(solid, low, high, 0.03);
    remesh::remesh(&mut mesh, solid, cat::spacing)?;
    mesh.scale_to_height(2.0);
    Ok(mesh)
}
