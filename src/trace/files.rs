//! Rays and hits as NPY arrays.

use super::{Hits, add_clearance};
use crate::npy;
use crate::rays::{RayKind, RecordedRays};
use crate::scene::Geometry;
use crate::whole_file;
use std::io;
use std::path::{Path, PathBuf};

/// The files of recorded rays in a folder, by kind: `primary.npy` and so on.
#[must_use]
pub fn ray_file(folder: &Path, kind: RayKind) -> PathBuf {
    folder.join(kind.name()).with_extension("npy")
}

/// The files of hits: `PREFIX.t.npy` and `PREFIX.prim.npy`.
#[must_use]
pub fn hit_files(prefix: &Path) -> [PathBuf; 2] {
    ["t", "prim"].map(|column| {
        let mut name = prefix.as_os_str().to_owned();
        name.push(format!(".{column}.npy"));
        PathBuf::from(name)
    })
}

/// Writes a frame's rays into a folder, which is made if need be: a file for each kind that has any, of shape (R, 8), with a
/// `t_min` that keeps a ray off what it starts on. A file of a kind without rays is removed, since it is of another frame.
///
/// # Errors
/// What the system says, and of which file.
pub fn write_rays(
    geometry: &Geometry,
    recorded: &RecordedRays,
    folder: &Path,
) -> Result<(), (PathBuf, io::Error)> {
    std::fs::create_dir_all(folder).map_err(|why| (folder.to_owned(), why))?;
    for kind in RayKind::ALL {
        let path = ray_file(folder, kind);
        let mut rays = recorded.of(kind).clone();
        if rays.is_empty() {
            match std::fs::remove_file(&path) {
                Err(why) if why.kind() != io::ErrorKind::NotFound => return Err((path, why)),
                _ => continue,
            }
        }
        add_clearance(geometry, &mut rays);
        let written =
            whole_file::write(&path, |writer| npy::write(&[rays.len(), 8], rays.rows.as_flattened(), writer));
        written.map_err(|why| (path, why))?;
    }
    Ok(())
}

/// Writes hits: t as f32, +∞ on a miss, and primitives as u32, [`Hits::MISS`] on a miss.
///
/// # Errors
/// What the system says, and of which file.
pub fn write_hits(hits: &Hits, prefix: &Path) -> Result<(), (PathBuf, io::Error)> {
    let [t, id] = hit_files(prefix);
    whole_file::write(&t, |writer| npy::write(&[hits.t.len()], &hits.t, writer)).map_err(|why| (t, why))?;
    whole_file::write(&id, |writer| npy::write(&[hits.id.len()], &hits.id, writer)).map_err(|why| (id, why))
}
