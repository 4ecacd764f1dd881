//! `cargo bench --bench heaps`: heaps of 1000 to 100,000 clumps at rest; writes Markdown to standard output.
//! `TILES="1 8"` chooses other sizes, in thousands of clumps.

use std::error::Error;

use tumble_bench::{describe_machine, measure_heaps};

fn main() -> Result<(), Box<dyn Error>> {
    // do not measure under `cargo test --benches`
    if !std::env::args().any(|arg| arg == "--bench") {
        return Ok(());
    }
    let sizes = std::env::var("TILES").unwrap_or_else(|_| "1 8 100".to_owned());
    let sizes = sizes.split_whitespace().map(str::parse).collect::<Result<Vec<usize>, _>>()?;
    println!("{}\n", describe_machine());
    println!(
        "| integrator | dt (s) | clumps | springs per clump | one thread (ns per clump and step) | two threads | one ÷ two | iterations per step | memory per clump (kB) |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for cost in measure_heaps(&sizes)? {
        println!(
            "| {} | {} | {} | {:.2} | {:.0} | {:.0} | {:.2} | {} | {} |",
            cost.integrator.name(),
            cost.dt,
            cost.clumps,
            cost.springs_per_clump,
            cost.one_thread,
            cost.two_threads,
            cost.speedup,
            format_number(cost.iterations_per_step),
            format_number(1e-3 * cost.memory_per_clump),
        );
    }
    Ok(())
}

fn format_number(value: f64) -> String {
    if value.is_nan() { "–".to_owned() } else { format!("{value:.1}") }
}
