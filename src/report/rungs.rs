//! The tables of what accuracy costs.

use super::block::Block;
use super::table::{NONE, Table, maybe, median, number};
use crate::measure::Percentiles;
use crate::measure::rungs::Rungs;
use crate::measure::rungs::kernels::{BoxRung, KernelRung, LeakRung};
use crate::measure::rungs::min_weight::{MinWeightFrame, MinWeightRung};
use crate::measure::rungs::samples::SamplesRung;
use crate::rays::RayKind;

/// Formulas, what is lost at edges and corners, weak rays, samples; what a scene does not have is left out.
pub(crate) fn rungs(rungs: &Rungs) -> Vec<Block> {
    let mut blocks = formulas(rungs);
    blocks.extend(robustness(rungs));
    blocks.extend(rungs.min_weight.iter().flat_map(weak_rays));
    blocks.extend(samples(&rungs.samples));
    blocks
}

/// A formula's name, and whether it is the engine's.
fn formula_name(name: &str, is_engines: bool) -> String {
    if is_engines { format!("{name}, the engine's") } else { name.to_owned() }
}

/// A limit as a fraction, which is how people choose it.
pub(super) fn limit(min_weight: f32) -> String {
    if min_weight > 0.0 { format!("1/{}", 1.0 / min_weight) } else { "0".into() }
}

fn formulas(rungs: &Rungs) -> Vec<Block> {
    if rungs.kernels.is_empty() {
        return vec![];
    }
    let mut blocks = vec![Block::Words(
        "What formulas cost: pairs of ray and primitive that the frame's rays test, played back through each formula on one \
         thread. A mistake is an answer that no rounding explains; near an edge rounding does. t in units in the last place, and \
         as backward error, the roundings of the primitive's place that explain it."
            .into(),
    )];
    for kernels in &rungs.kernels {
        blocks.extend(kernels.boxes.iter().flat_map(|rung| boxes_of(kernels.rays, rung)));
        blocks.extend(kernels.primitives().flat_map(|rung| formulas_of(kernels.rays, rung)));
    }
    blocks
}

fn boxes_of(rays: RayKind, rung: &BoxRung) -> [Block; 2] {
    let BoxRung { lanes, pairs, true_hits, .. } = rung;
    let words = format!(
        "boxes, {} rays: {pairs} pairs, {lanes} lanes. True hits left out: of {true_hits}, those whose leaf's box the ray is \
         found to miss.",
        rays.name()
    );
    [Block::Words(words), Block::Table(boxes(rung))]
}

/// Without times where there are none.
fn boxes(rung: &BoxRung) -> Table {
    let is_timed = rung.formulas.iter().any(|run| run.seconds.is_some());
    let times = is_timed.then_some("ns a test");
    let heading = ["formula"].into_iter().chain(times).chain(["true hits left out", "a million"]);
    let mut table = Table::new(1, heading);
    for run in &rung.formulas {
        let mut row = vec![formula_name(run.name, run.is_engines)];
        row.extend(is_timed.then(|| maybe(rung.nanoseconds(run))));
        row.extend([run.left_out.to_string(), per_million(run.left_out, rung.true_hits)]);
        table.push(row);
    }
    table
}

fn per_million(count: u64, of: u64) -> String {
    maybe((of > 0).then(|| count as f64 * 1e6 / of as f64))
}

/// What robustness buys where it matters.
fn robustness(rungs: &Rungs) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    blocks.extend([&rungs.leaks, &rungs.polygon_leaks].into_iter().flatten().flat_map(leaks));
    blocks.extend(rungs.box_corners.iter().flat_map(box_corners));
    if !blocks.is_empty() {
        let words = "That faces agree about their common edges, that no box hides a hit and that no surface hits itself by \
                     rounding are no choices: the engine has them always, and these tables show what they cost and what would \
                     be lost.";
        blocks.push(Block::Words(words.into()));
    }
    blocks
}

fn box_corners(rung: &BoxRung) -> [Block; 2] {
    let words = format!(
        "Corners of boxes: rays from the eye aimed at corners of triangles and polygons that lie on an edge of their leaf's box; of \
         their {} true hits, those whose leaf's box the ray is found to miss.",
        rung.true_hits
    );
    [Block::Words(words), Block::Table(boxes(rung))]
}

fn formulas_of(rays: RayKind, rung: &KernelRung) -> [Block; 2] {
    let heading = ["formula", "ns a test", "mistakes", "near edges", "t ulp p50", "p99", "max"];
    let mut table = Table::new(1, heading.into_iter().chain(["backward p50", "p99", "max"]));
    for run in &rung.formulas {
        let mut row = vec![
            formula_name(run.name, run.is_engines),
            maybe(rung.nanoseconds(run).map(|[median, _]| median)),
            run.errors.mistakes().to_string(),
            run.errors.near_edges().to_string(),
        ];
        for percentiles in [run.errors.t_ulps, run.errors.t_backward] {
            row.extend(match percentiles {
                Some(Percentiles { p50, p99, max }) => [p50, p99, max].map(number),
                None => [NONE; 3].map(str::to_owned),
            });
        }
        table.push(row);
    }
    let KernelRung { primitive, lanes, tested, pairs, edges, .. } = rung;
    let edges = edges.map_or(String::new(), |edges| {
        format!(", of {} edges on average", number(edges as f64 / *pairs as f64))
    });
    let words =
        format!("{primitive}s, {} rays: {pairs} of {tested} pairs{edges}, {lanes} lanes", rays.name());
    [Block::Words(words), Block::Table(table)]
}

fn leaks(rung: &LeakRung) -> [Block; 2] {
    let mut table = Table::new(1, ["formula", "at edges", "a million", "at corners", "a million"]);
    for leaks in &rung.formulas {
        table.push(vec![
            formula_name(leaks.name, leaks.is_engines),
            leaks.at_edges.to_string(),
            per_million(leaks.at_edges, rung.edge_rays),
            leaks.at_corners.to_string(),
            per_million(leaks.at_corners, rung.corner_rays),
        ]);
    }
    let words = format!(
        "Leaks: of {} rays aimed at edges that {}s share, and {} at corners that they lie all around, those that hit none of \
         them.",
        rung.edge_rays, rung.primitive, rung.corner_rays
    );
    [Block::Words(words), Block::Table(table)]
}

fn weak_rays(rung: &MinWeightRung) -> [Block; 2] {
    let [width, height] = rung.size;
    let pixels = f64::from(width) * f64::from(height);
    let mut table =
        Table::new(1, ["min_weight", "frame s", "× faster than 0", "Mrays", "RMSE", "over 1/255"]);
    let all = rung.frames.first().and_then(|frame| median(frame.seconds));
    for frame in &rung.frames {
        let MinWeightFrame { min_weight, seconds, rays, rms, pixels_over } = frame;
        let seconds = median(*seconds);
        let times =
            all.zip(seconds).filter(|(_, seconds)| *seconds > 0.0).map(|(all, seconds)| all / seconds);
        table.push(vec![
            limit(*min_weight),
            maybe(seconds),
            maybe(times),
            number(rays.total() as f64 / 1e6),
            number(*rms),
            format!("{} %", number(100.0 * *pixels_over as f64 / pixels)),
        ]);
    }
    let words = format!(
        "Without the rays whose weight is below min_weight, {width} x {height} pixels of one sample, against the reference with \
         all rays."
    );
    [Block::Words(words), Block::Table(table)]
}

fn samples(rung: &SamplesRung) -> Vec<Block> {
    let [width, height] = rung.size;
    let heading = rung.patterns.iter().flat_map(|pattern| [pattern.sampling, "frame s"]);
    let mut table = Table::new(1, ["samples"].into_iter().chain(heading));
    let rows = rung.patterns.first().map_or(0, |pattern| pattern.pictures.len());
    for row in 0..rows {
        let pictures = || rung.patterns.iter().filter_map(|pattern| pattern.pictures.get(row));
        let name = pictures().next().map_or_else(String::new, |picture| format!("{0} x {0}", picture.n));
        let cells = pictures().flat_map(|picture| [number(picture.rms), maybe(median(picture.seconds))]);
        table.push([name].into_iter().chain(cells).collect());
    }
    let slopes = rung.patterns.iter().flat_map(|pattern| [slope(pattern.slope), String::new()]);
    table.push(["slope".to_owned()].into_iter().chain(slopes).collect());
    let words = format!(
        "Samples a pixel: RMSE against {} jittered ones of another seed, {width} x {height} pixels. The slope is that of log RMSE \
         over log samples, from 2 x 2 up.",
        rung.truth_samples
    );
    let least = match rung.least_over_numerical() {
        Some(ratio) if ratio >= 1.0 => format!(", 1/{} of the least of these", number(ratio)),
        _ => String::new(),
    };
    let own =
        format!("The engine's own error, at one sample a pixel, is {}{least}.", number(rung.numerical_rms));
    vec![Block::Words(words), Block::Table(table), Block::Words(own)]
}

/// Two decimals, which is as much as a slope through seven points says.
pub(super) fn slope(slope: Option<f64>) -> String {
    slope.map_or_else(|| NONE.into(), |slope| format!("{slope:.2}"))
}
