//! Modules, style and data into one file.
//!
//! Each module becomes a function that is called at once and returns what the module exports; an
//! import becomes a look-up in what an earlier one returned. So every name stays private to its
//! module, as it is when the browser loads the modules themselves. For that the modules keep a
//! simple form, which the tests check: one import a line, at the start, and `export` only before a
//! `const`, a `function` or a `class` at the start of a line.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

use super::film::Film;
use super::head::Head;

macro_rules! modules {
    ($($name:literal),* $(,)?) => {
        [$(Module { name: $name, text: include_str!(concat!("../../embedded/viewer/", $name, ".js")) }),*]
    };
}

pub(super) struct Module {
    pub name: &'static str,
    pub text: &'static str,
}

/// In an order in which each needs only those before it.
pub(super) const MODULES: [Module; 28] = modules![
    "math",
    "format",
    "dom",
    "palette",
    "recording",
    "geometry",
    "gl",
    "shaders",
    "camera",
    "bodies",
    "walls",
    "lines",
    "arrows",
    "overlays",
    "bounds",
    "renderer",
    "picking",
    "player",
    "timeline",
    "energy_plot",
    "body_table",
    "panel",
    "connection",
    "live_controls",
    "mouse_spring",
    "keyboard",
    "app",
    "main",
];

const PAGE: &str = include_str!("../../embedded/viewer/index.html");
const STYLE: &str = include_str!("../../embedded/viewer/style.css");

const STYLE_LINK: &str = r#"<link rel="stylesheet" href="style.css">"#;
const SCRIPT_LINK: &str = r#"<script type="module" src="main.js"></script>"#;
const TITLE: &str = "<title>tumble</title>";

/// The page with a run inside: one file that needs nothing else, as `motion.html` in a run's folder.
pub fn motion_html(head: &Head, film: &Film) -> String {
    let mut head = head.clone();
    head.frame_count = film.frame_count();
    head.frames_recorded = film.seen();
    let mut data = String::new();
    data.push_str("<script type=\"application/json\" id=\"tumble-head\">");
    data.push_str(&head.to_json());
    data.push_str("</script>\n<script type=\"text/plain\" id=\"tumble-frames\">");
    STANDARD.encode_string(film.records(), &mut data);
    data.push_str("</script>\n");
    page(&format!("{} – tumble", head.name()), &data, "'none'")
}

/// The page without data: it asks the server that it came from, over a WebSocket at `/live`.
pub fn live_html() -> String {
    page("tumble", "", "'self' ws: wss:")
}

/// `connect`: whom the page may talk to.
fn page(title: &str, data: &str, connect: &str) -> String {
    let script = script();
    // the browser runs this very script and no other, and fetches nothing
    let policy = format!(
        "default-src 'none'; script-src '{}'; style-src '{}'; img-src data: blob:; connect-src {connect}; \
         base-uri 'none'; form-action 'none'",
        hash(&script),
        hash(STYLE)
    );
    let meta = format!(
        "<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n<title>{}</title>",
        escape(title)
    );
    let html = PAGE.replacen(TITLE, &meta, 1);
    let html = html.replacen(STYLE_LINK, &format!("<style>{STYLE}</style>"), 1);
    // the data may be large: they are copied once
    let (before, after) = html.split_once(SCRIPT_LINK).unwrap_or((&html, ""));
    [before, data, "<script>", &script, "</script>", after].concat()
}

fn hash(text: &str) -> String {
    format!("sha256-{}", STANDARD.encode(Sha256::digest(text)))
}

/// Text as it stands in HTML.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // letters that HTML does not allow
            '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{7f}' => {
                escaped.push('\u{fffd}');
            }
            other => escaped.push(other),
        }
    }
    escaped
}

/// All modules as one script.
pub(super) fn script() -> String {
    let mut script = String::from("\"use strict\";\n");
    for module in &MODULES {
        let mut exports = Vec::new();
        let _ = writeln!(script, "const module_{} = (() => {{", module.name);
        for line in module.text.lines() {
            script.push_str(&plain(line, &mut exports));
            script.push('\n');
        }
        let _ = writeln!(script, "return {{ {} }};\n}})();", exports.join(", "));
    }
    script
}

/// A line of a module as it stands in the script; what it exports is added to `exports`.
fn plain<'a>(line: &'a str, exports: &mut Vec<&'a str>) -> String {
    if let Some((names, from)) = import(line) {
        return format!("const {{ {names} }} = module_{from};");
    }
    let Some(rest) = line.strip_prefix("export ") else {
        return line.to_owned();
    };
    let words = ["const ", "function ", "class ", "async function "];
    if let Some(rest) = words.iter().find_map(|word| rest.strip_prefix(word)) {
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '$'));
        exports.push(&rest[..end.unwrap_or(rest.len())]);
    }
    rest.to_owned()
}

/// The names that a line imports, and from which module.
pub(super) fn import(line: &str) -> Option<(&str, &str)> {
    let (names, rest) = line.strip_prefix("import {")?.split_once('}')?;
    let from = rest.strip_prefix(" from './")?.strip_suffix(".js';")?;
    Some((names.trim(), from))
}
