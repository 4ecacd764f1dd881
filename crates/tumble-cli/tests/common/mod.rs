//! What the command's tests share: calling it, reading what it wrote.

#![allow(dead_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// A body of twelve particles, quick to run.
pub const BODY: &str = "[[body]]\nshape = \"sphere\"\nsubdivisions = 0\n";

/// A closed tetrahedron with an edge of about a metre.
pub const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A folder of its own for a test.
pub struct Desk(pub TempDir);

impl Desk {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        path
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// Calls the command in this folder.
    pub fn tumble(&self, args: &[&str]) -> Said {
        tumble_in(self.0.path(), args)
    }

    /// Runs a scene and returns its summary.
    pub fn run(&self, args: &[&str], out: &str) -> Value {
        let mut all = vec!["run"];
        all.extend(args);
        all.extend(["--out", out]);
        self.tumble(&all).ends_with(0);
        self.summary(out)
    }

    pub fn summary(&self, out: &str) -> Value {
        serde_json::from_str(&self.read(&format!("{out}/summary.json"))).unwrap()
    }

    pub fn files(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<String> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs a scene that must be refused: status 2, nothing on stdout, nothing written.
    pub fn refused(&self, scene: impl AsRef<[u8]>, args: &[&str]) -> String {
        self.write("s.toml", scene);
        let before = self.files("");
        let mut all = vec!["run", "s.toml"];
        all.extend(args);
        let said = self.tumble(&all).ends_with(2);
        assert_eq!(said.out, "");
        assert_eq!(self.files(""), before, "a refused scene left something behind");
        said.err
    }
}

/// How a call ended and what it said.
#[derive(Debug)]
pub struct Said {
    pub status: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Said {
    pub fn of(output: Output) -> Self {
        Self {
            status: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    pub fn ends_with(self, status: i32) -> Self {
        assert_eq!(self.status, Some(status), "{self:?}");
        assert!(!self.err.contains("panicked"), "{self:?}");
        self
    }
}

pub fn tumble_in(folder: &Path, args: &[&str]) -> Said {
    let mut command = Command::cargo_bin("tumble").unwrap();
    // a test that hangs is a test that fails
    command.timeout(std::time::Duration::from_secs(60));
    Said::of(command.current_dir(folder).args(args).output().unwrap())
}

/// Asserts that a message has all of these parts.
#[track_caller]
pub fn says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "{part:?} is missing in:\n{message}");
    }
}

/// The rows of a CSV file, its header first.
pub fn rows(text: &str) -> Vec<Vec<String>> {
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}
