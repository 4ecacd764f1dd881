//! A heap of bodies in contact: results are bitwise the same with any number of threads, and after a resume.

#![allow(clippy::unwrap_used)]

mod common;

use assert_cmd::Command;

use common::{Outcome, TestDir};

/// 125 clumps and a box fall on a vibrating slab.
const HEAP: &str = r#"
duration = 0.5
dt = 2e-4
[collision]
collision_stiffness = 2e4
restitution = 0.4
friction_stiffness = 0.5
[box]
min = [-0.4, -0.5, -0.4]
max = [0.4, 4.0, 0.4]
[[body]]
name = "clumps"
particles = [[0, 0, 0], [0.06, 0, 0], [0.02, 0.05, 0], [0.03, 0.02, 0.05]]
particle_mass = 0.2
surface = "spheres"
particle_radius = 0.035
position = [0, 0.4, 0]
initial_velocity = [0.3, -2.0, 0.1]
initial_angular_velocity = [1, 2, 3]
copies = { count = [5, 5, 5], spacing = [0.15, 0.17, 0.15], seed = 3 }
[[body]]
name = "box"
shape = "box"
size = [0.2, 0.12, 0.15]
divisions = 2
mass = 2
mass_model = "solid"
surface = "mesh"
position = [0, 1.2, 0]
initial_velocity = [0, -4, 0]
[[body]]
name = "slab"
shape = "box"
size = [0.7, 0.2, 0.7]
surface = "mesh"
motion = "prescribed"
oscillation = { amplitude = [0, 0.01, 0], frequency = 8.0 }
position = [0, -0.2, 0]
[output]
interval = 0.05
"#;

fn heap() -> TestDir {
    let dir = TestDir::new();
    dir.write("heap.toml", HEAP);
    dir
}

fn run(dir: &TestDir, threads: usize, args: &[&str]) {
    let mut command = Command::cargo_bin("tumble").unwrap();
    command.timeout(std::time::Duration::from_secs(300)).current_dir(dir.0.path());
    command.env("RAYON_NUM_THREADS", threads.to_string()).args(args);
    Outcome::new(command.output().unwrap()).expect_status(0);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let dir = heap();
    let mut first = None;
    for threads in [1, 2, 3, 8] {
        let out = format!("with{threads}");
        run(&dir, threads, &["run", "heap.toml", "--out", &out]);
        let summary = dir.summary(&out);
        assert!(summary["max_depth"].as_f64().unwrap() > 1e-3);
        let result = (summary["state_hash"].clone(), dir.read(&format!("{out}/trajectory.csv")));
        let (hash, rows) = first.get_or_insert_with(|| result.clone());
        assert_eq!(result.0, *hash, "{threads} threads");
        assert!(result.1 == *rows, "trajectory.csv differs with {threads} threads");
    }
}

#[test]
fn a_resumed_heap_has_the_same_results() {
    let dir = heap();
    run(&dir, 2, &["run", "heap.toml", "--out", "whole"]);
    // stopped during many contacts, and resumed with another number of threads
    run(&dir, 1, &["run", "heap.toml", "--duration", "0.33", "--out", "parts"]);
    run(&dir, 3, &["resume", "parts", "--duration", "0.5"]);
    for name in ["trajectory.csv", "energy.csv", "contacts.csv"] {
        let read = |folder: &str| dir.read(&format!("{folder}/{name}"));
        assert!(read("whole") == read("parts"), "{name} differs");
    }
    assert_eq!(dir.summary("whole")["state_hash"], dir.summary("parts")["state_hash"]);
}
