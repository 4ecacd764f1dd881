//! The live viewer: a simulation that goes on while pages in browsers look at it and change it.
//!
//! Data flows one way, and commands flow back:
//! simulation thread → [`Server`]'s latest values → one writer a page; reader of a page → commands →
//! simulation thread. A slow page misses frames and never slows the simulation.
//!
//! - [`Session`]: the simulation with its pending changes; no socket and no clock.
//! - [`Command`]: what a page may ask for, read and checked.
//! - [`head`] and [`frame`]: what a page is told.
//! - [`Server`]: HTTP and WebSocket on the loopback interface, threads and no more.
#![warn(missing_debug_implementations)]

mod command;
pub mod frame;
pub mod head;
mod http;
mod hub;
mod open;
mod parameters;
mod save;
mod server;
mod session;
mod setting;
mod simulation;
mod socket;

pub use command::{Command, MOST_BYTES, Setting};
pub use open::{has_display, open_browser};
pub use server::{Limits, Server, Show};
pub use session::Session;
