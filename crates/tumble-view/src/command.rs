//! What a page may ask for.

use serde::{Deserialize, Deserializer};
use serde_json::Value as Json;

/// A message from a page larger than this is refused.
pub const MOST_BYTES: usize = 64 << 10;

/// More characters than this are no key.
const LONGEST_KEY: usize = 200;

/// A command of a page, checked as far as that goes without the simulation.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Go on.
    Play,
    /// Stand still.
    Pause,
    /// One step, when paused.
    Step,
    /// Back to t = 0, with everything that was set.
    Reset,
    /// Simulated seconds a second; `None`: as fast as it goes.
    Speed(Option<f64>),
    /// Change the scene.
    Set(Setting),
    /// Take hold of a particle and pull it towards a place.
    Grab {
        /// Index of the body.
        body: usize,
        /// Index of the particle in the body.
        particle: usize,
        /// Where it is pulled to, world axes (m).
        target: [f64; 3],
    },
    /// Pull what is held to another place, world axes (m).
    Move([f64; 3]),
    /// Let go.
    Release,
    /// Send the scene as it is now.
    Save,
}

/// A change of one key of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The key, as for `tumble run --set KEY=VALUE`.
    pub key: String,
    /// Its value; `None` takes the key out of the scene, back to its default.
    pub value: Option<toml::Value>,
}

/// A command as it comes over the wire.
#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "lowercase", deny_unknown_fields)]
enum Wire {
    Play {},
    Pause {},
    Step {},
    Reset {},
    Speed {
        // without this a missing value would be read as null
        #[serde(deserialize_with = "present")]
        value: Option<f64>,
    },
    Set {
        key: String,
        value: Json,
    },
    Grab {
        body: u32,
        particle: u32,
        target: [f64; 3],
    },
    Move {
        target: [f64; 3],
    },
    Release {},
    Save {},
}

fn present<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Option::deserialize(deserializer)
}

impl Command {
    /// Reads a message of a page.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.len() > MOST_BYTES {
            return Err(format!("a message may have at most {MOST_BYTES} bytes"));
        }
        let wire: Wire =
            serde_json::from_str(text).map_err(|error| format!("this is no command: {error}"))?;
        Ok(match wire {
            Wire::Play {} => Self::Play,
            Wire::Pause {} => Self::Pause,
            Wire::Step {} => Self::Step,
            Wire::Reset {} => Self::Reset,
            Wire::Speed { value: Some(value) } if !(value > 0.0 && value.is_finite()) => {
                return Err("`speed` must be above 0, or null for as fast as it goes".to_owned());
            }
            Wire::Speed { value } => Self::Speed(value),
            Wire::Set { key, value } => Self::Set(Setting::new(key, value)?),
            Wire::Grab { body, particle, target } => {
                Self::Grab { body: body as usize, particle: particle as usize, target }
            }
            Wire::Move { target } => Self::Move(target),
            Wire::Release {} => Self::Release,
            Wire::Save {} => Self::Save,
        })
    }
}

impl Setting {
    fn new(key: String, value: Json) -> Result<Self, String> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
        if key.is_empty() || key.len() > LONGEST_KEY || !key.chars().all(plain) {
            return Err("this is no key; write it as `dt` or `collision.restitution`".to_owned());
        }
        // a page may change numbers, not make the program read files
        if key.split('.').any(|part| part.starts_with("mesh")) {
            return Err(format!(
                "`{key}` cannot be changed from a page; start with --set {key}=FILE instead"
            ));
        }
        let value = match value {
            Json::Null => None,
            value => Some(toml_value(&value).ok_or_else(|| {
                format!("`{key}` must be a number, a word, true or false, or a list of these")
            })?),
        };
        Ok(Self { key, value })
    }
}

/// The same in TOML; `None` for objects, nulls, and numbers beyond a double.
fn toml_value(value: &Json) -> Option<toml::Value> {
    Some(match value {
        Json::Bool(value) => (*value).into(),
        Json::Number(number) => match number.as_i64() {
            Some(integer) => integer.into(),
            None => number.as_f64().filter(|x| x.is_finite())?.into(),
        },
        Json::String(text) => text.clone().into(),
        Json::Array(items) => items.iter().map(toml_value).collect::<Option<Vec<_>>>()?.into(),
        Json::Null | Json::Object(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn every_command() {
        let parsed = |text| Command::parse(text).unwrap();
        assert_eq!(parsed(r#"{"type":"play"}"#), Command::Play);
        assert_eq!(parsed(r#"{"type":"pause"}"#), Command::Pause);
        assert_eq!(parsed(r#"{"type":"step"}"#), Command::Step);
        assert_eq!(parsed(r#"{"type":"reset"}"#), Command::Reset);
        assert_eq!(parsed(r#"{"type":"speed","value":0.5}"#), Command::Speed(Some(0.5)));
        assert_eq!(parsed(r#"{"type":"speed","value":2}"#), Command::Speed(Some(2.0)));
        assert_eq!(parsed(r#"{"type":"speed","value":null}"#), Command::Speed(None));
        assert_eq!(
            parsed(r#"{"type":"grab","body":0,"particle":17,"target":[1,2,3.5]}"#),
            Command::Grab { body: 0, particle: 17, target: [1.0, 2.0, 3.5] }
        );
        assert_eq!(parsed(r#"{"type":"move","target":[0,0,0]}"#), Command::Move([0.0; 3]));
        assert_eq!(parsed(r#"{"type":"release"}"#), Command::Release);
        assert_eq!(parsed(r#"{"type":"save"}"#), Command::Save);
        let Command::Set(setting) = parsed(r#"{"type":"set","key":"box.open","value":["+y"]}"#)
        else {
            panic!("no set")
        };
        assert_eq!(setting.key, "box.open");
        assert_eq!(setting.value.unwrap().to_string(), "[\"+y\"]");
    }

    #[test]
    fn what_is_no_command_is_refused_with_the_reason() {
        for (text, reason) in [
            ("", "no command"),
            ("[]", "no command"),
            ("{\"type\":\"explode\"}", "unknown variant `explode`"),
            ("{\"type\":\"play\",\"value\":1}", "unknown field `value`"),
            ("{\"type\":\"speed\"}", "missing field `value`"),
            ("{\"type\":\"speed\",\"value\":0}", "above 0"),
            ("{\"type\":\"speed\",\"value\":-1}", "above 0"),
            ("{\"type\":\"speed\",\"value\":1e999}", "no command"),
            ("{\"type\":\"grab\",\"body\":-1,\"particle\":0,\"target\":[0,0,0]}", "no command"),
            ("{\"type\":\"move\",\"target\":[0,0]}", "no command"),
            ("{\"type\":\"set\",\"key\":\"dt\"}", "missing field `value`"),
            ("{\"type\":\"set\",\"key\":\"\",\"value\":1}", "no key"),
            ("{\"type\":\"set\",\"key\":\"dt=1 #\",\"value\":1}", "no key"),
            ("{\"type\":\"set\",\"key\":\"body.0.mesh\",\"value\":\"/x\"}", "from a page"),
            ("{\"type\":\"set\",\"key\":\"body\",\"value\":[{\"mesh\":\"/x\"}]}", "must be"),
            ("{\"type\":\"set\",\"key\":\"dt\",\"value\":[null]}", "must be"),
        ] {
            let refused = Command::parse(text).unwrap_err();
            assert!(refused.contains(reason), "{text}: {refused}");
        }
        let long = format!("{{\"type\":\"play\"{}}}", " ".repeat(MOST_BYTES));
        assert!(Command::parse(&long).unwrap_err().contains("at most"));
        let deep = format!("{{\"type\":\"set\",\"key\":\"dt\",\"value\":{}", "[".repeat(60_000));
        assert!(Command::parse(&deep).is_err());
    }

    fn json() -> impl Strategy<Value = Json> {
        let leaf = prop_oneof![
            Just(Json::Null),
            any::<bool>().prop_map(Json::from),
            any::<i64>().prop_map(Json::from),
            any::<f64>().prop_map(Json::from),
            "[a-z._=\"\\\\\n-]{0,12}".prop_map(Json::from),
        ];
        leaf.prop_recursive(4, 32, 5, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 0..5).prop_map(Json::from),
                prop::collection::vec(("[a-z]{1,8}", inner), 0..4)
                    .prop_map(|entries| Json::Object(entries.into_iter().collect())),
            ]
        })
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
            let _ = Command::parse(&String::from_utf8_lossy(&bytes));
        }

        #[test]
        fn any_json_is_read_or_refused(
            kind in "(play|pause|step|reset|speed|set|grab|move|release|save|other)",
            key in "[a-z0-9._]{0,20}",
            value in json(),
            target in json(),
        ) {
            for fields in [
                serde_json::json!({"type": kind}),
                serde_json::json!({"type": kind, "value": value}),
                serde_json::json!({"type": kind, "key": key, "value": value}),
                serde_json::json!({"type": kind, "target": target}),
                serde_json::json!({"type": kind, "body": value, "particle": 0, "target": target}),
            ] {
                // what is read says no more than what it may: no number that is not one
                if let Ok(Command::Move(target)) = Command::parse(&fields.to_string()) {
                    prop_assert!(target.iter().all(|x| x.is_finite()));
                }
            }
        }
    }
}
