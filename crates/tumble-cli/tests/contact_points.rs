//! `[output] contact_points = true`: a row of `contact_points.csv` for each contact.

#![allow(clippy::unwrap_used)]

mod common;

use std::collections::BTreeMap;
use std::path::Path;

use common::{BODY, TestDir, assert_contains};

const HEADER: &str = "time,body,other,px,py,pz,nx,ny,nz,depth,fx,fy,fz\n";

/// Two boxes in a corner, one on the other, beside a slope.
const SCENE: &str = r#"
duration = 0.5
dt = 5e-4
[collision]
restitution = 0.5
friction_stiffness = 0.4
[box]
min = [-1, 0, -1]
max = [1, 2, 1]
open = ["-x", "+y"]
[[wall]]
normal = [1, 1, 0]
offset = -0.3
[[body]]
name = "a, \"b\""
shape = "box"
surface = "mesh"
mass = 1
position = [0, 0.2, 0]
initial_velocity = [-2, 0, 0]
[[body]]
name = "upper"
shape = "box"
surface = "mesh"
mass = 2
position = [0, 0.45, 0.02]
[output]
interval = 0.01
contact_points = true
"#;

type Row = (String, [String; 2], Vec<f64>);

/// The rows of a file: time, names and numbers.
fn rows(path: &Path, names: usize) -> Vec<Row> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows = reader.records().map(|row| row.unwrap());
    rows.map(|row| {
        let name = |i: usize| if i <= names { row[i].to_owned() } else { String::new() };
        let numbers = row.iter().skip(1 + names).map(|x| x.parse().unwrap()).collect();
        (row[0].to_owned(), [name(1), name(2)], numbers)
    })
    .collect()
}

#[test]
fn the_forces_of_all_contacts_add_up_to_those_of_the_bodies() {
    let dir = TestDir::new();
    dir.write("s.toml", SCENE);
    for integrator in ["splitting", "euler", "implicit"] {
        let set = format!("integrator={integrator}");
        dir.run(&["s.toml", "--set", &set], integrator);
        assert!(dir.read(&format!("{integrator}/contact_points.csv")).starts_with(HEADER));
        let file = |name: &str| dir.path(integrator).join(name);
        let mut sums: BTreeMap<(String, String), [f64; 4]> = BTreeMap::new();
        let mut others = Vec::new();
        for (time, [body, other], numbers) in rows(&file("contact_points.csv"), 2) {
            let force = &numbers[7..];
            for (name, sign) in [(&body, 1.0), (&other, -1.0)] {
                let sum = sums.entry((time.clone(), name.clone())).or_default();
                (0..3).for_each(|axis| sum[axis] += sign * force[axis]);
                sum[3] += force.iter().map(|x| x.abs()).sum::<f64>();
            }
            others.push(other);
        }
        for name in ["-y", "wall 0", "upper"] {
            assert!(others.iter().any(|other| other == name), "{integrator}: {name}");
        }
        let wrenches = rows(&file("contacts.csv"), 1);
        assert!(wrenches.len() > 50, "{integrator}");
        for (time, [body, _], numbers) in wrenches {
            let sum = sums.remove(&(time.clone(), body.clone())).unwrap();
            let is_close = |axis: usize| (sum[axis] - numbers[axis]).abs() <= 1e-9 * sum[3];
            assert!((0..3).all(is_close), "{integrator} {time} {body}: {sum:?} {numbers:?}");
        }
        // what is left are walls, and contacts that push with no force
        let is_wall = |name: &str| name.starts_with("wall") || name.len() == 2;
        assert!(sums.iter().all(|((_, name), sum)| is_wall(name) || sum[3] == 0.0), "{sums:?}");
    }
}

#[test]
fn the_file_has_its_header_alone_without_contact_and_is_not_there_if_not_asked_for() {
    let dir = TestDir::new();
    dir.write("s.toml", BODY);
    let short = ["s.toml", "--duration", "0.02"];
    dir.run(&[&short[..], &["--set", "output.contact_points=true"]].concat(), "asked");
    assert_eq!(dir.read("asked/contact_points.csv"), HEADER);
    assert_contains(&dir.read("asked/scene.toml"), &["contact_points = true"]);
    dir.run(&short, "plain");
    dir.run(&[&short[..], &["--set", "output.contact_points=false"]].concat(), "not");
    for folder in ["plain", "not"] {
        assert!(!dir.path(folder).join("contact_points.csv").exists());
        assert!(!dir.read(&format!("{folder}/scene.toml")).contains("contact_points"));
    }
    // a file of an old run is removed with it
    dir.tumble(&[&["run"], &short[..], &["--out", "asked", "--force"]].concat()).expect_status(0);
    assert!(!dir.path("asked/contact_points.csv").exists());
}

#[test]
fn what_cannot_be_asked_for_is_rejected() {
    let dir = TestDir::new();
    let with = |lines: &str| format!("{lines}\n{BODY}");
    let message = dir.rejected(with("[output]\ncontact_points = 1"), &[]);
    let parts = ["`output.contact_points` must be true or false, but is an integer", ":2:18"];
    assert_contains(&message, &parts);
    let lines = "energy_tolerance = 1e-6\n[output]\ncontact_points = true";
    let parts = ["`output.contact_points` cannot stand beside `energy_tolerance`", ":3:18"];
    assert_contains(&dir.rejected(with(lines), &[]), &parts);
}
