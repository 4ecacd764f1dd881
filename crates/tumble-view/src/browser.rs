//! Opens the user's web browser.

use std::env;
use std::process::{Command, Stdio};

/// Whether a browser window opened here would be visible: the machine has a display and the user is not
/// connected by SSH.
pub fn has_display() -> bool {
    let is_set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
    if is_set("SSH_CONNECTION") || is_set("SSH_TTY") {
        return false;
    }
    cfg!(windows) || cfg!(target_os = "macos") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

/// Opens `url` in the default browser.
///
/// Failures are ignored: the caller prints the address in any case.
pub fn open_browser(url: &str) {
    let mut command = if cfg!(windows) {
        let mut command = Command::new("rundll32");
        command.arg("url.dll,FileProtocolHandler");
        command
    } else if cfg!(target_os = "macos") {
        Command::new("open")
    } else {
        Command::new("xdg-open")
    };
    command.arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    if let Ok(mut child) = command.spawn() {
        // reap the child, so that it does not stay as a zombie process
        std::thread::spawn(move || child.wait());
    }
}
