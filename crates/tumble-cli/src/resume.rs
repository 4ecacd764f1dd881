//! `tumble resume`: goes on with a run from its checkpoint.

use std::path::PathBuf;

use clap::Args;
use tumble_io::run::{ResumeError, Resumption, RunFolder};

use crate::run::{bad_scene, carry_out, failure};
use crate::{Failure, complain};

#[derive(Args)]
pub struct ResumeArgs {
    /// The checkpoint, or the folder of a run that holds one
    checkpoint: PathBuf,
    /// Simulated time to reach, counted from 0 [default: the scene's duration]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    duration: Option<String>,
    /// Folder for the results [default: the checkpoint's own, whose files go on]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write over the results of another run in --out
    #[arg(long)]
    force: bool,
}

pub fn resume(args: &ResumeArgs) -> Result<(), Failure> {
    // a run's own folder is never written over, but gone on with
    let own = args.out.as_ref().is_some_and(|out| {
        let folder = args.checkpoint.parent().filter(|_| !args.checkpoint.is_dir());
        RunFolder::existing(folder.unwrap_or(&args.checkpoint)).is(out)
    });
    let out = args.out.as_ref().filter(|_| !own);
    let resumption = Resumption::prepare(&args.checkpoint, args.duration.as_deref(), out.is_none());
    let resumption = resumption.map_err(|error| match &error {
        ResumeError::Scene(error) => bad_scene(error),
        _ => Failure::Call(format!("error: {error}")),
    })?;
    let new = out.map(|path| RunFolder::create(path, args.force)).transpose();
    let new = new.map_err(|error| failure(&error))?;
    if let Some(time) = resumption.begins_at() {
        complain(&format!(
            "note: the rows before the checkpoint are not beside it; the new files begin at \
             t = {time} s"
        ));
    }
    let folder = new.clone().unwrap_or_else(|| resumption.own_folder().clone());
    carry_out(&folder, |watch| resumption.run(new.as_ref(), watch))
}
