//! `wavelane compare SCENE`.

use super::progress::{Progress, Style};
use super::settings::SceneSettings;
use super::table::{NONE, Table, maybe, number};
use super::{Failure, interrupt, output};
use crate::load;
use crate::measure::{
    Comparison, ComparisonOptions, Distance, EngineResult, HitErrors, Machine, Percentiles, Wrong,
};
use crate::rays::RayKind;
use crate::scene::Scene;
use serde::Serialize;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scene file: .toml, .nff, .obj or .ply, or a folder of .npy
    scene: PathBuf,
    #[command(flatten)]
    settings: SceneSettings,
    /// Worker threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Timed frames, and passes over recorded rays, of each wavefront engine; the reference has one
    #[arg(long, value_name = "K", default_value = "5", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,
    /// About so many rays of each kind are traced on their own, and looked at one by one
    #[arg(long, value_name = "R", default_value = "262144", value_parser = clap::value_parser!(u64).range(1..))]
    rays: u64,
    /// How far it is, on stderr
    #[arg(long, value_enum, default_value = "auto")]
    progress: Style,
    /// Write the result as JSON, to stdout instead of the tables if FILE is -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// The JSON result.
#[derive(Serialize)]
struct Report<'a> {
    scene: String,
    size: [u32; 2],
    sampling: &'static str,
    samples: u32,
    max_depth: u32,
    primitives: usize,
    machine: Machine,
    #[serde(flatten)]
    comparison: &'a Comparison,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    output::check_json(arguments.json.as_deref(), &[&arguments.scene])?;
    let mut loaded = load::load(&arguments.scene)?;
    output::warnings(&loaded);
    arguments.settings.apply(&mut loaded.scene);
    let scene = &loaded.scene;
    let comparison = compare(arguments, scene)?;

    let machine = Machine::here_and_now();
    let mut text = title(arguments, scene, &machine, &comparison);
    text += &speed(&comparison);
    text += &errors(&comparison);
    if let Some(path) = &arguments.json {
        let report = Report {
            scene: arguments.scene.display().to_string(),
            size: [scene.image.width, scene.image.height],
            sampling: scene.render.sampling.name(),
            samples: scene.render.samples,
            max_depth: scene.render.max_depth,
            primitives: scene.geometry.primitive_count(),
            machine,
            comparison: &comparison,
        };
        output::json(&report, path)?;
    }
    if arguments.json.as_ref().is_none_or(|path| path.as_os_str() != "-") {
        output::result(&text.trim_end())?;
    }
    match comparison.mistakes() {
        0 => Ok(()),
        mistakes => Err(Failure::OverLimit(format!(
            "{mistakes} rays have an answer that is wrong beyond rounding; please report this with the scene"
        ))),
    }
}

fn compare(arguments: &Arguments, scene: &Scene) -> Result<Comparison, Failure> {
    let mut progress: Option<Progress> = None;
    let progress = std::cell::RefCell::new(&mut progress);
    let on_progress = |done: u64, total: u64| {
        let mut progress = progress.borrow_mut();
        progress.get_or_insert_with(|| Progress::new(arguments.progress, total, "steps")).report(done);
    };
    let compared = interrupt::watched(|stop| {
        let options = ComparisonOptions {
            threads: arguments.threads.map_or(0, usize::from),
            repeat: arguments.repeat as usize,
            rays: arguments.rays,
            on_progress: &on_progress,
            stop,
        };
        Comparison::measure(scene, &options)
    });
    if let Some(progress) = progress.borrow().as_ref() {
        progress.finish();
    }
    interrupt::end_if_asked();
    let (comparison, _) = compared?;
    Ok(comparison)
}

fn title(arguments: &Arguments, scene: &Scene, machine: &Machine, comparison: &Comparison) -> String {
    let primitives = scene.geometry.primitive_count();
    let samples = u64::from(scene.render.samples).pow(2);
    format!(
        "{}: {} x {} pixels, samples a pixel: {samples}, primitives: {primitives}, rays to depth {}\n\
         {}, threads: {}, built for {}\n",
        arguments.scene.display(),
        scene.image.width,
        scene.image.height,
        scene.render.max_depth,
        machine.processor.as_deref().unwrap_or("unknown processor"),
        comparison.threads,
        machine.isa,
    )
}

/// Kinds of ray that there are.
fn kinds(comparison: &Comparison) -> impl Iterator<Item = RayKind> + '_ {
    RayKind::ALL.into_iter().filter(|&kind| comparison.recorded_rays.of(kind) > 0)
}

fn speed(comparison: &Comparison) -> String {
    let heading = ["engine", "lanes", "frame s", "× scalar"].into_iter();
    let heading =
        heading.chain(kinds(comparison).map(RayKind::name)).chain(["RMSE", "largest", "over 1/255"]);
    let mut table = Table::new(1, heading);
    let error = |image: &Distance, pixels: f64| {
        [
            number(image.rms),
            number(image.largest),
            format!("{} %", number(100.0 * image.pixels_over as f64 / pixels)),
        ]
    };
    let pixels = comparison.pixels as f64;
    for (index, engine) in comparison.engines.iter().enumerate() {
        let mut row = vec![
            engine.engine.to_owned(),
            engine.lanes.to_string(),
            maybe(engine.frame_seconds.map(|seconds| seconds.median)),
            maybe(engine.speed_up),
        ];
        row.extend(kinds(comparison).map(|kind| {
            maybe(engine.mrays_per_second.get(&kind).and_then(|rate| rate.map(|rate| rate.median)))
        }));
        row.extend(error(&engine.image, pixels));
        table.push(row);
        if index == 0 {
            let mut floor = vec!["f32 floor".to_owned()];
            floor.extend(std::iter::repeat_n(NONE.to_owned(), 3 + kinds(comparison).count()));
            floor.extend(error(&comparison.floor, pixels));
            table.push(floor);
        }
    }
    format!(
        "\nSpeed, and the picture against the reference's. Rays by kind in Mrays/s, traced on their own; a frame is traced and \
         shaded, after {} s of building.\n\n{}",
        maybe(comparison.build_seconds.map(|seconds| seconds.median)),
        table.lines()
    )
}

fn errors(comparison: &Comparison) -> String {
    let wavefront: Vec<&EngineResult> =
        comparison.engines.iter().filter(|engine| engine.same_bits_as_scalar.is_some()).collect();
    let mut text = String::from(
        "\nAnswers on the same rays, against the reference's. In brackets: within rounding of an edge, where no answer is wrong. t \
         in\nunits in the last place, and as backward error, the roundings of the primitive's place that explain it; normals in \
         2^-24.\n",
    );
    for engine in &wavefront {
        let is_scalar = engine.engine == "scalar";
        if !is_scalar && engine.same_bits_as_scalar == Some(true) {
            continue;
        }
        let same = wavefront.iter().filter(|other| is_scalar && other.same_bits_as_scalar == Some(true));
        let names = same.map(|other| format!("{} at {}", other.engine, other.lanes)).collect::<Vec<_>>();
        let names =
            if is_scalar { names.join(", ") } else { format!("{} at {}", engine.engine, engine.lanes) };
        let bits =
            if is_scalar { "; picture and hits have equal bits" } else { ", WHICH DIFFERS FROM SCALAR" };
        text += &format!("\n{names}{bits}\n\n{}", error_table(comparison, &engine.hits));
    }
    text
}

fn error_table(comparison: &Comparison, hits: &std::collections::BTreeMap<RayKind, HitErrors>) -> String {
    let mut table = Table::new(
        1,
        [
            "rays",
            "traced",
            "hit",
            "false hits",
            "false misses",
            "other primitive",
            "t ulp p50",
            "p99",
            "max",
            "backward p50",
            "p99",
            "max",
            "normal p50",
            "p99",
            "max",
        ],
    );
    for kind in kinds(comparison) {
        let Some(errors) = hits.get(&kind) else { continue };
        let wrong = |wrong: Wrong| format!("{} ({})", wrong.certain, wrong.near_edges);
        let mut row = vec![
            kind.name().to_owned(),
            errors.rays.to_string(),
            errors.hits.to_string(),
            wrong(errors.false_hits),
            wrong(errors.false_misses),
            if kind == RayKind::Shadow { NONE.to_owned() } else { wrong(errors.other_primitives) },
        ];
        for percentiles in [errors.t_ulps, errors.t_backward, errors.normal] {
            row.extend(match percentiles {
                Some(Percentiles { p50, p99, max }) => [p50, p99, max].map(number),
                None => [NONE; 3].map(str::to_owned),
            });
        }
        table.push(row);
    }
    table.lines()
}
