//! The commands of docs/tutorial.md run, and print what the tutorial quotes.
#![cfg(unix)]
#![allow(clippy::unwrap_used)]

mod common;

use std::path::Path;
use std::process::Command;

use common::TestDir;

/// A fenced block: what follows the fence, and its lines.
struct Block<'a> {
    label: &'a str,
    text: String,
}

#[test]
fn the_commands_of_the_tutorial_print_what_it_says() {
    let tutorial = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/tutorial.md");
    let tutorial = std::fs::read_to_string(tutorial).expect("docs/tutorial.md");
    let blocks = blocks(&tutorial);
    let dir = TestDir::new();
    let mut commands = 0;
    for (i, block) in blocks.iter().enumerate() {
        match block.label {
            "toml" => {
                let name = block.text.lines().next().and_then(|line| line.strip_prefix("# "));
                dir.write(name.expect("a first line `# FILE`"), &block.text);
            }
            // runs until Ctrl-C; tests/view.rs tests it
            "sh" if block.text.starts_with("tumble view") => {}
            "sh" => {
                let quoted = blocks.get(i + 1).filter(|next| next.label == "text");
                let quoted = quoted.map_or("", |next| &next.text);
                run(&dir, &block.text, quoted);
                commands += block.text.matches("tumble ").count();
            }
            _ => {}
        }
    }
    assert!(commands >= 12, "only {commands} commands of the tutorial were found");
    for file in ["first/motion.html", "die.gif", "hit.png", "die.glb", "dominoes/summary.json"] {
        assert!(dir.path(file).exists(), "the tutorial did not write {file}");
    }
}

/// Runs a block of commands and compares what it prints with what the tutorial quotes.
fn run(dir: &TestDir, script: &str, quoted: &str) {
    let binary = Path::new(env!("CARGO_BIN_EXE_tumble"));
    let folder = binary.parent().expect("the program is in a folder").display();
    let path = format!("{folder}:{}", std::env::var("PATH").unwrap_or_default());
    let output = Command::new("sh")
        .args(["-euc", script])
        .env("PATH", path)
        .current_dir(dir.path(""))
        .output()
        .expect("a shell");
    let printed = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    let fails = quoted.starts_with("error:");
    assert_eq!(output.status.success(), !fails, "{script}\nprints\n{printed}");
    for line in quoted.lines().map(str::trim) {
        // these depend on the computer
        if line.starts_with("steps ") || line.starts_with("speed ") {
            continue;
        }
        assert!(
            printed.lines().any(|l| l.trim() == line),
            "docs/tutorial.md quotes\n{line}\nbut\n{script}\nprints\n{printed}"
        );
    }
}

/// The fenced blocks of a Markdown file, also those indented in a list.
fn blocks(markdown: &str) -> Vec<Block<'_>> {
    let mut blocks = Vec::new();
    let mut open: Option<Block> = None;
    for line in markdown.lines() {
        match (&mut open, line.trim_start().strip_prefix("```")) {
            (None, Some(label)) => open = Some(Block { label, text: String::new() }),
            (None, None) => {}
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(block), None) => {
                block.text +=
                    line.strip_prefix("  ").filter(|_| block.label == "sh").unwrap_or(line);
                block.text.push('\n');
            }
        }
    }
    assert!(open.is_none(), "a block is not closed");
    blocks
}
