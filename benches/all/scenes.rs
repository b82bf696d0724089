//! The scenes of benches: small ones of the repository, and well-known ones from the folder that WAVELANE_SCENES names.

use std::io::Write;
use std::path::{Path, PathBuf};
use wavelane::load::load;
use wavelane::scene::Scene;

/// A scene that is there.
pub(crate) struct SceneFile {
    pub(crate) name: &'static str,
    path: PathBuf,
    /// Tracers of triangles can take part.
    pub(crate) is_of_triangles: bool,
}

/// Name, file, and whether it is of triangles only.
type Entry = (&'static str, &'static str, bool);
const OF_THE_REPOSITORY: [Entry; 2] =
    [("knot", "scenes/knot.obj", true), ("sphereflake", "scenes/sphereflake.toml", false)];
const FROM_ELSEWHERE: [Entry; 3] =
    [("bunny", "bunny.obj", true), ("balls", "spd/balls.nff", false), ("gears", "spd/gears.nff", false)];

/// All scenes that can be had; of those that cannot it is said why.
pub(crate) fn available() -> Vec<SceneFile> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let own = OF_THE_REPOSITORY.map(|entry| file(root, entry));
    let Some(folder) = std::env::var_os("WAVELANE_SCENES") else {
        skipped("bunny, balls, gears: WAVELANE_SCENES names no folder of scenes");
        return own.into();
    };
    let there = FROM_ELSEWHERE.map(|entry| file(Path::new(&folder), entry)).into_iter().filter(|scene| {
        let is_there = scene.path.is_file();
        if !is_there {
            skipped(&format!("{}: {} is absent", scene.name, scene.path.display()));
        }
        is_there
    });
    own.into_iter().chain(there).collect()
}

fn file(folder: &Path, (name, path, is_of_triangles): Entry) -> SceneFile {
    SceneFile { name, path: folder.join(path), is_of_triangles }
}

/// Said to stderr itself, where the names of benches are not.
fn skipped(what: &str) {
    let mut stderr = std::io::stderr().lock();
    writeln!(stderr, "skipped: {what}").unwrap();
}

impl SceneFile {
    /// Reads it, for a picture of size × size pixels with one sample each.
    pub(crate) fn load(&self, size: u32) -> Scene {
        let mut scene = load(&self.path).unwrap_or_else(|error| panic!("{error}")).scene;
        (scene.image.width, scene.image.height) = (size, size);
        scene.render.samples = 1;
        let others = scene.geometry.spheres.len() + scene.geometry.polygons.len();
        assert_eq!(others == 0, self.is_of_triangles, "{}", self.name);
        scene
    }
}
