//! Reads and parses the rows of a run's CSV files.

use std::borrow::Cow;
use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;

use super::energy_ledger::EnergyColumns;
use crate::plot::EnergyRow;

/// Length limit of a row (bytes).
const MAX_ROW_BYTES: u64 = 1 << 13;

/// An invalid row of a CSV file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowError {
    /// The file.
    pub path: PathBuf,
    /// Line number from 1; 0 if the problem is with the whole file.
    pub line: u64,
    /// The problem, as words that follow the name of the file.
    pub problem: String,
}

impl fmt::Display for RowError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = if self.line > 0 { format!(":{}:", self.line) } else { String::new() };
        write!(f, "{}{line} {}", self.path.display(), self.problem)
    }
}

impl std::error::Error for RowError {}

/// Reads a CSV file row by row.
pub(crate) struct CsvReader {
    path: PathBuf,
    file: BufReader<File>,
    /// Length of the header line (bytes).
    pub header_bytes: u64,
    /// Length of the header and of the rows returned so far (bytes).
    pub bytes_read: u64,
    /// Lines read so far, including the header.
    line: u64,
    /// Whether the file ends with an incomplete row.
    pub is_truncated: bool,
}

impl CsvReader {
    /// Opens a file whose first line is `header`.
    pub fn open(path: PathBuf, header: &str) -> Result<Self, RowError> {
        let file_error =
            |path: &PathBuf, problem| RowError { path: path.clone(), line: 0, problem };
        // opening a named pipe would block
        let metadata = std::fs::metadata(&path);
        let metadata = metadata.map_err(|e| file_error(&path, format!("cannot be read: {e}")))?;
        if !metadata.is_file() {
            return Err(file_error(&path, "is not a regular file".to_owned()));
        }
        let file =
            File::open(&path).map_err(|e| file_error(&path, format!("cannot be read: {e}")))?;
        let reader = BufReader::with_capacity(1 << 16, file);
        let mut rows = Self {
            path,
            file: reader,
            header_bytes: 0,
            bytes_read: 0,
            line: 0,
            is_truncated: false,
        };
        if rows.next_row()?.as_deref() != Some(header) {
            return Err(rows.error("does not begin with its header"));
        }
        rows.header_bytes = rows.bytes_read;
        Ok(rows)
    }

    /// The next complete row; `None` at the end of the file.
    pub fn next_row(&mut self) -> Result<Option<String>, RowError> {
        let mut row = Vec::new();
        let read = self.file.by_ref().take(MAX_ROW_BYTES).read_until(b'\n', &mut row);
        let read = read.map_err(|error| self.error(&format!("cannot be read: {error}")))?;
        if read > 0 {
            self.line += 1;
        }
        if row.pop() != Some(b'\n') {
            self.is_truncated = read > 0;
            let is_end = (read as u64) < MAX_ROW_BYTES;
            return if is_end { Ok(None) } else { Err(self.error("has a row that is too long")) };
        }
        self.bytes_read += read as u64;
        match String::from_utf8(row) {
            Ok(row) => Ok(Some(row)),
            Err(_) => Err(self.error("has a row that is not UTF-8 text")),
        }
    }

    /// An error at the line read last.
    pub fn error(&self, problem: &str) -> RowError {
        RowError { path: self.path.clone(), line: self.line, problem: problem.to_owned() }
    }
}

/// Parses a row of `energy.csv` with these columns.
pub(crate) fn parse_energy(row: &str, columns: EnergyColumns) -> Option<EnergyRow> {
    let last = |row: &'_ str, is_there: bool| match row.rsplit_once(',') {
        Some((rest, value)) if is_there => Some((rest.len(), value.parse().ok()?)),
        _ => Some((row.len(), 0.0)),
    };
    let (end, joint_friction) = last(row, columns.joints)?;
    let row = &row[..end];
    let (end, motor) = last(row, columns.joints)?;
    let row = &row[..end];
    let (end, spring) = last(row, columns.joints)?;
    let row = &row[..end];
    let (end, work) = last(row, columns.work)?;
    let row = &row[..end];
    let (end, numerical) = last(row, columns.numerical)?;
    let row = &row[..end];
    let [time, kinetic, gravitational, elastic, drag, dashpot, slip, total, residual] =
        parse_numbers::<9>(row)?;
    Some(EnergyRow {
        time,
        kinetic,
        gravitational,
        elastic,
        drag,
        dashpot,
        slip,
        numerical,
        work,
        spring,
        motor,
        joint_friction,
        total,
        residual,
    })
}

/// Parses a row of `trajectory.csv`: time (s), name of the body, and 16 numbers.
pub(crate) fn parse_trajectory(row: &str) -> Option<(f64, Cow<'_, str>, [f64; 16])> {
    parse_body_row(row)
}

/// Parses a row of `contacts.csv`: time (s), name of the body, force (N) and torque (N·m).
pub(crate) fn parse_contact(row: &str) -> Option<(f64, Cow<'_, str>, [f64; 6])> {
    parse_body_row(row)
}

/// Parses a row of `joints.csv`: time (s), name of the joint, force (N), torque (N·m), coordinate and rate.
pub(super) fn parse_joint(row: &str) -> Option<(f64, Cow<'_, str>, [f64; 8])> {
    parse_body_row(row)
}

/// The time (s) of a row of `contact_points.csv`, if it is one.
pub(super) fn parse_contact_point_time(row: &str) -> Option<f64> {
    let (time, rest) = row.split_once(',')?;
    let (_, rest) = split_text(rest)?;
    let (_, rest) = split_text(rest)?;
    parse_numbers::<10>(rest)?;
    time.parse().ok()
}

fn parse_body_row<const N: usize>(row: &str) -> Option<(f64, Cow<'_, str>, [f64; N])> {
    let (time, rest) = row.split_once(',')?;
    let (body, rest) = split_text(rest)?;
    Some((time.parse().ok()?, body, parse_numbers(rest)?))
}

/// The field of text at the start of `row` without its quotes (RFC 4180), and what follows its comma.
fn split_text(row: &str) -> Option<(Cow<'_, str>, &str)> {
    let Some(quoted) = row.strip_prefix('"') else {
        let (text, rest) = row.split_once(',')?;
        return Some((Cow::Borrowed(text), rest));
    };
    let bytes = quoted.as_bytes();
    let mut end = 0;
    while let Some(at) = quoted[end..].find('"') {
        end += at;
        // a doubled quote stands for one within the text
        if bytes.get(end + 1) != Some(&b'"') {
            let rest = quoted[end + 1..].strip_prefix(',')?;
            return Some((Cow::Owned(quoted[..end].replace("\"\"", "\"")), rest));
        }
        end += 2;
    }
    None
}

/// Parses exactly `N` numbers separated by commas.
fn parse_numbers<const N: usize>(row: &str) -> Option<[f64; N]> {
    let mut numbers = [0.0; N];
    let mut fields = row.split(',');
    for number in &mut numbers {
        *number = fields.next()?.parse().ok()?;
    }
    fields.next().is_none().then_some(numbers)
}
