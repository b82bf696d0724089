//! Rays recorded from a frame, traced again on their own.

use crate::real_scenes;
use crate::support::{render_with, root, scene};
use std::num::NonZeroU64;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use wavelane::lanes::Width;
use wavelane::load::load;
use wavelane::measure::HitErrors;
use wavelane::prepare::Prepared;
use wavelane::rays::{RayKind, RaySet, RecordedRays};
use wavelane::reference::Tracer;
use wavelane::render::Engine;
use wavelane::scene::Scene;
use wavelane::trace::{Hits, Query, RayColumns, ReferenceRun, Run, add_clearance};

/// All rays of a frame.
fn record(scene: &Scene) -> RecordedRays {
    let rays = NonZeroU64::new(1);
    let rendered =
        render_with(scene, Engine::Wavefront { width: Width::BEST, batch: 4096, records: false, rays });
    assert_eq!(rendered.recorded.counts(), rendered.rays, "every ray is kept");
    rendered.recorded
}

fn pool() -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap()
}

fn traced(scene: &Scene, rays: &RaySet, query: Query, width: Width) -> Hits {
    let prepared = Prepared::new(scene).unwrap();
    let columns = RayColumns::new(&prepared, rays);
    let mut run = Run::new(&prepared, &columns, query);
    run.pass(width, &pool());
    run.hits()
}

fn traced_by_reference(tracer: &Tracer<'_>, rays: &RaySet, query: Query) -> Hits {
    let mut run = ReferenceRun::new(tracer, rays, query);
    run.pass(&pool());
    run.hits().clone()
}

fn agrees(path: &Path) {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let mut scene = load(path).unwrap_or_else(|error| panic!("{error}")).scene;
    (scene.image.width, scene.image.height) = (150, 150);
    scene.render.samples = 1;
    let recorded = record(&scene);
    let stop = AtomicBool::new(false);
    let tracer = Tracer::new(&scene, &stop);
    for kind in RayKind::ALL {
        let (rays, query) = (recorded.of(kind), Query::of(kind));
        assert_eq!(rays.unusable(), 0);
        for width in Width::ALL {
            let hits = traced(&scene, rays, query, width);
            if query == Query::Closest {
                for (row, found) in rays.found.iter().enumerate() {
                    let id = found.id.map_or(Hits::MISS, |id| id.0);
                    assert_eq!(
                        (hits.t[row], hits.id[row]),
                        (found.t, id),
                        "{name}, {kind:?} ray {row}, {width:?}"
                    );
                }
            }
            if width == Width::BEST {
                let errors = HitErrors::measure(&tracer, rays, query, &hits);
                assert_eq!(errors.mistakes(), 0, "{name}, {kind:?}: {errors:?}");
                let by_reference = traced_by_reference(&tracer, rays, query);
                let none = HitErrors::measure(&tracer, rays, query, &by_reference);
                assert_eq!(none.false_hits.near_edges + none.false_misses.near_edges + none.mistakes(), 0);
                assert!(none.t_ulps.is_none_or(|ulps| ulps.max <= 0.5), "{none:?}");
            }
        }
    }
}

#[test]
fn rays_of_the_example_scenes_hit_alone_what_they_hit_in_the_frame() {
    for entry in std::fs::read_dir(root().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            agrees(&path);
        }
    }
}

#[test]
fn rays_of_real_scenes_hit_alone_what_they_hit_in_the_frame() {
    for name in
        ["spd/balls.nff", "spd/gears.nff", "spd/shells.nff", "spd/tetra.nff", "spd/mount.nff", "bunny.obj"]
    {
        if let Some(path) = real_scenes::file(name) {
            agrees(&path);
        }
    }
}

/// Without departures, as another tracer gets them.
fn as_from_a_file(scene: &Scene, rays: &RaySet) -> RaySet {
    let mut rays = rays.clone();
    add_clearance(&scene.geometry, &mut rays);
    RaySet { rows: rays.rows, starts: Vec::new(), found: Vec::new() }
}

#[test]
fn rays_with_a_clearance_hit_what_rays_hit_that_know_where_they_start() {
    for name in ["glass", "mesh", "polygons"] {
        let mut scene = load(&root().join(format!("scenes/{name}.toml"))).unwrap().scene;
        (scene.image.width, scene.image.height) = (150, 150);
        scene.render.samples = 1;
        let recorded = record(&scene);
        for kind in [RayKind::Shadow, RayKind::Reflect, RayKind::Refract] {
            let (rays, query) = (recorded.of(kind), Query::of(kind));
            let bare = as_from_a_file(&scene, rays);
            let [known, found] = [rays, &bare].map(|rays| traced(&scene, rays, query, Width::BEST));
            let differing = (0..rays.len()).filter(|&row| {
                known.id[row] != found.id[row] || known.t[row].is_finite() != found.t[row].is_finite()
            });
            // What touches the start, at an edge, may lie before or beyond t_min.
            let differing = differing.count();
            assert!(differing * 2000 <= rays.len(), "{name}, {kind:?}: {differing} of {}", rays.len());
        }
    }
}

#[test]
fn what_is_no_ray_hits_nothing_and_its_neighbours_are_none_the_wiser() {
    let scene = scene(
        "[image]\nsize = [8, 8]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n[material.m]\n[[sphere]]\ncenter = [0, 0, 0]\n\
         radius = 1\nmaterial = \"m\"\n",
    );
    let ray = [0.0, 0.0, 5.0, 0.0, 0.0, 0.0, -2.0, f32::INFINITY];
    let with = |place: usize, number: f32| {
        let mut ray = ray;
        ray[place] = number;
        ray
    };
    let none = [
        with(0, f32::NAN),
        with(1, f32::INFINITY),
        with(2, 1e30),
        with(3, f32::NAN),
        with(3, f32::INFINITY),
        with(4, f32::NAN),
        with(5, f32::INFINITY),
        with(6, 0.0),
        with(7, f32::NAN),
        with(7, 0.0),
        with(7, -1.0),
        with(7, f32::NEG_INFINITY),
        with(3, 3.5),
    ];
    let hit = [
        (ray, 2.0),
        (with(3, -1.0), 2.0),
        (with(3, 1.5), 2.0),
        (with(3, 2.0), 3.0),
        (with(7, 2.5), 2.0),
        (with(6, -1e-30), 4e30),
        (with(6, -1e30), 4e-30),
        (with(6, -f32::from_bits(1)), f32::MAX),
    ];
    let mut rows = Vec::new();
    for bad in none {
        rows.extend(hit.map(|(row, _)| row));
        rows.push(bad);
    }
    let rays = RaySet { rows, ..RaySet::default() };
    assert_eq!(rays.unusable(), 8, "the others are rays that end before they begin");
    let stop = AtomicBool::new(false);
    let tracer = Tracer::new(&scene, &stop);
    for query in [Query::Closest, Query::Any] {
        let by_reference = traced_by_reference(&tracer, &rays, query);
        for hits in
            Width::ALL.map(|width| traced(&scene, &rays, query, width)).into_iter().chain([by_reference])
        {
            for (row, (&t, &id)) in hits.t.iter().zip(&hits.id).enumerate() {
                let place = row % (hit.len() + 1);
                let expected = match (hit.get(place), query) {
                    (None, _) => (f32::INFINITY, Hits::MISS),
                    (Some(_), Query::Any) => (0.0, Hits::MISS),
                    (Some((_, t)), Query::Closest) => (*t, 0),
                };
                let is_close = t == expected.0 || (t - expected.0).abs() <= 2e-7 * expected.0;
                assert!(is_close && id == expected.1, "row {row}: {t} {id}, not {expected:?}, {query:?}");
            }
        }
    }
}

#[test]
fn no_rays_are_traced_in_no_time_and_nothing_is_hit_in_an_empty_scene() {
    let scene = scene(
        "[image]\nsize = [8, 8]\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov = 45\n",
    );
    let one = RaySet { rows: vec![[0.0, 0.0, 5.0, 0.0, 0.0, 0.0, -2.0, 1e30]], ..RaySet::default() };
    for rays in [RaySet::default(), one] {
        for query in [Query::Closest, Query::Any] {
            for width in Width::ALL {
                let hits = traced(&scene, &rays, query, width);
                assert_eq!((hits.t.len(), hits.count()), (rays.len(), 0));
            }
        }
    }
}
