//! The energy ledger of a tumbling box as an SVG chart on standard output:
//!
//!     cargo run --release --example energy_plot > energy.svg
//!
//! A box falls onto a slope with dashpots and friction. What it loses in height and speed appears in the columns of
//! the ledger, so that their sum stays what it was.

use tumble::{
    Body, DQuat, DVec3, Damping, Energy, MassModel, Material, Primitive, Sampling, Shape,
    WallPlane, World,
};

const WIDTH: f64 = 720.0; // px
const HEIGHT: f64 = 400.0; // px
const DURATION: f64 = 1.5; // s

/// A curve of the chart: its name, its colour and how to read it from the ledger.
type Curve = (&'static str, &'static str, fn(&Energy) -> f64);

const CURVES: [Curve; 6] = [
    ("kinetic", "#1f77b4", |e| e.kinetic),
    ("gravitational", "#2ca02c", |e| e.gravitational),
    ("elastic", "#9467bd", |e| e.elastic),
    ("lost to dashpots", "#ff7f0e", |e| e.dashpot),
    ("lost to friction", "#8c564b", |e| e.slip),
    ("total", "#000000", Energy::total),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let size = DVec3::new(0.3, 0.2, 0.2);
    let mesh = Primitive::Box { size, divisions: 4 }.mesh()?;
    let body = Body::new(Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid)?)
        .mass(2.0)
        .position(DVec3::new(0.0, 0.5, 0.0))
        .orientation(DQuat::from_xyzw(0.1, 0.2, 0.15, 0.95));
    let material = Material {
        damping: Damping::Restitution(0.3),
        friction_stiffness: 0.5,
        ..Material::default()
    };
    let slope = WallPlane::new(DVec3::new(0.34, 0.94, 0.0), 0.0).ok_or("the wall has no normal")?;
    let mut world = World::builder().dt(1e-4).material(material).wall(slope).body(body).build()?;

    let mut ledger = vec![(0.0, world.energy())];
    while world.time() < DURATION {
        for _ in 0..50 {
            world.step()?;
        }
        ledger.push((world.time(), world.energy()));
    }

    let start = ledger[0].1.total();
    let drift = ledger.iter().map(|(_, e)| (e.total() - start).abs()).fold(0.0, f64::max);
    assert!(drift < 1e-3 * start, "the ledger does not add up: off by {drift} J of {start} J");

    let values = ledger.iter().flat_map(|(_, e)| CURVES.map(|(.., read)| read(e)));
    let (low, high) = values.fold((0.0f64, 0.0f64), |(low, high), e| (low.min(e), high.max(e)));
    println!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif">"#
    );
    println!(r#"<rect width="100%" height="100%" fill="white"/>"#);
    println!(
        r#"<text x="10" y="{}">energy from {low:.1} to {high:.1} J over {DURATION} s</text>"#,
        HEIGHT - 10.0
    );
    for (i, (name, colour, read)) in CURVES.iter().enumerate() {
        let points: String = ledger
            .iter()
            .map(|(t, e)| {
                let x = 10.0 + t / DURATION * (WIDTH - 170.0);
                let y = 20.0 + (high - read(e)) / (high - low) * (HEIGHT - 60.0);
                format!("{x:.1},{y:.1} ")
            })
            .collect();
        println!(
            r#"<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.5"/>"#
        );
        println!(
            r#"<text x="{}" y="{}" fill="{colour}">{name}</text>"#,
            WIDTH - 150.0,
            30 + 20 * i
        );
    }
    println!("</svg>");
    Ok(())
}
