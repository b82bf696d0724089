//! The program: its allocator, and the result of a command as an exit code; nothing else.

#[cfg(target_os = "linux")]
mod huge_pages;

use std::process::ExitCode;

#[cfg(target_os = "linux")]
#[global_allocator]
static ALLOCATOR: huge_pages::HugePages = huge_pages::HugePages;

fn main() -> ExitCode {
    // Before all else, while nothing has run that this machine may not have the instructions for.
    if let Err(code) = wavelane::cli::check_machine() {
        return code;
    }
    wavelane::cli::run(std::env::args_os())
}
