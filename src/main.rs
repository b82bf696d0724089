//! The program: maps the result of a command to an exit code, nothing else.

use std::process::ExitCode;

fn main() -> ExitCode {
    wavelane::cli::run(std::env::args_os())
}
