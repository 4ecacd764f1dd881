//! Every case of `tumble verify` that is quick enough without much optimisation; `check.sh` runs the
//! rest through the command.

use tumble_verify::CASES;

#[test]
fn every_quick_case_is_within_its_bounds() {
    let mut failed = Vec::new();
    for case in CASES.iter().filter(|case| !case.slow) {
        match (case.run)() {
            Ok(checks) if checks.is_empty() => failed.push(format!("{}: no number", case.name)),
            Ok(checks) => failed.extend(
                checks
                    .iter()
                    .filter(|check| !check.passed())
                    .map(|check| format!("{}: {check:?}", case.name)),
            ),
            Err(error) => failed.push(format!("{}: {error}", case.name)),
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
