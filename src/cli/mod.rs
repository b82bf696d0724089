//! The command line, a file a command. Results go to stdout or to the named file, everything else to stderr.

mod bench;
mod check;
mod compare;
mod diff;
mod engine;
mod explain;
mod failure;
mod generate;
mod interrupt;
mod measuring;
mod output;
mod pixel;
mod progress;
mod render;
mod settings;
mod trace;

use crate::lanes;
use crate::lanes::Isa;
use crate::render::RenderError;
use clap::{Parser, Subcommand};
use failure::Failure;
use std::ffi::OsString;
use std::process::ExitCode;

/// A Whitted ray tracer that reports its speed beside its error.
#[derive(Debug, Parser)]
#[command(name = "wavelane", version, long_version = long_version(), max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a scene file to a picture
    Render(render::Arguments),
    /// Read and validate a scene file, and render nothing
    Check(check::Arguments),
    /// Say what a scene needs and so what will run: stages, kernels, queues and their bytes
    Explain(explain::Arguments),
    /// Measure throughput: rays a second by kind, seconds by phase and stage, scalar beside SIMD
    Bench(bench::Arguments),
    /// Compare the speed and the error of every engine on one scene, the f64 reference being the truth
    Compare(compare::Arguments),
    /// Trace recorded rays, and say how fast
    Trace(trace::Arguments),
    /// Write a standard scene of a benchmark, of any size, as a scene file
    Generate(generate::Arguments),
    /// Compare two pictures of the same size
    Diff(diff::Arguments),
}

fn long_version() -> String {
    format!("{}\nbuilt for {}", env!("CARGO_PKG_VERSION"), Isa::BUILT_FOR)
}

/// Ends the program with exit code 1 and the reason on stderr where this machine has not all of the instructions that the
/// program was built for.
///
/// # Errors
///
/// The exit code.
pub fn check_machine() -> Result<(), ExitCode> {
    lanes::check_machine().map_err(|refusal| {
        output::diagnostic(&refusal);
        ExitCode::FAILURE
    })
}

/// Runs the program with its arguments, the program's name first.
///
/// The exit code is 0 when the work is done; 1 when it failed; 2 for usage; 3 for an input that cannot be opened, parsed or
/// accepted; 4 for a comparison over its limit; 130 when interrupted.
#[inline(never)]
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(usage) => {
            // Help and version are results, wrong usage is not; clap knows which goes where, and its exit codes are ours.
            let _ = usage.print();
            return ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2));
        }
    };
    interrupt::catch();
    let result = match arguments.command {
        Command::Render(arguments) => render::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Trace(arguments) => trace::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Generate(arguments) => generate::run(&arguments),
        Command::Diff(arguments) => diff::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            output::diagnostic(&failure);
            ExitCode::from(failure.exit_code())
        }
    }
}

/// Does work on so many threads, 0 for one a core.
fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(RenderError::from)?.install(work))
}
