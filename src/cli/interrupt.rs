//! Ctrl-C: the first asks the work to stop, a second does not wait for it.

use std::sync::atomic::{AtomicBool, Ordering};

/// The exit code of an interrupted program.
const INTERRUPTED: i32 = 130;

/// Is true once the user has asked to stop.
pub(super) fn flag() -> &'static AtomicBool {
    static STOP: AtomicBool = AtomicBool::new(false);
    let handler = || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
    };
    // Without a handler Ctrl-C still ends the program, and no file is ever half there.
    let _ = ctrlc::set_handler(handler);
    &STOP
}
