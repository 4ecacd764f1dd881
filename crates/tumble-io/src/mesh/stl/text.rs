//! Text STL: a sequence of words, whatever their lines.
//!
//! Only the name of a solid depends on lines: it runs to the end of its line, unless a facet begins there.

use glam::DVec3;

use super::super::error::ReadError;
use super::super::parsed::Parsed;
use super::super::text::{Style, Words, show};
use super::Soup;

/// Reads the bytes of a text file.
pub(super) fn parse(bytes: &[u8]) -> Result<Parsed, ReadError> {
    let words = Words::new(bytes, Style::Plain);
    let mut reader = Reader { words, soup: Soup::default(), solid_count: 0, inside: false };
    while let Some(word) = reader.words.next_word_of_text() {
        reader.statement(word)?;
    }
    if reader.inside {
        return Err(reader.words.line_error("the file ends without `endsolid`: it is truncated"));
    }
    reader.soup.finish(reader.solid_count)
}

struct Reader<'a> {
    words: Words<'a>,
    soup: Soup,
    solid_count: usize,
    /// Whether a solid is open.
    inside: bool,
}

impl<'a> Reader<'a> {
    /// Reads a statement outside of facets.
    fn statement(&mut self, word: &[u8]) -> Result<(), ReadError> {
        match word.to_ascii_lowercase().as_slice() {
            b"solid" => {
                self.open_solid();
                self.skip_name()
            }
            b"facet" => self.facet(),
            b"endsolid" => self.close_solid(),
            // the words of a facet read their own ends
            b"end" => {
                self.expect("solid")?;
                self.close_solid()
            }
            b"color" => {
                self.skip_numbers();
                Ok(())
            }
            b"normal" | b"outer" | b"loop" | b"vertex" | b"endloop" | b"endfacet" => {
                Err(self.words.error(format!(
                    "{} is out of place: facet, endsolid or solid is expected here",
                    show(word)
                )))
            }
            _ => Err(self.words.error(format!(
                "{} is no STL statement; solid, facet, outer loop, vertex, endloop, endfacet or endsolid is expected",
                show(word)
            ))),
        }
    }

    fn open_solid(&mut self) {
        (self.solid_count, self.inside) = (self.solid_count + 1, true);
    }

    fn close_solid(&mut self) -> Result<(), ReadError> {
        self.inside = false;
        self.skip_name()
    }

    /// Reads a facet, behind its first word.
    fn facet(&mut self) -> Result<(), ReadError> {
        // a line such as `endsolid a solid b facet …` has opened the next solid within a name
        if !self.inside {
            self.open_solid();
        }
        self.open_loop()?;
        for _ in 0..3 {
            let word = self.next("vertex")?;
            if !word.eq_ignore_ascii_case(b"vertex") {
                return Err(self.corner_error(word));
            }
            let corner = [
                self.coordinate("the x coordinate")?,
                self.coordinate("the y coordinate")?,
                self.coordinate("the z coordinate")?,
            ];
            self.soup.vertices.push(DVec3::from_array(corner));
        }
        self.expect_end("endloop")?;
        self.expect_end("endfacet")
    }

    /// Reads `normal x y z outer loop`; the normal may be left out.
    fn open_loop(&mut self) -> Result<(), ReadError> {
        let mut word = self.next("normal")?;
        if word.eq_ignore_ascii_case(b"normal") {
            // it is not used, and some programs write what is no number, such as `-1.#IND`
            for _ in 0..4 {
                word = self.next("outer loop")?;
                if word.eq_ignore_ascii_case(b"outer") {
                    break;
                }
            }
        }
        if !word.eq_ignore_ascii_case(b"outer") {
            return Err(self
                .words
                .error(format!("{} stands where `outer loop` is expected", show(word))));
        }
        self.expect("loop")
    }

    /// The next word, which a facet needs.
    fn next(&mut self, wanted: &str) -> Result<&'a [u8], ReadError> {
        let word = self.words.next_word_of_text();
        word.ok_or_else(|| {
            self.words.error(format!("the file ends where `{wanted}` is expected: it is truncated"))
        })
    }

    fn expect(&mut self, wanted: &str) -> Result<(), ReadError> {
        let word = self.next(wanted)?;
        if word.eq_ignore_ascii_case(wanted.as_bytes()) {
            return Ok(());
        }
        Err(self.words.error(format!("{} stands where `{wanted}` is expected", show(word))))
    }

    /// Reads `endloop` or `endfacet`, or the same as two words.
    fn expect_end(&mut self, wanted: &str) -> Result<(), ReadError> {
        let word = self.next(wanted)?;
        if word.eq_ignore_ascii_case(wanted.as_bytes()) {
            return Ok(());
        }
        if word.eq_ignore_ascii_case(b"end") {
            return self.expect(wanted.trim_start_matches("end"));
        }
        Err(self.corner_error(word))
    }

    fn corner_error(&self, word: &[u8]) -> ReadError {
        self.words.error(format!(
            "{} is out of place in a facet; each has exactly 3 times `vertex x y z`, then endloop and endfacet",
            show(word)
        ))
    }

    fn coordinate(&mut self, what: &str) -> Result<f64, ReadError> {
        match self.words.next_word_of_text() {
            Some(word) => self.words.number(word, what),
            None => Err(self.words.error(format!("{what} is missing; a number is expected"))),
        }
    }

    /// Skips the name of a solid: the rest of its line, up to a facet that begins there.
    fn skip_name(&mut self) -> Result<(), ReadError> {
        loop {
            let mut ahead = self.words.clone();
            let Some(word) = ahead.next_word() else { return Ok(()) };
            // a name may hold a keyword, but nobody calls a part `facet normal 0 0 1`
            if word.eq_ignore_ascii_case(b"facet") && begins_facet(ahead.clone()) {
                return Ok(());
            }
            if word.eq_ignore_ascii_case(b"vertex") && begins_position(ahead.clone()) {
                return Err(ahead.error(
                    "a vertex stands in the line of a solid's name, and no `facet normal x y z` begins before it",
                ));
            }
            self.words = ahead;
        }
    }

    /// Skips the numbers that follow in this line.
    fn skip_numbers(&mut self) {
        let mut ahead = self.words.clone();
        while ahead.next_word().is_some_and(is_number) {
            self.words = ahead.clone();
        }
    }
}

/// Whether the words behind `facet` are those of a facet, and not of a name.
fn begins_facet(mut words: Words<'_>) -> bool {
    let first = words.next_word_of_text().unwrap_or_default();
    let second = words.next_word_of_text().unwrap_or_default();
    (first.eq_ignore_ascii_case(b"normal") && is_number(second))
        || (first.eq_ignore_ascii_case(b"outer") && second.eq_ignore_ascii_case(b"loop"))
}

/// Whether three numbers follow.
fn begins_position(mut words: Words<'_>) -> bool {
    (0..3).all(|_| words.next_word_of_text().is_some_and(is_number))
}

/// Whether a word is a number, or what programs write for infinite ones (`nan`, `-1.#IND`).
fn is_number(word: &[u8]) -> bool {
    let digits = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(word);
    let [first, ..] = digits else { return false };
    let text = std::str::from_utf8(digits).unwrap_or_default();
    first.is_ascii_digit() || *first == b'.' || text.parse::<f64>().is_ok()
}
