//! The `tumble` command: rigid bodies made of particles, from a scene to its results.

mod export;
mod info;
mod resume;
mod run;
mod scenes;
mod table;
mod verify;
mod view;

use std::io::IsTerminal;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// How the command ends when it does not end well.
#[derive(Debug)]
enum Failure {
    /// The simulation failed: exit status 1.
    Run(String),
    /// A wrong call, scene or mesh: exit status 2.
    Call(String),
    /// Stopped by Ctrl-C, after everything was written: exit status 130.
    Interrupted,
}

#[derive(Parser)]
#[command(name = "tumble", version, about = "Simulates rigid bodies made of particles")]
#[command(
    after_help = "Exit status: 0 done, 1 the simulation failed, 2 wrong call, scene, mesh, checkpoint or run, \
                        130 stopped by Ctrl-C"
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Simulate a scene and write its results into a folder
    Run(run::RunArgs),
    /// Go on with a run from its checkpoint, to the same bits as if it had never stopped
    Resume(resume::ResumeArgs),
    /// Write a run in another format: .glb .usda .pvd .csv .png .gif .mp4
    Export(export::ExportArgs),
    /// List the built-in scenes, or print one to start from
    Scenes(scenes::ScenesArgs),
    /// Show what a mesh is: particles, mass, centre, principal moments, watertight or not
    Info(info::InfoArgs),
    /// Hold the physics against theory: expected, measured, bound, verdict
    Verify(verify::VerifyArgs),
    /// Watch and change a simulation in the browser while it runs, or look at a finished run
    View(view::ViewArgs),
}

fn main() -> ExitCode {
    // a wrong call ends here, with clap's message and status 2
    let cli = Cli::parse();
    let result = match cli.command {
        Command::Run(args) => run::run(&args),
        Command::Resume(args) => resume::resume(&args),
        Command::Export(args) => export::export(&args),
        Command::Scenes(args) => scenes::scenes(&args),
        Command::Info(args) => info::info(&args),
        Command::Verify(args) => verify::verify(&args),
        Command::View(args) => view::view(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Run(message)) => {
            complain(&message);
            ExitCode::from(1)
        }
        Err(Failure::Call(message)) => {
            complain(&message);
            ExitCode::from(2)
        }
        Err(Failure::Interrupted) => ExitCode::from(130),
    }
}

/// Whether messages on stderr may have colours.
fn colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}

/// Prints to stderr; where even that fails, the exit status has to do.
fn complain(message: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr().lock(), "{message}");
}

/// Prints to stdout; a reader that went away (`tumble scenes | head -1`) is no failure.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::Write;
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Run(format!("error: cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
