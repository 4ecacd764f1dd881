//! A run: step a world, keep what it did, and write it all into one folder.

mod drawing;
mod folder;
mod history;
mod ledger;
mod recorder;
mod recording;
mod resume;
mod rows;
mod runner;
mod scribe;
mod summary;
mod trajectory;

pub use folder::{CHECKPOINT, RunError, RunFolder};
pub use ledger::{LEDGER_HEADER, ledger_header, ledger_row};
pub use recorder::Recorder;
pub use resume::{ResumeError, Resumption};
pub use rows::RowError;
pub use runner::{Finished, Progress, run};
pub use summary::Summary;
pub use trajectory::{CONTACTS_HEADER, TRAJECTORY_HEADER};

pub(crate) use drawing::{boundary, in_studio};
pub(crate) use folder::{LEDGER, SCENE, TRAJECTORY};
pub(crate) use rows::{Rows, parse_ledger, parse_trajectory};
pub(crate) use trajectory::write_row;
