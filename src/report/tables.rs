//! The tables of a comparison.

use super::block::Block;
use super::table::{NONE, Table, maybe, number};
use crate::measure::{Comparison, Distance, EngineResult, HitErrors, Percentiles, Wrong};
use crate::rays::RayKind;
use std::collections::BTreeMap;

/// Speed and error of every engine, then the errors of their hits.
pub(crate) fn tables(comparison: &Comparison) -> Vec<Block> {
    let mut blocks = speed(comparison);
    blocks.extend(errors(comparison));
    blocks
}

/// Kinds of ray that there are.
pub(super) fn kinds(comparison: &Comparison) -> impl Iterator<Item = RayKind> + '_ {
    RayKind::ALL.into_iter().filter(|&kind| comparison.recorded_rays.of(kind) > 0)
}

fn speed(comparison: &Comparison) -> Vec<Block> {
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
    let words = format!(
        "Speed, and the picture against the reference's. Rays by kind in Mrays/s, traced on their own; a frame is traced and \
         shaded, after {} s of building.",
        maybe(comparison.build_seconds.map(|seconds| seconds.median)),
    );
    vec![Block::Words(words), Block::Table(table)]
}

fn errors(comparison: &Comparison) -> Vec<Block> {
    let wavefront: Vec<&EngineResult> =
        comparison.engines.iter().filter(|engine| engine.same_bits_as_scalar.is_some()).collect();
    let mut blocks = vec![Block::Words(
        "Answers on the same rays, against the reference's. In brackets: within rounding of an edge, where no answer is wrong. t \
         in units in the last place, and as backward error, the roundings of the primitive's place that explain it; normals in \
         2^-24."
            .into(),
    )];
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
        blocks.push(Block::Words(format!("{names}{bits}")));
        blocks.push(Block::Table(error_table(comparison, &engine.hits)));
    }
    blocks
}

fn error_table(comparison: &Comparison, hits: &BTreeMap<RayKind, HitErrors>) -> Table {
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
    table
}
