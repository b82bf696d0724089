//! Ctrl-C ends the program with exit code 130 and no file half written: at once, or where rays are being traced as soon
//! as these have stopped.

use crate::whole_file;
use std::sync::atomic::{AtomicBool, Ordering};

const INTERRUPTED: i32 = 130;

/// Whether somebody looks at `STOP`.
static IS_WATCHED: AtomicBool = AtomicBool::new(false);
static STOP: AtomicBool = AtomicBool::new(false);

/// Takes Ctrl-C over from the system.
pub(super) fn catch() {
    let handler = || {
        // A second Ctrl-C does not wait for the first.
        if STOP.swap(true, Ordering::SeqCst) || !IS_WATCHED.load(Ordering::SeqCst) {
            end();
        }
    };
    // Without a handler Ctrl-C still ends the program, if not with this exit code.
    let _ = ctrlc::set_handler(handler);
}

/// Does some work that stops soon once the flag is true.
pub(super) fn watched<T>(work: impl FnOnce(&AtomicBool) -> T) -> T {
    IS_WATCHED.store(true, Ordering::SeqCst);
    let result = work(&STOP);
    IS_WATCHED.store(false, Ordering::SeqCst);
    result
}

/// Ends the program if Ctrl-C came when it was not looked at any more.
pub(super) fn end_if_asked() {
    if STOP.load(Ordering::SeqCst) {
        end();
    }
}

fn end() -> ! {
    whole_file::discard_unfinished();
    std::process::exit(INTERRUPTED)
}
