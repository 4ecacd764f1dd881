//! Reads the keys of a table by name, type and range, and collects the problems.

use std::cell::RefCell;

use tumble::DVec3;

use super::place::Place;
use super::problem::Problem;
use super::tree::{Entry, Node, Value};

/// The range of a number.
#[derive(Clone, Copy, Debug)]
pub enum Range {
    /// Any finite number.
    Finite,
    /// Above 0.
    Positive,
    /// 0 or more.
    NotNegative,
    /// Above 0, up to 1.
    UpToOne,
    /// Above 0, below 1.
    BelowOne,
    /// Any number, infinite ones too.
    Any,
    /// Above 0, infinity too.
    PositiveOrInfinite,
}

impl Range {
    fn allows(self, x: f64) -> bool {
        let has_infinite = matches!(self, Self::Any | Self::PositiveOrInfinite);
        (x.is_finite() || (has_infinite && !x.is_nan()))
            && match self {
                Self::Finite | Self::Any => true,
                Self::Positive | Self::PositiveOrInfinite => x > 0.0,
                Self::NotNegative => x >= 0.0,
                Self::UpToOne => x > 0.0 && x <= 1.0,
                Self::BelowOne => x > 0.0 && x < 1.0,
            }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Finite => "finite",
            Self::Positive | Self::PositiveOrInfinite => "above 0",
            Self::Any => "not nan",
            Self::NotNegative => "0 or more",
            Self::UpToOne => "above 0, up to 1",
            Self::BelowOne => "above 0 and below 1",
        }
    }
}

/// A table while it is read. [`Reader::finish`] reports the keys that were not read.
pub struct Reader<'a> {
    /// Whether this is a table; if not, that is the only problem reported.
    is_table: bool,
    entries: &'a [Entry],
    place: Place,
    path: String,
    requested: RefCell<Vec<&'static str>>,
    /// What is needed and not given: the keys any of which would do, and the problem.
    missing: RefCell<Vec<(Vec<&'static str>, Problem)>>,
    problems: &'a RefCell<Vec<Problem>>,
}

impl<'a> Reader<'a> {
    /// Reads `node` at the dotted `path`; anything but a table is a problem.
    pub fn new(node: &'a Node, path: String, problems: &'a RefCell<Vec<Problem>>) -> Self {
        let entries: &[Entry] = match &node.value {
            Value::Table(entries) => entries,
            other => {
                let message = format!("must be a table, but is {}", other.kind());
                problems.borrow_mut().push(Problem::new(node.place.clone(), path.clone(), message));
                &[]
            }
        };
        let is_table = matches!(node.value, Value::Table(_));
        let (requested, missing) = (RefCell::default(), RefCell::default());
        Self { is_table, entries, place: node.place.clone(), path, requested, missing, problems }
    }

    /// The dotted name of one of its keys.
    pub fn key(&self, key: &str) -> String {
        match (self.path.as_str(), key) {
            ("", key) => key.to_owned(),
            (path, "") => path.to_owned(),
            (path, key) => format!("{path}.{key}"),
        }
    }

    /// Reports a problem with one of its keys, or with the table where the key is not given.
    pub fn problem(&self, key: &str, message: impl Into<String>) {
        if self.is_table {
            self.report(Problem::new(self.place_of(key), self.key(key), message));
        }
    }

    /// Reports a problem.
    pub fn report(&self, problem: Problem) {
        self.problems.borrow_mut().push(problem);
    }

    /// Reports that a key is needed if it is not given, unless [`finish`](Self::finish) finds a misspelling of it,
    /// which is then the only problem.
    pub fn need(&self, key: &'static str, message: impl Into<String>) {
        if !self.has(key) {
            self.missing(&[key], Problem::new(self.place.clone(), self.key(key), message));
        }
    }

    /// Reports that one of `keys` is needed, unless [`finish`](Self::finish) finds a misspelling of one of them.
    pub fn missing(&self, keys: &[&'static str], problem: Problem) {
        if self.is_table {
            self.missing.borrow_mut().push((keys.to_vec(), problem));
        }
    }

    /// The place of the value of a key, or of the table if the key is not given.
    pub fn place_of(&self, key: &str) -> Place {
        let found = self.entries.iter().find(|entry| entry.key == key);
        found.map_or(self.place.clone(), |entry| entry.node.place.clone())
    }

    /// Whether the key is given.
    pub fn has(&self, key: &str) -> bool {
        self.entries.iter().any(|entry| entry.key == key)
    }

    /// Marks keys as known, where another problem prevents reading them.
    pub fn mark_known(&self, keys: &[&'static str]) {
        self.requested.borrow_mut().extend(keys);
    }

    fn get(&self, key: &'static str) -> Option<&'a Node> {
        self.requested.borrow_mut().push(key);
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    /// A number in a range.
    pub fn number(&self, key: &'static str, range: Range) -> Option<f64> {
        let node = self.get(key)?;
        match number(node) {
            Some(x) if range.allows(x) => Some(x),
            Some(x) => {
                self.problem(key, format!("must be {}, but is {}", range.text(), plain(x)));
                None
            }
            None => {
                self.wrong_type(key, node, &format!("a number, {}", range.text()));
                None
            }
        }
    }

    /// A whole number from `least` to `most`, inclusive.
    pub fn integer(&self, key: &'static str, least: i64, most: i64) -> Option<i64> {
        let node = self.get(key)?;
        match node.value {
            Value::Integer(i) if (least..=most).contains(&i) => Some(i),
            Value::Integer(i) => {
                self.problem(key, format!("must be from {least} to {most}, but is {i}"));
                None
            }
            _ => {
                self.wrong_type(key, node, &format!("a whole number from {least} to {most}"));
                None
            }
        }
    }

    /// An array of exactly `N` numbers in a range.
    pub fn numbers<const N: usize>(&self, key: &'static str, range: Range) -> Option<[f64; N]> {
        let node = self.get(key)?;
        match numbers(node) {
            Some(x) if x.iter().all(|&x| range.allows(x)) => Some(x),
            Some(x) => {
                self.problem(
                    key,
                    format!("must hold numbers that are {}, but is {x:?}", range.text()),
                );
                None
            }
            None => {
                let wanted = if key == "orientation" { " (a quaternion w, x, y, z)" } else { "" };
                self.wrong_type(key, node, &format!("an array of {N} numbers{wanted}"));
                None
            }
        }
    }

    /// A vector of three finite numbers.
    pub fn vector(&self, key: &'static str) -> Option<DVec3> {
        self.numbers::<3>(key, Range::Finite).map(DVec3::from_array)
    }

    /// Three rows of three finite numbers.
    pub fn matrix(&self, key: &'static str) -> Option<[[f64; 3]; 3]> {
        let node = self.get(key)?;
        let rows = match &node.value {
            Value::Array(items) => items.iter().map(numbers::<3>).collect::<Option<Vec<_>>>(),
            _ => None,
        };
        let rows: Option<[[f64; 3]; 3]> = rows.and_then(|rows| rows.try_into().ok());
        let rows = rows.filter(|rows| rows.iter().flatten().all(|x| x.is_finite()));
        if rows.is_none() {
            let message = "must be three rows of three finite numbers, [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]";
            self.report(Problem::new(node.place.clone(), self.key(key), message));
        }
        rows
    }

    /// An array of points.
    pub fn points(&self, key: &'static str) -> Option<Vec<DVec3>> {
        let node = self.get(key)?;
        let Value::Array(items) = &node.value else {
            self.wrong_type(key, node, "an array of points [x, y, z]");
            return None;
        };
        if items.is_empty() {
            self.problem(key, "is empty, but a body needs at least one particle");
            return None;
        }
        let mut points = Vec::with_capacity(items.len());
        for (index, item) in items.iter().enumerate() {
            match numbers::<3>(item).map(DVec3::from_array) {
                Some(point) if point.is_finite() => points.push(point),
                _ => {
                    let name = format!("{}.{index}", self.key(key));
                    let message = "must be a point [x, y, z] of three finite numbers";
                    self.report(Problem::new(item.place.clone(), name, message));
                }
            }
        }
        (points.len() == items.len()).then_some(points)
    }

    /// A point, which both values then are, or a pair of points.
    pub fn point_or_pair(&self, key: &'static str) -> Option<[DVec3; 2]> {
        let node = self.get(key)?;
        let point = |node| numbers::<3>(node).map(DVec3::from_array).filter(|p| p.is_finite());
        let pair = match &node.value {
            Value::Array(items) if items.len() == 2 => point(&items[0]).zip(point(&items[1])),
            _ => None,
        };
        let found = point(node).map(|p| [p, p]).or(pair.map(|(a, b)| [a, b]));
        if found.is_none() {
            self.wrong_type(
                key,
                node,
                "a point [x, y, z] or two points [[x, y, z], [x, y, z]] of finite numbers",
            );
        }
        found
    }

    /// An array of arrays of exactly `N` finite numbers; `what` describes one.
    pub fn rows<const N: usize>(&self, key: &'static str, what: &str) -> Option<Vec<[f64; N]>> {
        let node = self.get(key)?;
        let rows = match &node.value {
            Value::Array(items) if !items.is_empty() => {
                let row = |item| numbers::<N>(item).filter(|row| row.iter().all(|x| x.is_finite()));
                items.iter().map(row).collect::<Option<Vec<_>>>()
            }
            _ => None,
        };
        if rows.is_none() {
            self.wrong_type(key, node, &format!("an array of rows {what} of finite numbers"));
        }
        rows
    }

    /// Two names; "world" is `None`.
    pub fn pair_of_names(&self, key: &'static str) -> Option<[Option<String>; 2]> {
        let node = self.get(key)?;
        let name = |node: &Node| match &node.value {
            Value::String(text) => Some((text != "world").then(|| text.clone())),
            _ => None,
        };
        let pair = match &node.value {
            Value::Array(items) if items.len() == 2 => name(&items[0]).zip(name(&items[1])),
            _ => None,
        };
        if pair.is_none() {
            self.wrong_type(key, node, "two names in brackets, of bodies or \"world\"");
        }
        pair.map(|(first, second)| [first, second])
    }

    /// A boolean.
    pub fn switch(&self, key: &'static str) -> Option<bool> {
        let node = self.get(key)?;
        if let Value::Boolean(boolean) = node.value {
            return Some(boolean);
        }
        self.wrong_type(key, node, "true or false");
        None
    }

    /// A boolean (`Ok`) or a number in a range (`Err`), which `what` describes.
    pub fn switch_or_number(
        &self,
        key: &'static str,
        range: Range,
        what: &str,
    ) -> Option<Result<bool, f64>> {
        let node = self.get(key)?;
        match (&node.value, number(node)) {
            (Value::Boolean(boolean), _) => Some(Ok(*boolean)),
            (_, Some(x)) if range.allows(x) => Some(Err(x)),
            (_, Some(x)) => {
                let (range, given) = (range.text(), plain(x));
                self.problem(
                    key,
                    format!("must be true, false, or {what}, {range}, but is {given}"),
                );
                None
            }
            _ => {
                self.wrong_type(key, node, &format!("true, false, or {what}"));
                None
            }
        }
    }

    /// A string.
    pub fn string(&self, key: &'static str) -> Option<&'a str> {
        let node = self.get(key)?;
        if let Value::String(text) = &node.value {
            return Some(text);
        }
        self.wrong_type(key, node, "a string");
        None
    }

    /// An array of strings, each one of `allowed`.
    pub fn choices(
        &self,
        key: &'static str,
        allowed: &[&'static str],
    ) -> Option<Vec<&'static str>> {
        let node = self.get(key)?;
        let Value::Array(items) = &node.value else {
            self.wrong_type(key, node, &format!("an array of {}", quoted(allowed)));
            return None;
        };
        Some(items.iter().filter_map(|item| self.choose(key, item, allowed)).collect())
    }

    /// One of a few words.
    pub fn choice(&self, key: &'static str, allowed: &[&'static str]) -> Option<&'static str> {
        let node = self.get(key)?;
        self.choose(key, node, allowed)
    }

    fn choose(&self, key: &str, node: &Node, allowed: &[&'static str]) -> Option<&'static str> {
        let found = match &node.value {
            Value::String(text) => allowed.iter().find(|word| *word == text).copied(),
            _ => None,
        };
        if found.is_none() {
            let (given, near) = match &node.value {
                Value::String(text) => (format!("\"{text}\""), nearest(text, allowed)),
                other => (other.kind().to_owned(), None),
            };
            let message = format!("must be one of {}, but is {given}", quoted(allowed));
            let problem = Problem::new(node.place.clone(), self.key(key), message);
            self.report(match near {
                Some(near) => problem.help(format!("did you mean \"{near}\"?")),
                None => problem,
            });
        }
        found
    }

    /// A table inside this one.
    pub fn table(&self, key: &'static str) -> Option<Reader<'a>> {
        let node = self.get(key)?;
        Some(Reader::new(node, self.key(key), self.problems))
    }

    /// An array of tables, `[[key]]`.
    pub fn tables(&self, key: &'static str) -> Vec<Reader<'a>> {
        match self.get(key) {
            None => Vec::new(),
            Some(node) => match &node.value {
                Value::Array(items) => items
                    .iter()
                    .enumerate()
                    .map(|(i, item)| {
                        Reader::new(item, format!("{}.{i}", self.key(key)), self.problems)
                    })
                    .collect(),
                _ => {
                    let problem = Problem::new(
                        node.place.clone(),
                        self.key(key),
                        format!("must be an array of tables, but is {}", node.value.kind()),
                    );
                    self.report(problem.help(format!("write [[{key}]] with two brackets")));
                    Vec::new()
                }
            },
        }
    }

    /// The one that is given of several keys that exclude each other. More than one is a problem.
    pub fn only_one(&self, keys: &[&'static str]) -> Option<&'static str> {
        self.mark_known(keys);
        let given: Vec<_> = keys.iter().filter(|key| self.has(key)).copied().collect();
        if given.len() > 1 {
            let rest = quoted_keys(&given[..given.len() - 1]);
            self.problem(
                given[given.len() - 1],
                format!("cannot stand beside {rest}: give only one"),
            );
        }
        given.first().copied()
    }

    /// Reports the keys that were not requested, and those that are missing.
    pub fn finish(self) {
        let requested = self.requested.borrow();
        let mut missing = self.missing.take();
        for entry in self.entries.iter().filter(|entry| !requested.contains(&entry.key.as_str())) {
            let mut known: Vec<&str> = requested.clone();
            known.sort_unstable();
            known.dedup();
            let help = match meant(&entry.key, &known) {
                Some(near) => {
                    missing.retain(|(keys, _)| !keys.contains(&near));
                    format!("did you mean `{near}`?")
                }
                None => format!("known here: {}", quoted_keys(&known)),
            };
            let problem =
                Problem::new(entry.place.clone(), self.key(&entry.key), "is not a known key");
            self.report(problem.help(help));
        }
        missing.into_iter().for_each(|(_, problem)| self.report(problem));
    }

    fn wrong_type(&self, key: &str, node: &Node, wanted: &str) {
        let message = format!("must be {wanted}, but is {}", node.value.kind());
        self.report(Problem::new(node.place.clone(), self.key(key), message));
    }
}

/// A number in its usual notation, with an exponent if it is very large or small.
fn plain(x: f64) -> String {
    let long = x.is_finite() && x != 0.0 && !(1e-6..1e15).contains(&x.abs());
    if long { format!("{x:e}") } else { format!("{x}") }
}

fn number(node: &Node) -> Option<f64> {
    match node.value {
        Value::Number(x) => Some(x),
        Value::Integer(i) => Some(i as f64),
        _ => None,
    }
}

fn numbers<const N: usize>(node: &Node) -> Option<[f64; N]> {
    let Value::Array(items) = &node.value else { return None };
    let numbers: Option<Vec<f64>> = items.iter().map(number).collect();
    numbers?.try_into().ok()
}

/// Names in other programs, and the names of the keys here.
const ALIASES: [(&str, &str); 30] = [
    ("friction", "friction_stiffness"),
    ("mu", "friction_stiffness"),
    ("friction_coefficient", "friction_stiffness"),
    ("stiffness", "collision_stiffness"),
    ("k", "collision_stiffness"),
    ("damping", "collision_damping"),
    ("c", "velocity_damping_stiffness"),
    ("drag", "velocity_damping_stiffness"),
    ("g", "gravity"),
    ("h", "dt"),
    ("timestep", "dt"),
    ("time_step", "dt"),
    ("v", "initial_velocity"),
    ("velocity", "initial_velocity"),
    ("omega", "initial_angular_velocity"),
    ("angular_velocity", "initial_angular_velocity"),
    ("rotation", "orientation"),
    ("quaternion", "orientation"),
    ("com", "center_of_mass"),
    ("centre_of_mass", "center_of_mass"),
    ("inertia_tensor", "inertia"),
    ("moments", "inertia"),
    ("points", "particles"),
    ("file", "mesh"),
    ("e", "restitution"),
    ("time", "duration"),
    ("object", "body"),
    ("objects", "body"),
    ("plane", "wall"),
    ("floor", "wall"),
];

/// The known word for which `word` is an alias, or else the most similar one.
pub fn meant<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let alias = ALIASES.iter().find(|(alias, _)| *alias == word);
    let named = alias.and_then(|(_, name)| known.iter().find(|known| *known == name));
    named.copied().or_else(|| nearest(word, known))
}

/// The word most similar to `word`, if it is similar enough.
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let score = |candidate: &str| strsim::jaro_winkler(word, candidate);
    let best = known.iter().copied().max_by(|a, b| score(a).total_cmp(&score(b)))?;
    (score(best) > 0.75).then_some(best)
}

fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
}

fn quoted_keys(keys: &[&str]) -> String {
    keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::super::tree::parse;
    use super::*;

    /// The problems that `read` reports for `text`.
    fn problems_of(text: &str, read: impl FnOnce(&Reader)) -> Vec<String> {
        let (root, _) = parse(text, 0);
        let problems = RefCell::default();
        let reader = Reader::new(&root, String::new(), &problems);
        read(&reader);
        reader.finish();
        problems.into_inner().iter().map(|problem| format!("{problem:?}")).collect()
    }

    #[test]
    fn numbers_are_read_within_their_range() {
        assert!(
            problems_of("a = 1", |r| assert_eq!(r.number("a", Range::Positive), Some(1.0)))
                .is_empty()
        );
        assert!(problems_of("", |r| assert_eq!(r.number("a", Range::Positive), None)).is_empty());
        for wrong in ["a = 0", "a = nan", "a = \"1\"", "a = [1]"] {
            assert_eq!(
                problems_of(wrong, |r| assert_eq!(r.number("a", Range::Positive), None)).len(),
                1
            );
        }
        for wrong in ["a = [1, 2]", "a = [1, 2, inf]", "a = [1, 2, true]", "a = 1"] {
            assert_eq!(problems_of(wrong, |r| assert_eq!(r.vector("a"), None)).len(), 1);
        }
    }

    #[test]
    fn exclusive_keys_are_known_keys() {
        let read = |r: &Reader| assert_eq!(r.only_one(&["a", "b"]), Some("a"));
        let problems = problems_of("a = 1\nb = 2", read);
        assert_eq!(problems.len(), 1);
        assert!(problems[0].contains("cannot stand beside `a`"), "{problems:?}");
    }

    #[test]
    fn a_value_that_is_not_a_table_is_reported_once() {
        let problems = problems_of("t = 3", |r| {
            let inner = r.table("t").unwrap();
            inner.problem("x", "is missing");
            inner.finish();
        });
        assert_eq!(problems.len(), 1);
        assert!(problems[0].contains("must be a table, but is an integer"), "{problems:?}");
    }

    #[test]
    fn nearest_finds_similar_words_only() {
        let known = ["gravity", "duration", "dt"];
        assert_eq!(nearest("gravty", &known), Some("gravity"));
        assert_eq!(nearest("zzz", &known), None);
        assert_eq!(nearest("", &known), None);
        assert_eq!(nearest("x", &[]), None);
        assert_eq!([plain(0.0), plain(-1.0), plain(1e-300)], ["0", "-1", "1e-300"]);
    }
}
