//! Ctrl-C ends the program with exit code 130: at once, or where a render is under way when that has stopped.

use std::sync::atomic::{AtomicBool, Ordering};

const INTERRUPTED: i32 = 130;

/// Whether somebody looks at `STOP`.
static IS_WATCHED: AtomicBool = AtomicBool::new(false);
static STOP: AtomicBool = AtomicBool::new(false);

/// Takes Ctrl-C over from the system.
pub(super) fn catch() {
    let handler = || {
        // A second Ctrl-C does not wait for the first.
        if !IS_WATCHED.load(Ordering::Relaxed) || STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
    };
    // Without a handler Ctrl-C still ends the program, and no file is ever half there.
    let _ = ctrlc::set_handler(handler);
}

/// Is true once the user has asked to stop; from now on it is the caller who stops.
pub(super) fn watch() -> &'static AtomicBool {
    IS_WATCHED.store(true, Ordering::Relaxed);
    &STOP
}
