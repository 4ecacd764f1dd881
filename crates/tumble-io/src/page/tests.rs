use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::assemble::{MODULES, escape, parse_import, script};
use super::*;
use crate::plot::EnergyRow;
use crate::scene::{LoadOptions, Loaded, Source, load_builtin, load_text};

fn between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    let from = text.find(start).unwrap() + start.len();
    let length = text[from..].find(end).unwrap();
    &text[from..from + length]
}

fn record(loaded: &Loaded, frames: u64) -> Recording {
    let mut recording = Recording::new(loaded.world.body_count(), loaded.world.joint_count());
    for step in 0..frames {
        let row = EnergyRow { time: step as f64, ..EnergyRow::default() };
        recording.record(step, &row, &WorldFrame::new(&loaded.world));
    }
    recording
}

fn task2() -> Loaded {
    load_builtin("task2", &LoadOptions::default()).unwrap().unwrap()
}

#[test]
fn the_page_contains_header_and_frames() {
    let loaded = task2();
    let recording = record(&loaded, 3);
    let html = motion_html(&Header::new(&loaded.scene, &loaded.world), &recording);
    let json = between(&html, "id=\"tumble-head\">", "</script>");
    let head: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(head["type"], "head");
    assert_eq!(head["frame_count"], 3);
    assert_eq!(head["box"]["open"][0], "+y");
    assert_eq!(head["walls"].as_array().unwrap().len(), 5);
    assert_eq!(head["shapes"][0]["particle_count"], 42);
    let vertices = STANDARD.decode(head["shapes"][0]["vertices"].as_str().unwrap()).unwrap();
    assert_eq!(vertices.len(), 42 * 12);
    assert!(head["shapes"][0]["particles"].is_null());
    let frames = STANDARD.decode(between(&html, "id=\"tumble-frames\">", "</script>")).unwrap();
    assert_eq!(frames, recording.records());
    assert_eq!(frames.len(), 3 * record_size(1, 0));
    let number = |at: usize| f64::from_le_bytes(frames[at..at + 8].try_into().unwrap());
    assert_eq!(number(record_size(1, 0)), 1.0);
}

#[test]
fn contact_is_the_wall_force_of_the_latest_step() {
    let mut loaded = task2();
    let weight = 42.0 * 9.8;
    let mut strongest: f64 = 0.0;
    assert_eq!(loaded.world.contact_wrench(0).force.length(), 0.0);
    for _ in 0..1000 {
        let before = loaded.world.body(0).velocity();
        loaded.world.step().unwrap();
        let contact = loaded.world.contact_wrench(0).force;
        let drag = before * -42.0;
        let change = (loaded.world.body(0).velocity() - before) * (42.0 / loaded.world.dt());
        let expected = change - drag - tumble::DVec3::Y * -weight;
        assert!((contact - expected).length() < 1e-6 * (1.0 + contact.length()));
        strongest = strongest.max(contact.length());
    }
    assert!(strongest > weight);
}

#[test]
fn names_in_the_page_are_escaped() {
    let evil = "</script><script>alert(1)</script><!-- & \"";
    let text = "description = '</script><!--<script>'\n[[body]]\nshape = \"sphere\"\n";
    let source = Source { name: "evil".to_owned(), text: text.to_owned() };
    let loaded =
        load_text(evil, source, std::path::Path::new("."), &LoadOptions::default()).unwrap();
    let html = motion_html(&Header::new(&loaded.scene, &loaded.world), &record(&loaded, 1));
    let plain = motion_html(&Header::new(&task2().scene, &task2().world), &record(&task2(), 1));
    for tag in ["<script", "</script>", "<!--", "<title>", "</title>"] {
        assert_eq!(html.matches(tag).count(), plain.matches(tag).count(), "{tag}");
    }
    let json = between(&html, "id=\"tumble-head\">", "</script>");
    let head: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(head["name"], evil);
    assert_eq!(escape("a<b>&\"\u{1}"), "a&lt;b&gt;&amp;&quot;\u{fffd}");
}

#[test]
fn the_page_loads_nothing_from_outside() {
    for html in [
        live_html(),
        motion_html(&Header::new(&task2().scene, &task2().world), &Recording::new(1, 0)),
    ] {
        for word in ["http://", "https://", " src=", "url(", "@import", "import ", "export "] {
            let allowed = html.replace("http://www.w3.org/2000/svg", "");
            assert!(!allowed.contains(word), "{word}");
        }
        assert!(html.contains("default-src 'none'"));
        assert!(html.starts_with("<!doctype html>"));
        assert!(html.trim_end().ends_with("</html>"));
        // size of the page without data
        assert!(html.len() < 400_000, "{}", html.len());
    }
    assert!(!live_html().contains("id=\"tumble-head\""));
}

#[test]
fn modules_have_the_form_that_the_script_requires() {
    for (index, module) in MODULES.iter().enumerate() {
        let before: Vec<_> = MODULES[..index].iter().map(|module| module.name).collect();
        let mut code = false;
        for line in module.text.lines() {
            if line.starts_with("import") {
                let (names, from) =
                    parse_import(line).unwrap_or_else(|| panic!("{}: {line}", module.name));
                assert!(before.contains(&from), "{} before {from}", module.name);
                assert!(!names.contains(" as ") && !code, "{}: {line}", module.name);
                let text = MODULES.iter().find(|other| other.name == from).unwrap().text;
                for name in names.split(',').map(str::trim).filter(|name| !name.is_empty()) {
                    let found = ["const", "function", "class", "async function"]
                        .iter()
                        .any(|word| has_export(text, &format!("export {word} {name}")));
                    assert!(found, "{} imports {name} from {from}", module.name);
                }
            } else if !(line.is_empty() || line.starts_with("//")) {
                code = true;
            }
            let exported = line.strip_prefix("export ");
            let simple = exported.is_none_or(|rest| {
                ["const ", "function ", "class ", "async function "]
                    .iter()
                    .any(|w| rest.starts_with(w) && !rest[w.len()..].starts_with(['{', '[']))
            });
            assert!(simple, "{}: {line}", module.name);
            assert!(!line.contains("</script") && !line.contains("<!--"), "{line}");
        }
        assert!(module.text.lines().count() < 600, "{}", module.name);
    }
    assert!(!script().contains("\nexport "));
}

fn has_export(text: &str, start: &str) -> bool {
    text.lines().any(|line| {
        line.strip_prefix(start)
            .is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    })
}

#[test]
fn every_module_in_the_viewer_folder_is_in_the_page() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../viewer");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .filter_map(|entry| {
            let name = entry.unwrap().file_name().into_string().unwrap();
            name.strip_suffix(".js").map(str::to_owned)
        })
        .collect();
    let mut names: Vec<_> = MODULES.iter().map(|module| module.name.to_owned()).collect();
    files.sort();
    names.sort();
    assert_eq!(files, names);
}

#[test]
fn a_long_recording_is_thinned_out_and_keeps_both_ends() {
    let mut recording = Recording::with_capacity(record_size(0, 0), 8);
    for step in 0..1003 {
        let row = EnergyRow { time: step as f64, ..EnergyRow::default() };
        recording.record(step, &row, &WorldFrame::default());
        let records = recording.records();
        assert_eq!(records.len(), recording.frame_count() * record_size(0, 0));
        let time = |record: &[u8]| f64::from_le_bytes(record[..8].try_into().unwrap());
        let times: Vec<_> = records.chunks(record_size(0, 0)).map(time).collect();
        assert_eq!(times[0], 0.0);
        assert_eq!(times.last(), Some(&(step as f64)));
        assert!(times.len() <= 9 && times.is_sorted_by(|a, b| a < b), "{times:?}");
        // evenly spaced, apart from the last frame
        let gaps: Vec<_> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(gaps.iter().rev().skip(1).all(|gap| *gap == gaps[0]), "{times:?}");
    }
    assert_eq!(recording.recorded_count(), 1003);
    let large = Recording::new(1_000_000, 0);
    assert!(large.is_empty() && large.frame_count() == 0);
}
