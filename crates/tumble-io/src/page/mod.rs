//! The viewer: one HTML page that shows a run, and `motion.html`, the same page with a run inside.
//!
//! The page itself lives in the folder `viewer` of the project as plain HTML, CSS and JavaScript
//! modules. [`motion_html`] and [`live_html`] put them together into one file that needs nothing
//! else: no network, no server, no other file.
//!
//! | file | does |
//! |---|---|
//! | `head` | what is constant during a run, as JSON |
//! | `film` | the frames, as binary records |
//! | `assemble` | modules, style and data into one file |

mod assemble;
mod film;
mod head;
#[cfg(test)]
mod tests;

pub use assemble::{live_html, motion_html};
pub use film::{BodyFrame, Film, encode_frame, record_size};
pub use head::{Head, Parameter};
