//! `cargo bench --bench heaps`: heaps of 1000 to 100,000 clumps at rest; writes Markdown to standard output.

use std::error::Error;

use tumble_bench::{describe_machine, measure_heaps};

fn main() -> Result<(), Box<dyn Error>> {
    // do not measure under `cargo test --benches`
    if !std::env::args().any(|arg| arg == "--bench") {
        return Ok(());
    }
    println!("{}\n", describe_machine());
    println!(
        "| clumps | springs per clump | one thread (ns per clump and step) | two threads | one ÷ two | memory per clump (kB) |"
    );
    println!("|---|---|---|---|---|---|");
    for cost in measure_heaps(&[1, 8, 100])? {
        println!(
            "| {} | {:.2} | {:.0} | {:.0} | {:.2} | {} |",
            cost.clumps,
            cost.springs_per_clump,
            cost.one_thread,
            cost.two_threads,
            cost.speedup,
            format_kilobytes(cost.memory_per_clump),
        );
    }
    Ok(())
}

fn format_kilobytes(bytes: f64) -> String {
    if bytes.is_nan() { "–".to_owned() } else { format!("{:.1}", 1e-3 * bytes) }
}
