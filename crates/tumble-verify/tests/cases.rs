//! Runs the quick cases of `tumble verify`; `check.sh` runs all of them through the command.

use tumble_verify::CASES;

#[test]
fn every_quick_case_is_within_its_bounds() {
    let mut failures = Vec::new();
    for case in CASES.iter().filter(|case| !case.slow) {
        match (case.run)() {
            Ok(checks) if checks.is_empty() => failures.push(format!("{}: no checks", case.name)),
            Ok(checks) => failures.extend(
                checks
                    .iter()
                    .filter(|check| !check.passed())
                    .map(|check| format!("{}: {check:?}", case.name)),
            ),
            Err(error) => failures.push(format!("{}: {error}", case.name)),
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
