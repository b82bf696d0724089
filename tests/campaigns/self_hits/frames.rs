//! Frames without end: renders, traces shadow rays again, and has everything judged.

use super::judge::{Answer, judge};
use super::settings::Setting;
use super::table::Table;
use super::views::{Eye, scene};
use crate::random::Random;
use std::num::NonZeroU64;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use wavelane::film::Region;
use wavelane::lanes::Width;
use wavelane::prepare::Prepared;
use wavelane::rays::{RayKind, RaySet};
use wavelane::reference::Tracer;
use wavelane::render::{Engine, RenderOptions, render};
use wavelane::scene::Scene;
use wavelane::trace::{Hits, Query, RayColumns, ReferenceRun, Run};

/// What a campaign renders.
pub(super) struct Frames<'a> {
    pub(super) name: &'static str,
    pub(super) first_seed: u64,
    /// How many secondary rays to trace, or a few more.
    pub(super) rays: u64,
    pub(super) setting: &'a (dyn Fn(&mut Random) -> (Setting, Eye) + Sync),
}

/// Frames between two looks at how many rays there have been: the same frames on any number of threads.
const ROUND: u64 = 32;

/// Every so many frames the reference answers for the same rays.
const REFERENCE: u64 = 16;

/// Renders until there are enough rays, prints the table, and sees to it that nothing was wrong.
pub(super) fn run(frames: &Frames<'_>) {
    let mut table = Table::default();
    let mut by_reference = Table::default();
    let mut seed = frames.first_seed;
    while table.total().rays < frames.rays {
        let next = AtomicU64::new(seed);
        let tables = Mutex::new((&mut table, &mut by_reference));
        let work = || {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            loop {
                let seed_of_frame = next.fetch_add(1, Ordering::Relaxed);
                if seed_of_frame >= seed + ROUND {
                    break;
                }
                let found = frame(frames, seed_of_frame, &pool);
                let mut tables = tables.lock().unwrap_or_else(PoisonError::into_inner);
                tables.0.append(found.0);
                tables.1.append(found.1);
            }
        };
        std::thread::scope(|scope| {
            let threads = std::thread::available_parallelism().map_or(2, usize::from);
            for _ in 0..threads {
                scope.spawn(work);
            }
        });
        seed += ROUND;
    }
    let (judged, of_reference) = (table.total(), by_reference.total().rays);
    println!(
        "\n{}, {} frames; of them {of_reference} rays by the reference too",
        frames.name,
        seed - frames.first_seed
    );
    println!("{table}");
    assert!(
        judged.free + judged.bound > judged.rays / 10 * 9,
        "geometry says something of most rays: {judged:?}"
    );
    for (engine, table) in [("wavefront", table), ("reference", by_reference)] {
        let total = table.total();
        assert_eq!(
            (total.self_hits, total.missed),
            (0, 0),
            "self-hits and missed walls of the {engine} engine in {} rays, {}:\n{}",
            total.rays,
            frames.name,
            table.wrong.join("\n")
        );
    }
}

/// What both engines found for the secondary rays of a frame.
fn frame(frames: &Frames<'_>, seed: u64, pool: &rayon::ThreadPool) -> (Table, Table) {
    let mut random = Random::new(&[seed]);
    let (setting, scene) = loop {
        let (setting, eye) = (frames.setting)(&mut random);
        let scene = scene(&setting, eye, &mut random);
        // Far out, the eye and what it looks at may be one point to f32.
        if scene.camera.check().is_ok() {
            break (setting, scene);
        }
    };
    let width = Width::ALL[(seed % Width::ALL.len() as u64) as usize];
    let recorded = record(&scene, width);
    let mut tables = (Table::default(), Table::default());
    let prepared = Prepared::new(&scene).unwrap();
    let stop = AtomicBool::new(false);
    let tracer = Tracer::new(&scene, &stop);
    let bodies = (setting.name, setting.bodies.as_slice());
    let name = || format!("seed {seed}, {}, {width:?}", setting.name);
    for kind in [RayKind::Shadow, RayKind::Reflect, RayKind::Refract] {
        let (rays, query) = (recorded.of(kind), Query::of(kind));
        if query == Query::Closest {
            let found = |row: usize| rays.found[row].id.map_or(Answer::Nothing, Answer::Primitive);
            judge(&mut tables.0, bodies, (kind, rays), found, name);
        } else {
            let hits = traced(&prepared, rays, query, width, pool);
            judge(&mut tables.0, bodies, (kind, rays), |row| Answer::of(query, &hits, row), name);
        }
        if seed.is_multiple_of(REFERENCE) {
            let mut run = ReferenceRun::new(&tracer, rays, query);
            run.pass(pool);
            judge(&mut tables.1, bodies, (kind, rays), |row| Answer::of(query, run.hits(), row), name);
        }
    }
    tables
}

fn record(scene: &Scene, width: Width) -> wavelane::rays::RecordedRays {
    let stop = AtomicBool::new(false);
    let options = RenderOptions {
        engine: Engine::Wavefront { width, batch: 512, records: false, rays: NonZeroU64::new(1) },
        region: Region::whole(scene.image.width, scene.image.height),
        threads: 1,
        on_progress: &|_| {},
        stop: &stop,
    };
    render(scene, &options).unwrap().recorded
}

fn traced(
    prepared: &Prepared<'_>,
    rays: &RaySet,
    query: Query,
    width: Width,
    pool: &rayon::ThreadPool,
) -> Hits {
    let columns = RayColumns::new(prepared, rays);
    let mut run = Run::new(prepared, &columns, query);
    run.pass(width, pool);
    run.hits()
}
