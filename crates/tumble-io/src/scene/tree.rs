//! A TOML document as a tree whose keys and values have source places, and the overrides of `--set`.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::place::Place;
use super::problem::Problem;
use crate::counted::counted;

/// Groups of keys of which a table may have only one. `--set` of one removes the others.
pub const EXCLUSIVE_KEYS: [&[&str]; 3] = [
    &["collision_stiffness", "collision_stiffness_per_area"],
    &["collision_damping", "restitution"],
    &["particle_mass", "mass", "density"],
];

/// The largest number of parts of a dotted key.
const MAX_KEY_PARTS: usize = 32;

/// A value and its place.
#[derive(Clone, Debug)]
pub struct Node {
    pub value: Value,
    pub place: Place,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub enum Value {
    Table(Vec<Entry>),
    Array(Vec<Node>),
    Number(f64),
    Integer(i64),
    String(String),
    Boolean(bool),
    Date,
}

/// A key of a table with its value.
#[derive(Clone, Debug)]
pub struct Entry {
    pub key: String,
    pub place: Place,
    pub node: Node,
}

impl Value {
    /// Its name in messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Table(_) => "a table",
            Self::Array(_) => "an array",
            Self::Number(_) => "a number",
            Self::Integer(_) => "an integer",
            Self::String(_) => "a string",
            Self::Boolean(_) => "a boolean",
            Self::Date => "a date",
        }
    }
}

/// Parses `text` as source number `source`; returns all syntax errors.
pub fn parse(text: &str, source: usize) -> (Node, Vec<Problem>) {
    let (table, errors) = DeTable::parse_recoverable(text);
    let problems = errors
        .iter()
        .map(|error| {
            let span = error.span().unwrap_or(0..0);
            Problem::new(Place { source, span }, "", error.message().to_owned())
        })
        .collect();
    let place = Place { source, span: table.span() };
    (Node { value: from_table(table.into_inner(), source), place }, problems)
}

fn from_table(table: DeTable<'_>, source: usize) -> Value {
    let mut entries: Vec<_> = table
        .into_iter()
        .map(|(key, value)| Entry {
            place: Place { source, span: key.span() },
            key: key.into_inner().into_owned(),
            node: from_value(value, source),
        })
        .collect();
    // problems are reported in the order of the file
    entries.sort_by_key(|entry| entry.place.span.start);
    Value::Table(entries)
}

fn from_value(value: Spanned<DeValue<'_>>, source: usize) -> Node {
    let place = Place { source, span: value.span() };
    let value = match value.into_inner() {
        DeValue::String(text) => Value::String(text.into_owned()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => Value::Integer(integer),
            Err(_) => Value::Number(large(integer.as_str(), integer.radix())),
        },
        DeValue::Float(float) => Value::Number(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(boolean) => Value::Boolean(boolean),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(array) => {
            Value::Array(array.into_iter().map(|item| from_value(item, source)).collect())
        }
        DeValue::Table(table) => from_table(table, source),
    };
    Node { value, place }
}

/// An integer too large for an `i64`, as the nearest float.
fn large(digits: &str, radix: u32) -> f64 {
    let digit = |c: char| c.to_digit(radix).map(f64::from);
    match radix {
        10 => digits.parse().unwrap_or(f64::NAN),
        _ => digits.chars().filter_map(digit).fold(0.0, |x, d| x * f64::from(radix) + d),
    }
}

/// Applies `KEY=VALUE` to the tree. KEY is dotted: `body.scale` sets the key of every body, `body.0.scale` of the first. A VALUE that is
/// not TOML is taken as a string, so that `integrator=euler` works. Of keys that exclude each other, such as `mass` and
/// `density`, the new one replaces the old one.
pub fn set(root: &mut Node, assignment: &str, source: usize) -> Result<(), Problem> {
    let whole = Place { source, span: 0..assignment.len() };
    let Some((key, text)) = assignment.split_once('=') else {
        let message = "`--set` takes KEY=VALUE, for example --set dt=1e-4".to_owned();
        return Err(Problem::new(whole, "", message));
    };
    let start = key.len() + 1;
    let place = Place { source, span: start..assignment.len().max(start) };
    let value = match DeValue::parse(text.trim()) {
        Ok(value) => from_value(value, source).value,
        Err(_) => Value::String(text.trim().to_owned()),
    };
    let path: Vec<&str> = key.trim().split('.').map(str::trim).collect();
    if path.iter().any(|part| part.is_empty()) || path.len() > MAX_KEY_PARTS {
        let message = "is no key; write it as `dt` or `collision.collision_stiffness`".to_owned();
        return Err(Problem::new(Place { source, span: 0..key.len() }, key, message));
    }
    let node = Node { value: relocate(value, &place), place };
    let key_place = Place { source, span: 0..key.len() };
    assign(root, &path, &node, &key_place).map_err(|message| Problem::new(key_place, "", message))
}

/// Gives everything inside a value the same place.
fn relocate(value: Value, place: &Place) -> Value {
    let node = |node: Node| Node { value: relocate(node.value, place), place: place.clone() };
    match value {
        Value::Array(items) => Value::Array(items.into_iter().map(node).collect()),
        Value::Table(entries) => Value::Table(
            entries
                .into_iter()
                .map(|e| Entry { key: e.key, place: place.clone(), node: node(e.node) })
                .collect(),
        ),
        other => other,
    }
}

/// Removes the keys that exclude `key` from a table.
fn remove_exclusive(entries: &mut Vec<Entry>, key: &str) {
    let group = EXCLUSIVE_KEYS.into_iter().find(|group| group.contains(&key)).unwrap_or_default();
    entries.retain(|entry| entry.key == key || !group.contains(&entry.key.as_str()));
}

fn assign(target: &mut Node, path: &[&str], new: &Node, place: &Place) -> Result<(), String> {
    let Some((&part, rest)) = path.split_first() else {
        *target = new.clone();
        return Ok(());
    };
    match &mut target.value {
        Value::Table(entries) => {
            if rest.is_empty() {
                remove_exclusive(entries, part);
            }
            let at = match entries.iter().position(|entry| entry.key == part) {
                Some(at) => at,
                None => {
                    let node = Node { value: Value::Table(Vec::new()), place: place.clone() };
                    entries.push(Entry { key: part.to_owned(), place: place.clone(), node });
                    entries.len() - 1
                }
            };
            entries[at].place =
                if rest.is_empty() { place.clone() } else { entries[at].place.clone() };
            assign(&mut entries[at].node, rest, new, place)
        }
        Value::Array(items) => match part.parse::<usize>() {
            Ok(index) => {
                let count = items.len();
                match items.get_mut(index) {
                    Some(item) => assign(item, rest, new, place),
                    None => Err(format!(
                        "there is no number {index} here: the array has {}, counted from 0",
                        counted(count, "entry", "entries")
                    )),
                }
            }
            Err(_) => items.iter_mut().try_for_each(|item| assign(item, path, new, place)),
        },
        other => Err(format!("`{part}` cannot be set inside {}", other.kind())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(text: &str) -> Node {
        let (root, problems) = parse(text, 0);
        assert!(problems.is_empty(), "{problems:?}");
        root
    }

    /// The tree as text, without places.
    fn text_of(node: &Node) -> String {
        match &node.value {
            Value::Table(entries) => {
                let each = entries.iter().map(|e| format!("{}={}", e.key, text_of(&e.node)));
                format!("{{{}}}", each.collect::<Vec<_>>().join(","))
            }
            Value::Array(items) => {
                format!("[{}]", items.iter().map(text_of).collect::<Vec<_>>().join(","))
            }
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn keys_and_values_have_places() {
        let root = tree("a = 1\n[b]\nc = [true, \"x\"]\n");
        let Value::Table(top) = &root.value else { panic!("no table") };
        assert_eq!((top[0].place.span.clone(), top[0].node.place.span.clone()), (0..1, 4..5));
        let Value::Table(b) = &top[1].node.value else { panic!("no table") };
        let Value::Array(c) = &b[0].node.value else { panic!("no array") };
        assert_eq!(c[1].place.span, 21..24);
    }

    #[test]
    fn all_notations_of_numbers_are_read() {
        let text = "a = 1_000\nb = 0x10\nc = 1e3\nd = -inf\ne = 99999999999999999999\nf = 0xFFFFFFFFFFFFFFFFFF";
        assert_eq!(
            text_of(&tree(text)),
            "{a=Integer(1000),b=Integer(16),c=Number(1000.0),d=Number(-inf),\
             e=Number(1e20),f=Number(4.722366482869645e21)}"
        );
    }

    #[test]
    fn set_reaches_tables_bodies_and_missing_keys() {
        let mut root = tree("dt = 1\n[[body]]\nscale = 1\n[[body]]\n");
        for assignment in ["dt=2", "body.scale=3", "body.0.scale = 4", "box.min=[0]", "w=a b", "e="]
        {
            set(&mut root, assignment, 1).unwrap();
        }
        assert_eq!(
            text_of(&root),
            "{dt=Integer(2),body=[{scale=Integer(4)},{scale=Integer(3)}],\
             box={min=[Integer(0)]},w=String(\"a b\"),e=String(\"\")}"
        );
        let mut root = tree("[collision]\nrestitution = 1\ncollision_stiffness = 1\nx = 1");
        for assignment in ["collision.collision_stiffness_per_area=2", "collision.restitution=3"] {
            set(&mut root, assignment, 1).unwrap();
        }
        assert_eq!(
            text_of(&root),
            "{collision={restitution=Integer(3),x=Integer(1),collision_stiffness_per_area=Integer(2)}}"
        );
        let mut root = tree("dt = 1\n[[body]]\nscale = 1\n[[body]]\n");
        let deep = vec!["a"; MAX_KEY_PARTS + 1].join(".") + "=1";
        for wrong in ["dt", "=1", "a..b=1", "dt.x=1", "body.2.scale=1", deep.as_str()] {
            assert!(set(&mut root, wrong, 1).is_err(), "{wrong}");
        }
    }
}
