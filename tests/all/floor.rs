//! The reference with rays and hits kept in f32: no holes, no acne, and a picture that is nearly the truth.

use crate::support::{STILL_LIFE, ball, root, scaled, scene};
use glam::Vec3;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use wavelane::load::load;
use wavelane::rays::RayCounts;
use wavelane::reference::{Precision, Tracer};
use wavelane::scene::Scene;

type Pixels = Vec<[f64; 3]>;

fn pixels(scene: &Scene, precision: Precision) -> Pixels {
    let stop = AtomicBool::new(false);
    let tracer = Tracer::with_precision(scene, precision, &stop);
    let columns_of = |y| (0..scene.image.width).map(move |x| (x, y));
    let all = (0..scene.image.height).flat_map(columns_of);
    all.map(|(x, y)| tracer.pixel(x, y, &mut RayCounts::default())).collect()
}

/// The floor of a TOML text's picture.
fn floor(toml: &str) -> Pixels {
    pixels(&scene(toml), Precision::F32Queues)
}

#[test]
fn the_floor_is_the_same_at_every_scale() {
    let expected = floor(STILL_LIFE);
    for exponent in [-30, -20, 20, 30] {
        let found = pixels(&scaled(scene(STILL_LIFE), exponent), Precision::F32Queues);
        assert_eq!(found, expected, "scaled by 2^{exponent}");
    }
}

/// As the truth is tested, with points that f32 puts off their faces by up to a thousandth of a face.
#[test]
fn no_face_of_a_convex_solid_shadows_itself_or_its_neighbour() {
    for (center, radius) in [(Vec3::ZERO, 1.0), (Vec3::ZERO, 1e-6), (Vec3::new(1000.0, -2000.0, 500.0), 1.0)]
    {
        for quads in [false, true] {
            let eye = (center + radius * Vec3::new(1.0, 3.0, 2.0)).to_array();
            let found = floor(&format!(
                "[image]\nsize = [240, 240]\nbackground = 1\n[camera]\neye = {eye:?}\ntarget = {:?}\nup = [0, 0, 1]\nfov = 32\n\
                 [[light]]\nposition = {eye:?}\n[material.m]\ndiffuse = 1\n{}",
                center.to_array(),
                ball(center, radius, quads)
            ));
            let dark = found.iter().filter(|pixel| **pixel == [0.0; 3]).count();
            assert_eq!(dark, 0, "ball at {center} of radius {radius}, quads {quads}");
        }
    }
}

/// The lamp's surface is seen at all angles; the lamp is before it, so every point of the ground is lit.
#[test]
fn a_light_on_a_surface_is_not_hidden_by_it() {
    let found = floor(
        "[image]\nsize = [100, 100]\n[camera]\nkind = \"orthographic\"\neye = [0, 0, 0.4]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nheight = 18\n\
         [[light]]\nposition = [0.75, 0.5, 1.046875]\n[material.m]\ndiffuse = 1\n\
         [[polygon]]\nvertices = [[-9, -9, 0.1], [9, -9, 0.1], [9, 9, 0.3], [-9, 9, 0.3]]\nmaterial = \"m\"\n\
         [[polygon]]\nvertices = [[-16, -16, 0], [16, -16, 2], [16, 16, 2], [-16, 16, 0]]\nmaterial = \"m\"\n",
    );
    let dark = found.iter().filter(|pixel| **pixel == [0.0; 3]).count();
    assert_eq!(dark, 0);
}

/// Pixels whose floor is more than a step of eight bits off the truth.
fn off_the_truth(path: &Path, side: u32) -> usize {
    let mut scene = load(path).unwrap_or_else(|error| panic!("{error}")).scene;
    (scene.image.width, scene.image.height, scene.render.samples) = (side, side, 1);
    let (truth, floor) = (pixels(&scene, Precision::F64), pixels(&scene, Precision::F32Queues));
    let differ = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).any(|c| (a[c] - b[c]).abs() > 1.0 / 255.0);
    truth.iter().zip(&floor).filter(|&pair| differ(pair)).count()
}

#[test]
fn the_floor_of_the_example_scenes_is_nearly_the_truth() {
    for name in ["glass", "isometric", "lights", "mesh", "polygons", "sphereflake"] {
        let off = off_the_truth(&root().join(format!("scenes/{name}.toml")), 64);
        assert!(off <= 2, "{name}: {off} of 4096 pixels");
    }
}

/// Mirrored from sphere to sphere, a ray multiplies what it was off by; one or two hundredths of a share are lost to that.
#[test]
fn the_floor_of_the_spd_scenes_is_nearly_the_truth() {
    let Some(folder) = std::env::var_os("WAVELANE_SCENES") else { return };
    for name in ["balls", "gears", "mount", "shells", "sombrero", "teapot", "tetra"] {
        let path = PathBuf::from(&folder).join(format!("spd/{name}.nff"));
        if path.is_file() {
            let off = off_the_truth(&path, 128);
            assert!(off <= 80, "{name}: {off} of 16384 pixels");
        }
    }
}
