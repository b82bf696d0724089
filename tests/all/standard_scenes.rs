//! The standard scenes: their sizes, what they show, that they are the same everywhere, and the command that writes them.

use crate::support::{Folder, render_with, stderr, stdout, wavefront, wavelane};
use wavelane::generate::{StandardScene, generate};
use wavelane::load::load;
use wavelane::save::{SaveError, save};
use wavelane::scene::Scene;

const SAID_IN_NFF: [StandardScene; 3] =
    [StandardScene::Sphereflake, StandardScene::Tetrahedra, StandardScene::Gears];

fn made(which: StandardScene, size: usize) -> Scene {
    generate(which, size).unwrap()
}

/// What each is made of says how near it can come: spheres one by one, divisions that add 12, gears of 98, cells of 2.
#[test]
fn sizes_are_as_near_as_the_construction_comes() {
    for which in StandardScene::ALL {
        for size in [100, 1_000, 3_333, 10_000, 100_000, 1_000_000] {
            let count = made(which, size).geometry.primitive_count();
            let most = match which {
                StandardScene::Sphereflake | StandardScene::Glass => 0,
                StandardScene::Tetrahedra => 6,
                StandardScene::Gears => 49,
                StandardScene::Terrain => 2 + size / 200,
            };
            assert!(count.abs_diff(size) <= most, "{}: {count} for {size}", which.name());
        }
    }
}

#[test]
fn the_smallest_are_still_themselves() {
    for (which, spheres, triangles, polygons) in [
        (StandardScene::Sphereflake, 1, 0, 1),
        (StandardScene::Tetrahedra, 0, 4, 0),
        (StandardScene::Gears, 0, 0, 1 + 98),
        (StandardScene::Terrain, 4, 2, 1),
        (StandardScene::Glass, 1, 0, 1),
    ] {
        for size in [0, 1] {
            let geometry = made(which, size).geometry;
            let found = (geometry.spheres.len(), geometry.triangles.len(), geometry.polygons.len());
            assert_eq!(found, (spheres, triangles, polygons), "{}", which.name());
        }
    }
}

/// Which kinds of ray there are is what a scene is chosen for. That the engines agree on it is tested where they are compared.
#[test]
fn each_scene_shows_something_and_has_the_rays_that_it_promises() {
    for (which, reflects, refracts) in [
        (StandardScene::Sphereflake, true, false),
        (StandardScene::Tetrahedra, false, false),
        (StandardScene::Gears, true, true),
        (StandardScene::Terrain, true, true),
        (StandardScene::Glass, true, true),
    ] {
        for size in [100, 1_000] {
            let name = which.name();
            let mut scene = made(which, size);
            (scene.image.width, scene.image.height) = (48, 48);
            let background = scene.image.background.to_array();
            let rendered = render_with(&scene, wavefront());
            let pixels = &rendered.image.pixels;
            let hits = pixels.iter().filter(|&&pixel| pixel != background).count();
            assert!(5 * hits > pixels.len(), "{name}: {hits} of {} pixels show something", pixels.len());
            let black = pixels.iter().filter(|pixel| pixel.iter().all(|&channel| channel < 0.01)).count();
            assert!(4 * black < hits, "{name}: {black} of {hits} are black");
            let rays = rendered.rays;
            assert!(rays.shadow > 0, "{name}: {rays:?}");
            assert_eq!((rays.reflect > 0, rays.refract > 0), (reflects, refracts), "{name}: {rays:?}");
        }
    }
}

#[test]
fn every_scene_comes_back_from_its_file() {
    let folder = Folder::new();
    for which in StandardScene::ALL {
        for size in [1, 7, 300] {
            let scene = made(which, size);
            let endings = if SAID_IN_NFF.contains(&which) { &["toml", "nff"][..] } else { &["toml"] };
            for ending in endings {
                let path = folder.file(&format!("scene.{ending}"));
                save(&scene, &path).unwrap();
                let loaded = load(&path).unwrap_or_else(|error| panic!("{error}"));
                assert_eq!(loaded.warnings, [], "{}.{ending}", which.name());
                assert!(loaded.scene == scene, "{}.{ending} of {size}", which.name());
            }
        }
    }
}

#[test]
fn what_nff_cannot_say_is_refused_by_name() {
    let folder = Folder::new();
    for (which, what) in [(StandardScene::Terrain, "ambient"), (StandardScene::Glass, "Schlick")] {
        let refused = save(&made(which, 100), &folder.file("scene.nff")).unwrap_err();
        assert!(matches!(refused, SaveError::CannotSay { .. }));
        let message = refused.to_string();
        assert!(message.contains(what) && message.contains(".toml"), "{message}");
    }
    assert_eq!(folder.names(), [""; 0]);
}

/// One hash a file, held in a snapshot: every build and processor has to come to it. Who changes a scene looks at its
/// picture, and lets the snapshot be written anew; figures that were measured on it before are then history.
#[test]
fn files_do_not_depend_on_the_build() {
    let folder = Folder::new();
    let hash = |which: StandardScene| {
        let path = folder.file("scene.toml");
        save(&made(which, 1000), &path).unwrap();
        let bytes = std::fs::read(path).unwrap();
        // Fowler, Noll and Vo's, 1a.
        let hash = bytes.iter().fold(0xCBF2_9CE4_8422_2325_u64, |hash, &byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3)
        });
        format!("{} {hash:016x}", which.name())
    };
    insta::assert_snapshot!(StandardScene::ALL.map(hash).join("\n"));
}

#[test]
fn the_command_writes_a_scene_and_says_how_large_it_became() {
    let folder = Folder::new();
    for (name, ending, size, says) in [
        ("tetrahedra", "toml", "500", "tetrahedra, 496 primitives"),
        ("sphereflake", "nff", "500", "sphereflake, 500 primitives"),
    ] {
        let path = folder.file(&format!("{name}.{ending}"));
        let path = path.to_str().unwrap();
        let output = wavelane(&["generate", name, "--size", size, "-o", path]);
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
        assert!(stdout(&output).contains(says), "{}", stdout(&output));
        assert!(load(path.as_ref()).is_ok());
    }
}

#[test]
fn what_the_command_cannot_do_is_usage_and_leaves_no_file() {
    let folder = Folder::new();
    let at = |name: &str| folder.file(name).into_os_string().into_string().unwrap();
    let (toml, nff, obj) = (at("a.toml"), at("a.nff"), at("a.obj"));
    for (name, size, path, said) in [
        ("cube", "10", &toml, "sphereflake"),
        ("cube", "10", &toml, "glass"),
        ("gear", "10", &toml, "gears"),
        ("gears", "0", &toml, "1..=10000000"),
        ("gears", "10000001", &toml, "1..=10000000"),
        ("gears", "many", &toml, "many"),
        ("gears", "1000", &obj, ".toml or .nff"),
        ("glass", "1000", &nff, "write a .toml file"),
    ] {
        let output = wavelane(&["generate", name, "--size", size, "-o", path]);
        assert_eq!(output.status.code(), Some(2), "{name} {size} {path}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{name} {size} {path} says {}", stderr(&output));
    }
    let output = wavelane(&["generate", "glass", "--size", "10", "-o", &at("absent/a.toml")]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert_eq!(folder.names(), [""; 0]);
}
