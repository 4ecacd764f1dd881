//! Counts in messages.

/// The count with its noun: "1 vertex", "2 vertices".
pub(crate) fn counted(count: usize, one: &str, many: &str) -> String {
    let noun = if count == 1 { one } else { many };
    format!("{count} {noun}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular() {
        let counts = [0, 1, 2].map(|count| counted(count, "vertex", "vertices"));
        assert_eq!(counts, ["0 vertices", "1 vertex", "2 vertices"]);
    }
}
