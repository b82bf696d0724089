//! Scenes that the project did not write: Haines' SPD and the Stanford bunny, in the folder that WAVELANE_SCENES names.

use crate::support::render_with;
use std::io::Write;
use std::path::PathBuf;
use wavelane::load::load;
use wavelane::rays::RayCounts;
use wavelane::render::Engine;

/// A file of the folder; none, said out loud, where it is absent.
pub(crate) fn file(name: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os("WAVELANE_SCENES") else {
        skipped(&format!("{name}: WAVELANE_SCENES names no folder of scenes"));
        return None;
    };
    let path = PathBuf::from(folder).join(name);
    if !path.is_file() {
        skipped(&format!("{} is absent", path.display()));
        return None;
    }
    Some(path)
}

/// Said to stderr itself: what a passing test prints with a macro is not shown.
fn skipped(what: &str) {
    let mut stderr = std::io::stderr().lock();
    writeln!(stderr, "skipped: {what}").unwrap();
}

#[test]
fn the_spd_scenes_render() {
    // Spheres, triangles and polygons are counted in the files by their first words. The mean colours are those of this
    // engine on 2026-11-22, when pictures of 32 × 32 agreed to 1e-7 with those of an independent program written from the
    // model alone: they keep the light as it was.
    for (name, spheres, triangles, polygons, lights, mean) in [
        ("balls", 7381, 0, 1, 3, [0.64474, 0.53256, 0.33590]),
        ("gears", 0, 0, 9345, 5, [0.53557, 0.59758, 0.66652]),
        ("mount", 4, 8192, 0, 1, [0.12158, 0.24360, 0.40789]),
        ("teapot", 0, 2256, 36, 2, [0.42650, 0.52617, 0.70288]),
        ("tetra", 0, 4096, 0, 1, [0.15374, 0.31028, 0.62752]),
        ("shells", 5761, 0, 0, 1, [0.22158, 0.40299, 0.63458]),
        ("sombrero", 0, 1922, 0, 1, [0.26464, 0.22897, 0.45372]),
    ] {
        let Some(path) = file(&format!("spd/{name}.nff")) else { continue };
        let scene = load(&path).unwrap_or_else(|error| panic!("{error}")).scene;
        let geometry = &scene.geometry;
        let counts =
            (geometry.spheres.len(), geometry.triangles.len(), geometry.polygons.len(), scene.lights.len());
        assert_eq!(counts, (spheres, triangles, polygons, lights), "{name}");
        assert_eq!((scene.image.width, scene.image.height), (512, 512), "{name}");
        let rendered = render_with(&scene, Engine::Reference);
        assert_eq!(rendered.rays.primary, 512 * 512, "{name}");
        let background = scene.image.background.to_array();
        let covered = rendered.image.pixels.iter().filter(|pixel| **pixel != background).count();
        assert!((20_000..=262_144).contains(&covered), "{name} covers {covered} pixels");
        for (channel, mean) in mean.into_iter().enumerate() {
            let sum: f64 = rendered.image.pixels.iter().map(|pixel| f64::from(pixel[channel])).sum();
            let found = sum / rendered.image.pixels.len() as f64;
            assert!(
                (found - mean).abs() < 2e-5,
                "{name}: mean of channel {channel} is {found}, expected {mean}"
            );
        }
        assert!(rendered.image.pixels.iter().flatten().all(|channel| channel.is_finite()), "{name}");
    }
}

#[test]
fn the_bunny_is_framed() {
    let Some(path) = file("bunny.obj") else { return };
    let mut scene = load(&path).unwrap_or_else(|error| panic!("{error}")).scene;
    (scene.image.width, scene.image.height) = (128, 128);
    assert_eq!(scene.geometry.triangles.len(), 69_451);
    let rendered = render_with(&scene, Engine::Reference);
    assert_eq!(rendered.rays, RayCounts { reflect: 0, refract: 0, ..rendered.rays });
    let lit = rendered.image.pixels.iter().filter(|pixel| pixel[0] > 0.0).count();
    assert!(lit > 2000, "{lit} pixels are lit");
}
