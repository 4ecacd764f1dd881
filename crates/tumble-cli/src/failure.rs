//! How the command ends when it fails.

use tumble_io::run::RunError;
use tumble_io::scene::SceneError;

use crate::console;

/// A failure with its message and exit status.
#[derive(Debug)]
pub enum Failure {
    /// The simulation failed or a file could not be written: exit status 1.
    Run(String),
    /// The command line, mesh, checkpoint or run is invalid: exit status 2.
    Call(String),
    /// The scene is invalid: exit status 2. The message may have colours.
    Scene(String),
    /// Stopped by Ctrl-C: exit status 130.
    Interrupted,
}

impl Failure {
    /// An invalid command line or input file.
    pub fn call(error: &dyn std::fmt::Display) -> Self {
        Self::Call(format!("error: {error}"))
    }
}

impl From<&SceneError> for Failure {
    /// All problems of a scene.
    fn from(error: &SceneError) -> Self {
        let count = error.problem_count();
        let total = if count > 1 {
            format!("\n\n{count} problems; nothing was run")
        } else {
            String::new()
        };
        Self::Scene(format!("{}{total}", error.render(console::use_colour())))
    }
}

impl From<&RunError> for Failure {
    fn from(error: &RunError) -> Self {
        match error {
            RunError::FolderInUse(_) | RunError::Running(_) | RunError::NotARun(_) => {
                Self::call(error)
            }
            _ => Self::Run(format!("error: {error}")),
        }
    }
}

/// Prints text to stdout.
///
/// # Errors
/// [`Failure::Run`] when stdout cannot be written.
pub fn print(text: &str) -> Result<(), Failure> {
    console::print(text)
        .map_err(|error| Failure::Run(format!("error: cannot write to standard output: {error}")))
}
