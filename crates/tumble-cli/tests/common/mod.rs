//! Shared by the tests of the command: runs it in a temporary directory and reads its files.

#![allow(dead_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// A body of twelve particles.
pub const BODY: &str = "[[body]]\nshape = \"sphere\"\nsubdivisions = 0\n";

/// A closed tetrahedron with an edge of about a metre.
pub const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A temporary directory for one test.
pub struct TestDir(pub TempDir);

impl TestDir {
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

    /// Runs the command in this directory.
    pub fn tumble(&self, args: &[&str]) -> Outcome {
        tumble_in(self.0.path(), args)
    }

    /// Runs a scene and returns its summary.
    pub fn run(&self, args: &[&str], out: &str) -> Value {
        let mut all = vec!["run"];
        all.extend(args);
        all.extend(["--out", out]);
        self.tumble(&all).expect_status(0);
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

    /// Runs a scene that must be rejected: status 2, nothing on stdout, nothing written. Returns stderr.
    pub fn rejected(&self, scene: impl AsRef<[u8]>, args: &[&str]) -> String {
        self.write("s.toml", scene);
        let before = self.files("");
        let mut all = vec!["run", "s.toml"];
        all.extend(args);
        let outcome = self.tumble(&all).expect_status(2);
        assert_eq!(outcome.stdout, "");
        assert_eq!(self.files(""), before, "a rejected scene left files behind");
        outcome.stderr
    }
}

/// Exit status and output of the command.
#[derive(Debug)]
pub struct Outcome {
    pub status: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    pub fn new(output: Output) -> Self {
        Self {
            status: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    pub fn expect_status(self, status: i32) -> Self {
        assert_eq!(self.status, Some(status), "{self:?}");
        assert!(!self.stderr.contains("panicked"), "{self:?}");
        self
    }
}

pub fn tumble_in(folder: &Path, args: &[&str]) -> Outcome {
    let mut command = Command::cargo_bin("tumble").unwrap();
    // fails instead of hanging
    command.timeout(std::time::Duration::from_secs(60));
    Outcome::new(command.current_dir(folder).args(args).output().unwrap())
}

/// Asserts that a message contains all of these parts.
#[track_caller]
pub fn assert_contains(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "{part:?} is missing in:\n{message}");
    }
}

/// The rows of a CSV file, including its header.
pub fn rows(text: &str) -> Vec<Vec<String>> {
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}
