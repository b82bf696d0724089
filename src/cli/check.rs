//! `wavelane check SCENE`.

use super::{Failure, output};
use crate::load;
use crate::scene::Scene;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scene: a .toml, .nff, .obj or .ply file, or a folder of .npy arrays
    scene: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let loaded = load::load(&arguments.scene)?;
    output::warnings(&loaded);
    output::result(&format!("{}: {}", arguments.scene.display(), summary(&loaded.scene)))
}

/// What the scene holds, in a line.
fn summary(scene: &Scene) -> String {
    let counted = |count: usize, one: &str, many: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {many}"),
    };
    let geometry = &scene.geometry;
    let parts = [
        counted(geometry.spheres.len(), "sphere", "spheres"),
        counted(geometry.triangles.len(), "triangle", "triangles"),
        counted(geometry.polygons.len(), "polygon", "polygons"),
        counted(scene.lights.len(), "light", "lights"),
        counted(scene.materials.len(), "material", "materials"),
        format!("{} x {} pixels", scene.image.width, scene.image.height),
    ];
    parts.join(", ")
}
