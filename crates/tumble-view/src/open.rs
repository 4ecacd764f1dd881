//! Opening the person's browser.

use std::env;
use std::process::{Command, Stdio};

/// Whether a window opened here would be seen: there is a display, and it is not at the other end of
/// an ssh connection.
pub fn has_display() -> bool {
    let is_set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
    if is_set("SSH_CONNECTION") || is_set("SSH_TTY") {
        return false;
    }
    cfg!(windows) || cfg!(target_os = "macos") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

/// Opens `address` in the browser, by the means of the system. Whether that worked is not waited for: the
/// address is printed in any case.
pub fn open_browser(address: &str) {
    let mut command = if cfg!(windows) {
        let mut command = Command::new("rundll32");
        command.arg("url.dll,FileProtocolHandler");
        command
    } else if cfg!(target_os = "macos") {
        Command::new("open")
    } else {
        Command::new("xdg-open")
    };
    command.arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    if let Ok(mut child) = command.spawn() {
        // somebody has to take note of its end
        std::thread::spawn(move || child.wait());
    }
}
