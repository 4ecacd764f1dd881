//! Invalid surfaces and motions of bodies are rejected with a message.

#![allow(clippy::unwrap_used)]

mod common;

use common::{BODY, TestDir, assert_contains};

const BARE: &str = "[[body]]\nparticles = [[0, 0, 0], [0.1, 0, 0]]\n";

/// Checks the message for each of these lines in the only body of a scene.
fn check_body_lines(cases: &[(&str, &[&str])]) {
    let dir = TestDir::new();
    for (line, parts) in cases {
        let message = dir.rejected(format!("{BODY}{line}\n"), &[]);
        assert_contains(&message, parts);
        assert_eq!(message.matches("error:").count(), 1, "{message}");
    }
}

#[test]
fn invalid_surfaces_are_rejected() {
    check_body_lines(&[
        (
            "surface = \"spheers\"",
            &["`body.0.surface` must be one of", "mean \"spheres\"?", ":4:11"],
        ),
        ("surface = 3\nparticle_radius = 1", &["`body.0.surface` must be one of", "an integer"]),
        (
            "surface = \"spheres\"",
            &["`body.0.surface` \"spheres\" needs `particle_radius`", ":4:11"],
        ),
        (
            "surface = \"spheres\"\nparticle_radius = 0",
            &["`body.0.particle_radius` must be above 0"],
        ),
        (
            "surface = \"mesh\"\nparticle_radius = 0.1",
            &[
                "`body.0.particle_radius` only goes with surface = \"spheres\"",
                "mesh is what",
                ":5:19",
            ],
        ),
        (
            "surface = \"none\"\nparticle_radius = 0.1",
            &[
                "`body.0.particle_radius` only goes with surface = \"spheres\"",
                "no other body",
                ":5:19",
            ],
        ),
        ("particle_radius = -1", &["`body.0.particle_radius` must be above 0, but is -1"]),
        ("particel_radius = 1", &["`body.0.particel_radius`", "mean `particle_radius`?"]),
    ]);
    let message = TestDir::new().rejected(format!("{BARE}surface = \"mesh\"\n"), &[]);
    assert_contains(
        &message,
        &["`body.0.surface` cannot be \"mesh\"", "s.toml:3:11", "give `particle_radius`"],
    );
}

#[test]
fn invalid_motions_are_rejected() {
    let swing = "{ amplitude = [0, 0.1, 0], frequency = 5 }";
    check_body_lines(&[
        ("motion = \"fix\"", &["`body.0.motion` must be one of", "mean \"fixed\"?", ":4:10"]),
        (
            "motion = \"fixed\"\ninitial_velocity = [1, 0, 0]",
            &["`body.0.initial_velocity` must be zero", ":5:20", "motion = \"prescribed\""],
        ),
        (
            "motion = \"fixed\"\ninitial_angular_velocity = [1, 0, 0]",
            &["`body.0.initial_angular_velocity` must be zero", ":5:28", "motion = \"prescribed\""],
        ),
        (
            &format!("motion = \"fixed\"\noscillation = {swing}"),
            &["`body.0.oscillation` only goes with motion = \"prescribed\"", "is fixed", ":5:15"],
        ),
        (&format!("oscillation = {swing}"), &["`body.0.oscillation` only goes with", "is free"]),
        ("surface_velocity = [1, 0, 0]", &["`body.0.surface_velocity` only goes with", ":4:20"]),
        (
            "motion = \"prescribed\"\noscillation = { amplitude = [0, 1, 0] }",
            &["`body.0.oscillation.frequency` is missing"],
        ),
        (
            "motion = \"prescribed\"\noscillation = { frequency = 1 }",
            &["`body.0.oscillation.amplitude` is missing"],
        ),
        (
            "motion = \"prescribed\"\noscillation = { amplitude = [0, 1, 0], frequency = 0 }",
            &["`body.0.oscillation.frequency` must be above 0"],
        ),
        (
            "motion = \"prescribed\"\noscillation = { amplitude = [0, 1, 0], frequency = 1, fase = 0 }",
            &["`body.0.oscillation.fase`", "mean `phase`?"],
        ),
        ("motion = \"prescribed\"\nsurface_velocity = 1", &["must be an array of 3 numbers"]),
    ]);
}

#[test]
fn a_note_says_that_bodies_without_surfaces_do_not_touch() {
    let dir = TestDir::new();
    let note = "the bodies do not touch each other: none has a `surface`";
    let out = |scene: String| {
        dir.write("s.toml", format!("duration = 0.01\n{scene}"));
        dir.tumble(&["run", "s.toml"]).expect_status(0).stdout
    };
    assert_contains(&out(format!("{BODY}{BODY}")), &[note]);
    assert_contains(
        &out(format!("{BODY}copies = {{count = [2, 1, 1], spacing = [1, 1, 1]}}\n")),
        &[note],
    );
    assert!(!out(BODY.to_owned()).contains(note));
    let apart = format!("{BODY}{BODY}position = [3, 0, 0]\nparticle_radius = 0.01\n");
    assert!(!out(apart).contains(note));
}
