//! `cargo bench --bench heaps`: heaps of clumps at rest, from 1000 to 100,000, as Markdown on standard output.

use std::error::Error;

use tumble_bench::{heaps, machine};

fn main() -> Result<(), Box<dyn Error>> {
    // `cargo test --benches` is no time to measure
    if !std::env::args().any(|arg| arg == "--bench") {
        return Ok(());
    }
    println!("{}\n", machine());
    println!(
        "| clumps | springs a clump | one thread (ns a clump and step) | two threads | one ÷ two | memory a clump (kB) |"
    );
    println!("|---|---|---|---|---|---|");
    for cost in heaps(&[1, 8, 100])? {
        println!(
            "| {} | {:.2} | {:.0} | {:.0} | {:.2} | {} |",
            cost.clumps,
            cost.springs,
            cost.alone,
            cost.together,
            cost.gain,
            memory(cost.memory),
        );
    }
    Ok(())
}

fn memory(bytes: f64) -> String {
    if bytes.is_nan() { "–".to_owned() } else { format!("{:.1}", 1e-3 * bytes) }
}
