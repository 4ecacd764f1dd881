//! Commands from a page.

use serde::{Deserialize, Deserializer};
use serde_json::Value as Json;

/// Longest message that is accepted from a page, in bytes.
pub const MAX_MESSAGE_BYTES: usize = 64 << 10;

/// Longest key that is accepted, in bytes.
const MAX_KEY_BYTES: usize = 200;

/// A command from a page, checked as far as is possible without the simulation.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Start or continue the simulation.
    Play,
    /// Pause the simulation.
    Pause,
    /// Take one step; only while paused.
    Step,
    /// Go back to t = 0, with all edits of the scene.
    Reset,
    /// Set the speed: simulated seconds per second, or `None` for as fast as possible.
    Speed(Option<f64>),
    /// Change one key of the scene.
    Set(SceneEdit),
    /// Attach the mouse spring to a particle.
    AttachSpring {
        /// Index of the body.
        body: usize,
        /// Index of the particle in the body.
        particle: usize,
        /// The point that the particle is pulled to, world axes (m).
        target: [f64; 3],
    },
    /// Move the target of the mouse spring, world axes (m).
    MoveSpring([f64; 3]),
    /// Release the mouse spring.
    ReleaseSpring,
    /// Send the present state as a scene file.
    Save,
}

/// A change of one key of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneEdit {
    /// The key, as for `tumble run --set KEY=VALUE`.
    pub key: String,
    /// The new value; `None` removes the key, so that its default applies.
    pub value: Option<toml::Value>,
}

/// A command in the JSON format of the WebSocket.
#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "lowercase", deny_unknown_fields)]
enum Message {
    Play {},
    Pause {},
    Step {},
    Reset {},
    Speed {
        // without this a missing value would be read as null
        #[serde(deserialize_with = "required")]
        value: Option<f64>,
    },
    Set {
        key: String,
        value: Json,
    },
    #[serde(rename = "grab")]
    AttachSpring {
        body: u32,
        particle: u32,
        target: [f64; 3],
    },
    #[serde(rename = "move")]
    MoveSpring {
        target: [f64; 3],
    },
    #[serde(rename = "release")]
    ReleaseSpring {},
    Save {},
}

fn required<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Option::deserialize(deserializer)
}

impl Command {
    /// Parses a message from a page.
    ///
    /// # Errors
    /// What is wrong with the message.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.len() > MAX_MESSAGE_BYTES {
            return Err(format!("a message may have at most {MAX_MESSAGE_BYTES} bytes"));
        }
        let message: Message =
            serde_json::from_str(text).map_err(|error| format!("not a command: {error}"))?;
        Ok(match message {
            Message::Play {} => Self::Play,
            Message::Pause {} => Self::Pause,
            Message::Step {} => Self::Step,
            Message::Reset {} => Self::Reset,
            Message::Speed { value: Some(value) } if !(value > 0.0 && value.is_finite()) => {
                return Err("`speed` must be above 0, or null for as fast as possible".to_owned());
            }
            Message::Speed { value } => Self::Speed(value),
            Message::Set { key, value } => Self::Set(SceneEdit::new(key, value)?),
            Message::AttachSpring { body, particle, target } => {
                Self::AttachSpring { body: body as usize, particle: particle as usize, target }
            }
            Message::MoveSpring { target } => Self::MoveSpring(target),
            Message::ReleaseSpring {} => Self::ReleaseSpring,
            Message::Save {} => Self::Save,
        })
    }
}

impl SceneEdit {
    fn new(key: String, value: Json) -> Result<Self, String> {
        let is_allowed = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
        if key.is_empty() || key.len() > MAX_KEY_BYTES || !key.chars().all(is_allowed) {
            return Err("not a key: write it as `dt` or `collision.restitution`".to_owned());
        }
        // a page must not be able to make the server read files
        if key.split('.').any(|part| part.starts_with("mesh")) {
            return Err(format!(
                "`{key}` cannot be changed from a page; restart with --set {key}=FILE"
            ));
        }
        let value = match value {
            Json::Null => None,
            value => Some(to_toml(&value).ok_or_else(|| {
                format!("`{key}` must be a number, a string, true or false, or an array of these")
            })?),
        };
        Ok(Self { key, value })
    }
}

/// The value as TOML; `None` for objects, nulls and numbers outside the range of a double.
fn to_toml(value: &Json) -> Option<toml::Value> {
    Some(match value {
        Json::Bool(value) => (*value).into(),
        Json::Number(number) => match number.as_i64() {
            Some(integer) => integer.into(),
            None => number.as_f64().filter(|x| x.is_finite())?.into(),
        },
        Json::String(text) => text.clone().into(),
        Json::Array(items) => items.iter().map(to_toml).collect::<Option<Vec<_>>>()?.into(),
        Json::Null | Json::Object(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn every_command_is_parsed() {
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
            Command::AttachSpring { body: 0, particle: 17, target: [1.0, 2.0, 3.5] }
        );
        assert_eq!(parsed(r#"{"type":"move","target":[0,0,0]}"#), Command::MoveSpring([0.0; 3]));
        assert_eq!(parsed(r#"{"type":"release"}"#), Command::ReleaseSpring);
        assert_eq!(parsed(r#"{"type":"save"}"#), Command::Save);
        let Command::Set(edit) = parsed(r#"{"type":"set","key":"box.open","value":["+y"]}"#) else {
            panic!("not a Set command")
        };
        assert_eq!(edit.key, "box.open");
        assert_eq!(edit.value.unwrap().to_string(), "[\"+y\"]");
    }

    #[test]
    fn invalid_messages_are_rejected_with_the_reason() {
        for (text, reason) in [
            ("", "not a command"),
            ("[]", "not a command"),
            ("{\"type\":\"explode\"}", "unknown variant `explode`"),
            ("{\"type\":\"play\",\"value\":1}", "unknown field `value`"),
            ("{\"type\":\"speed\"}", "missing field `value`"),
            ("{\"type\":\"speed\",\"value\":0}", "above 0"),
            ("{\"type\":\"speed\",\"value\":-1}", "above 0"),
            ("{\"type\":\"speed\",\"value\":1e999}", "not a command"),
            ("{\"type\":\"grab\",\"body\":-1,\"particle\":0,\"target\":[0,0,0]}", "not a command"),
            ("{\"type\":\"move\",\"target\":[0,0]}", "not a command"),
            ("{\"type\":\"set\",\"key\":\"dt\"}", "missing field `value`"),
            ("{\"type\":\"set\",\"key\":\"\",\"value\":1}", "not a key"),
            ("{\"type\":\"set\",\"key\":\"dt=1 #\",\"value\":1}", "not a key"),
            ("{\"type\":\"set\",\"key\":\"body.0.mesh\",\"value\":\"/x\"}", "from a page"),
            ("{\"type\":\"set\",\"key\":\"body\",\"value\":[{\"mesh\":\"/x\"}]}", "must be"),
            ("{\"type\":\"set\",\"key\":\"dt\",\"value\":[null]}", "must be"),
        ] {
            let error = Command::parse(text).unwrap_err();
            assert!(error.contains(reason), "{text}: {error}");
        }
        let long = format!("{{\"type\":\"play\"{}}}", " ".repeat(MAX_MESSAGE_BYTES));
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
        fn any_bytes_are_parsed_or_rejected(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
            let _ = Command::parse(&String::from_utf8_lossy(&bytes));
        }

        #[test]
        fn any_json_is_parsed_or_rejected(
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
                // a parsed target is finite
                if let Ok(Command::MoveSpring(target)) = Command::parse(&fields.to_string()) {
                    prop_assert!(target.iter().all(|x| x.is_finite()));
                }
            }
        }
    }
}
