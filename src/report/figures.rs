//! The plots of a comparison.

use super::plot::bars::{self, Bars};
use super::plot::ranges::{self, Ranges};
use super::plot::{Axis, Chart, Colour, Mark, PlotError, Point, Rule, Series};
use super::summary::{frame_mrays_per_second, name};
use super::table::number;
use super::tables::kinds;
use crate::measure::{Comparison, EngineResult, HitErrors, Percentiles};

/// A plot in a file of its own.
pub(super) struct Figure {
    /// Name of the file.
    pub(super) file: &'static str,
    /// The SVG.
    pub(super) svg: String,
    /// What is plotted, in a sentence; for those who do not see it, too.
    pub(super) caption: String,
}

pub(super) const SPEED_OVER_ERROR: &str = "speed-over-error.svg";
pub(super) const SPEED_BY_KIND: &str = "speed-by-kind.svg";
pub(super) const HIT_ERRORS: &str = "hit-errors.svg";

/// Frame speed over the error of the picture: a point for each engine.
pub(super) fn speed_over_error(comparison: &Comparison) -> Result<Figure, PlotError> {
    let point = |engine: &EngineResult| {
        let (x, y) = (engine.image.rms, frame_mrays_per_second(comparison, engine)?);
        let seconds = engine.frame_seconds?;
        let times = engine.speed_up.filter(|_| engine.engine == "simd");
        let times = times.map_or_else(String::new, |times| format!(": {} × scalar", number(times)));
        let point = Point {
            x,
            y,
            // The rate is a constant over seconds, so both are off by the same share.
            y_spread: y * (seconds.median_absolute_deviation / seconds.median).min(1.0),
            label: format!("{}{times}", name(engine)),
        };
        let mark = if engine.same_bits_as_scalar.is_none() { Mark::Open } else { Mark::Full };
        x.is_finite().then(|| Series { points: vec![point], colour: colour(engine), mark, is_line: false })
    };
    let series: Vec<Series> = comparison.engines.iter().filter_map(point).collect();
    let mut rules =
        vec![Rule { x: Comparison::LIMIT, label: "a step of 8 bits, 1/255".into(), colour: Colour::MUTED }];
    if comparison.floor.rms.is_finite() {
        rules.push(Rule {
            x: comparison.floor.rms,
            label: format!("f32 floor, {}", number(comparison.floor.rms)),
            colour: Colour::LIMIT,
        });
    }
    let points = || series.iter().flat_map(|series| &series.points);
    let errors: Vec<f64> = points().map(|point| point.x).chain(rules.iter().map(|rule| rule.x)).collect();
    let least = errors.iter().copied().filter(|&error| error > 0.0).fold(f64::MAX, f64::min);
    // What is exact has its name right of it, before the first that is not.
    let x = errors.into_iter().chain([least / 8.0]);
    let x = Axis::log("error of the picture: RMSE against the f64 reference, linear colour", x);
    let y = Axis::linear("speed of the frame (Mrays/s)", points().map(|point| point.y + point.y_spread));
    let runs = comparison.engines.last().and_then(|engine| engine.frame_seconds).map_or(0, |it| it.runs);
    let runs = if runs == 1 { "one frame".to_owned() } else { format!("the median of {runs} frames") };
    Ok(Figure {
        file: SPEED_OVER_ERROR,
        svg: Chart { x, y, series, rules, guides: vec![] }.draw()?,
        caption: format!(
            "Speed over error: up is faster, left is nearer to the truth. All rays of the frame over the seconds to trace and \
             shade it, {runs}, a bar as long as their median absolute deviation to either side; the reference has one frame, and \
             its error is 0 by definition."
        ),
    })
}

/// Rays a second by kind and engine, on recorded rays; none where there are no rays.
pub(super) fn speed_by_kind(comparison: &Comparison) -> Result<Option<Figure>, PlotError> {
    let groups: Vec<bars::Group> = kinds(comparison)
        .map(|kind| {
            let rate = |engine: &EngineResult| Some((*engine.mrays_per_second.get(&kind)?)?.median);
            bars::Group {
                name: format!("{} rays", kind.name()),
                values: comparison.engines.iter().map(rate).collect(),
            }
        })
        .collect();
    if groups.is_empty() {
        return Ok(None);
    }
    let values = groups.iter().flat_map(|group| &group.values).copied().flatten();
    let plot = Bars {
        y: Axis::linear("Mrays/s", values),
        series: comparison.engines.iter().map(|engine| (name(engine), colour(engine))).collect(),
        groups,
    };
    Ok(Some(Figure {
        file: SPEED_BY_KIND,
        svg: plot.draw()?,
        caption: "Rays a second by kind: rays of this frame, recorded and traced on their own, without shading; medians.".into(),
    }))
}

/// Errors of hits by kind of ray; none where nothing is hit.
pub(super) fn hit_errors(comparison: &Comparison) -> Result<Option<Figure>, PlotError> {
    let Some(engine) = comparison.engines.iter().find(|engine| engine.engine == "scalar") else {
        return Ok(None);
    };
    let group = |heading: &str, of: fn(&HitErrors) -> Option<Percentiles>| {
        let row = |kind| Some((crate::rays::RayKind::name(kind).to_owned(), of(engine.hits.get(&kind)?)?));
        let rows = kinds(comparison).filter_map(row).filter(|(_, Percentiles { max, .. })| max.is_finite());
        ranges::Group { heading: heading.to_owned(), rows: rows.collect() }
    };
    let groups = [
        group("t, in units in the last place", |errors| errors.t_ulps),
        group("t, in roundings of the primitive's place that explain it", |errors| errors.t_backward),
        group("shading normal, in 2⁻²⁴", |errors| errors.normal),
    ];
    let groups: Vec<_> = groups.into_iter().filter(|group| !group.rows.is_empty()).collect();
    if groups.is_empty() {
        return Ok(None);
    }
    let rows = groups.iter().flat_map(|group| &group.rows);
    let values = rows.flat_map(|(_, Percentiles { p50, p99, max })| [*p50, *p99, *max]);
    let x = Axis::log("error against the f64 reference, in roundings to f32", values);
    Ok(Some(Figure {
        file: HIT_ERRORS,
        svg: Ranges { x, groups }.draw()?,
        caption: "Errors of hits, by kind of ray. Where t is off by many units in the last place but by few roundings of the \
                  primitive's place, it is the question that is delicate, a grazing ray or a start far off, not the answer that \
                  is bad."
            .into(),
    }))
}

fn colour(engine: &EngineResult) -> Colour {
    match (engine.engine, engine.lanes) {
        ("reference", _) => Colour::TRUTH,
        (_, 1) => Colour::LANES[0],
        (_, 4) => Colour::LANES[1],
        (_, 8) => Colour::LANES[2],
        _ => Colour::LANES[3],
    }
}
