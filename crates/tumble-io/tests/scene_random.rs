//! Scenes that nobody would write: whatever the text, there is a world or a list of problems.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use tumble::{Motion, Oscillation, Prescribed, Surface};
use tumble_io::scene::{BUILTIN, LoadOptions, Loaded, SceneError, Source, load_text};

fn load(text: &str, sets: &[String]) -> Result<Loaded, SceneError> {
    let source = Source { name: "s.toml".to_owned(), text: text.to_owned() };
    let options = LoadOptions { sets: sets.to_vec(), force: false };
    load_text("s", source, Path::new("/nowhere"), &options)
}

/// A world that can be written, read again and is then the same; or problems, each with a place.
fn judge(loaded: Result<Loaded, SceneError>) -> Result<(), TestCaseError> {
    match loaded {
        Ok(loaded) => {
            let text = loaded.scene.to_toml();
            let again = load(&text, &[]);
            let again = again.map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
            prop_assert_eq!(&text, &again.scene.to_toml());
            prop_assert_eq!(loaded.world.state().hash(), again.world.state().hash());
        }
        Err(error) => {
            prop_assert!(error.problem_count() > 0);
            let text = error.render(true) + &error.render(false);
            let places = text.matches("s.toml:").count() + text.matches("--set:").count();
            prop_assert!(places > 0, "{}", text);
            prop_assert!(text.len() < 1_000_000);
        }
    }
    Ok(())
}

const WORDS: [&str; 75] = [
    "duration",
    "dt",
    "gravity",
    "integrator",
    "[collision]",
    "collision_stiffness",
    "collision_stiffness_per_area",
    "[box]",
    "min",
    "max",
    "open",
    "[[wall]]",
    "[wall]",
    "normal",
    "offset",
    "[[body]]",
    "[body]",
    "body",
    "name",
    "shape",
    "mesh",
    "particles",
    "scale",
    "mass",
    "density",
    "sampling",
    "spacing",
    "mass_model",
    "center_of_mass",
    "inertia",
    "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
    "position",
    "orientation",
    "copies",
    "count",
    "seed",
    "[output]",
    "interval",
    "contact_points",
    "radius",
    "subdivisions",
    "surface",
    "particle_radius",
    "motion",
    "surface_velocity",
    "oscillation",
    "\"sphere\"",
    "\"box\"",
    "\"cat\"",
    "\"euler\"",
    "\"solid\"",
    "\"volume\"",
    "\"spheres\"",
    "\"prescribed\"",
    "{ amplitude = [0, 1, 0], frequency = 2 }",
    "\"+y\"",
    "\"",
    "'''",
    "\"\"\"",
    "[",
    "]",
    "{",
    "}",
    ",",
    ".",
    "0",
    "1",
    "-1",
    "1e999",
    "nan",
    "[1, 0, 0]",
    "[[0, 0, 0], [1, 0, 0]]",
    "[2, 1, 1]",
    "#",
    "ä",
];

fn words() -> impl Strategy<Value = String> {
    vec((select(&WORDS[..]), select(&[" ", " = ", "\n", "\r\n", ""][..])), 0..40)
        .prop_map(|words| words.into_iter().flat_map(|(word, gap)| [word, gap]).collect())
}

/// Lines `key = value` that are TOML most of the time.
fn lines() -> impl Strategy<Value = String> {
    vec((select(&WORDS[..42]), select(&WORDS[42..])), 0..12).prop_map(|lines| {
        let line = |(key, value): (&str, &str)| match key.starts_with('[') {
            true => format!("{key}\n"),
            false => format!("{key} = {value}\n"),
        };
        lines.into_iter().map(line).collect::<String>() + "[[body]]\nshape = \"tetrahedron\"\n"
    })
}

fn builtin() -> impl Strategy<Value = String> {
    select(BUILTIN.map(|scene| scene.text).to_vec()).prop_map(str::to_owned)
}

const NUMBERS: [&str; 14] = [
    "0",
    "-0.0",
    "-1",
    "5e-324",
    "1e-300",
    "1e-9",
    "0.5",
    "3",
    "1e9",
    "1e150",
    "-1e150",
    "1e300",
    "1.7976931348623157e308",
    "9223372036854775807",
];

/// A built-in scene with other numbers, which keeps its form.
fn renumbered() -> impl Strategy<Value = String> {
    let changes = vec((any::<Index>(), select(&NUMBERS[..])), 1..4);
    (builtin(), changes).prop_map(|(text, changes)| {
        let mut words: Vec<String> =
            text.split_inclusive([' ', '\n', '[', ',']).map(str::to_owned).collect();
        let trim = |word: &str| {
            word.trim_matches(|c: char| !c.is_ascii_alphanumeric() && c != '-').to_owned()
        };
        let numbers: Vec<usize> =
            (0..words.len()).filter(|&i| trim(&words[i]).parse::<f64>().is_ok()).collect();
        for (at, new) in changes {
            let word = &mut words[*at.get(&numbers)];
            *word = word.replacen(&trim(word), new, 1);
        }
        words.concat()
    })
}

/// A built-in scene with some of its words exchanged, doubled or left out.
fn mutated() -> impl Strategy<Value = String> {
    let change = (any::<Index>(), 0..4, select(&WORDS[..]), any::<Index>());
    (builtin(), vec(change, 1..4)).prop_map(|(text, changes)| {
        let mut words: Vec<String> = text.split_inclusive([' ', '\n']).map(str::to_owned).collect();
        for (at, kind, word, other) in changes {
            let (at, other) = (at.index(words.len()), other.index(words.len()));
            match kind {
                0 => words[at] = format!("{word} "),
                1 => words[at].clear(),
                2 => words.swap(at, other),
                _ => {
                    let copy = words[other].clone();
                    words.insert(at, copy);
                }
            }
        }
        words.concat()
    })
}

/// A built-in scene with some of its characters exchanged.
fn smudged() -> impl Strategy<Value = String> {
    (builtin(), vec((any::<Index>(), any::<char>()), 1..4)).prop_map(|(text, changes)| {
        let mut chars: Vec<char> = text.chars().collect();
        for (at, new) in changes {
            let at = at.index(chars.len());
            chars[at] = new;
        }
        chars.into_iter().collect()
    })
}

/// A body with whatever keys of surface and motion, each as it may be or not at all.
fn meetings() -> impl Strategy<Value = String> {
    let number = || select(&["0", "-1", "1e-9", "0.5", "nan", "1e300"][..]);
    let geometry = select(
        &["shape = \"tetrahedron\"", "particles = [[0, 0, 0], [0, 1, 0], [0.3, 0, 0.2]]"][..],
    );
    let surface = select(&["", "none", "mesh", "spheres"][..]);
    let motion = select(&["", "free", "fixed", "prescribed"][..]);
    let mass_model = select(&["particles", "solid"][..]);
    let maybe = || proptest::option::of(number());
    (geometry, surface, motion, mass_model, [maybe(), maybe(), maybe()], (maybe(), maybe()))
        .prop_map(
            |(geometry, surface, motion, mass_model, [radius, belt, amplitude], (phase, speed))| {
                let word = |key: &str, word: &str| match word {
                    "" => String::new(),
                    word => format!("{key} = \"{word}\"\n"),
                };
                let value = |value: Option<&str>, line: &dyn Fn(&str) -> String| {
                    value.map_or(String::new(), |value| line(value) + "\n")
                };
                let phase = value(phase, &|x| format!(", phase = {x}")).replace('\n', "");
                [
                    format!("[[body]]\n{geometry}\nmass_model = \"{mass_model}\"\n"),
                    word("surface", surface),
                    word("motion", motion),
                    value(radius, &|x| format!("particle_radius = {x}")),
                    value(belt, &|x| format!("surface_velocity = [{x}, 0, 0]")),
                    value(speed, &|x| format!("initial_velocity = [{x}, 0, 0]")),
                    value(amplitude, &|x| {
                        format!("oscillation = {{ amplitude = [0, {x}, 0], frequency = 2{phase} }}")
                    }),
                ]
                .concat()
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_at_all(text in any::<String>()) {
        judge(load(&text, &[]))?;
    }

    #[test]
    fn words_of_scenes_in_any_order(text in words()) {
        judge(load(&text, &[]))?;
    }

    #[test]
    fn keys_with_any_values(text in lines()) {
        judge(load(&text, &[]))?;
    }

    #[test]
    fn bodies_that_meet_and_move_by_themselves(text in meetings()) {
        judge(load(&text, &[]))?;
    }

    #[test]
    fn scenes_with_other_words(text in mutated()) {
        judge(load(&text, &[]))?;
    }

    #[test]
    fn scenes_with_other_numbers(text in renumbered()) {
        let loaded = load(&text, &[]);
        if let Ok(Loaded { mut world, .. }) = load(&text, &[]) {
            // it may diverge, or bodies may be deep in each other, and then it says so
            for _ in 0..3 {
                if let Err(error) = world.step() {
                    let message = error.to_string();
                    prop_assert!(message.contains("diverged") || message.contains("stopped"));
                    break;
                }
            }
        }
        judge(loaded)?;
    }

    #[test]
    fn scenes_with_other_characters(text in smudged()) {
        judge(load(&text, &[]))?;
    }

    #[test]
    fn any_assignment(
        key in vec(select(&["body", "0", "1", "scale", "dt", "box", "min", "wall", "", "x", "copies"][..]), 1..5),
        value in prop_oneof![any::<String>(), words()],
        free in any::<String>(),
    ) {
        let text = BUILTIN[1].text;
        judge(load(text, &[format!("{}={value}", key.join("."))]))?;
        judge(load(text, &[free]))?;
    }

    #[test]
    fn the_next_frame_is_the_first_after_a_step(
        interval in 1e-3..20.0f64, dt in prop_oneof![Just(1.0), 0.1..3.0f64], step in 0..2000u64,
    ) {
        let mut scene = load(BUILTIN[0].text, &[]).unwrap().scene;
        (scene.dt, scene.output.interval) = (dt, interval);
        let first = (0..).map(|frame| scene.frame_step(frame)).find(|&at| at > step);
        prop_assert_eq!(Some(scene.next_frame(step)), first);
    }
}

#[test]
fn what_bodies_meet_and_how_they_move_reaches_the_world() {
    let text = "[[body]]\nshape = \"tetrahedron\"\nparticle_radius = 0.01\n\
                [[body]]\nshape = \"tetrahedron\"\nposition = [3, 0, 0]\nsurface = \"mesh\"\n\
                motion = \"prescribed\"\noscillation = { amplitude = [0, 0.1, 0], frequency = 5 }\n\
                [[body]]\nshape = \"tetrahedron\"\nposition = [9, 0, 0]\nmotion = \"fixed\"\n\
                surface_velocity = [2, 0, 0]\n";
    let loaded = load(text, &[]).unwrap();
    let again = load(&loaded.scene.to_toml(), &[]).unwrap();
    for world in [loaded.world, again.world] {
        let bodies = &world.model().bodies;
        assert_eq!(bodies[0].surface, Surface::Spheres { radius: 0.01 });
        assert_eq!(bodies[0].motion, Motion::Free);
        assert_eq!(bodies[1].surface, Surface::Mesh);
        let amplitude = tumble::DVec3::new(0.0, 0.1, 0.0);
        let oscillation = Some(Oscillation { amplitude, frequency: 5.0, phase: 0.0 });
        let swing = Prescribed { oscillation, ..Prescribed::default() };
        assert_eq!(bodies[1].motion, Motion::Prescribed(swing));
        assert_eq!(bodies[2].surface, Surface::None);
        let surface_velocity = 2.0 * tumble::DVec3::X;
        let belt = Prescribed { oscillation: None, surface_velocity };
        assert_eq!(bodies[2].motion, Motion::Prescribed(belt));
    }
}

#[test]
fn a_clump_of_solid_balls_weighs_its_union_once() {
    let clump = |keys: &str| {
        let text = format!(
            "[[body]]\nparticles = [[0, 0, 0], [0.1, 0, 0]]\nscale = 2\nparticle_radius = 0.2\n\
             mass_model = \"solid\"\n{keys}"
        );
        load(&text, &[]).map(|loaded| loaded.world.model().bodies[0].clone())
    };
    // two balls whose centres are a radius apart: 27/16 of a ball
    let body = clump("density = 1000\n").unwrap();
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.008;
    assert!((body.mass / (1000.0 * ball * 27.0 / 16.0) - 1.0).abs() < 1e-4, "{}", body.mass);
    assert!((body.shape.centre() - tumble::DVec3::X * 0.1).length() < 1e-12);
    // a lone ball: 2/5 m r²
    let text = "[[body]]\nparticles = [[3, 4, 5]]\nparticle_radius = 0.5\n\
                mass_model = \"solid\"\nmass = 2\n";
    let ball = load(text, &[]).unwrap().world.model().bodies[0].clone();
    for moment in ball.inertia.to_cols_array_2d().iter().enumerate().map(|(i, column)| column[i]) {
        assert!((moment - 0.2).abs() < 1e-14, "{moment}");
    }
    // without spheres there is nothing solid
    let error = clump("surface = \"none\"\n").unwrap_err().to_string();
    assert!(error.contains("only goes with surface = \"spheres\""), "{error}");
}

#[test]
fn given_mass_properties_are_in_the_coordinates_of_the_shape_and_are_written_back() {
    let of = |keys: &str| {
        let text = format!("[[body]]\nshape = \"box\"\nsize = [1, 1, 1]\nscale = 0.5\n{keys}");
        load(&text, &[]).unwrap()
    };
    let centre = tumble::DVec3::new(0.1, 0.2, 0.3);
    let inertia = "inertia = [[0.03, 0.001, 0], [0.001, 0.04, 0], [0, 0, 0.05]]\n";
    let given = of(&format!("mass = 3\ncenter_of_mass = [0.2, 0.4, 0.6]\n{inertia}"));
    let body = &given.world.model().bodies[0];
    // the centre is scaled as the shape is, the inertia is not
    assert_eq!(body.shape.centre(), centre);
    assert!((body.inertia.x_axis - tumble::DVec3::new(0.03, 0.001, 0.0)).length() < 1e-15);
    // without a position the shape stays where it is
    assert_eq!(given.world.body(0).position(), centre);
    let placed = of("position = [1, 2, 3]\ncenter_of_mass = [0.2, 0.4, 0.6]\n");
    assert_eq!(placed.world.body(0).position(), tumble::DVec3::new(1.0, 2.0, 3.0));
    // the inertia of the mass model about its own centre stays
    let plain = of("");
    let [moved, own] = [&placed, &plain].map(|l| l.world.model().bodies[0].shape.gyration());
    assert!((moved - own).to_cols_array().iter().all(|x| x.abs() < 1e-15));
    let again = load(&given.scene.to_toml(), &[]).unwrap();
    assert_eq!(again.world.model().bodies[0].shape, body.shape);
    assert_eq!(again.scene.to_toml(), given.scene.to_toml());
}
