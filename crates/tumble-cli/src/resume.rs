//! `tumble resume`: continues a run from its checkpoint.

use std::path::PathBuf;

use clap::Args;
use tumble_io::run::{ResumeError, Resumption, RunFolder};

use crate::console::print_error;
use crate::failure::Failure;
use crate::run::execute;

#[derive(Args)]
#[command(after_help = "The results are bit for bit those of a run that was never stopped.")]
pub struct ResumeArgs {
    /// Checkpoint file, or folder of a run with a checkpoint
    checkpoint: PathBuf,
    /// Simulated time at which to stop (s), counted from t = 0
    /// [default: the duration of the scene]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    duration: Option<String>,
    /// Folder for the results [default: the checkpoint's folder, whose files are continued]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Overwrite another run in --out
    #[arg(long)]
    force: bool,
}

pub fn resume(args: &ResumeArgs) -> Result<(), Failure> {
    // if --out is the checkpoint's own folder, its files are continued, not overwritten
    let is_own = args.out.as_ref().is_some_and(|out| {
        let folder = args.checkpoint.parent().filter(|_| !args.checkpoint.is_dir());
        RunFolder::from_path(folder.unwrap_or(&args.checkpoint)).is_same_as(out)
    });
    let out = args.out.as_ref().filter(|_| !is_own);
    let resumption = Resumption::prepare(&args.checkpoint, args.duration.as_deref(), out.is_none());
    let resumption = resumption.map_err(|error| match &error {
        ResumeError::Scene(error) => Failure::from(error),
        ResumeError::Folder(error) => Failure::from(error),
        _ => Failure::call(&error),
    })?;
    let new_folder = out.map(|path| RunFolder::create(path, args.force)).transpose();
    let new_folder = new_folder.map_err(|error| Failure::from(&error))?;
    if let Some(time) = resumption.first_time_without_rows() {
        print_error(&format!(
            "note: the files with the rows before the checkpoint are missing; the new files begin at \
             t = {time} s"
        ));
    }
    let folder = new_folder.clone().unwrap_or_else(|| resumption.checkpoint_folder().clone());
    execute(&folder, |watch| resumption.run(new_folder.as_ref(), watch))
}
