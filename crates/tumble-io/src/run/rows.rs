//! The rows of a run's CSV files, read back one by one.

use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;

use crate::plot::EnergyRow;

/// A longer row is none.
const LONGEST: u64 = 1 << 13;

/// What is wrong with a row, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1; 0 where it is the whole file.
    pub line: u64,
    /// What is wrong, to be read after the name of the file.
    pub what: String,
}

impl fmt::Display for RowError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = if self.line > 0 { format!(":{}:", self.line) } else { String::new() };
        write!(f, "{}{line} {}", self.path.display(), self.what)
    }
}

impl std::error::Error for RowError {}

/// The rows of a CSV file, one by one.
pub(crate) struct Rows {
    path: PathBuf,
    from: BufReader<File>,
    /// Bytes of the header.
    pub header: u64,
    /// Bytes read so far.
    pub at: u64,
    /// Lines read so far, the header included.
    line: u64,
    /// Whether the file ends in the middle of a row.
    pub torn: bool,
}

impl Rows {
    /// Opens a file that begins with `header`.
    pub fn open(path: PathBuf, header: &str) -> Result<Self, RowError> {
        let whole = |path: &PathBuf, what| RowError { path: path.clone(), line: 0, what };
        // opening a pipe would wait for its writer
        let metadata = std::fs::metadata(&path);
        let metadata = metadata.map_err(|e| whole(&path, format!("cannot be read: {e}")))?;
        if !metadata.is_file() {
            return Err(whole(&path, "is no ordinary file".to_owned()));
        }
        let file = File::open(&path).map_err(|e| whole(&path, format!("cannot be read: {e}")))?;
        let from = BufReader::with_capacity(1 << 16, file);
        let mut rows = Self { path, from, header: 0, at: 0, line: 0, torn: false };
        if rows.next()?.as_deref() != Some(header) {
            return Err(rows.wrong("does not begin with its header"));
        }
        rows.header = rows.at;
        Ok(rows)
    }

    /// The next row that is whole.
    pub fn next(&mut self) -> Result<Option<String>, RowError> {
        let mut row = Vec::new();
        let read = self.from.by_ref().take(LONGEST).read_until(b'\n', &mut row);
        let read = read.map_err(|error| self.wrong(&format!("cannot be read: {error}")))?;
        if read > 0 {
            self.line += 1;
        }
        if row.pop() != Some(b'\n') {
            self.torn = read > 0;
            let short = (read as u64) < LONGEST;
            return if short { Ok(None) } else { Err(self.wrong("has a row without an end")) };
        }
        self.at += read as u64;
        match String::from_utf8(row) {
            Ok(row) => Ok(Some(row)),
            Err(_) => Err(self.wrong("has a row that is no text")),
        }
    }

    /// An error at the row read last.
    pub fn wrong(&self, what: &str) -> RowError {
        RowError { path: self.path.clone(), line: self.line, what: what.to_owned() }
    }
}

/// A row of `energy.csv`, with the column `work` or without.
pub(crate) fn parse_ledger(row: &str, has_work: bool) -> Option<EnergyRow> {
    let (row, work) = match row.rsplit_once(',') {
        Some((row, work)) if has_work => (row, work.parse().ok()?),
        _ => (row, 0.0),
    };
    let [time, kinetic, gravitational, elastic, drag, dashpot, slip, total, residual] =
        numbers::<9>(row)?;
    Some(EnergyRow {
        time,
        kinetic,
        gravitational,
        elastic,
        drag,
        dashpot,
        slip,
        work,
        total,
        residual,
    })
}

/// Time (s), body and the numbers of a row of `trajectory.csv`.
pub(crate) fn parse_trajectory(row: &str) -> Option<(f64, &str, [f64; 16])> {
    parse_of_body(row)
}

/// Time (s), body, force (N) and torque (N·m) of a row of `contacts.csv`.
pub(crate) fn parse_contact(row: &str) -> Option<(f64, &str, [f64; 6])> {
    parse_of_body(row)
}

fn parse_of_body<const N: usize>(row: &str) -> Option<(f64, &str, [f64; N])> {
    let (time, rest) = row.split_once(',')?;
    let (body, rest) = rest.split_once(',')?;
    Some((time.parse().ok()?, body, numbers(rest)?))
}

/// Exactly `N` numbers.
fn numbers<const N: usize>(row: &str) -> Option<[f64; N]> {
    let mut numbers = [0.0; N];
    let mut fields = row.split(',');
    for number in &mut numbers {
        *number = fields.next()?.parse().ok()?;
    }
    fields.next().is_none().then_some(numbers)
}
