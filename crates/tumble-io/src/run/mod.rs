//! A run: step a world, keep what it did, and write it all into one folder.

mod folder;
mod ledger;
mod recorder;
mod runner;
mod summary;
mod trajectory;

pub use folder::{RunError, RunFolder};
pub use ledger::{LEDGER_HEADER, ledger_row};
pub use recorder::Recorder;
pub use runner::{Finished, Progress, run};
pub use summary::Summary;
pub use trajectory::{TRAJECTORY_HEADER, write_frame};
