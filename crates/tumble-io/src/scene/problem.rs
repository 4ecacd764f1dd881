//! Problems of a scene and their places.

use std::ops::Range;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::place::{Place, Source};
use crate::counted::counted;
use crate::printable::{on_one_line, printable};

/// The largest number of problems shown; others are counted.
const MAX_SHOWN: usize = 100;

/// One problem.
#[derive(Clone, Debug, PartialEq)]
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

    /// Adds a hint.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// All problems of a scene.
#[derive(Clone, Debug)]
pub struct SceneError {
    sources: Vec<Source>,
    problems: Vec<Problem>,
}

impl SceneError {
    pub(super) fn new(sources: Vec<Source>, mut problems: Vec<Problem>) -> Self {
        problems.sort_by_key(|p| (p.place.source, p.place.span.start));
        problems.dedup();
        Self { sources, problems }
    }

    /// Number of problems.
    pub fn problem_count(&self) -> usize {
        self.problems.len()
    }

    /// The messages without source text, one per problem.
    pub fn messages(&self) -> Vec<String> {
        let words = |problem: &Problem| {
            let message = cut(&problem.message, 2000);
            match problem.key.as_str() {
                "" => message,
                key => format!("`{}` {message}", cut(key, 200)),
            }
        };
        self.problems.iter().take(MAX_SHOWN).map(words).collect()
    }

    /// All problems (of very many, the first hundred), each with file, line, column and the text
    /// it is about; with colours or not.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let renderer = renderer.decor_style(DecorStyle::Ascii);
        let shown = self.problems.iter().take(MAX_SHOWN);
        let mut reports: Vec<String> =
            shown.map(|problem| renderer.render(&[self.group(problem)])).collect();
        let hidden = self.problems.len().saturating_sub(MAX_SHOWN);
        if hidden > 0 {
            reports.push(format!("and {}", counted(hidden, "more problem", "more problems")));
        }
        reports.join("\n\n")
    }

    fn group<'a>(&'a self, problem: &'a Problem) -> Group<'a> {
        let message = cut(&problem.message, 2000);
        let title = if problem.key.is_empty() {
            message
        } else {
            format!("`{}` {message}", cut(&problem.key, 200))
        };
        let group = match self.sources.get(problem.place.source) {
            Some(source) => {
                let span = on_characters(&source.text, problem.place.span.clone());
                let (line, number, within) = line_of(&source.text, span);
                Level::ERROR.primary_title(title).element(
                    Snippet::source(line)
                        .line_start(number)
                        .path(on_one_line(&source.name))
                        .annotation(AnnotationKind::Primary.span(within)),
                )
            }
            None => Group::with_title(Level::ERROR.primary_title(title)),
        };
        match &problem.help {
            Some(help) => group.element(Level::HELP.message(printable(help))),
            None => group,
        }
    }
}

/// The span, cut to the text's end and its first line, and widened to whole characters.
fn on_characters(text: &str, span: Range<usize>) -> Range<usize> {
    let mut start = span.start.min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let mut end = span.end.clamp(start, text.len());
    while !text.is_char_boundary(end) {
        end += 1;
    }
    // do not quote a whole table or long array
    let line_end = text[start..end].find('\n').map_or(end, |at| start + at);
    start..line_end
}

/// At most `most` characters of a text that may come from the file, none of them a control.
fn cut(text: &str, most: usize) -> String {
    let start = text.char_indices().nth(most).map_or(text, |(end, _)| &text[..end]);
    let more = if start.len() < text.len() { "…" } else { "" };
    printable(start) + more
}

/// The line in which a span lies, its number from 1, and the span within it. Only this line goes
/// to the renderer, which would otherwise scan the whole text for every problem.
fn line_of(text: &str, span: Range<usize>) -> (&str, usize, Range<usize>) {
    let start = text[..span.start].rfind('\n').map_or(0, |at| at + 1);
    let number = text[..start].bytes().filter(|&byte| byte == b'\n').count() + 1;
    let end = text[span.start..].find('\n').map_or(text.len(), |at| span.start + at);
    let line = text[start..end].trim_end_matches('\r');
    let within = |at: usize| (at - start).min(line.len());
    (line, number, within(span.start)..within(span.end))
}

impl std::fmt::Display for SceneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for SceneError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_is_cut_to_whole_characters_of_its_first_line() {
        let text = "äb\ncd\r\nef";
        assert_eq!(on_characters(text, 1..2), 0..2);
        assert_eq!(on_characters(text, 2..9), 2..3);
        assert_eq!(on_characters(text, 90..99), 10..10);
        assert_eq!(line_of(text, 4..6), ("cd", 2, 0..2));
        assert_eq!(line_of(text, 6..6), ("cd", 2, 2..2));
        assert_eq!(line_of(text, 10..10), ("ef", 3, 2..2));
        assert_eq!(line_of("", 0..0), ("", 1, 0..0));
    }

    #[test]
    fn what_comes_from_a_file_is_cut_and_harmless() {
        assert_eq!(cut("abc", 3), "abc");
        assert_eq!(cut("abcd", 3), "abc…");
        assert_eq!(cut("a\u{1b}[31m", 9), "a\u{fffd}[31m");
    }

    #[test]
    fn very_many_problems_are_counted() {
        let at = |start| Place { source: 0, span: start..start + 1 };
        let problems = (0..150).rev().map(|i| Problem::new(at(i), format!("k{i}"), "is wrong"));
        // report equal problems once
        let problems = problems.chain([Problem::new(at(0), "k0", "is wrong")]).collect();
        let source = Source { name: "s".to_owned(), text: "x".repeat(150) };
        let error = SceneError::new(vec![source], problems);
        assert_eq!(error.problem_count(), 150);
        let text = error.to_string();
        assert!(text.starts_with("error: `k0` is wrong\n --> s:1:1\n"), "{text}");
        assert!(text.contains("`k99`") && !text.contains("`k100`"));
        assert!(text.ends_with("and 50 more problems"), "{text}");
    }
}
