//! Scale: a scene whose every length is multiplied by a power of two is the same picture, to the bit.

use super::engines;
use crate::support::{render_with, root, scaled, scene};
use wavelane::generate::{StandardScene, generate};
use wavelane::load::load;
use wavelane::scene::Scene;

/// 51, for whole pictures: nothing in either engine is of a size that a scene could be too small or too large for.
#[track_caller]
fn is_the_same_at_every_scale(name: &str, mut scene: Scene) {
    (scene.image.width, scene.image.height) = (40, 30);
    scene.render.samples = 1;
    for engine in engines() {
        let expected = render_with(&scene, engine);
        for exponent in [-20, -7, -1, 1, 7, 20] {
            let found = render_with(&scaled(scene.clone(), exponent), engine);
            let differing = expected.image.pixels.iter().zip(&found.image.pixels);
            let differing = differing.filter(|(a, b)| a.map(f32::to_bits) != b.map(f32::to_bits)).count();
            assert_eq!(differing, 0, "pixels of {name} at 2^{exponent}, {engine:?}");
            assert_eq!(found.rays, expected.rays, "{name} at 2^{exponent}, {engine:?}");
        }
    }
}

#[test]
fn example_scenes_are_the_same_at_every_scale() {
    for entry in std::fs::read_dir(root().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            is_the_same_at_every_scale(&path.display().to_string(), load(&path).unwrap().scene);
        }
    }
}

#[test]
fn standard_scenes_are_the_same_at_every_scale() {
    for which in StandardScene::ALL {
        is_the_same_at_every_scale(which.name(), generate(which, 200).unwrap());
    }
}

/// Everything that has a length: every projection, all kinds of primitive, glass that absorbs, point lights, spheres in
/// spheres. Shares and attenuations decide which rays are spawned, so `min_weight` cuts some.
#[test]
fn glass_that_absorbs_is_the_same_at_every_scale_through_every_camera() {
    for camera in [
        "fov = 40",
        "window = [-0.7, 0.5, -0.4, 0.6]\ndistance = 1.3",
        "kind = \"orthographic\"\nheight = 3.3",
        "kind = \"orthographic\"\nwindow = [-2.2, 1.7, -1.2, 1.9]",
    ] {
        let knot = root().join("scenes/knot.obj");
        let toml = format!(
            "[image]\nsize = [40, 30]\nbackground = [0.1, 0.2, 0.3]\n[render]\nmin_weight = 0.004\n\
             [camera]\neye = [1.5, -4, 2.25]\ntarget = [0.1, 0, 0.5]\nup = [0, 0, 1]\n{camera}\n\
             [[light]]\nposition = [3, -2, 4]\n[[light]]\ndirection = [1, 0.5, -1]\nintensity = 0.3\n\
             [material.matte]\ndiffuse = 0.7\nspecular = 0.2\nshininess = 31\n[material.mirror]\nmirror = 0.8\n\
             [material.amber]\nior = 1.5\nabsorption = [0.1, 0.7, 2.3]\n\
             [material.air]\nior = 0.66\n\
             [material.green]\nior = 1.33\nfresnel = false\nmirror = 0.1\ntransmission = 0.9\nabsorption = [3.1, 0.2, 0]\n\
             [[sphere]]\ncenter = [0, 0, 0.5]\nradius = 0.5\nmaterial = \"amber\"\n\
             [[sphere]]\ncenter = [0, 0, 0.5]\nradius = 0.3\nmaterial = \"air\"\n\
             [[sphere]]\ncenter = [1, 0, 0.5]\nradius = 0.5\nmaterial = \"mirror\"\n\
             [[triangle]]\nvertices = [[-1, 1, 0], [-0.5, 0.25, 0], [-1, 0.5, 1]]\nmaterial = \"green\"\n\
             [[polygon]]\nvertices = [[-1.2, -1, 0.1], [-0.2, -1.1, 0.1], [-0.7, -0.9, 0.9]]\nmaterial = \"amber\"\n\
             [[polygon]]\nvertices = [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]]\nmaterial = \"matte\"\n\
             [[mesh]]\nfile = {knot:?}\nmaterial = \"green\"\ntranslate = [-0.7, 0.8, 0.6]\nscale = 0.3\n"
        );
        is_the_same_at_every_scale(camera, scene(&toml));
    }
}
