#[test]
fn print() {
    for case in tumble_verify::CASES.iter().filter(|c| {
        [
            "collision",
            "collision ledger",
            "meeting order",
            "cradle",
            "two balls",
            "oblique impact",
            "rolling down",
            "wall or mesh",
            "belt",
            "piston",
        ]
        .contains(&c.name)
    }) {
        let t = std::time::Instant::now();
        match (case.run)() {
            Ok(checks) => {
                for c in checks {
                    println!(
                        "{} {:16} {:60} exp {:e} got {:e} bound {:e} {}",
                        if c.passed() { "ok  " } else { "FAIL" },
                        case.name,
                        c.quantity,
                        c.expected,
                        c.measured,
                        c.bound,
                        c.remark
                    );
                }
            }
            Err(e) => println!("ERR {}: {e}", case.name),
        }
        println!("   {:?}", t.elapsed());
    }
}
