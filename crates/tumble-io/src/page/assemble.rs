//! Combines modules, style sheet and data into one HTML file.
//!
//! Each JavaScript module becomes a function that is called immediately and returns the exports of the
//! module. An import becomes a destructuring of the object that an earlier module returned. So names
//! stay private to their module, as when a browser loads the modules. This requires a simple form of
//! the modules, which the tests check: one import per line, imports first, and `export` only before
//! `const`, `function` or `class` at the start of a line.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

use super::header::Header;
use super::recording::Recording;

macro_rules! modules {
    ($($name:literal),* $(,)?) => {
        [$(Module { name: $name, text: include_str!(concat!("../../embedded/viewer/", $name, ".js")) }),*]
    };
}

/// A JavaScript module of the viewer.
pub(super) struct Module {
    pub name: &'static str,
    pub text: &'static str,
}

/// All modules. Each imports only from earlier ones.
pub(super) const MODULES: [Module; 33] = modules![
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
    "joints",
    "overlays",
    "joint_shapes",
    "bounds",
    "renderer",
    "picking",
    "player",
    "timeline",
    "time_plot",
    "energy_plot",
    "table",
    "body_table",
    "joint_list",
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

/// The page with a recorded run, as `motion.html` in the folder of a run. It loads no other file.
pub fn motion_html(header: &Header, recording: &Recording) -> String {
    let mut header = header.clone();
    header.frame_count = recording.frame_count();
    header.frames_recorded = recording.recorded_count();
    let mut data = String::new();
    data.push_str("<script type=\"application/json\" id=\"tumble-head\">");
    data.push_str(&header.to_json());
    data.push_str("</script>\n<script type=\"text/plain\" id=\"tumble-frames\">");
    STANDARD.encode_string(recording.records(), &mut data);
    data.push_str("</script>\n");
    page(&format!("{} – tumble", header.name()), &data, "'none'")
}

/// The page without a run. It connects to its server over a WebSocket at `/live`.
pub fn live_html() -> String {
    page("tumble", "", "'self' ws: wss:")
}

/// The page. `connect` lists the connections that its content security policy permits.
fn page(title: &str, data: &str, connect: &str) -> String {
    let script = script();
    // permits only this script and style sheet, and no requests except `connect`
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
    // the data may be large, so they are copied only once
    let (before, after) = html.split_once(SCRIPT_LINK).unwrap_or((&html, ""));
    [before, data, "<script>", &script, "</script>", after].concat()
}

fn hash(text: &str) -> String {
    format!("sha256-{}", STANDARD.encode(Sha256::digest(text)))
}

/// `text` as text or an attribute value of HTML.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // control characters that HTML does not permit
            '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{7f}' => {
                escaped.push('\u{fffd}');
            }
            other => escaped.push(other),
        }
    }
    escaped
}

/// All modules combined into one script.
pub(super) fn script() -> String {
    let mut script = String::from("\"use strict\";\n");
    for module in &MODULES {
        let mut exports = Vec::new();
        let _ = writeln!(script, "const module_{} = (() => {{", module.name);
        for line in module.text.lines() {
            script.push_str(&convert_line(line, &mut exports));
            script.push('\n');
        }
        let _ = writeln!(script, "return {{ {} }};\n}})();", exports.join(", "));
    }
    script
}

/// Converts a line of a module for the script. Adds a name that it exports to `exports`.
fn convert_line<'a>(line: &'a str, exports: &mut Vec<&'a str>) -> String {
    if let Some((names, from)) = parse_import(line) {
        return format!("const {{ {names} }} = module_{from};");
    }
    let Some(rest) = line.strip_prefix("export ") else {
        return line.to_owned();
    };
    let keywords = ["const ", "function ", "class ", "async function "];
    if let Some(rest) = keywords.iter().find_map(|keyword| rest.strip_prefix(keyword)) {
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '$'));
        exports.push(&rest[..end.unwrap_or(rest.len())]);
    }
    rest.to_owned()
}

/// The names that an import line imports, and the name of the module that exports them.
pub(super) fn parse_import(line: &str) -> Option<(&str, &str)> {
    let (names, rest) = line.strip_prefix("import {")?.split_once('}')?;
    let from = rest.strip_prefix(" from './")?.strip_suffix(".js';")?;
    Some((names.trim(), from))
}
