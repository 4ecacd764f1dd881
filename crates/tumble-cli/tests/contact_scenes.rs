//! The built-in scenes with contacts between bodies, shortened.

#![allow(clippy::unwrap_used)]

mod common;

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use common::{TestDir, assert_contains};

/// One row of `trajectory.csv` without the name: time, position, orientation w x y z, velocity, angular velocity.
type Row = [f64; 14];

/// The rows of every body, in order of time.
type Trajectory = BTreeMap<String, Vec<Row>>;

/// Runs a built-in scene and returns its trajectory and summary.
fn run(scene: &str, args: &[&str]) -> (Trajectory, serde_json::Value) {
    let dir = TestDir::new();
    let mut all = vec![scene];
    all.extend(args);
    let summary = dir.run(&all, "out");
    let mut trajectory = Trajectory::new();
    for line in dir.read("out/trajectory.csv").lines().skip(1) {
        let mut cells = line.split(',');
        let time = cells.next().unwrap();
        let body = cells.next().unwrap().to_owned();
        let numbers = [time].into_iter().chain(cells).map(|cell| cell.parse().unwrap());
        let numbers: Vec<f64> = numbers.take(14).collect();
        trajectory.entry(body).or_default().push(numbers.try_into().unwrap());
    }
    (trajectory, summary)
}

fn position(row: &Row) -> [f64; 3] {
    [row[1], row[2], row[3]]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// The last rows of the bodies whose names start with `name`.
fn last_rows<'a>(trajectory: &'a Trajectory, name: &'a str) -> impl Iterator<Item = &'a Row> {
    let named = trajectory.iter().filter(move |(body, _)| body.starts_with(name));
    named.map(|(_, rows)| rows.last().unwrap())
}

#[test]
fn a_stack_is_stable() {
    let (trajectory, summary) = run("stack", &["--duration", "1.5"]);
    assert_eq!(trajectory.len(), 10);
    for (body, rows) in &trajectory {
        let settled = rows.iter().find(|row| row[0] >= 1.0).unwrap();
        let last = rows.last().unwrap();
        let drift = distance(position(settled), position(last));
        assert!(drift < 2e-5, "{body} drifts {drift:e} m in half a second");
        assert!((0..4).all(|i| (settled[4 + i] - last[4 + i]).abs() < 1e-6), "{body} turns");
    }
    // penetration is below 1/200 of the height of a body
    assert!(summary["max_depth"].as_f64().unwrap() < 6e-4);
}

#[test]
fn a_chain_holds_together() {
    let (trajectory, _) = run("chain", &["--duration", "0.5"]);
    let mut links = vec!["hook".to_owned()];
    for i in 0..10 {
        links.extend([format!("link {i}"), format!("cross link {i}")]);
    }
    for pair in links.windows(2) {
        for (a, b) in trajectory[&pair[0]].iter().zip(&trajectory[&pair[1]]) {
            let apart = distance(position(a), position(b));
            // two rings of radius 0.05 m with tubes of radius 0.012 m are taut at 0.076 m
            assert!(apart < 0.08, "{pair:?} are {apart} m apart at {} s", a[0]);
        }
    }
    let lowest = trajectory["cross link 9"].last().unwrap();
    assert!(lowest[2] < -0.8, "the end has not fallen: {lowest:?}");
}

#[test]
fn a_heap_of_cats_stays_in_its_box() {
    let count = "body.copies.count=[2,3,2]";
    let (trajectory, summary) = run("cats", &["--duration", "0.7", "--set", count]);
    assert_eq!(trajectory.len(), 12);
    for row in trajectory.values().flatten() {
        assert!(row[1].abs() < 0.36 && row[3].abs() < 0.36 && row[2] > 0.03, "{row:?}");
    }
    let deepest = summary["max_depth"].as_f64().unwrap();
    assert!(deepest < 0.02, "deepest contact {deepest} m, of cats 0.2 m high");
    for key in ["body_depth_end", "wall_depth_end"] {
        let depth = summary[key].as_f64().unwrap();
        assert!((0.0..=deepest).contains(&depth), "{key}: {depth} m");
    }
    // without contacts all would lie on the floor
    let highest = last_rows(&trajectory, "cat").map(|row| row[2]).fold(0.0, f64::max);
    assert!(highest > 0.1, "{highest}");
}

#[test]
fn the_last_ball_of_the_cradle_takes_over_the_speed_of_the_first() {
    let (trajectory, _) = run("cradle", &["--duration", "0.3"]);
    let speed = |body: &str| trajectory[body].last().unwrap()[8];
    assert!((speed("ball 3") - 1.0).abs() < 1e-3, "{}", speed("ball 3"));
    for body in ["thrown", "ball 0", "ball 1", "ball 2"] {
        assert!(speed(body).abs() < 1e-3, "{body}: {}", speed(body));
    }
}

#[test]
fn all_dominoes_fall_one_after_the_other() {
    let row = ["--set", "body.1.copies.count=[10,1,1]", "--set", "body.1.position=[0.18,0.05,0]"];
    let (trajectory, _) = run("dominoes", &[&["--duration", "0.9"][..], &row].concat());
    let mut fell = Vec::new();
    for i in 0..10 {
        let rows = &trajectory[&format!("domino {i}")];
        // cosine of the angle between the domino's own upward axis and the vertical
        let upright = |row: &Row| 1.0 - 2.0 * (row[5] * row[5] + row[7] * row[7]);
        assert!(upright(rows.last().unwrap()).abs() < 0.5, "domino {i} stands");
        fell.push(rows.iter().find(|row| upright(row) < 0.98).unwrap()[0]);
    }
    assert!(fell.is_sorted(), "{fell:?}");
    let speed = 0.04 * 7.0 / (fell[9] - fell[2]);
    assert!((1.0..2.0).contains(&speed), "the wave has a speed of {speed} m/s");
}

#[test]
fn grains_leave_a_hopper_only_at_the_bottom() {
    let fewer = [
        "--set",
        "body.2.copies.count=[5,4,5]",
        "--set",
        "body.2.position=[0,0.25,0]",
        "--duration",
        "0.5",
    ];
    let (trajectory, _) = run("hopper", &fewer);
    for (grain, rows) in trajectory.iter().filter(|(name, _)| name.starts_with("grain")) {
        for row in rows.iter().filter(|row| row[2] > 0.12) {
            assert!(row[1].hypot(row[3]) < 0.09, "{grain} is in the wall: {row:?}");
        }
    }
    let out = last_rows(&trajectory, "grain").filter(|row| row[2] < 0.11).count();
    assert!((10..=100).contains(&out), "{out} of 100 grains are out");
    assert!(
        last_rows(&trajectory, "grain").all(|row| row[2] > 0.004),
        "a grain is below the floor"
    );
}

#[test]
fn a_drum_lifts_its_grains() {
    let fewer = ["--set", "body.1.copies.count=[6,6,2]", "--duration", "1.2"];
    let (trajectory, _) = run("drum", &fewer);
    for row in trajectory.iter().filter(|(name, _)| name.starts_with("grain")).flat_map(|(_, r)| r)
    {
        assert!(row[1].hypot(row[2]) < 0.15 && row[3].abs() < 0.03, "{row:?} left the drum");
    }
    // the drum has its prescribed angular velocity; its wall moves towards -x at the bottom and carries the grains
    let drum = trajectory["drum"].last().unwrap();
    assert!((drum[13] + 3.0).abs() < 1e-9, "{drum:?}");
    let (mut x, mut count) = (0.0, 0.0);
    for row in last_rows(&trajectory, "grain") {
        x += row[1];
        count += 1.0;
    }
    let lifted = x / count;
    assert!(lifted < -0.03, "the centre of the grains is at x = {lifted} m");
}

#[test]
fn a_belt_transports_boxes_and_a_pan_oscillates() {
    let (trajectory, _) = run("conveyor", &["--duration", "0.5"]);
    for row in last_rows(&trajectory, "box").filter(|row| row[1] < -0.1) {
        assert!((row[8] - 0.6).abs() < 0.02, "{row:?} does not move with the belt");
    }
    for row in &trajectory["pan"] {
        let displacement = 0.003 * (TAU * 15.0 * row[0]).sin();
        assert!((row[2] - 0.1 - displacement).abs() < 1e-9, "{row:?}");
    }
}

#[test]
fn overlapping_bodies_are_rejected_with_both_names() {
    let sphere = |name: &str, radius: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nshape = \"sphere\"\nradius = {radius}\nsurface = \"mesh\"\n"
        )
    };
    let scene = sphere("shell", 0.3) + &sphere("stone", 0.1);
    let message = TestDir::new().rejected(scene, &[]);
    assert_contains(&message, &["\"shell\"", "\"stone\"", "in each other", "`position`"]);
}
