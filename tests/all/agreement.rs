//! The wavefront engine against the f64 reference, from the same samples.

use crate::real_scenes;
use crate::support::root;
use std::path::Path;
use wavelane::generate::{StandardScene, generate};
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::measure::Agreement;
use wavelane::scene::Scene;

/// A row of docs/accuracy.md; shown with `--nocapture`.
#[expect(clippy::print_stdout, reason = "what a test prints is its own")]
fn print(name: &str, found: &Agreement) {
    let Agreement { engine, floor, .. } = found;
    println!(
        "| {name} | {:.1e} | {:.1e} | {} | {} | {} | {} | {} | {} |",
        engine.rms,
        floor.rms,
        engine.pixels_over,
        floor.pixels_over,
        found.wrong_primaries,
        found.uncertain_primaries,
        found.pixels - found.same_trees,
        found.same_trees_over
    );
}

fn file_agrees(path: &Path) {
    let name = path.file_name().unwrap().to_string_lossy();
    agrees(&name, load(path).unwrap_or_else(|error| panic!("{error}")).scene);
}

/// Renders small, with the scene's own samples and depth.
fn agrees(name: &str, mut scene: Scene) {
    (scene.image.width, scene.image.height) = (200, 200);
    scene.render.samples = scene.render.samples.min(2);
    let found = Agreement::measure(&scene, Width::BEST).unwrap();
    print(name, &found);
    assert_eq!(found.wrong_primaries, 0, "{name}: {found:?}");

    // Light is f32 too, where the floor rounds rays and hits alone: half a unit in its last place is no error.
    let light_rounding = 1.0 / f64::from(1 << 24);
    assert!(found.engine.rms <= 2.0 * found.floor.rms.max(light_rounding), "{name}: {found:?}");
    // Some pixels more or less are chance where there are few.
    let allowed = 2 * found.floor.pixels_over + 4;
    assert!(found.engine.pixels_over <= allowed, "{name}: {found:?}");
    let outside = found.same_trees_over as f64 / found.same_trees as f64;
    assert!(outside <= 0.001, "{name}: {found:?}");
}

#[test]
fn on_the_example_scenes() {
    for entry in std::fs::read_dir(root().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            file_agrees(&path);
        }
    }
}

#[test]
fn on_the_standard_scenes() {
    for which in StandardScene::ALL {
        agrees(which.name(), generate(which, 1000).unwrap());
    }
}

#[test]
fn on_the_spd_scenes() {
    for name in ["balls", "gears", "mount", "shells", "sombrero", "teapot", "tetra"] {
        let Some(path) = real_scenes::file(&format!("spd/{name}.nff")) else { continue };
        file_agrees(&path);
    }
}

#[test]
fn on_the_bunny() {
    if let Some(path) = real_scenes::file("bunny.obj") {
        file_agrees(&path);
    }
}
