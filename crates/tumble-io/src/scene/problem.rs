//! What is wrong with a scene, and where.

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::tree::Place;

/// A text that a scene was read from.
#[derive(Clone, Debug)]
pub struct Source {
    /// What to call it: the file's path, or `--set`.
    pub name: String,
    /// The text.
    pub text: String,
}

/// One thing that is wrong.
#[derive(Clone, Debug)]
pub struct Problem {
    place: Place,
    key: String,
    message: String,
    help: Option<String>,
}

impl Problem {
    /// `key` is the dotted key it is about, or empty.
    pub fn new(place: Place, key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { place, key: key.into(), message: message.into(), help: None }
    }

    /// Adds what to do about it.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Everything that is wrong with a scene.
#[derive(Clone, Debug)]
pub struct SceneError {
    sources: Vec<Source>,
    problems: Vec<Problem>,
}

impl SceneError {
    pub(super) fn new(sources: Vec<Source>, mut problems: Vec<Problem>) -> Self {
        problems.sort_by_key(|p| (p.place.source, p.place.span.start));
        Self { sources, problems }
    }

    /// How many problems there are.
    pub fn problem_count(&self) -> usize {
        self.problems.len()
    }

    /// All problems, each with file, line, column and the text it is about; with colours or not.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let renderer = renderer.decor_style(DecorStyle::Ascii);
        let reports: Vec<String> =
            self.problems.iter().map(|problem| renderer.render(&[self.group(problem)])).collect();
        reports.join("\n\n")
    }

    fn group<'a>(&'a self, problem: &'a Problem) -> Group<'a> {
        let title = if problem.key.is_empty() {
            problem.message.clone()
        } else {
            format!("`{}` {}", problem.key, problem.message)
        };
        let group = match self.sources.get(problem.place.source) {
            Some(source) => {
                let span = on_characters(&source.text, problem.place.span.clone());
                Level::ERROR.primary_title(title).element(
                    Snippet::source(source.text.as_str())
                        .path(source.name.as_str())
                        .annotation(AnnotationKind::Primary.span(span)),
                )
            }
            None => Group::with_title(Level::ERROR.primary_title(title)),
        };
        match &problem.help {
            Some(help) => group.element(Level::HELP.message(help.as_str())),
            None => group,
        }
    }
}

/// The span, cut to the text's end and its first line, and widened to whole characters.
fn on_characters(text: &str, span: std::ops::Range<usize>) -> std::ops::Range<usize> {
    let mut start = span.start.min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let mut end = span.end.clamp(start, text.len());
    while !text.is_char_boundary(end) {
        end += 1;
    }
    // a table or a long array would quote the whole of itself
    let line_end = text[start..end].find('\n').map_or(end, |at| start + at);
    start..line_end
}

impl std::fmt::Display for SceneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneError {}
