//! The tree: time from a scene's primitives in memory to all that a traversal reads, on one thread.

use crate::peer::{Peer, Triangles};
use crate::rays::{self, Kind};
use crate::scenes::SceneFile;
use crate::truth::Truth;
use criterion::{Criterion, Throughput};
use obvhs::BvhBuildParams;
use rayon::ThreadPool;
use std::cell::OnceCell;
use std::sync::atomic::AtomicBool;
use wavelane::lanes::Width;
use wavelane::prepare::Prepared;
use wavelane::rays::RaySet;
use wavelane::reference::Tracer;
use wavelane::scene::Scene;
use wavelane::trace::{Hits, Query, RayColumns, Run};

/// Pixels along a side of the picture whose rays are to find what is in the tree.
const SIZE: u32 = 64;

pub(crate) fn benches(criterion: &mut Criterion, file: &SceneFile, pool: &ThreadPool) {
    let scene = file.load(SIZE);
    let mut group = criterion.benchmark_group(format!("build/{}", file.name));
    let primitives = scene.geometry.primitive_count() as u64;
    group.sample_size(10).throughput(Throughput::Elements(primitives));

    let checked = OnceCell::new();
    group.bench_function("wavelane", |bencher| {
        checked.get_or_init(|| assert_complete(&scene));
        pool.install(|| bencher.iter_with_large_drop(|| Prepared::new(&scene).unwrap()));
    });
    if !file.is_of_triangles {
        return;
    }
    let triangles = Triangles::of(&scene.geometry);
    for (builder, parameters) in [
        ("obvhs_fast", BvhBuildParams::fast_build()),
        ("obvhs", BvhBuildParams::medium_build()),
        ("obvhs_slow", BvhBuildParams::slow_build()),
    ] {
        let checked = OnceCell::new();
        group.bench_function(builder, |bencher| {
            checked.get_or_init(|| assert_complete_of_peer(&scene, &Peer::build(&triangles, parameters)));
            bencher.iter_with_large_drop(|| Peer::build(&triangles, parameters));
        });
    }
}

/// That a tree holds the scene: rays through it find what they find in truth.
fn assert_complete(scene: &Scene) {
    let prepared = Prepared::new(scene).unwrap();
    assert_primary_hits(scene, |rays, truth| {
        let columns = RayColumns::new(&prepared, rays);
        let mut run = Run::new(&prepared, &columns, Query::Closest);
        run.pass(Width::BEST, &rayon::ThreadPoolBuilder::new().build().unwrap());
        truth.assert_found_by_us(&run.hits());
    });
}

fn assert_complete_of_peer(scene: &Scene, peer: &Peer) {
    assert_primary_hits(scene, |rays, truth| {
        let mut hits = Hits { t: vec![0.0; rays.len()], id: vec![0; rays.len()] };
        peer.trace(rays, &mut hits);
        truth.assert_found_by_another(&hits, 1000);
    });
}

fn assert_primary_hits(scene: &Scene, assert: impl Fn(&RaySet, &Truth<'_>)) {
    let stop = AtomicBool::new(false);
    let tracer = Tracer::new(scene, &stop);
    let rays = rays::of(Kind::Primary, scene, &rays::primary(scene), &tracer);
    assert(&rays, &Truth::new(&tracer, &rays, Query::Closest));
}
