//! A heap of bodies that meet: the command gives the same bits with any number of threads, and when it goes on from a checkpoint.

#![allow(clippy::unwrap_used)]

mod common;

use assert_cmd::Command;

use common::{Desk, Said};

/// 125 clumps and a box fall on a rough floor that is shaken.
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

fn heap() -> Desk {
    let desk = Desk::new();
    desk.write("heap.toml", HEAP);
    desk
}

fn run(desk: &Desk, threads: usize, args: &[&str]) {
    let mut command = Command::cargo_bin("tumble").unwrap();
    command.timeout(std::time::Duration::from_secs(300)).current_dir(desk.0.path());
    command.env("RAYON_NUM_THREADS", threads.to_string()).args(args);
    Said::of(command.output().unwrap()).ends_with(0);
}

#[test]
fn the_number_of_threads_changes_no_bit_of_a_run() {
    let desk = heap();
    let mut first = None;
    for threads in [1, 2, 3, 8] {
        let out = format!("with{threads}");
        run(&desk, threads, &["run", "heap.toml", "--out", &out]);
        let summary = desk.summary(&out);
        assert!(summary["max_depth"].as_f64().unwrap() > 1e-3);
        let found = (summary["state_hash"].clone(), desk.read(&format!("{out}/trajectory.csv")));
        let (hash, rows) = first.get_or_insert_with(|| found.clone());
        assert_eq!(found.0, *hash, "{threads} threads");
        assert!(found.1 == *rows, "trajectory.csv differs with {threads} threads");
    }
}

#[test]
fn a_heap_goes_on_from_its_checkpoint_to_the_same_bits() {
    let desk = heap();
    run(&desk, 2, &["run", "heap.toml", "--out", "whole"]);
    // in the middle of many contacts, and with another number of threads
    run(&desk, 1, &["run", "heap.toml", "--duration", "0.33", "--out", "parts"]);
    run(&desk, 3, &["resume", "parts", "--duration", "0.5"]);
    for name in ["trajectory.csv", "energy.csv", "contacts.csv"] {
        let read = |folder: &str| desk.read(&format!("{folder}/{name}"));
        assert!(read("whole") == read("parts"), "{name} differs");
    }
    assert_eq!(desk.summary("whole")["state_hash"], desk.summary("parts")["state_hash"]);
}
