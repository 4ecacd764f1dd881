//! A run: simulates a scene and records it into a folder.
//!
//! Data flow: [`World`](tumble::World) → recorder → folder → [`replay`](crate::replay) →
//! [`export`](crate::export). At its end a run also draws `energy.svg`
//! ([`plot`](crate::plot)), `motion.png` ([`picture`](crate::picture)) and `motion.html`
//! ([`page`](crate::page)), from frames that it holds in memory.
//!
//! The files of this module, each of which imports only from those above it:
//!
//! | file | contents |
//! |---|---|
//! | `error` | [`RunError`] |
//! | `lock` | the lock of a folder |
//! | `folder` | [`RunFolder`]: names of all files, creation of the folder, writing of files |
//! | `kept_meshes` | the meshes of a run, kept with its folder |
//! | `trajectory` | rows of `trajectory.csv` and `contacts.csv` |
//! | `contact_points` | rows of `contact_points.csv` |
//! | `joint_rows` | rows of `joints.csv` |
//! | `energy_ledger` | rows of `energy.csv` |
//! | `csv_reader` | reads and parses those rows |
//! | `picture_input` | scene and frames as input of the picture module |
//! | `frame_buffers` | frames held in memory for pictures and page |
//! | `recorded_rows` | the rows of an interrupted run |
//! | `run_writer` | the thread that writes the rows |
//! | `recorder` | frames, checkpoints and pictures |
//! | `summary`, `progress` | `summary.json`, and what the caller of a run receives |
//! | `run_loop` | [`run`]: step, record, repeat |
//! | `resume_error`, `resume` | [`Resumption`]: continues from a checkpoint |
//!
//! To add a file to the folder, name it in `folder` (a constant and an entry of `FILES`, so that
//! `--force` removes it). Then write it in `Recorder::finish`, if it is written once at the end. A
//! file with a row per frame is a field of `CsvFiles` in `run_writer`; open it in `Recorder::start`
//! and `Recorder::resume`, and measure its length up to the checkpoint in `recorded_rows`.

mod contact_points;
mod csv_reader;
mod energy_ledger;
mod error;
mod folder;
mod frame_buffers;
mod joint_rows;
mod kept_meshes;
mod lock;
mod picture_input;
mod progress;
mod recorded_rows;
mod recorder;
mod resume;
mod resume_error;
mod run_loop;
mod run_writer;
mod summary;
mod trajectory;

pub use contact_points::CONTACT_POINTS_HEADER;
pub use csv_reader::RowError;
pub use energy_ledger::{ENERGY_HEADER, EnergyColumns, energy_row};
pub use error::RunError;
pub use folder::{CHECKPOINT_FILE, RunFolder};
pub use frame_buffers::FrameHistory;
pub use joint_rows::JOINTS_HEADER;
pub use progress::{FinishedRun, Progress};
pub use resume::Resumption;
pub use resume_error::ResumeError;
pub use run_loop::run;
pub use summary::{ContactSteps, Summary};
pub use trajectory::{CONTACTS_HEADER, TRAJECTORY_HEADER};

pub(crate) use csv_reader::{CsvReader, parse_energy, parse_trajectory};
pub(crate) use folder::{ENERGY_FILE, SCENE_FILE, TRAJECTORY_FILE};
pub(crate) use picture_input::{boundaries, draw_run};
pub(crate) use trajectory::write_row;
