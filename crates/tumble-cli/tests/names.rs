//! Names of bodies, scenes and files that mean something in the formats they are written to: every output is read
//! back by a parser of its format and has the same names.

#![cfg(unix)]
#![allow(clippy::unwrap_used)]

mod common;

use std::path::Path;

use common::TestDir;
use roxmltree::Document;
use serde_json::Value;

/// Names of bodies, as they are and as a TOML string.
const BODIES: [(&str, &str); 9] = [
    ("</script><script>alert('x')</script><!--", "'''</script><script>alert('x')</script><!--'''"),
    ("a & b \\ c; &amp; &#10;", "'a & b \\ c; &amp; &#10;'"),
    ("../../outside", "'../../outside'"),
    ("=1+1", "'=1+1'"),
    ("@SUM(A1) ünïcode ☃ 球", "'@SUM(A1) ünïcode ☃ 球'"),
    ("</World/x> {def} ]]> % $HOME `id`", "'</World/x> {def} ]]> % $HOME `id`'"),
    ("it's", "\"it's\""),
    ("\"big\", the 2\" one", "'\"big\", the 2\" one'"),
    (",", "','"),
];

/// A name of a scene file with nearly everything that a file system permits.
const SCENE: &str = "'x', \"y\" <b>&amp;\n[[body]]\u{1b}[31m ☃ </script><!--";

/// Runs a scene with these names in the folder `DIR/run <"'&, ☃`.
fn run(dir: &TestDir) -> String {
    let bodies = BODIES.iter().enumerate().map(|(x, (_, name))| {
        format!(
            "[[body]]\nname = {name}\nparticles = [[0, 0, 0]]\nposition = [{x}, 0.1, 0]\nparticle_radius = 0.1\n"
        )
    });
    let bodies: String = bodies.collect();
    // `/` is the only character of SCENE that a file name cannot have
    let name = SCENE.replace('/', "|");
    dir.write(
        &format!("{name}.toml"),
        format!("duration = 0.05\n[[wall]]\nnormal = [0, 1, 0]\n{bodies}"),
    );
    let folder = "run <\"'&, ☃";
    let outcome = dir.tumble(&["run", &format!("{name}.toml"), "--out", folder]).expect_status(0);
    assert_plain(&outcome.stdout);
    assert_plain(&outcome.stderr);
    folder.to_owned()
}

/// Asserts that a text may be shown by a terminal.
fn assert_plain(text: &str) {
    assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text:?}");
}

fn names() -> Vec<&'static str> {
    BODIES.iter().map(|(name, _)| *name).collect()
}

/// The names in the column `body` of the first rows, one of each body.
fn names_in_csv(path: &Path) -> Vec<String> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let headers = reader.headers().unwrap().clone();
    let column = headers.iter().position(|name| name == "body").unwrap();
    let rows: Vec<_> = reader.records().map(|row| row.unwrap()).collect();
    assert!(rows.iter().all(|row| row.len() == headers.len()));
    assert!(rows.len() > BODIES.len());
    rows.iter().take(BODIES.len()).map(|row| row[column].to_owned()).collect()
}

/// The text between two words, the first of which occurs once.
fn between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    assert_eq!(text.matches(start).count(), 1, "{start}");
    let (_, rest) = text.split_once(start).unwrap();
    rest.split_once(end).unwrap().0
}

#[test]
fn the_files_of_a_run_have_the_names_of_its_bodies_and_scene() {
    let dir = TestDir::new();
    let folder = run(&dir);
    let scene = SCENE.replace('/', "|");
    for file in ["trajectory.csv", "contacts.csv"] {
        assert_eq!(names_in_csv(&dir.path(&folder).join(file)), names(), "{file}");
    }
    assert_eq!(dir.summary(&folder)["scene"], scene);
    let page = dir.read(&format!("{folder}/motion.html"));
    let head = between(&page, "id=\"tumble-head\">", "</script>");
    let head: Value = serde_json::from_str(head).unwrap();
    assert_eq!(head["name"], scene);
    let bodies: Vec<_> =
        head["bodies"].as_array().unwrap().iter().map(|b| b["name"].as_str().unwrap()).collect();
    assert_eq!(bodies, names());
    assert!(!page.contains("<script>alert") && !page.contains("<b>&amp;"));
    let chart = dir.read(&format!("{folder}/energy.svg"));
    let chart = Document::parse(&chart).unwrap();
    let texts: String = chart.descendants().filter_map(|node| node.text()).collect();
    assert!(texts.contains("'x', \"y\" <b>&amp;"), "{texts}");
    // the scene that was written runs again, and has the same names
    dir.run(&[&format!("{folder}/scene.toml")], "again");
    assert_eq!(names_in_csv(&dir.path("again/trajectory.csv")), names());
    // nothing was written outside
    let mut files = dir.files("");
    files.retain(|name| *name != format!("{scene}.toml"));
    assert_eq!(files, ["again", &folder]);
}

#[test]
fn a_run_with_such_names_is_resumed_to_the_same_bytes() {
    let dir = TestDir::new();
    let folder = run(&dir);
    let scene = format!("{}.toml", SCENE.replace('/', "|"));
    dir.run(&[&scene, "--duration", "0.1"], "whole");
    let outcome = dir.tumble(&["resume", &folder, "--duration", "0.1"]).expect_status(0);
    assert_plain(&outcome.stdout);
    for file in ["trajectory.csv", "contacts.csv", "energy.csv", "energy.svg", "motion.html"] {
        let read = |folder: &str| dir.read(&format!("{folder}/{file}"));
        assert_eq!(read(&folder), read("whole"), "{file}");
    }
}

#[test]
fn exports_have_the_names_of_bodies_and_scene() {
    let dir = TestDir::new();
    let folder = run(&dir);
    let export = |to: &str| {
        let outcome = dir.tumble(&["export", &folder, "--to", to]).expect_status(0);
        assert_plain(&outcome.stdout);
        std::fs::read(dir.path(to)).unwrap()
    };
    export("a.csv");
    assert_eq!(names_in_csv(&dir.path("a.csv")), names());
    let glb = export("a.glb");
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let root: Value = serde_json::from_slice(&glb[20..20 + length]).unwrap();
    let nodes: Vec<_> =
        root["nodes"].as_array().unwrap().iter().map(|n| n["name"].as_str().unwrap()).collect();
    assert_eq!(nodes[0], SCENE.replace('/', "|"));
    assert_eq!(nodes[1..=BODIES.len()], names());
    check_usda(&String::from_utf8(export("a.usda")).unwrap());
    let list = String::from_utf8(export("b <\"'&\n.pvd")).unwrap();
    let list = Document::parse(&list).unwrap();
    let files: Vec<_> = list.descendants().filter_map(|node| node.attribute("file")).collect();
    assert!(!files.is_empty());
    for file in files {
        assert!(file.starts_with("b <\"'&\n_frames/"), "{file:?}");
        assert!(dir.path(file).is_file(), "{file:?}");
    }
    for file in ["a.png", "a.gif"] {
        assert!(!export(file).is_empty());
    }
}

/// Checks that the prims have identifiers that differ, and that strings are closed in their line.
fn check_usda(text: &str) {
    let mut prims = Vec::new();
    let mut shown = Vec::new();
    for line in text.lines().map(str::trim) {
        let strings = strings(line);
        if line.starts_with("def Xform \"") {
            let name = strings[0].clone();
            let is_identifier = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
                && !name.starts_with(|c: char| c.is_ascii_digit());
            assert!(is_identifier, "{name:?}");
            prims.push(name);
        } else if line.starts_with("displayName") {
            shown.push(strings[0].clone());
        } else if line.starts_with("doc") {
            assert!(strings[0].starts_with("'x', \"y\" <b>&amp;[[body]][31m ☃"), "{strings:?}");
        }
    }
    assert_eq!(shown, names());
    prims.retain(|name| name != "shape" && name != "World");
    assert_eq!(prims.len(), BODIES.len());
    prims.sort();
    prims.dedup();
    assert_eq!(prims.len(), BODIES.len());
}

/// The strings in a line of USD.
fn strings(line: &str) -> Vec<String> {
    let (mut found, mut letters) = (Vec::new(), line.chars());
    while letters.any(|letter| letter == '"') {
        let mut string = String::new();
        loop {
            match letters.next().unwrap() {
                '\\' => string.push(letters.next().unwrap()),
                '"' => break,
                letter => string.push(letter),
            }
        }
        found.push(string);
    }
    found
}

#[test]
fn a_name_of_dots_does_not_lead_out_of_the_folder_of_results() {
    let dir = TestDir::new();
    for (file, folder) in [("..toml", "scene."), ("...toml", "scene.."), (".toml", ".toml")] {
        dir.write(file, format!("duration = 0.01\n{}", common::BODY));
        dir.tumble(&["run", file]).expect_status(0);
        assert!(dir.path(&format!("out/{folder}/summary.json")).is_file(), "{file}");
    }
    assert_eq!(dir.files(""), ["...toml", "..toml", ".toml", "out"]);
    assert_eq!(dir.files("out"), [".toml", "scene.", "scene.."]);
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let dir = TestDir::new();
    let (evil, escape) = ("a\u{1b}]0;title\u{7}\r\u{9b}31m", "\u{1b}[2J");
    dir.write(&format!("{evil}.toml"), "dt = -1\n");
    dir.write(&format!("{evil}.obj"), "v 0 0\n");
    dir.write("mesh.toml", format!("[[body]]\nmesh = '{}.obj'\n", "no such"));
    for args in [
        vec!["run".to_owned(), format!("{evil}.toml")],
        vec!["run".to_owned(), format!("{evil}{escape}.toml")],
        vec!["run".to_owned(), "task2".to_owned(), "--set".to_owned(), format!("{escape}=1")],
        vec!["run".to_owned(), "task2".to_owned(), "--set".to_owned(), format!("dt={escape}")],
        vec!["info".to_owned(), format!("{evil}.obj")],
        vec!["info".to_owned(), format!("{evil}{escape}.obj")],
        vec!["export".to_owned(), evil.to_owned(), "--to".to_owned(), "a.glb".to_owned()],
        vec!["export".to_owned(), ".".to_owned(), "--to".to_owned(), format!("a.{escape}")],
        vec!["resume".to_owned(), evil.to_owned()],
        vec!["view".to_owned(), evil.to_owned()],
        vec!["scenes".to_owned(), evil.to_owned()],
    ] {
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let outcome = dir.tumble(&args).expect_status(2);
        assert_plain(&outcome.stderr);
        assert_plain(&outcome.stdout);
    }
}
