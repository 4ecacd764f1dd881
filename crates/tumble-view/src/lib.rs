//! The live viewer: a local web server that runs a simulation and shows it in browser pages.
//!
//! # Data flow
//!
//! The simulation thread owns the [`Session`] and is the only thread that steps it. Results flow from it to
//! the pages, commands flow back:
//!
//! ```text
//! simulation thread ── Session ──> Broadcast ──> one writer thread per page ──> WebSocket ──> page
//!         ^                                                                                    │
//!         └────────── command queue <── one reader thread per page <── WebSocket <─────────────┘
//! ```
//!
//! `Broadcast` keeps only the latest header, status and frame. A page on a slow connection skips frames; it
//! never delays the simulation or another page.
//!
//! # Files, from the simulation outwards
//!
//! | file | content |
//! |---|---|
//! | `command` | [`Command`]: a message from a page, parsed and checked |
//! | `scene_edit` | a scene with one key changed, loaded again |
//! | `transfer` | the state of one world moved into a world with another model |
//! | `save` | the present state written as a scene file |
//! | `capacity` | how large a scene the viewer accepts |
//! | `session` | [`Session`]: scene, world and pending edits; no socket and no clock |
//! | `integrators` | the integrators that the page offers, with the steps that suit them |
//! | `parameters` | the list of sliders: key, value, unit and range |
//! | [`header`] | what a page needs once: shapes, bodies, walls, sliders (JSON) |
//! | [`frame`] | one frame (binary) |
//! | `broadcast` | the latest header, status and frame; replies to single pages |
//! | `simulation` | the simulation thread |
//! | `limits` | [`Limits`]: timeouts and the number of connections |
//! | `http` | HTTP requests and responses |
//! | `socket` | the two threads of one page's WebSocket |
//! | `server` | [`Server`]: listens, accepts connections, starts the threads |
//! | `browser` | opens the user's browser |
//!
//! The page itself is in the folder `viewer` of the repository. `docs/formats.md` describes the messages.
//!
//! # How to add a slider
//!
//! A slider sets one number of the scene file.
//!
//! 1. The number must be a key of the scene, so that `tumble run --set KEY=VALUE` accepts it. If it is new,
//!    add it to the scene reader and writer in `tumble-io/src/scene`.
//! 2. In `parameters.rs`, add a line to the function `parameters` (or to the method for materials or bodies):
//!    key, present value, unit and range, with `log` for a logarithmic slider and `linear` for a linear one.
//! 3. In `scene_edit.rs`, check `applies_at_once`. Every key outside `[[body]]` takes effect while the simulation
//!    runs. A key inside `[[body]]` waits for the next reset unless it is in `MATERIAL_KEYS`.
//! 4. If a running simulation can take the new value only with a change of its state (as friction springs are
//!    released when a wall moves), add that to `transfer.rs`.
//!
//! The page needs no change: `viewer/live_controls.js` builds a slider for every entry of the list and labels it with
//! its key. `cargo test -p tumble-view` sets every slider of every built-in scene to its present value.
#![warn(missing_debug_implementations)]

mod broadcast;
mod browser;
mod capacity;
mod command;
pub mod frame;
pub mod header;
mod http;
mod integrators;
mod limits;
mod parameters;
mod save;
mod scene_edit;
mod server;
mod session;
mod simulation;
mod socket;
mod transfer;

pub use browser::{has_display, open_browser};
pub use command::{Command, MAX_MESSAGE_BYTES, SceneEdit};
pub use limits::Limits;
pub use server::{Content, Server};
pub use session::Session;
