//! The viewer page: an HTML page that shows a run.
//!
//! The source of the page is in the folder `viewer` of the project, as HTML, CSS and JavaScript
//! modules. [`motion_html`] combines them and a recorded run into `motion.html`, a single file that
//! works offline. [`live_html`] is the same page without a run; it reads frames from a running server.
//!
//! | file | contents |
//! |---|---|
//! | `header` | the constant data of a run, as JSON |
//! | `recording` | the frames, as binary records |
//! | `assemble` | combines modules, style sheet and data into one file |

mod assemble;
mod header;
mod recording;
#[cfg(test)]
mod tests;

pub use assemble::{live_html, motion_html};
pub use header::{Header, IntegratorChoice, Parameter};
pub use recording::{BodyFrame, Recording, WorldFrame, encode_frame, record_size};
