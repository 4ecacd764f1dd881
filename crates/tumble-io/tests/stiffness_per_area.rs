//! `collision_stiffness_per_area` in scenes: where it is allowed, what it overrides, and what is rejected.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use tumble_io::scene::{LoadOptions, Loaded, Source, load_text};

fn load(text: &str, sets: &[&str]) -> Result<Loaded, String> {
    let source = Source { name: "s.toml".to_owned(), text: text.to_owned() };
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let options = LoadOptions { sets, force: false };
    load_text("s", source, Path::new("/nowhere"), &options).map_err(|error| error.to_string())
}

/// A sphere above a floor; `collision`, `wall` and `body` are lines of their tables.
fn scene(collision: &str, wall: &str, body: &str) -> String {
    format!(
        "dt = 1e-4\n[collision]\n{collision}\n[[wall]]\nnormal = [0, 1, 0]\noffset = -1\n{wall}\n\
         [[body]]\nshape = \"sphere\"\nmass = 2\nmass_model = \"solid\"\n{body}\n"
    )
}

/// The stiffness of an average particle (N/m), and whether the particles have weights.
fn mean_stiffness_and_weighting(loaded: &Loaded) -> (f64, bool) {
    let body = loaded.world.body(0).model();
    (body.contacts[0].stiffness, body.shape.particles().is_weighted())
}

#[test]
fn each_stiffness_overrides_the_other_at_every_level() {
    let (k, per_area) = ("collision_stiffness = 100", "collision_stiffness_per_area = 1e6");
    // the area of a geodesic sphere of radius 0.15 m is slightly less than 4 π r²
    let mean = 1e6 * 0.28 / 642.0;
    for (collision, wall, body, is_per_area) in [
        (per_area, "", "", true),
        (k, per_area, "", true),
        (k, "", per_area, true),
        (per_area, k, "", false),
        (per_area, "", k, false),
        // the wall takes precedence over the body
        ("", k, per_area, false),
        ("", per_area, k, true),
    ] {
        let loaded = load(&scene(collision, wall, body), &[]).unwrap();
        let (stiffness, weighted) = mean_stiffness_and_weighting(&loaded);
        let what = format!("{collision} {wall} {body}: {stiffness}");
        assert_eq!(weighted, is_per_area, "{what}");
        let expected = if is_per_area { mean } else { 100.0 };
        assert!((stiffness / expected - 1.0).abs() < 0.02, "{what}");
        // a written scene gives the same stiffness when it is read again
        let text = loaded.scene.to_toml();
        assert_eq!(
            mean_stiffness_and_weighting(&load(&text, &[]).unwrap()),
            (stiffness, weighted),
            "{text}"
        );
    }
}

#[test]
fn set_options_override_the_file_and_a_table_with_both_is_rejected() {
    let text = scene("collision_stiffness = 100", "", "");
    let set = load(&text, &["collision.collision_stiffness_per_area=1e6"]).unwrap();
    assert!(mean_stiffness_and_weighting(&set).1);
    let back = ["collision.collision_stiffness_per_area=1e6", "collision.collision_stiffness=70"];
    assert_eq!(mean_stiffness_and_weighting(&load(&text, &back).unwrap()), (70.0, false));
    let both = scene("collision_stiffness = 1\ncollision_stiffness_per_area = 1", "", "");
    let error = load(&both, &[]).unwrap_err();
    let expected =
        "`collision.collision_stiffness_per_area` cannot stand beside `collision_stiffness`";
    assert!(error.contains(expected) && error.contains("s.toml:4:"), "{error}");
    let error = load(&text, &["collision.collision_stiffness_per_area=-1"]).unwrap_err();
    assert!(error.contains("must be 0 or more"), "{error}");
}

#[test]
fn particles_without_a_surface_are_rejected() {
    let per_area = "collision_stiffness_per_area = 1e6";
    let filled = scene("", per_area, "sampling = \"volume\"\nspacing = 0.05");
    let error = load(&filled, &[]).unwrap_err();
    assert!(error.contains("`collision_stiffness_per_area` is 1000000"), "{error}");
    assert!(error.contains("\"volume\" lie inside"), "{error}");
    let bare = "[[wall]]\nnormal = [0, 1, 0]\noffset = -1\ncollision_stiffness_per_area = 5\n\
                [[body]]\nparticles = [[0, 0, 0], [1, 0, 0]]\n";
    let error = load(bare, &[]).unwrap_err();
    assert!(
        error.contains("bare particles have no area") && error.contains("s.toml:5:"),
        "{error}"
    );
    // surface samples have areas; their own stiffness is allowed
    let sampled = scene("", per_area, "sampling = \"surface\"\nspacing = 0.05");
    let (stiffness, weighted) = mean_stiffness_and_weighting(&load(&sampled, &[]).unwrap());
    assert!(stiffness > 0.0 && !weighted);
}
