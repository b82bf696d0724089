//! Rays through a tree: time from rays in columns to hits in columns, on one thread. What is made ready before is not timed.

use crate::Extent;
use crate::peer::{Peer, Triangles};
use crate::rays::{self, Kind};
use crate::scenes::SceneFile;
use crate::truth::Truth;
use criterion::{Criterion, Throughput};
use obvhs::BvhBuildParams;
use rayon::ThreadPool;
use std::cell::LazyCell;
use std::sync::atomic::AtomicBool;
use wavelane::lanes::Width;
use wavelane::prepare::Prepared;
use wavelane::reference::Tracer;
use wavelane::trace::{Hits, Query, RayColumns, Run};

/// Pixels along a side of the picture whose rays are traced.
fn size(extent: Extent) -> u32 {
    match extent {
        Extent::Timed => 1024,
        Extent::Tested => 64,
    }
}

pub(crate) fn benches(criterion: &mut Criterion, file: &SceneFile, extent: Extent, pool: &ThreadPool) {
    // These are needed to say how many rays there are, for every bench; the rest only for a bench that is run.
    let scene = file.load(size(extent));
    let primary = rays::primary(&scene);
    let stop = AtomicBool::new(false);
    let tracer = LazyCell::new(|| Tracer::new(&scene, &stop));
    let prepared = LazyCell::new(|| Prepared::new(&scene).unwrap());
    let peer = LazyCell::new(|| Peer::build(&Triangles::of(&scene.geometry), BvhBuildParams::medium_build()));
    for kind in Kind::ALL {
        let query = kind.query();
        let rays = LazyCell::new(|| rays::of(kind, &scene, &primary, &tracer));
        let truth = LazyCell::new(|| Truth::new(&tracer, &rays, query));
        let columns = LazyCell::new(|| RayColumns::new(&prepared, &rays));

        let mut group = criterion.benchmark_group(format!("traverse/{}/{}", file.name, kind.name()));
        group.sample_size(10).throughput(Throughput::Elements(rays::count(kind, &primary) as u64));
        for (engine, width) in [("scalar", Width::One), ("simd", Width::BEST)] {
            let checked = || {
                let mut run = Run::new(&prepared, &columns, query);
                run.pass(width, pool);
                truth.assert_found_by_us(&run.hits());
                run
            };
            let mut run = None;
            group.bench_function(engine, |bencher| {
                let run = run.get_or_insert_with(checked);
                bencher.iter(|| run.pass(width, pool));
            });
        }
        if file.is_of_triangles && query == Query::Closest {
            let checked = || {
                let mut hits = Hits { t: vec![0.0; rays.len()], id: vec![0; rays.len()] };
                peer.trace(&rays, &mut hits);
                truth.assert_found_by_another(&hits, 1000);
                hits
            };
            let mut hits = None;
            group.bench_function("obvhs", |bencher| {
                let hits = hits.get_or_insert_with(checked);
                bencher.iter(|| peer.trace(&rays, hits));
            });
        }
    }
}
