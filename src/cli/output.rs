//! Where words go: results to stdout or a file, diagnostics to stderr.

use super::Failure;
use crate::load::Loaded;
use crate::whole_file;
use serde::Serialize;
use std::fmt::Display;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

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
    check_distinct_of("--json ", &[path], others)?;
    probe(path)
}

/// Says early whether [`svg`] could write there, without taking the place of a file that is read.
pub(super) fn check_svg(path: Option<&Path>, inputs: &[&Path]) -> Result<(), Failure> {
    let Some(path) = path else { return Ok(()) };
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        return Err(Failure::Usage(format!("{}: the name of a plot ends in .svg", path.display())));
    }
    check_distinct(&[path], inputs)?;
    probe(path)
}

/// Says early whether a file can be written.
pub(super) fn probe(path: &Path) -> Result<(), Failure> {
    whole_file::probe(path).map_err(|why| Failure::Write { path: path.to_owned(), why })
}

/// Says early whether files to be written would take each other's place, or that of what is read.
pub(super) fn check_distinct(outputs: &[&Path], inputs: &[&Path]) -> Result<(), Failure> {
    check_distinct_of("", outputs, inputs)
}

/// The same of the files that an option names.
fn check_distinct_of(option: &str, outputs: &[&Path], inputs: &[&Path]) -> Result<(), Failure> {
    for (index, output) in outputs.iter().enumerate() {
        if inputs.iter().chain(&outputs[..index]).any(|other| clash(output, other)) {
            return Err(Failure::Usage(format!(
                "{option}{}: another file of this command has this name; choose another",
                output.display()
            )));
        }
    }
    Ok(())
}

/// Whether a file to be written is another file, however both are named, or lies in a folder of arrays that is read. Devices
/// and pipes are nobody's.
fn clash(output: &Path, other: &Path) -> bool {
    const ARRAYS: [&str; 3] = ["vertices.npy", "triangles.npy", "spheres.npy"];
    if output == Path::new("-") || output.metadata().is_ok_and(|meta| !meta.is_file()) {
        return false;
    }
    let (output, other) = (resolved(output), resolved(other));
    let is_array = || ARRAYS.iter().any(|name| output == other.join(name));
    output == other || is_array()
}

/// A path without links and detours, where there is one; of a file that is not there yet, its folder's.
fn resolved(path: &Path) -> PathBuf {
    let in_folder = || {
        let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
        Some(folder.canonicalize().ok()?.join(path.file_name()?))
    };
    path.canonicalize().ok().or_else(in_folder).unwrap_or_else(|| path.to_owned())
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

/// A plot, to a file.
pub(super) fn svg(text: &str, path: &Path) -> Result<(), Failure> {
    let written = whole_file::write(path, |writer| writer.write_all(text.as_bytes()));
    written.map_err(|why| Failure::Write { path: path.to_owned(), why })
}
