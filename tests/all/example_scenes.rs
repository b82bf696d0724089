//! The scenes that come with the project: each loads without a warning and shows something.

use crate::support::{Folder, render_whole, root, specification_example};
use wavelane::load::load;

#[test]
fn every_example_scene_renders() {
    let mut scenes = 0;
    for entry in std::fs::read_dir(root().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml" && extension != "nff") {
            continue;
        }
        scenes += 1;
        let loaded = load(&path).unwrap();
        assert_eq!(loaded.warnings, [], "{}", path.display());
        let mut scene = loaded.scene;
        (scene.image.width, scene.image.height, scene.render.samples) = (40, 30, 1);
        let image = render_whole(&scene).image;
        let channels = || image.pixels.iter().flatten();
        assert!(channels().all(|channel| channel.is_finite()), "{}", path.display());
        let (low, high) = (channels().copied().fold(9.0, f32::min), channels().copied().fold(0.0, f32::max));
        assert!(high - low > 0.2, "{} is of one shade", path.display());
    }
    assert!(scenes >= 6, "only {scenes} scenes found");
}

/// The example in the scene format's specification shows every key, and is accepted as it stands.
#[test]
fn the_specification_is_true() {
    let folder = Folder::new();
    folder.write("bunny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let loaded =
        load(&folder.write("scene.toml", specification_example())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.warnings, []);
    assert_eq!((loaded.scene.geometry.primitive_count(), loaded.scene.lights.len()), (4, 2));
}
