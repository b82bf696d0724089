//! A file that appears whole or not at all.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The temporary files that the process is writing, for [`discard_unfinished`].
static UNFINISHED: Unfinished = Unfinished(Mutex::new(BTreeSet::new()));

/// Writes a file through a temporary one beside it, which takes its name only once all of it is on disk. A name that is
/// a device or a pipe already is written to directly, since replacing it is never meant.
///
/// # Errors
/// What the system says; the temporary file is gone then, and the file is as it was.
pub(crate) fn write(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    write_noted(path, &UNFINISHED, write)
}

/// [`write()`], with the temporary file noted in `unfinished` for as long as there is one.
fn write_noted(
    path: &Path,
    unfinished: &Unfinished,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    if fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir()) {
        let mut writer = BufWriter::new(OpenOptions::new().write(true).open(path)?);
        write(&mut writer)?;
        return writer.flush();
    }
    let target = target(path)?;
    let (file, temporary_path) = temporary_file(&target)?.into_parts();
    let noted_path = temporary_path.to_path_buf();
    unfinished.lock().insert(noted_path.clone());
    let mut writer = BufWriter::new(file);
    let written = write(&mut writer).and_then(|()| {
        writer.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()?;
        temporary_path.persist(&target).map_err(|error| error.error)
    });
    unfinished.lock().remove(&noted_path);
    written
}

/// Says early what [`write()`] would run into, so that no long work ends in a file that cannot be written.
pub(crate) fn probe(path: &Path) -> io::Result<()> {
    if fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir()) {
        return OpenOptions::new().write(true).open(path).map(drop);
    }
    temporary_file(&target(path)?).map(drop)
}

/// Removes the temporary files that other threads are writing, if any are; for a program that is about to end.
pub(crate) fn discard_unfinished() {
    UNFINISHED.discard();
}

struct Unfinished(Mutex<BTreeSet<PathBuf>>);

impl Unfinished {
    fn lock(&self) -> MutexGuard<'_, BTreeSet<PathBuf>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn discard(&self) {
        for path in std::mem::take(&mut *self.lock()) {
            // There is nobody left to tell.
            let _ = fs::remove_file(path);
        }
    }
}

/// The file to replace. Renaming onto a link would replace the link; what is meant is the file that it names, which need
/// not be there yet.
fn target(path: &Path) -> io::Result<PathBuf> {
    let target = match fs::read_link(path) {
        Ok(named) => fs::canonicalize(path).unwrap_or_else(|_| parent(path).join(named)),
        Err(_) => path.to_owned(),
    };
    if target.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    Ok(target)
}

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// Beside the target, since only there can it take the target's name in one step.
fn temporary_file(target: &Path) -> io::Result<tempfile::NamedTempFile> {
    let folder = parent(target);
    if !folder.is_dir() {
        let message = format!("there is no folder {}", folder.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, message));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".wavelane-");
    // A temporary file is private by default; a file of ours gets the rights that any new file gets.
    #[cfg(unix)]
    let permissions = std::os::unix::fs::PermissionsExt::from_mode(0o666);
    #[cfg(unix)]
    builder.permissions(permissions);
    // The library's own error names the temporary file, which says nothing to the user.
    builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_that_fails_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "old").unwrap();
        let failed = super::write(&path, |writer| {
            writer.write_all(b"new")?;
            Err(io::Error::other("the disk is full"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "the disk is full");
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    /// Who has the old file open goes on reading the old file: it is replaced, not written over.
    #[test]
    fn a_file_is_replaced_in_one_step() {
        use std::io::Read;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "old").unwrap();
        let mut reader = File::open(&path).unwrap();
        super::write(&path, |writer| writer.write_all(b"new")).unwrap();
        let mut seen = String::new();
        reader.read_to_string(&mut seen).unwrap();
        assert_eq!((seen.as_str(), fs::read_to_string(&path).unwrap().as_str()), ("old", "new"));
    }

    #[test]
    fn an_unfinished_file_can_be_discarded() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        // Not the list of the process: other tests are writing at the same time.
        let unfinished = Unfinished(Mutex::default());
        let ended = write_noted(&path, &unfinished, |_| {
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "the temporary file");
            unfinished.discard();
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
            Ok(())
        });
        assert!(ended.is_err());
    }
}
