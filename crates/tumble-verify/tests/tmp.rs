#[test]
fn p() {
    let case = tumble_verify::CASES.iter().find(|c| c.name == "remeshing").unwrap();
    for c in (case.run)().unwrap() {
        println!(
            "{} {:55} {:.6e} {:.6e} {:+.2e} bound {:.1e} {}",
            if c.passed() { "ok  " } else { "FAIL" },
            c.quantity,
            c.expected,
            c.measured,
            (c.measured - c.expected) / c.expected.abs().max(1e-300),
            c.bound / c.expected.abs().max(1e-300),
            c.unit
        );
    }
}
