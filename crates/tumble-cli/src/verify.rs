//! `tumble verify`: compares simulations with theory.

use clap::Args;
use tumble_io::scene::nearest;
use tumble_verify::{CASES, Case, Check};

use crate::failure::{Failure, print};
use crate::format::number;

#[derive(Args)]
#[command(
    after_help = "Prints expected value, measured value, difference and bound of every quantity.\n\
        The exit status is 1 if a difference exceeds its bound."
)]
pub struct VerifyArgs {
    /// Names of the cases [default: all]
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Print Markdown
    #[arg(long)]
    markdown: bool,
}

pub fn verify(args: &VerifyArgs) -> Result<(), Failure> {
    let mut failed = 0;
    if args.markdown {
        print(HEADER)?;
    }
    for case in select(&args.cases)? {
        match (case.run)() {
            Ok(checks) => {
                // a case without checks counts as failed
                failed += usize::from(checks.is_empty());
                failed += checks.iter().filter(|check| !check.passed()).count();
                print(&if args.markdown { markdown(case, &checks) } else { text(case, &checks) })?;
            }
            Err(error) => {
                failed += 1;
                print(&format!("{}: FAILED: {error}\n", case.name))?;
            }
        }
    }
    if failed == 0 {
        return Ok(());
    }
    Err(Failure::Run(format!("error: {failed} checks failed")))
}

fn select(names: &[String]) -> Result<Vec<&'static Case>, Failure> {
    if names.is_empty() {
        return Ok(CASES.iter().collect());
    }
    let known: Vec<&str> = CASES.iter().map(|case| case.name).collect();
    names
        .iter()
        .map(|name| {
            CASES.iter().find(|case| case.name == name).ok_or_else(|| {
                let help = match nearest(name, &known) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => format!("the cases are {}", known.join(", ")),
                };
                Failure::call(&format!("there is no case \"{name}\"; {help}"))
            })
        })
        .collect()
}

/// The cells of one check: quantity, expected, measured, difference, bound, verdict, remark.
fn row(check: &Check) -> [String; 7] {
    let unit = if check.unit.is_empty() { String::new() } else { format!(" {}", check.unit) };
    [
        check.quantity.clone(),
        format!("{}{unit}", number(check.expected)),
        format!("{}{unit}", number(check.measured)),
        number(check.measured - check.expected),
        format!("±{}", number(check.bound)),
        if check.passed() { "ok".to_owned() } else { "FAILED".to_owned() },
        check.remark.clone(),
    ]
}

fn text(case: &Case, checks: &[Check]) -> String {
    let rows: Vec<_> = checks.iter().map(row).collect();
    let width =
        |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<_> = (0..6).map(width).collect();
    let mut out = format!("{}: {}\n", case.name, case.description);
    for row in &rows {
        let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}"));
        let line = format!("  {}  {}", cells.collect::<Vec<_>>().join("  "), row[6]);
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out.push('\n');
    out
}

const HEADER: &str = "# Validation

The physics against theory: made by `docs/make.sh`, the tables by `tumble verify --markdown`.

";

fn markdown(case: &Case, checks: &[Check]) -> String {
    let mut out = format!("## {}\n\n{}\n\n", case.name, case.description);
    out.push_str(
        "| quantity | expected | measured | off by | bound | verdict | |\n|---|---|---|---|---|---|---|\n",
    );
    for check in checks {
        let cells = row(check).map(|cell| cell.replace('|', "\\|"));
        out.push_str(&format!("| {} |\n", cells.join(" | ")));
    }
    out.push('\n');
    out
}
