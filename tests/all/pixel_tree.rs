//! The tree of rays of one pixel: what both engines say of it, held against what they say of the pixel alone.

use crate::support::{STILL_LIFE, render_region, root, scaled, scene};
use glam::DVec3;
use std::sync::atomic::AtomicBool;
use wavelane::film::Region;
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::measure::TreeComparison;
use wavelane::ray_tree::{PixelTree, RayTree, Shadow, TreeTooLarge};
use wavelane::rays::RayCounts;
use wavelane::reference::Tracer;
use wavelane::render::{DEFAULT_BATCH, Engine, RenderError, pixel_tree};
use wavelane::scene::{Sampling, Scene};

fn tree(scene: &Scene, engine: Engine, place: [u32; 2]) -> PixelTree {
    pixel_tree(scene, engine, place, &AtomicBool::new(false)).unwrap()
}

/// The example scenes at a size at which all of them are tried quickly, and the still life with random samples.
fn scenes() -> Vec<(String, Scene)> {
    let mut scenes: Vec<(String, Scene)> = std::fs::read_dir(root().join("scenes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| (path.display().to_string(), load(&path).unwrap().scene))
        .collect();
    let mut still_life = scene(STILL_LIFE);
    (still_life.render.samples, still_life.render.sampling) = (3, Sampling::Random);
    scenes.push(("still life".to_owned(), still_life));
    for (_, scene) in &mut scenes {
        (scene.image.width, scene.image.height) = (60, 45);
        scene.render.samples = scene.render.samples.min(2);
    }
    scenes
}

/// Pixels all over the image.
fn places(scene: &Scene) -> impl Iterator<Item = [u32; 2]> {
    let (width, height) = (scene.image.width, scene.image.height);
    (0..height).step_by(4).flat_map(move |y| (y % 3..width).step_by(5).map(move |x| [x, y]))
}

#[test]
fn the_references_tree_is_that_of_its_pixel() {
    for (name, scene) in scenes() {
        let stop = AtomicBool::new(false);
        let tracer = Tracer::new(&scene, &stop);
        for [x, y] in places(&scene) {
            let mut counts = RayCounts::default();
            let colour = tracer.pixel(x, y, &mut counts);
            let tree = tree(&scene, Engine::Reference, [x, y]);
            assert_eq!((tree.colour, tree.rays()), (colour, counts), "{name} at {x},{y}");
            assert_eq!(tree.signature(), tracer.signature(x, y), "{name} at {x},{y}");
        }
    }
}

#[test]
fn the_engines_tree_is_that_of_its_pixel_at_any_width() {
    for (name, scene) in scenes() {
        for [x, y] in places(&scene).step_by(3) {
            let tree = tree(&scene, Engine::wavefront(Width::BEST), [x, y]);
            let engine =
                Engine::Wavefront { width: Width::BEST, batch: DEFAULT_BATCH, records: true, rays: None };
            let pixel = render_region(&scene, engine, Region { x0: x, y0: y, x1: x + 1, y1: y + 1 }, 1);
            assert_eq!(tree.colour, pixel.image.pixels[0].map(f64::from), "{name} at {x},{y}");
            assert_eq!(tree.rays(), pixel.rays, "{name} at {x},{y}");
            assert_eq!(tree.signature(), pixel.records[0].signature, "{name} at {x},{y}");
            for width in Width::ALL {
                let other = self::tree(&scene, Engine::wavefront(width), [x, y]);
                assert_eq!(other, tree, "{name} at {x},{y}, {width:?}");
            }
        }
    }
}

/// By the pixel's signature, and by the comparison, which also tells the side from which a surface is hit.
#[test]
fn trees_part_exactly_where_signatures_do() {
    let (mut same, mut parted) = (0, 0);
    for (name, scene) in scenes() {
        for place in places(&scene) {
            let [reference, engine] =
                [Engine::Reference, Engine::wavefront(Width::BEST)].map(|engine| tree(&scene, engine, place));
            let found = TreeComparison::new(&reference, &engine);
            let is_same = reference.signature() == engine.signature();
            assert_eq!(found.parting.is_none(), is_same, "{name} at {place:?}");
            assert!(is_same || found.first_difference <= found.parting, "{name} at {place:?}");
            same += usize::from(is_same);
            parted += usize::from(!is_same);
        }
    }
    // As docs/accuracy.md has it: some of the mirrored things of `mesh`.
    assert!(same > 500 && (1..20).contains(&parted), "{same} the same, {parted} not");
}

/// Calls a check with every ray of a tree and its depth.
fn each_ray(ray: &RayTree, depth: u32, check: &mut impl FnMut(&RayTree, u32)) {
    check(ray, depth);
    for child in [&ray.reflect, &ray.refract].into_iter().flatten() {
        each_ray(child, depth + 1, check);
    }
}

/// Geometry and light have to fit together whatever the engine keeps them in; f32 and its scale would show.
#[test]
fn what_a_tree_says_fits_together() {
    let close = |a: DVec3, b: DVec3, size: f64| (a - b).length() <= 1e-5 * size.max(1.0);
    for (name, scene) in scenes() {
        for engine in [Engine::Reference, Engine::wavefront(Width::BEST)] {
            for place in places(&scene) {
                let tree = tree(&scene, engine, place);
                let samples = tree.samples.len() as f64;
                let mean = tree.samples.iter().map(|ray| DVec3::from(ray.colour)).sum::<DVec3>() / samples;
                assert!(close(mean, tree.colour.into(), 1.0), "{name} at {place:?}");
                let mut check = |ray: &RayTree, depth: u32| {
                    let at = format!("{name} at {place:?}, depth {depth}, {engine:?}: {ray:?}");
                    assert!((DVec3::from(ray.direction).length() - 1.0).abs() < 1e-6, "{at}");
                    assert!(depth > 0 || ray.weight == [1.0; 3], "{at}");
                    let Some(hit) = &ray.hit else {
                        assert_eq!(
                            ray.colour.map(|channel| channel as f32),
                            scene.image.background.to_array()
                        );
                        return;
                    };
                    let [origin, direction, point] = [ray.origin, ray.direction, hit.point].map(DVec3::from);
                    assert!(close(origin + hit.t * direction, point, point.length() + hit.t), "{at}");
                    let normal = DVec3::from(hit.geometric_normal);
                    assert!(direction.dot(normal) < 1e-6, "{at}");
                    let ambient = scene.materials[hit.material.0 as usize].ambient * scene.ambient;
                    let light = hit.lights.iter().map(|light| DVec3::from(light.adds)).sum::<DVec3>();
                    assert!(close(ambient.as_dvec3() + light, hit.local_light.into(), 1.0), "{at}");
                    assert_eq!(hit.lights.len(), scene.lights.len());
                    let only_visible = hit
                        .lights
                        .iter()
                        .all(|light| light.shadow == Shadow::Visible || light.adds == [0.0; 3]);
                    assert!(only_visible, "{at}");
                    for child in [&ray.reflect, &ray.refract].into_iter().flatten() {
                        assert_eq!(child.origin, hit.point, "{at}");
                        assert!(depth < scene.render.max_depth, "{at}");
                    }
                    if let Some(reflect) = &ray.reflect {
                        assert!(DVec3::from(reflect.direction).dot(normal) > -1e-6, "{at}");
                    }
                    if let Some(refract) = &ray.refract {
                        assert!(DVec3::from(refract.direction).dot(normal) < 1e-6, "{at}");
                    }
                };
                tree.samples.iter().for_each(|ray| each_ray(ray, 0, &mut check));
            }
        }
    }
}

/// Lengths are the world's, though the engine's own scale is another.
#[test]
fn a_tree_scales_with_its_scene() {
    let (small, large) = (scene(STILL_LIFE), scaled(scene(STILL_LIFE), 9));
    for engine in [Engine::Reference, Engine::wavefront(Width::BEST)] {
        for place in places(&small) {
            let [mut expected, found] = [&small, &large].map(|scene| tree(scene, engine, place));
            fn enlarge(ray: &mut RayTree) {
                let larger = |vector: [f64; 3]| vector.map(|coordinate| coordinate * 512.0);
                ray.origin = larger(ray.origin);
                if let Some(hit) = &mut ray.hit {
                    (hit.t, hit.point) = (hit.t * 512.0, larger(hit.point));
                }
                [&mut ray.reflect, &mut ray.refract].into_iter().flatten().for_each(|child| enlarge(child));
            }
            expected.samples.iter_mut().for_each(enlarge);
            assert_eq!(found, expected, "{engine:?} at {place:?}");
        }
    }
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let mut scene = scene(STILL_LIFE);
    let (stopped, free) = (AtomicBool::new(true), AtomicBool::new(false));
    for engine in [Engine::Reference, Engine::wavefront(Width::BEST)] {
        let refusal = |scene: &Scene, place, stop| pixel_tree(scene, engine, place, stop).unwrap_err();
        assert!(matches!(refusal(&scene, [32, 24], &stopped), RenderError::Stopped));
        for place in [[64, 0], [0, 48], [u32::MAX, u32::MAX]] {
            let found = refusal(&scene, place, &free);
            assert!(matches!(found, RenderError::Pixel { width: 64, height: 48, .. }), "{found}");
        }
        // Of the glass, from which rays are mirrored on to the end.
        (scene.render.samples, scene.render.max_depth) = (64, 64);
        let found = refusal(&scene, [26, 27], &free);
        assert!(
            matches!(found, RenderError::Tree(TreeTooLarge { entries }) if entries > PixelTree::MOST_ENTRIES),
            "{found}"
        );
        (scene.render.samples, scene.render.max_depth) = (1, 8);
    }
}
