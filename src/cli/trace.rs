//! `wavelane trace GEOMETRY --rays RAYS.npy`.

use super::engine::EngineArguments;
use super::progress::{Progress, Style};
use super::{Failure, output};
use crate::lanes::{Isa, Width};
use crate::load;
use crate::measure::{Better, HitErrors, Machine, Spread};
use crate::prepare::Prepared;
use crate::rays::RaySet;
use crate::reference::Tracer;
use crate::render::RenderError;
use crate::report::maybe;
use crate::scene::Scene;
use crate::trace::{self, Hits, Query, RayColumns, ReferenceRun, Run, TestsMade};
use clap::ValueEnum;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scene file, or a folder of vertices.npy with triangles.npy, and spheres.npy
    geometry: PathBuf,
    /// The rays: an array of shape (R, 8), f32: origin xyz, tmin, direction xyz, tmax. A tmin below 0 counts as 0
    #[arg(long, value_name = "FILE")]
    rays: PathBuf,
    /// What is asked of them
    #[arg(long, value_enum, default_value = "closest")]
    query: QueryName,
    #[command(flatten)]
    engine: EngineArguments,
    /// Timed passes over all rays; before them go others, for a tenth of a second and one at least
    #[arg(long, value_name = "K", default_value = "5", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    repeat: u32,
    /// Write what is hit to PREFIX.t.npy (+inf on a miss) and PREFIX.prim.npy (4294967295 on a miss)
    #[arg(long, value_name = "PREFIX")]
    hits: Option<PathBuf>,
    /// Compare what is hit with what the f64 reference hits
    #[arg(long)]
    check: bool,
    /// How far it is, on stderr
    #[arg(long, value_enum, default_value = "auto")]
    progress: Style,
    /// Write the result as JSON, to stdout instead of the text if FILE is -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum QueryName {
    /// What each ray hits first
    Closest,
    /// Whether each ray hits anything that casts a shadow
    Any,
}

/// The JSON result.
#[derive(Serialize)]
struct Report {
    geometry: String,
    primitives: usize,
    rays: usize,
    /// Rows that are no rays; they count as misses.
    unusable_rays: usize,
    hits: usize,
    query: &'static str,
    engine: &'static str,
    lanes: u32,
    isa: Isa,
    threads: usize,
    build_seconds: f64,
    /// None where the clock did not move.
    mrays_per_second: Option<Spread>,
    /// What a pass of the wavefront engine took.
    tests: Option<TestsMade>,
    /// Against the reference, if asked for.
    errors: Option<HitErrors>,
    machine: Machine,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.engine.warn_of_useless_lanes();
    let hit_files = arguments.hits.as_deref().map(trace::hit_files);
    let written: Vec<&Path> = hit_files.iter().flatten().map(PathBuf::as_path).collect();
    let read = [arguments.geometry.as_path(), arguments.rays.as_path()];
    output::check_distinct(&written, &read)?;
    written.iter().try_for_each(|path| output::probe(path))?;
    output::check_json(arguments.json.as_deref(), &[&written[..], &read].concat())?;

    let loaded = load::load_geometry(&arguments.geometry)?;
    output::warnings(&loaded);
    let rays = load::rays(&arguments.rays)?;
    let unusable_rays = rays.unusable();
    if unusable_rays > 0 {
        output::diagnostic(&format!(
            "{}: warning: {unusable_rays} of {} rows are no rays (what is not a number, an infinite or zero direction, an origin \
             beyond 1e18); they count as misses",
            arguments.rays.display(),
            rays.len()
        ));
    }

    arguments.engine.warn_of_unused_instructions(arguments.progress);
    let Traced { hits, seconds, build_seconds, threads, tests } = traced(arguments, &loaded.scene, &rays)?;
    if let Some(prefix) = &arguments.hits {
        trace::write_hits(&hits, prefix).map_err(|(path, why)| Failure::Write { path, why })?;
    }
    let query = arguments.query.query();
    let errors = arguments.check.then(|| {
        HitErrors::measure(&Tracer::new(&loaded.scene, &AtomicBool::new(false)), &rays, query, &hits)
    });
    let mrays = |seconds: &f64| rays.len() as f64 / seconds / 1e6;
    let report = Report {
        geometry: arguments.geometry.display().to_string(),
        primitives: loaded.scene.geometry.primitive_count(),
        rays: rays.len(),
        unusable_rays,
        hits: hits.count(),
        query: query.name(),
        engine: arguments.engine.name(),
        lanes: arguments.engine.width().map_or(1, Width::lanes),
        isa: Isa::BUILT_FOR,
        threads,
        build_seconds,
        mrays_per_second: Spread::of(seconds.iter().map(mrays).collect(), Better::More),
        tests,
        errors,
        machine: Machine::here_and_now(),
    };
    if let Some(path) = &arguments.json {
        output::json(&report, path)?;
        if path.as_os_str() == "-" {
            return Ok(());
        }
    }
    output::result(&report.text())
}

impl QueryName {
    fn query(self) -> Query {
        match self {
            Self::Closest => Query::Closest,
            Self::Any => Query::Any,
        }
    }
}

struct Traced {
    hits: Hits,
    /// Of each timed pass.
    seconds: Vec<f64>,
    build_seconds: f64,
    threads: usize,
    tests: Option<TestsMade>,
}

fn traced(arguments: &Arguments, scene: &Scene, rays: &RaySet) -> Result<Traced, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.engine.threads()).build();
    let pool = pool.map_err(RenderError::from)?;
    let threads = pool.current_num_threads();
    let query = arguments.query.query();
    let start = Instant::now();
    let traced = match arguments.engine.width() {
        Some(width) => {
            let prepared = pool.install(|| Prepared::new(scene)).map_err(RenderError::from)?;
            let build_seconds = start.elapsed().as_secs_f64();
            let columns = RayColumns::new(&prepared, rays);
            let mut run = Run::new(&prepared, &columns, query);
            let seconds = timed(arguments, || run.pass(width, &pool));
            Traced { hits: run.hits(), seconds, build_seconds, threads, tests: run.tests() }
        }
        None => {
            let never = AtomicBool::new(false);
            let tracer = Tracer::new(scene, &never);
            let build_seconds = start.elapsed().as_secs_f64();
            let mut run = ReferenceRun::new(&tracer, rays, query);
            let seconds = timed(arguments, || run.pass(&pool));
            Traced { hits: run.hits().clone(), seconds, build_seconds, threads, tests: None }
        }
    };
    Ok(traced)
}

/// Passes that are not timed go on for so long. Threads that have only just begun may share a core for some tens of
/// milliseconds, in which others have done three passes.
const WARM_UP: Duration = Duration::from_millis(100);

/// Seconds of passes, after some that are not counted.
fn timed(arguments: &Arguments, mut pass: impl FnMut() -> f64) -> Vec<f64> {
    let progress = Progress::new(arguments.progress, u64::from(arguments.repeat) + 1, "passes");
    let start = Instant::now();
    pass();
    while start.elapsed() < WARM_UP {
        pass();
    }
    progress.report(1);
    let seconds = (1..=u64::from(arguments.repeat)).map(|done| {
        let seconds = pass();
        progress.report(done + 1);
        seconds
    });
    let seconds = seconds.collect();
    progress.finish();
    seconds
}

impl Report {
    fn text(&self) -> String {
        let share = 100.0 * self.hits as f64 / self.rays as f64;
        let hit = if self.query == "any" { "occluded" } else { "hit" };
        let mut text = format!(
            "{}: {} primitives, built in {:.3} s\n\
             {} rays, {}, {} of {} lanes ({}), {} threads: {} Mrays/s in the median, {} at best\n\
             {} {hit} ({share:.1} %)",
            self.geometry,
            self.primitives,
            self.build_seconds,
            self.rays,
            self.query,
            self.engine,
            self.lanes,
            self.isa,
            self.threads,
            maybe(self.mrays_per_second.map(|rate| rate.median)),
            maybe(self.mrays_per_second.map(|rate| rate.best)),
            self.hits,
        );
        if let Some(tests) = &self.tests {
            text += &format!("\n{tests}");
        }
        if let Some(errors) = &self.errors {
            text += &format!("\nagainst the f64 reference: {errors}");
        }
        text
    }
}
