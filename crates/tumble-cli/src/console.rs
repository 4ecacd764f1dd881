//! Output to the terminal.

use std::io::{self, IsTerminal, Write};

use indicatif::{ProgressBar, ProgressStyle};
use tumble_io::printable;

/// Whether messages on stderr may be coloured.
pub fn use_colour() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}

/// Prints a line to stderr. Failures are ignored: there is nowhere left to report them. Control characters,
/// which may come from the name of a file, are replaced.
pub fn print_error(message: &str) {
    print_styled_error(&printable(message));
}

/// As [`print_error`], for a message with colours, of which only its maker knows which control characters are its own.
pub fn print_styled_error(message: &str) {
    let _ = writeln!(io::stderr().lock(), "{message}");
}

/// Prints text to stdout, without control characters. A closed pipe, as in `tumble scenes | head -1`, is not an error.
///
/// # Errors
/// When stdout cannot be written for another reason.
pub fn print(text: &str) -> io::Result<()> {
    match io::stdout().lock().write_all(printable(text).as_bytes()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// A progress bar on stderr, hidden unless stderr is a terminal.
pub fn progress_bar() -> ProgressBar {
    if !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(0);
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}  {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}
