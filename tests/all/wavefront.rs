//! The wavefront engine: the same bits however it works, memory that does not grow, and only what a scene needs.

use crate::support::{STILL_LIFE, render_region, render_with, root, scene, wavefront};
use wavelane::film::{Image, Region};
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::prepare::Prepared;
use wavelane::render::{DEFAULT_BATCH, Engine};
use wavelane::scene::Scene;
use wavelane::wavefront::{Counters, Explanation, WavefrontReport};

/// The scenes that come with the project, small, by name.
fn example_scenes() -> Vec<(String, Scene)> {
    let entries = std::fs::read_dir(root().join("scenes")).unwrap();
    let mut scenes: Vec<(String, Scene)> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| {
            let mut scene = load(&path).unwrap().scene;
            (scene.image.width, scene.image.height) = (97, 71);
            (path.file_stem().unwrap().to_string_lossy().into_owned(), scene)
        })
        .collect();
    scenes.sort_by(|a, b| a.0.cmp(&b.0));
    scenes
}

/// Equal bits, zeros of either sign told apart.
fn bits(image: &Image) -> Vec<[u32; 3]> {
    image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn bits_do_not_depend_on_lanes_threads_batches_or_crop() {
    for (name, scene) in example_scenes() {
        let whole = Region::whole(scene.image.width, scene.image.height);
        let expected = render_region(&scene, Engine::wavefront(Width::One), whole, 1).image;
        for (width, batch, threads) in [
            (Width::Four, DEFAULT_BATCH, 1),
            (Width::Eight, 64, 2),
            (Width::Sixteen, 1000, 3),
            (Width::One, 192, 2),
            (Width::Sixteen, 1 << 16, 1),
        ] {
            let engine = Engine::Wavefront { width, batch, records: false, rays: None };
            let found = render_region(&scene, engine, whole, threads).image;
            assert!(bits(&found) == bits(&expected), "{name}: {width:?}, batch {batch}, {threads} threads");
        }
        let region = Region { x0: 31, y0: 9, x1: 80, y1: 52 };
        let part = render_region(&scene, wavefront(), region, 2).image;
        for (y, x) in (0..part.height).flat_map(|y| (0..part.width).map(move |x| (y, x))) {
            let of_whole = expected.pixels[expected.index(x + region.x0, y + region.y0)];
            let found = part.pixels[part.index(x, y)];
            assert_eq!(found.map(f32::to_bits), of_whole.map(f32::to_bits), "{name}: ({x}, {y}) of the crop");
        }
    }
}

/// One hash a scene, held in a snapshot: every build, for whatever instruction set, and every processor has to come to it.
/// Who changes what the engine computes looks at the pictures, and lets the snapshot be written anew.
#[test]
fn bits_do_not_depend_on_the_build() {
    let hashes: Vec<String> = example_scenes()
        .iter()
        .map(|(name, scene)| format!("{name} {:016x}", hash(&render_with(scene, wavefront()).image)))
        .collect();
    insta::assert_snapshot!(hashes.join("\n"));
}

/// Fowler, Noll and Vo's hash, 1a, of all channels' bits.
fn hash(image: &Image) -> u64 {
    let bytes = image.pixels.iter().flatten().flat_map(|channel| channel.to_bits().to_le_bytes());
    bytes.fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3))
}

fn report(scene: &Scene) -> WavefrontReport {
    render_with(scene, wavefront()).wavefront.unwrap()
}

#[test]
fn queues_do_not_grow_with_pixels_or_samples() {
    let bytes = |size: u32, samples: u32| {
        let mut scene = scene(STILL_LIFE);
        (scene.image.width, scene.image.height, scene.render.samples) = (size, size, samples);
        report(&scene).memory.queue_bytes_per_worker
    };
    let expected = bytes(128, 1);
    assert!(expected > 0);
    for (size, samples) in [(128, 4), (500, 1), (16, 64)] {
        assert_eq!(bytes(size, samples), expected, "{size} x {size} with {samples} x {samples} samples");
    }
}

/// Between two balls of glass every ray has two children: their number may double at each depth, the memory grows by a
/// step. The ray of the one pixel runs to and fro along the axis, so every depth is got to.
#[test]
fn queues_grow_by_a_step_a_depth() {
    let bytes = |depth: u32| {
        let scene = scene(&format!(
            "[image]\nsize = [1, 1]\n[render]\nmax_depth = {depth}\nmin_weight = 0.01\n\
             [camera]\neye = [0, 0, 0]\ntarget = [1, 0, 0]\nup = [0, 0, 1]\nfov = 10\n\
             [material.glass]\nior = 1.5\nfresnel = false\nmirror = 0.95\ntransmission = 0.05\n\
             [[sphere]]\ncenter = [1.2, 0, 0]\nradius = 1\nmaterial = \"glass\"\n\
             [[sphere]]\ncenter = [-1.2, 0, 0]\nradius = 1\nmaterial = \"glass\"\n"
        ));
        let report = report(&scene);
        let deepest = report.stages.iter().map(|stage| stage.depth).max();
        assert_eq!(deepest, Some(depth as usize));
        report.memory.queue_bytes_per_worker
    };
    let [five, six, fifty] = [5, 6, 50].map(bytes);
    let step = six - five;
    assert!(step > 0 && step < 2_000_000, "{step} bytes a depth");
    assert_eq!(fifty, five + 45 * step, "{five} bytes at depth 5, {step} a step");
}

/// A scene with everything, from which a test takes one thing.
const EVERYTHING: &str = "
[image]
size = [60, 40]
background = 0.2
[render]
samples = 2
sampling = \"jittered\"
max_depth = 3
[camera]
eye = [0, -6, 2]
target = [0, 0, 0.5]
up = [0, 0, 1]
fov = 50
[[light]]
position = [3, -4, 5]
[material.floor]
ambient = 0.1
diffuse = 0.7
[material.shiny]
diffuse = 0.5
specular = 0.5
shininess = 30
mirror = 0.3
[material.glass]
specular = 0.4
ior = 1.5
absorption = [0.3, 0.1, 0.2]
[[polygon]]
vertices = [[-4, -4, 0], [4, -4, 0], [4, 4, 0], [-4, 4, 0]]
material = \"floor\"
[[sphere]]
center = [-1, 0, 0.6]
radius = 0.6
material = \"shiny\"
[[sphere]]
center = [1, -1, 0.5]
radius = 0.5
material = \"glass\"
[[triangle]]
vertices = [[-1, 2, 0], [2, 2, 0], [0, 2, 2]]
material = \"shiny\"
";

/// Without a table of the scene: from its header up to the next one.
fn without(toml: &str, header: &str) -> String {
    let blocks: Vec<&str> = toml.split("\n[").collect();
    let kept: Vec<&str> = blocks.into_iter().filter(|block| !block.starts_with(&header[1..])).collect();
    assert!(kept.len() < toml.split("\n[").count(), "{header} is in the scene");
    kept.join("\n[")
}

/// What the stages and kernels counted, what is planned, and the names of all queues that take memory.
fn needs(toml: &str) -> (Counters, WavefrontReport, Vec<&'static str>) {
    let scene = scene(toml);
    let report = report(&scene);
    let prepared = Prepared::new(&scene).unwrap();
    let explained = Explanation::new(&prepared);
    let all = [explained.shared_queues, explained.primary_queues, explained.deeper_queues];
    (report.counters, report, all.iter().flatten().map(|queue| queue.name).collect())
}

fn rows(report: &WavefrontReport, stage: &str) -> u64 {
    report.stages.iter().filter(|found| found.stage == stage).map(|found| found.rows).sum()
}

#[test]
fn a_scene_with_everything_uses_everything() {
    let (counters, report, queues) = needs(EVERYTHING);
    for (what, count) in [
        ("boxes", counters.box_tests),
        ("spheres", counters.sphere_tests),
        ("triangles", counters.triangle_tests),
        ("edges of polygons", counters.polygon_edge_tests),
        ("powers", counters.powers),
        ("exponentials", counters.exponentials),
        ("random numbers", counters.random_pairs),
    ] {
        assert!(count > 0, "no {what}");
    }
    for stage in ["generate", "intersect", "surface", "absorb", "illuminate", "occlude", "spawn", "resolve"] {
        assert!(rows(&report, stage) > 0, "{stage} has no rows");
    }
    for queue in ["ShadowQueue", "RefractionQueue", "AttenuationQueue", "ChildQueue", "DepartureQueue"] {
        assert!(queues.contains(&queue), "no {queue} in {queues:?}");
    }
}

#[test]
fn without_spheres_there_is_no_sphere_test() {
    let (counters, ..) = needs(&without(&without(EVERYTHING, "[[sphere]]"), "[[polygon]]"));
    assert_eq!((counters.sphere_tests, counters.polygon_edge_tests), (0, 0));
    assert!(counters.triangle_tests > 0);
}

#[test]
fn without_triangles_there_is_no_triangle_test() {
    let (counters, ..) = needs(&without(EVERYTHING, "[[triangle]]"));
    assert_eq!(counters.triangle_tests, 0);
    assert!(counters.sphere_tests > 0 && counters.polygon_edge_tests > 0, "polygons are tested as polygons");
}

#[test]
fn without_polygons_there_is_no_polygon_test() {
    let (counters, ..) = needs(&without(EVERYTHING, "[[polygon]]"));
    assert_eq!(counters.polygon_edge_tests, 0);
    assert!(counters.sphere_tests > 0 && counters.triangle_tests > 0);
}

#[test]
fn without_lights_there_are_no_shadow_rays() {
    let (counters, report, queues) = needs(&without(EVERYTHING, "[[light]]"));
    assert_eq!((counters.powers, rows(&report, "occlude")), (0, 0));
    assert!(!queues.contains(&"ShadowQueue"), "{queues:?}");
}

#[test]
fn without_mirrors_and_dielectrics_no_ray_is_spawned() {
    let matte = EVERYTHING.replace("mirror = 0.3\n", "").replace("ior = 1.5\n", "");
    let matte = matte.replace("absorption = [0.3, 0.1, 0.2]\n", "");
    let (counters, report, queues) = needs(&matte);
    assert_eq!((counters.exponentials, rows(&report, "spawn"), rows(&report, "absorb")), (0, 0, 0));
    assert!(report.stages.iter().all(|stage| stage.depth == 0), "there is depth 0 alone");
    for queue in ["ChildQueue", "DepartureQueue", "RefractionQueue", "AttenuationQueue"] {
        assert!(!queues.contains(&queue), "{queue} in {queues:?}");
    }
}

#[test]
fn without_dielectrics_nothing_refracts() {
    let opaque = EVERYTHING.replace("ior = 1.5\n", "").replace("absorption = [0.3, 0.1, 0.2]\n", "");
    let (_, report, queues) = needs(&opaque);
    assert!(rows(&report, "spawn") > 0);
    assert!(!queues.contains(&"RefractionQueue"), "{queues:?}");
    assert_eq!(
        queues.iter().filter(|queue| **queue == "ChildQueue").count(),
        2,
        "one at depth 0, one deeper"
    );
}

#[test]
fn without_absorption_no_exponential_is_taken() {
    let (counters, report, queues) = needs(&EVERYTHING.replace("absorption = [0.3, 0.1, 0.2]\n", ""));
    assert_eq!((counters.exponentials, rows(&report, "absorb")), (0, 0));
    assert!(!queues.contains(&"AttenuationQueue"), "{queues:?}");
}

#[test]
fn without_highlights_no_power_is_taken() {
    let dull = EVERYTHING.replace("specular = 0.5\n", "").replace("specular = 0.4\n", "");
    let (counters, report, _) = needs(&dull);
    assert_eq!(counters.powers, 0);
    assert!(rows(&report, "occlude") > 0);
}

#[test]
fn without_antialiasing_no_random_number_is_drawn() {
    for settings in ["samples = 1\nsampling = \"jittered\"", "samples = 3\nsampling = \"regular\""] {
        let toml = EVERYTHING.replace("samples = 2\nsampling = \"jittered\"", settings);
        assert_eq!(needs(&toml).0.random_pairs, 0, "{settings}");
    }
}

#[test]
fn without_vertex_normals_there_is_no_queue_for_them() {
    assert!(!needs(EVERYTHING).2.contains(&"NormalQueue"));
}

#[test]
fn an_empty_scene_takes_no_queue_of_surfaces() {
    let (counters, report, queues) = needs("[image]\nsize = [9, 9]\nbackground = [0.1, 0.2, 0.3]\n");
    assert_eq!((counters.box_tests, rows(&report, "surface")), (0, 0));
    assert_eq!(queues, ["HitQueue", "RayQueue", "RadianceQueue"]);
}

#[test]
fn a_material_that_nothing_is_made_of_changes_no_bit() {
    let unused =
        "[material.unused]\nior = 1.3\nabsorption = 1\nspecular = 1\nmirror = 1\ncasts_shadow = false\n";
    for plain in [EVERYTHING.to_owned(), without(&without(EVERYTHING, "[[light]]"), "[[polygon]]")] {
        let with_unused = format!("{plain}{unused}");
        assert_eq!(needs(&plain).2, needs(&with_unused).2, "queues");
        let [a, b] = [&plain, &with_unused].map(|toml| render_with(&scene(toml), wavefront()).image);
        assert!(bits(&a) == bits(&b));
    }
}
