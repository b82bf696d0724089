//! What several tests need: scenes from text, rendered by the library; the program; temporary folders.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::AtomicBool;
use wavelane::film::{Image, Region};
use wavelane::load::load;
use wavelane::render::{Engine, RenderOptions, Rendered, render};
use wavelane::scene::Scene;

/// A folder that goes away with the value.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.file(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    /// Names of all files, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// The scene of a TOML text.
pub(crate) fn scene(toml: &str) -> Scene {
    let folder = Folder::new();
    load(&folder.write("scene.toml", toml)).unwrap_or_else(|error| panic!("{error}\nin\n{toml}")).scene
}

pub(crate) fn render_whole(scene: &Scene) -> Rendered {
    let options = RenderOptions {
        engine: Engine::Reference,
        region: Region::whole(scene.image.width, scene.image.height),
        threads: 0,
        on_progress: &|_| {},
        stop: &AtomicBool::new(false),
    };
    render(scene, &options).unwrap()
}

/// The picture of a TOML text.
pub(crate) fn picture(toml: &str) -> Image {
    render_whole(&scene(toml)).image
}

/// The only pixel of a TOML text's picture.
pub(crate) fn pixel(toml: &str) -> [f32; 3] {
    let image = picture(toml);
    assert_eq!((image.width, image.height), (1, 1));
    image.pixels[0]
}

/// A camera of one pixel that looks from `eye` along the line to `target`, with orthographic rays.
pub(crate) fn one_ray(eye: [f64; 3], target: [f64; 3]) -> String {
    format!(
        "[image]\nsize = [1, 1]\n[camera]\nkind = \"orthographic\"\neye = {eye:?}\ntarget = {target:?}\nup = [0.123, 0.987, 0.456]\nheight = 1e-9\n"
    )
}

#[track_caller]
pub(crate) fn assert_close(found: [f32; 3], expected: [f64; 3], tolerance: f64) {
    for channel in 0..3 {
        let difference = (f64::from(found[channel]) - expected[channel]).abs();
        assert!(difference <= tolerance, "found {found:?}, expected {expected:?}");
    }
}

/// Runs the program.
pub(crate) fn wavelane(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wavelane")).args(arguments).output().unwrap()
}

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The project's root.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The scene in the scene format's specification, which has every key; it names a mesh bunny.obj.
pub(crate) fn specification_example() -> String {
    let page = std::fs::read_to_string(root().join("docs/scenes.md")).unwrap();
    let (_, after) = page.split_once("```toml\n").unwrap();
    after.split_once("```").unwrap().0.to_owned()
}
