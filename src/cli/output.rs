//! Where words go: results to stdout or a file, diagnostics to stderr.

use super::Failure;
use crate::load::Loaded;
use crate::whole_file;
use serde::Serialize;
use std::fmt::Display;
use std::io::{self, Write};
use std::path::Path;

/// A line on stderr. There is nobody to tell if that fails.
pub(super) fn diagnostic(message: &impl Display) {
    let _ = writeln!(io::stderr().lock(), "{message}");
}

/// The warnings of a scene file.
pub(super) fn warnings(loaded: &Loaded) {
    loaded.warnings.iter().for_each(diagnostic);
}

/// A line on stdout; a reader that has gone away has read enough.
pub(super) fn result(line: &impl Display) -> Result<(), Failure> {
    match writeln!(io::stdout().lock(), "{line}") {
        Err(why) if why.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Write { path: "standard output".into(), why })
        }
        _ => Ok(()),
    }
}

/// Says early whether [`json`] could write there, without taking the place of another file of the command.
pub(super) fn check_json(path: Option<&Path>, others: &[&Path]) -> Result<(), Failure> {
    let Some(path) = path.filter(|path| *path != Path::new("-")) else { return Ok(()) };
    if others.contains(&path) {
        let message =
            format!("--json {}: another file of this command has this name; choose another", path.display());
        return Err(Failure::Usage(message));
    }
    whole_file::probe(path).map_err(|why| Failure::Write { path: path.to_owned(), why })
}

/// A report as JSON, to a file, or to stdout where the name is `-`.
pub(super) fn json(report: &impl Serialize, path: &Path) -> Result<(), Failure> {
    let failed = |why| Failure::Write { path: path.to_owned(), why };
    let text = serde_json::to_string_pretty(report).map_err(|error| failed(error.into()))?;
    if path == Path::new("-") {
        return result(&text);
    }
    whole_file::write(path, |writer| writeln!(writer, "{text}")).map_err(failed)
}
