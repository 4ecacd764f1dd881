//! Numbers and columns as text.

/// Rows of name and value, with the names padded to one width.
pub fn columns(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    rows.iter().map(|(name, value)| format!("  {name:width$}  {value}\n")).collect()
}

/// The most columns of a line of [`wrapped_columns`].
const WIDTH: usize = 100;

/// As [`columns`], with long values wrapped at spaces.
pub fn wrapped_columns(rows: &[(&str, String)]) -> String {
    let indent = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0) + 4;
    let mut lines: Vec<(&str, String)> = Vec::new();
    for (name, value) in rows {
        let mut line = String::new();
        let mut name = *name;
        for word in unbreakable(value) {
            if !line.is_empty() && indent + line.chars().count() + 1 + word.chars().count() > WIDTH
            {
                lines.push((std::mem::take(&mut name), std::mem::take(&mut line)));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(&word);
        }
        lines.push((name, line));
    }
    columns(&lines)
}

/// The words of a text, with vectors and settings such as `scale = 2` in one piece.
fn unbreakable(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match words.last_mut() {
            Some(last)
                if last.matches('(').count() > last.matches(')').count()
                    || word == "="
                    || last.ends_with('=') =>
            {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// A number with four to six significant digits, and with an exponent below 0.001 and from a million on.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        let digits = (4 - size.log10().floor() as i32).clamp(0, 7) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{x:.4e}")
    }
}

/// A count with a comma between groups of three digits, as in 1,234,567.
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_values_are_wrapped_at_spaces() {
        let settings = "set scale = 0.001 or (1, 2, 3) ".repeat(9);
        for line in wrapped_columns(&[("name", settings)]).lines() {
            assert!(line.matches('(').count() == line.matches(')').count() && !line.ends_with('='));
        }
        let text = wrapped_columns(&[("name", "word ".repeat(40)), ("b", "short".to_owned())]);
        assert!(text.lines().all(|line| line.len() <= WIDTH));
        assert!(text.starts_with("  name  word word") && text.contains("\n        word"));
        assert_eq!(text.matches("word").count(), 40);
    }

    #[test]
    fn numbers_are_short_and_counts_are_grouped() {
        assert_eq!(number(0.0), "0");
        assert_eq!(number(42.0), "42");
        assert_eq!(number(-0.001234567), "-0.0012346");
        assert_eq!(number(123456.7), "123457");
        assert_eq!(number(1e-9), "1.0000e-9");
        assert_eq!(count(1234567), "1,234,567");
        assert_eq!(count(12), "12");
    }
}
