//! The `tumble` command.
//!
//! | file | content |
//! |---|---|
//! | `run`, `resume`, `export`, `scenes`, `info`, `verify`, `view` | one subcommand each |
//! | `mesh_info`, `mesh_verdict` | what `info` says about a mesh |
//! | `scene_info`, `integrator_cost` | what `info` says about a scene |
//! | `report` | what `run` and `resume` print at the end |
//! | `scene_argument` | loads the scene named on the command line |
//! | `failure` | exit status and message of a failure |
//! | `interrupt` | Ctrl-C |
//! | `console` | stdout, stderr, progress bar |
//! | `format` | numbers and columns |

mod console;
mod export;
mod failure;
mod format;
mod info;
mod integrator_cost;
mod interrupt;
mod mesh_info;
mod mesh_verdict;
mod report;
mod resume;
mod run;
mod scene_argument;
mod scene_info;
mod scenes;
mod verify;
mod view;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::console::{print_error, print_styled_error};
use crate::failure::Failure;

#[derive(Parser)]
#[command(name = "tumble", version, about = "Simulator of rigid bodies made of particles")]
#[command(after_help = "Use `tumble COMMAND --help` for the options of a command.\n\n\
    Exit status:\n  \
    0    success\n  \
    1    the simulation failed, or a file could not be written\n  \
    2    invalid command line, scene, mesh, checkpoint or run\n  \
    130  stopped by Ctrl-C")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a simulation and write the results to a folder
    Run(run::RunArgs),
    /// Continue a run from its checkpoint
    Resume(resume::ResumeArgs),
    /// Convert the results of a run to another format
    Export(export::ExportArgs),
    /// List the built-in scenes, or print one
    Scenes(scenes::ScenesArgs),
    /// Print the properties of a mesh, or compare the integrators for a scene
    Info(info::InfoArgs),
    /// Compare simulations with theory
    Verify(verify::VerifyArgs),
    /// Show a running simulation or a finished run in the browser
    View(view::ViewArgs),
}

fn main() -> ExitCode {
    // clap reports an invalid command line itself and exits with status 2
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
            print_error(&message);
            ExitCode::from(1)
        }
        Err(Failure::Call(message)) => {
            print_error(&message);
            ExitCode::from(2)
        }
        Err(Failure::Scene(message)) => {
            print_styled_error(&message);
            ExitCode::from(2)
        }
        Err(Failure::Interrupted) => ExitCode::from(130),
    }
}
