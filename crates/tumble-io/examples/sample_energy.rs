//! Draws energy charts of synthetic ledgers: `sample_energy FOLDER`.

use std::error::Error;
use std::path::Path;
use tumble_io::plot::{EnergyRow, energy_svg};

/// Ledger of a bouncing ball with drag. `scale` multiplies all energies.
fn bounce(count: usize, scale: f64, duration: f64) -> Vec<EnergyRow> {
    let row = |i: usize| {
        let fraction = i as f64 / count.max(2) as f64;
        let phase = (6.0 * fraction).fract();
        let left = 100.0 * (-1.2 * fraction).exp();
        let height = 4.0 * phase * (1.0 - phase);
        let noise = ((i * 7919 % 1000) as f64 / 500.0 - 1.0) * 1e-13;
        EnergyRow {
            time: duration * fraction,
            kinetic: scale * left * (1.0 - height),
            gravitational: scale * (left * height - 40.0),
            elastic: scale * if phase < 0.03 { 20.0 * left / 100.0 } else { 0.0 },
            drag: scale * (100.0 - left) * 0.8,
            slip: scale * (100.0 - left) * 0.2,
            dashpot: 0.0,
            numerical: 0.0,
            spring: 0.0,
            motor: 0.0,
            joint_friction: 0.0,
            work: 0.0,
            total: scale * 60.0,
            residual: scale * 100.0 * noise * fraction,
        }
    };
    (0..count).map(row).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "pictures".to_owned());
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let zeros: Vec<EnergyRow> =
        (0..100).map(|i| EnergyRow { time: f64::from(i), ..EnergyRow::default() }).collect();
    let samples = [
        ("energy", bounce(300, 1.0, 3.0)),
        ("energy-tiny", bounce(300, 1e-14, 2e-5)),
        ("energy-large", bounce(1_000_000, 3e7, 1e4)),
        ("energy-zeros", zeros),
        ("energy-one", bounce(1, 1.0, 1.0)),
        ("energy-none", Vec::new()),
    ];
    for (name, rows) in samples {
        let start = std::time::Instant::now();
        let svg = energy_svg("a ball that bounces <& loses>", &rows)?;
        println!("{name:14} {:8.2?} {} kB", start.elapsed(), svg.len() / 1024);
        std::fs::write(folder.join(format!("{name}.svg")), svg)?;
    }
    Ok(())
}
