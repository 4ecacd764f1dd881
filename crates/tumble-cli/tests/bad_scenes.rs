//! Invalid scenes: status 2, all problems at once with file, line, column, key, allowed values and nearest key, and no
//! files written.

#![allow(clippy::unwrap_used)]

mod common;

use common::{BODY, TestDir, assert_contains};

/// Checks the message for each of these lines at the top of an otherwise valid scene.
fn check_top_lines(cases: &[(&str, &[&str])]) {
    let dir = TestDir::new();
    for (line, parts) in cases {
        let message = dir.rejected(format!("# \n{line}\n{BODY}"), &[]);
        assert_contains(&message, parts);
    }
}

/// Checks the message for each of these lines in the only body of a scene.
fn check_body_lines(cases: &[(&str, &[&str])]) {
    let dir = TestDir::new();
    for (line, parts) in cases {
        let message = dir.rejected(format!("{BODY}{line}\n"), &[]);
        assert_contains(&message, parts);
    }
}

#[test]
fn unknown_keys_are_reported_with_the_nearest_key() {
    check_top_lines(&[
        ("gravty = [0, 0, 0]", &["`gravty` is not a known key", "s.toml:2:1", "mean `gravity`?"]),
        (
            "box = {min=[-9, -9, -9], max=[9, 9, 9], opne=[]}",
            &["`box.opne`", ":2:41", "mean `open`?"],
        ),
        (
            "[collision]\nstifness = 1",
            &["`collision.stifness`", "s.toml:3:1", "`collision_stiffness`"],
        ),
        ("[[wall]]\nnormal = [0, 1, 0]\nofset = 1", &["`wall.0.ofset`", ":4:1", "mean `offset`?"]),
        ("[output]\nintervall = 1", &["`output.intervall`", "s.toml:3:1", "mean `interval`?"]),
        ("zzz = 1", &["known here: `body`, `box`"]),
    ]);
    check_body_lines(&[
        ("scael = 1", &["`body.0.scael`", "s.toml:4:1", "mean `scale`?"]),
        (
            "copies = {cuont = [1, 1, 1], count = [1, 1, 1], spacing = [1, 1, 1]}",
            &["`body.0.copies.cuont`", "s.toml:4:11", "mean `count`?"],
        ),
    ]);
    let dir = TestDir::new();
    assert_contains(&dir.rejected("[[body]]\nmass = 1\n", &[]), &["`body.0` needs one of", ":1:1"]);
    // the keys of a misspelt shape are not reported as unknown
    let message = dir.rejected("[[body]]\nshape = \"sphre\"\nradius = 1\nsegments = 3\n", &[]);
    assert_contains(
        &message,
        &["`body.0.shape` must be one of \"sphere\"", "s.toml:2:9", "mean \"sphere\"?"],
    );
    assert!(!message.contains("not a known key"), "{message}");
}

#[test]
fn numbers_out_of_range_are_rejected() {
    check_top_lines(&[
        ("dt = 0", &["`dt` must be above 0, but is 0", "s.toml:2:6"]),
        ("dt = -1", &["`dt` must be above 0, but is -1", "s.toml:2:6"]),
        ("dt = nan", &["`dt` must be above 0, but is NaN"]),
        ("dt = inf", &["`dt` must be above 0, but is inf"]),
        ("dt = -1e-300", &["but is -1e-300"]),
        ("dt = 1e-300\nduration = 1e300", &["`dt` leads to inf steps", "s.toml:2:6"]),
        ("duration = 1e18", &["`duration` leads to 1e21 steps", "s.toml:2:12"]),
        ("duration = 1e-9", &["`duration` leads to no step at all", "a `dt` of 0.000000001 s"]),
        ("dt = 0xFFFFFFFFFFFFFFFFFFFFFFFF", &["no step at all"]),
        ("dt = 9223372036854775808", &["no step at all"]),
        ("velocity_damping_stiffness = -1", &["must be 0 or more, but is -1", ":2:30"]),
        ("gravity = [0, nan, 0]", &["`gravity` must hold numbers that are finite", ":2:11"]),
        ("[output]\ninterval = 0", &["`output.interval` must be above 0", ":3:12"]),
        ("[collision]\ncollision_stiffness = -1", &["`collision.collision_stiffness` must be 0"]),
        ("[[wall]]\nnormal = [0, 0, 0]", &["`wall.0.normal` must not be zero", ":3:10"]),
        ("[[wall]]\noffset = 1", &["`wall.0.normal` is missing"]),
        ("[box]\nmin = [1, 1, 1]\nmax = [2, 0, 2]", &["`box.max` must lie above `min`", ":4:7"]),
        ("[box]\nmin = [1, 1, 1]", &["`box.max` is missing", ":2:1"]),
        (
            "[box]\nmin=[-1,-1,-1]\nmax=[1,1,1]\norientation = [0, 0, 0, 0]",
            &["`box.orientation` must not be all zeros", ":5:15"],
        ),
        (
            "[box]\nmin=[-1,-1,-1]\nmax=[1,1,1]\nopen = [\"y\"]",
            &["`box.open` must be one of", "\"+y\"", ":5:9"],
        ),
    ]);
    check_body_lines(&[
        ("particle_mass = -1", &["`body.0.particle_mass` must be above 0, but is -1", ":4:17"]),
        ("mass = 0", &["`body.0.mass` must be above 0", ":4:8"]),
        ("mass = 1\ndensity = 1", &["`body.0.density` cannot stand beside `mass`", ":5:11"]),
        ("scale = 0", &["`body.0.scale` must be above 0", ":4:9"]),
        ("orientation = [0, 0, 0, 0]", &["`body.0.orientation` must not be all zeros", ":4:15"]),
        ("orientation = [1, 0, 0]", &["must be an array of 4 numbers", ":4:15"]),
        ("radius = 1e200", &["`body.0.shape`", "1e100 m", ":2:9"]),
        ("particle_mass = 1e308", &["`body.0.particle_mass` cannot work", "mass", ":4:17"]),
        (
            "initial_velocity = [1e200, 0, 0]",
            &["`body.0` has an energy that is not a finite number"],
        ),
        ("initial_angular_velocity = [1e200, 0, 0]", &["`body.0` has an energy that is not"]),
        ("position = [1e999, 0, 0]", &["`body.0.position`", ":4:12"]),
        ("name = \"\"", &["`body.0.name` must not be empty"]),
        ("name = \"a\\nb\"", &["`body.0.name` must not contain"]),
        ("name = \"\\u001b[31m\"", &["`body.0.name` must not contain"]),
        ("spacing = 1", &["`body.0.spacing` only goes with sampling"]),
        ("sampling = \"volume\"", &["`body.0.sampling` \"volume\" needs `spacing`"]),
        ("mass_model = \"soild\"", &["`body.0.mass_model` must be one of", "mean \"solid\"?"]),
        ("particles = [[0, 0, 0]]", &["`body.0.particles` cannot stand beside `shape`"]),
        (
            "copies = {count = [1e9, 1, 1], spacing = [1, 1, 1]}",
            &["`body.0.copies.count`", "at most 1000000"],
        ),
        ("copies = {count = [1e300, 1e300, 1], spacing = [1, 1, 1]}", &["at most 1000000"]),
        ("copies = {count = [1.5, 1, 1], spacing = [1, 1, 1]}", &["whole numbers"]),
        (
            "copies = {}",
            &["`body.0.copies.count` is missing", "`body.0.copies.spacing` is missing"],
        ),
        (
            "copies = {count = [1, 1, 1], spacing = [1, 1, 1], seed = 99999999999999999999}",
            &["`body.0.copies.seed` must be a whole number"],
        ),
    ]);
}

#[test]
fn impossible_mass_properties_are_rejected() {
    let unit = "inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]";
    check_body_lines(&[
        (unit, &["`body.0.inertia` needs `mass` (kg)", ":4:11"]),
        (
            &format!("particle_mass = 1\n{unit}"),
            &["`body.0.inertia` only goes with `mass`", "given by `particle_mass`", ":5:11"],
        ),
        (&format!("density = 1\n{unit}"), &["given by `density`", ":5:11"]),
        (
            "mass = 1\ninertia = [1, 1, 1]",
            &["`body.0.inertia` must be three rows of three finite numbers", ":5:11"],
        ),
        ("mass = 1\ninertia = [[1, 0, 0], [0, 1, 0]]", &["must be three rows", ":5:11"]),
        ("mass = 1\ninertia = [[1, 0, 0], [0, nan, 0], [0, 0, 1]]", &["finite numbers"]),
        (
            "mass = 2\ninertia = [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]",
            &["`body.0.inertia` must be symmetric", ":5:11"],
        ),
        (
            "mass = 2\ninertia = [[1, 0, 0], [0, 1, 0], [0, 0, 2.1]]",
            &[
                "`body.0.inertia` is that of no body",
                "1.0000e0, 1.0000e0 and 2.1000e0 kg·m²",
                "at most the sum of the others",
                ":5:11",
            ],
        ),
        ("mass = 2\ninertia = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]", &["is that of no body"]),
        (
            "mass = 2\ninertia = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]",
            &[
                "`body.0.inertia` cannot work: there is no moment of inertia about the axis",
                ":5:11",
            ],
        ),
        (
            "mass = 1e-300\ninertia = [[1e300, 0, 0], [0, 1e300, 0], [0, 0, 1e300]]",
            &["`body.0.inertia` is so large", ":5:11"],
        ),
        ("center_of_mass = [0, 0]", &["`body.0.center_of_mass` must be an array of 3", ":4:18"]),
        ("center_of_mass = [0, inf, 0]", &["`body.0.center_of_mass` must hold numbers", ":4:18"]),
        ("center_of_mass = [1e200, 0, 0]", &["`body.0.center_of_mass` is so large", ":4:18"]),
        ("centre_of_mass = [0, 0, 0]", &["did you mean `center_of_mass`?"]),
    ]);
    let dir = TestDir::new();
    let beside = "[[body]]\nparticles = [[0, 0, 0], [1, 0, 0]]\ncenter_of_mass = [0, 1, 0]\n";
    let parts = ["`body.0.center_of_mass` needs `mass` and `inertia` beside it", "s.toml:3:18"];
    assert_contains(&dir.rejected(beside, &[]), &parts);
}

#[test]
fn wrong_types_are_rejected() {
    check_top_lines(&[
        ("dt = \"fast\"", &["`dt` must be a number, above 0, but is a string", ":2:6"]),
        ("dt = 2026-01-01", &["`dt` must be a number", "a date"]),
        ("gravity = -9.8", &["`gravity` must be an array of 3 numbers, but is a number"]),
        ("gravity = [0, -9.8]", &["`gravity` must be an array of 3 numbers"]),
        ("integrator = \"eulre\"", &["`integrator` must be one of", "mean \"euler\"?", ":2:14"]),
        ("integrator = 3", &["`integrator` must be one of", "an integer"]),
        ("description = 3", &["`description` must be a string"]),
        ("wall = {normal = [0, 1, 0]}", &["write [[wall]] with two brackets"]),
        ("output = []", &["`output` must be a table, but is an array"]),
    ]);
    let dir = TestDir::new();
    // one mistake, one message
    let message = dir.rejected(format!("box = 3\n{BODY}"), &[]);
    assert!(!message.contains("is missing"), "{message}");
    assert_contains(
        &dir.rejected("body = 3\n", &[]),
        &["write [[body]] with two brackets", ":1:8"],
    );
    assert_contains(&dir.rejected("body = [3]\n", &[]), &["`body.0` must be a table", ":1:9"]);
    assert_contains(&dir.rejected("body = []\n", &[]), &["the scene has no body"]);
    let particles = |points: &str| dir.rejected(format!("[[body]]\nparticles = {points}\n"), &[]);
    assert_contains(&particles("[]"), &["`body.0.particles` is empty", ":2:13"]);
    assert_contains(&particles("3"), &["must be an array of points"]);
    assert_contains(
        &particles("[[0, 0, 0],\n[0, nan, 0]]"),
        &["`body.0.particles.1` must be a point", ":3:1"],
    );
    assert_contains(&particles("[[0, 0]]"), &["`body.0.particles.0` must be a point"]);
    assert_contains(&particles("[[1e300, 0, 0], [0, 0, 0]]"), &["so far apart"]);
}

#[test]
fn all_problems_are_reported_at_once() {
    let dir = TestDir::new();
    let scene =
        format!("dt = 0\nfoo = 1\n[output]\ninterval = 0\n{BODY}mass = -1\n{BODY}bar = 1\n");
    let message = dir.rejected(scene, &["--set", "duration=x"]);
    assert_contains(
        &message,
        &["s.toml:1:6", "s.toml:2:1", "s.toml:4:12", "s.toml:8:8", "s.toml:12:1"],
    );
    assert_contains(&message, &["--set:1:10", "6 problems; nothing was run"]);
}

#[test]
fn invalid_positions_names_and_counts_are_rejected() {
    let dir = TestDir::new();
    let walls = "[box]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n";
    let message = dir.rejected(format!("{walls}{BODY}position = [0, -3, 0]\n"), &[]);
    assert_contains(&message, &["`body.0.position`", "starts outside", "2.000e0 m", "s.toml:7:12"]);
    // only one of many copies is reported
    let copies = "copies = {count = [100, 100, 10], spacing = [1, 1, 1]}\n";
    let message = dir.rejected(format!("{walls}{BODY}{copies}"), &[]);
    assert_eq!(message.matches("error:").count(), 1, "{message}");

    let named = |name: &str| format!("{BODY}name = \"{name}\"\n");
    let message = dir.rejected(format!("{}{}", named("a"), named("a")), &[]);
    assert_contains(&message, &["`body.1.name`", "two bodies are called \"a\"", "s.toml:8:8"]);
    let two = "copies = {count = [2, 1, 1], spacing = [1, 1, 1]}\n";
    let message = dir.rejected(format!("{}{}{two}", named("a 1"), named("a")), &[]);
    assert_contains(&message, &["two bodies are called \"a 1\""]);
    let many = "copies = {count = [1000, 600, 1], spacing = [1, 1, 1]}\n";
    let message = dir.rejected(format!("{}{many}{}{many}", named("a"), named("b")), &[]);
    assert_contains(&message, &["`body` leads to 1200000 bodies; at most 1000000"]);
}

#[test]
fn files_that_are_not_scenes_are_rejected() {
    let dir = TestDir::new();
    std::fs::create_dir(dir.path("folder")).unwrap();
    assert_contains(
        &dir.tumble(&["run", "folder"]).expect_status(2).stderr,
        &["folder is a folder"],
    );
    assert_contains(
        &dir.tumble(&["run", "no.toml"]).expect_status(2).stderr,
        &["no file", "`no.toml`"],
    );
    assert_contains(
        &dir.tumble(&["run", "/dev/zero"]).expect_status(2).stderr,
        &["not a regular file"],
    );
    assert_contains(&dir.rejected("", &[]), &["the scene has no body", "shape = \"sphere\""]);
    assert_contains(&dir.rejected(b"dt = 1\xff", &[]), &["s.toml is no scene", "byte 6"]);
    assert_contains(&dir.rejected("dt = ", &[]), &["s.toml:1:"]);
    assert_contains(&dir.rejected("dt = 1\ndt = 2", &[]), &["duplicate key", "s.toml:2:1"]);
    assert_contains(&dir.rejected(common::TETRAHEDRON, &[]), &["s.toml:1:"]);
}

#[test]
fn huge_files_give_short_messages() {
    let dir = TestDir::new();
    let start = std::time::Instant::now();
    let garbage: String =
        (0..10_000_000u64).map(|i| (32 + ((i * 2_654_435_761) >> 20) % 95) as u8 as char).collect();
    let scenes = [
        format!("x = {}", "[".repeat(200_000)),
        format!("x = {}", "{a=".repeat(200_000)),
        format!("[{}a]", "a.".repeat(200_000)),
        format!("{} = 1", "k".repeat(1_000_000)),
        format!("integrator = \"{}\"", "e".repeat(1_000_000)),
        format!("{BODY}name = \"{}\"", "n".repeat(1_000_000)),
        format!("[[body]]\nparticles = [{}]", "[nan, 0, 0],\n".repeat(100_000)),
        format!("[[body]]\nparticles = [{}]", "[nan, 0, 0],".repeat(20_000)),
        "[[body]]\nmass = -1\n".repeat(20_000),
        garbage,
    ];
    for scene in scenes {
        let message = dir.rejected(scene, &[]);
        assert!(message.len() < 100_000, "{}", message.len());
    }
    assert!(start.elapsed() < std::time::Duration::from_secs(60));
}

#[test]
fn a_default_dt_that_is_too_long_points_at_its_cause() {
    let dir = TestDir::new();
    let floor = "duration = 0.001\n[[wall]]\nnormal = [0, 1, 0]\noffset = -3\n";
    let cases = [
        (
            format!("{floor}[collision]\ncollision_stiffness = 1e9\n{BODY}"),
            "`collision.collision_stiffness`",
            "6:23",
        ),
        (
            format!("{floor}collision_stiffness = 1e9\n{BODY}"),
            "`wall.0.collision_stiffness`",
            "5:23",
        ),
        (format!("{floor}{BODY}mass = 1e-4\n"), "`body.0.mass` makes the body light", "8:8"),
        (
            format!("{floor}[collision]\ncollision_stiffness = 5e3\n{BODY}particle_mass = 1e-6\n"),
            "`body.0.particle_mass` makes the body light",
            "10:17",
        ),
    ];
    for (index, (scene, key, place)) in cases.into_iter().enumerate() {
        let message = dir.rejected(&scene, &[]);
        let place = format!("s.toml:{place}");
        assert_contains(&message, &[key, &place, "the default `dt` of 0.001 s", "--force"]);
        // the advice helps
        let line = message.split('`').find(|part| part.starts_with("dt = ")).unwrap();
        dir.write("good.toml", format!("{line}\n{scene}"));
        dir.run(&["good.toml"], &format!("o{index}"));
    }
}

#[test]
fn a_file_that_is_too_large_for_a_scene_is_not_read() {
    let dir = TestDir::new();
    let file = std::fs::File::create(dir.path("huge.toml")).unwrap();
    file.set_len(1 << 30).unwrap();
    let outcome = dir.tumble(&["run", "huge.toml"]).expect_status(2);
    assert_contains(&outcome.stderr, &["huge.toml is larger than 16 MiB", "mesh file", "copies"]);
}

#[test]
fn crlf_and_byte_order_mark_are_accepted() {
    let dir = TestDir::new();
    let scene = format!("\u{feff}duration = 0.01\n{BODY}").replace('\n', "\r\n");
    dir.write("good.toml", &scene);
    dir.run(&["good.toml"], "o");
    let message = dir.rejected(scene.replace("shape", "shap"), &[]);
    assert_contains(&message, &["s.toml:3:1", "mean `shape`?"]);
    // the byte order mark is not counted as a column
    let message = dir.rejected("\u{feff}dt = 0\r\n", &[]);
    assert_contains(&message, &["s.toml:1:6"]);
}

#[test]
fn a_misspelling_is_the_only_problem() {
    let dir = TestDir::new();
    for (table, meant) in [
        ("[[bodi]]\nshape = \"sphere\"\nmass = 2", "body"),
        ("[[bodies]]\nshape = \"sphere\"", "body"),
        ("[[Body]]\nshape = \"sphere\"", "body"),
        ("[[object]]\nmesh = \"no such file.obj\"", "body"),
        ("[bodi]\nshape = \"sphere\"", "body"),
        ("[colision]\nrestitution = 0.5\n[[body]]\nshape = \"sphere\"", "collision"),
        ("[outptu]\ninterval = 0.1\n[[body]]\nshape = \"sphere\"", "output"),
        ("[[wal]]\nnormal = [0, 1, 0]\n[[body]]\nshape = \"sphere\"", "wall"),
        ("[boxx]\nmin = [-1, -1, -1]\n[[body]]\nshape = \"sphere\"", "box"),
        ("[[wall]]\nnormla = [0, 1, 0]\n[[body]]\nshape = \"sphere\"", "normal"),
        ("[box]\nminn = [-1, -1, -1]\nmax = [1, 1, 1]\n[[body]]\nshape = \"sphere\"", "min"),
        ("[[body]]\nmseh = \"cat.obj\"", "mesh"),
        ("[[body]]\nfile = \"cat.obj\"", "mesh"),
        ("[[body]]\nshpe = \"sphere\"", "shape"),
        ("[[body]]\nshpe = \"sphere\"\nradius = 2", "shape"),
        ("[[body]]\npoints = [[0, 0, 0]]", "particles"),
        ("[[body]]\nshape = \"sphere\"\nsampling = \"volume\"\nspcing = 0.1", "spacing"),
        (
            "[[body]]\nshape = \"sphere\"\ncopies = { cuont = [1, 1, 1], spacing = [1, 1, 1] }",
            "count",
        ),
        (
            "[[body]]\nshape = \"sphere\"\nmotion = \"prescribed\"\n\
             oscillation = { amplitude = [0, 1, 0], freqency = 1 }",
            "frequency",
        ),
    ] {
        let message = dir.rejected(table, &[]);
        assert_contains(&message, &["is not a known key", &format!("did you mean `{meant}`?")]);
        assert_eq!(message.matches("error: ").count(), 1, "{message}");
    }
    // one misspelling does not hide what else is missing
    let message = dir.rejected("[box]\nminn = [0, 0, 0]\n[[wal]]\nnormal = [0, 1, 0]\n", &[]);
    assert_contains(&message, &["has no body", "mean `min`?", "`box.max` is missing", "`wall`?"]);
    assert_eq!(message.matches("error: ").count(), 4, "{message}");
}

#[test]
fn a_duration_below_the_step_names_both() {
    let dir = TestDir::new();
    for line in ["dt = 0.1\nduration = 0.01", "duration = 1e-5"] {
        let message = dir.rejected(format!("{line}\n{BODY}"), &[]);
        assert_contains(&message, &["`duration` leads to no step", "`dt`"]);
        assert_eq!(message.matches("error: ").count(), 1, "{message}");
    }
}

#[test]
fn a_step_above_the_critical_one_can_be_kept_with_the_implicit_integrator() {
    let dir = TestDir::new();
    let walls = "[[wall]]\nnormal = [0, 1, 0]\noffset = -5\n";
    let scene = |dt: &str| format!("{dt}\n[collision]\ncollision_stiffness = 1e7\n{walls}{BODY}");
    let keep = "keep it with `integrator = \"implicit\"`";
    assert_contains(&dir.rejected(scene("dt = 0.01"), &[]), &["stable only up to", keep]);
    assert_contains(&dir.rejected(scene(""), &[]), &["add the line `dt = ", keep]);
    // it is not meant for steps that long
    let message = dir.rejected(scene("dt = 0.1"), &[]);
    assert!(message.contains("stable only up to") && !message.contains("implicit"), "{message}");
    dir.write("s.toml", scene("dt = 0.01\nduration = 0.1"));
    dir.run(&["s.toml", "--set", "integrator=implicit"], "out");
}
