//! The tables of a benchmark.

use super::table::{NONE, Table, maybe, median, number};
use crate::measure::Spread;
use crate::measure::bench::{BenchReport, EngineBench, GrowthPoint, PhaseSeconds};
use crate::rays::RayKind;

/// All tables, with the words between them.
pub(crate) fn benched(report: &BenchReport) -> String {
    let machine = &report.machine;
    let mut text = format!(
        "{}, threads: {}, built for {} by {}\n",
        machine.processor.as_deref().unwrap_or("unknown processor"),
        report.threads,
        machine.isa,
        machine.compiler.unwrap_or("an unknown compiler"),
    );
    text += &speed(report);
    text += &phases(report);
    text += &stages(report);
    text += &growth(report);
    text
}

/// A median and how far the repeats lie from it, in the median.
fn with_spread(spread: Option<Spread>) -> String {
    spread.map_or_else(
        || NONE.into(),
        |spread| {
            if spread.runs == 1 {
                return number(spread.median);
            }
            let share = 100.0 * spread.median_absolute_deviation / spread.median;
            format!("{} ±{share:.0}%", number(spread.median))
        },
    )
}

fn speed(report: &BenchReport) -> String {
    let heading = ["scene", "engine", "primitives", "frame s", "× scalar"].into_iter();
    let heading = heading.chain(RayKind::ALL.map(RayKind::name)).chain(["wrong", "t ulp p99"]);
    let mut table = Table::new(2, heading);
    for scene in &report.scenes {
        let mut row = |engine: &EngineBench, name: &str, speed_up: Option<f64>, errors: [String; 2]| {
            let mut row = vec![
                scene.scene.clone(),
                format!("{name} {}", engine.lanes),
                scene.primitives.to_string(),
                with_spread(engine.frame_seconds),
                maybe(speed_up),
            ];
            row.extend(
                RayKind::ALL.map(|kind| with_spread(engine.mrays_per_second.get(&kind).copied().flatten())),
            );
            row.extend(errors);
            table.push(row);
        };
        let worst = scene.errors.values().filter_map(|errors| Some(errors.t_ulps?.p99)).reduce(f64::max);
        // Both give the same bits.
        let errors = [scene.mistakes().to_string(), maybe(worst)];
        row(&scene.scalar, "scalar", Some(1.0), errors.clone());
        row(&scene.simd, "simd", scene.speed_up, errors);
    }
    format!(
        "\nFrames, and rays by kind in Mrays/s, traced on their own: medians, and how far repeats lie from them in the median. \
         Wrong: of\nsome rays of each kind, those with another answer than the f64 reference's, beyond rounding; t: their error, \
         units in the last place.\n\n{}",
        table.lines()
    )
}

fn phases(report: &BenchReport) -> String {
    let heading = [
        "scene",
        "primitives",
        "load",
        "build",
        "trace",
        "shade",
        "write",
        "MiB",
        "bytes/primitive",
        "KiB/worker",
    ];
    let mut table = Table::new(1, heading);
    for scene in &report.scenes {
        let PhaseSeconds { load, build, trace, shade, write } = scene.seconds;
        table.push(vec![
            scene.scene.clone(),
            scene.primitives.to_string(),
            maybe(load),
            maybe(median(build)),
            maybe(trace),
            maybe(shade),
            maybe(median(write)),
            number(scene.memory.hierarchy_bytes as f64 / f64::from(1 << 20)),
            maybe(scene.memory.bytes_per_primitive),
            number(scene.memory.queue_bytes_per_worker as f64 / 1024.0),
        ]);
    }
    format!(
        "\nSeconds by phase, simd; memory of the hierarchy, and of a worker's queues.\n\n{}",
        table.lines()
    )
}

fn stages(report: &BenchReport) -> String {
    let names: Vec<&str> = report
        .scenes
        .first()
        .map(|scene| scene.simd.stages.iter().map(|stage| stage.stage).collect())
        .unwrap_or_default();
    let mut table = Table::new(1, ["scene", "primitives"].into_iter().chain(names));
    for scene in &report.scenes {
        let all: f64 = scene.simd.stages.iter().map(|stage| stage.seconds).sum();
        let mut row = vec![scene.scene.clone(), scene.primitives.to_string()];
        row.extend(scene.simd.stages.iter().map(|stage| {
            let share = if all > 0.0 { 100.0 * stage.seconds / all } else { 0.0 };
            match stage.lanes {
                Some(lanes) => format!("{share:.0}% {:.1}", lanes.in_use),
                None => format!("{share:.0}%"),
            }
        }));
        table.push(row);
    }
    format!("\nShare of the frame by stage, and lanes in use, simd.\n\n{}", table.lines())
}

fn growth(report: &BenchReport) -> String {
    let mut table = Table::new(2, ["scene", "over", "build s", "frame s", "build ~", "frame ~"]);
    for growth in &report.growth {
        let series = |of: fn(&GrowthPoint) -> Option<Spread>| {
            let medians: Vec<_> = growth.points.iter().map(|point| median(of(point))).collect();
            if medians.iter().all(Option::is_none) {
                return NONE.to_owned();
            }
            medians.into_iter().map(maybe).collect::<Vec<_>>().join(" ")
        };
        let counts = growth.points.iter().map(|point| point.count.to_string()).collect::<Vec<_>>().join(" ");
        table.push(vec![
            growth.scene.clone(),
            format!("{} {counts}", growth.over),
            series(|point| point.build_seconds),
            series(|point| point.frame_seconds),
            exponent(growth.build_exponent),
            exponent(growth.frame_exponent),
        ]);
    }
    format!(
        "\nHow cost grows: seconds, and the power of the count that they follow. Samples are of a pixel; levels of rays are one more \
         than\nthe depth of the deepest. Pictures for samples, lights and levels have half the sides.\n\n{}",
        table.lines()
    )
}

pub(super) fn exponent(exponent: Option<f64>) -> String {
    exponent.map_or_else(|| NONE.into(), |exponent| format!("n^{exponent:.2}"))
}
