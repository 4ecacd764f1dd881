//! Names and paths in messages and comments.

/// `text` with the replacement character for every control character, so that a name can neither
/// break a line nor command a terminal.
pub fn on_one_line(text: &str) -> String {
    replace_controls(text, |_| false)
}

/// As [`on_one_line`], for a text of several lines: line breaks and tabs are kept.
pub fn printable(text: &str) -> String {
    replace_controls(text, |c| matches!(c, '\n' | '\t'))
}

fn replace_controls(text: &str, keep: impl Fn(char) -> bool) -> String {
    let shown = |c: char| {
        if c.is_control() && !keep(c) { char::REPLACEMENT_CHARACTER } else { c }
    };
    text.chars().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_replaced() {
        let text = "a\u{1b}[31m\nb\tc\u{9b}\u{7f}ä";
        assert_eq!(on_one_line(text), "a\u{fffd}[31m\u{fffd}b\u{fffd}c\u{fffd}\u{fffd}ä");
        assert_eq!(printable(text), "a\u{fffd}[31m\nb\tc\u{fffd}\u{fffd}ä");
    }
}
