//! The scenes of `scenes/`, built into the program.

/// A scene that comes with the program.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Its name.
    pub name: &'static str,
    /// Its TOML text.
    pub text: &'static str,
}

macro_rules! builtin {
    ($($name:literal),* $(,)?) => {
        [$(Builtin {
            name: $name,
            text: include_str!(concat!("../../embedded/scenes/", $name, ".toml")),
        }),*]
    };
}

/// All built-in scenes, in teaching order.
pub const BUILTIN: [Builtin; 28] = builtin![
    "task1",
    "task2",
    "task1-cat",
    "task2-cat",
    "top",
    "racket",
    "coin",
    "slope",
    "many",
    "bounce",
    "cradle",
    "dominoes",
    "stack",
    "chain",
    "cats",
    "hopper",
    "drum",
    "heap",
    "conveyor",
    "pendulum",
    "double-pendulum",
    "gyroscope",
    "kapitza",
    "slider-crank",
    "four-bar",
    "cradle-strings",
    "beads",
    "trebuchet",
];

/// The built-in scene of that name.
pub fn builtin(name: &str) -> Option<Builtin> {
    BUILTIN.iter().find(|scene| scene.name == name).copied()
}

impl Builtin {
    /// The scene's own one-line description.
    pub fn description(&self) -> Option<&'static str> {
        let line = self.text.lines().find_map(|line| line.strip_prefix("description = \""))?;
        line.strip_suffix('"')
    }
}
