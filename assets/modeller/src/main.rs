//! Models the meshes under `assets/`: a sitting cat.
//!
//! `cargo run -p tumble-modeller` writes `assets/cat.obj`; the same bytes on every machine, since
//! only basic arithmetic, square roots and the `libm` crate are used.

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

  --out FILE  where to write the mesh (default: assets/cat.obj of this source tree)
  --check     write nothing; fail if FILE differs from what would be written";

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

/// Follows the command line and says what it did.
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
    let mesh = model(&solid)?;
    let text = obj::write(&mesh, &solid);
    let counts = format!(
        "{} vertices, {} triangles, volume {:.4}",
        mesh.points.len(),
        mesh.triangles.len(),
        mesh.volume()
    );
    if check {
        let found = std::fs::read_to_string(&out).map_err(|error| format!("{out}: {error}"))?;
        if found != text {
            return Err(format!("{out} differs from the model: run cargo run -p tumble-modeller"));
        }
        return Ok(format!("{out} is up to date: {counts}"));
    }
    std::fs::write(&out, text).map_err(|error| format!("{out}: {error}"))?;
    Ok(format!("{out}: {counts}"))
}

/// The finished mesh of the cat: two units tall, centred on its bounding box.
fn model(solid: &Solid) -> Result<Mesh, String> {
    let (low, high) = (DVec3::new(-1.0, -0.1, -1.1), DVec3::new(1.0, 2.3, 1.1));
    let mut mesh = polygonise::polygonise(solid, low, high, 0.03);
    remesh::remesh(&mut mesh, solid, cat::spacing)?;
    mesh.fit(2.0);
    Ok(mesh)
}
