//! Ctrl-C and requests to terminate.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::console::print_error;

/// A flag that the first SIGINT (Ctrl-C) or SIGTERM sets; a second signal ends the process at once.
///
/// SIGHUP keeps its default action, so that `nohup` works as usual.
pub fn stop_flag() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let registered = [SIGINT, SIGTERM].into_iter().try_for_each(|signal| {
        // the order matters: the conditional shutdown must see the flag of the previous signal
        flag::register_conditional_shutdown(signal, 130, Arc::clone(&stop))?;
        flag::register(signal, Arc::clone(&stop)).map(|_| ())
    });
    if registered.is_err() {
        print_error(
            "warning: cannot handle Ctrl-C: it will end the command without saving results",
        );
    }
    stop
}
