//! A small picture, on one thread: the time of all stages, without that of the tree.

use crate::Extent;
use crate::scenes::SceneFile;
use criterion::{Criterion, SamplingMode, Throughput};
use std::cell::OnceCell;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use wavelane::film::Region;
use wavelane::lanes::Width;
use wavelane::measure::Agreement;
use wavelane::render::{Engine, RenderOptions, render};
use wavelane::scene::Scene;

/// Pixels along a side.
fn size(extent: Extent) -> u32 {
    match extent {
        Extent::Timed => 256,
        Extent::Tested => 64,
    }
}

pub(crate) fn benches(criterion: &mut Criterion, file: &SceneFile, extent: Extent) {
    let scene = file.load(size(extent));
    let mut group = criterion.benchmark_group(format!("frame/{}", file.name));
    let pixels = u64::from(scene.image.width) * u64::from(scene.image.height);
    // Every picture builds a tree too, which is not counted: few samples, and few pictures a sample.
    group.sample_size(10).sampling_mode(SamplingMode::Flat).measurement_time(Duration::from_secs(2));
    group.throughput(Throughput::Elements(pixels));
    for (engine, width) in [("scalar", Width::One), ("simd", Width::BEST)] {
        let checked = OnceCell::new();
        group.bench_function(engine, |bencher| {
            checked.get_or_init(|| assert_found(&scene, width));
            bencher.iter_custom(|pictures| (0..pictures).map(|_| trace_time(&scene, width)).sum());
        });
    }
}

fn trace_time(scene: &Scene, width: Width) -> Duration {
    let options = RenderOptions {
        engine: Engine::wavefront(width),
        region: Region::whole(scene.image.width, scene.image.height),
        threads: 1,
        on_progress: &|_| {},
        stop: &AtomicBool::new(false),
    };
    Duration::from_secs_f64(render(scene, &options).unwrap().trace_seconds)
}

/// That the rays of nine pixels in ten hit what they hit in truth, all the way down, and then the picture is the same too.
/// Mirrors in mirrors make edges of everything, where rounding decides: the others may hit something else, but for primary
/// rays, of which it is known how near to an edge they are.
fn assert_found(scene: &Scene, width: Width) {
    let found = Agreement::measure(scene, width).unwrap();
    assert_eq!(found.wrong_primaries, 0, "{found:?}");
    assert!(found.same_trees * 10 >= found.pixels * 9, "{found:?}");
    assert!(found.same_trees_over * 1000 <= found.same_trees, "{found:?}");
}
