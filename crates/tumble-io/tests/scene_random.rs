//! Scenes that nobody would write: whatever the text, there is a world or a list of problems.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
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

const WORDS: [&str; 63] = [
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
    "position",
    "orientation",
    "copies",
    "count",
    "seed",
    "[output]",
    "interval",
    "radius",
    "subdivisions",
    "\"sphere\"",
    "\"box\"",
    "\"cat\"",
    "\"euler\"",
    "\"solid\"",
    "\"volume\"",
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
    vec((select(&WORDS[..37]), select(&WORDS[37..])), 0..12).prop_map(|lines| {
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
    fn scenes_with_other_words(text in mutated()) {
        judge(load(&text, &[]))?;
    }

    #[test]
    fn scenes_with_other_numbers(text in renumbered()) {
        let loaded = load(&text, &[]);
        if let Ok(Loaded { mut world, .. }) = load(&text, &[]) {
            // it may diverge, and then says so
            for _ in 0..3 {
                if let Err(error) = world.step() {
                    prop_assert!(error.to_string().contains("diverged"));
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
