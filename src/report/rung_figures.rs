//! The plots of what accuracy costs.

use super::figures::Figure;
use super::plot::{Axis, Chart, Colour, Mark, PlotError, Point, Series};
use super::rungs::{limit, slope};
use crate::measure::rungs::Rungs;
use crate::measure::rungs::kernels::{FormulaRun, KernelRung, LeakRung};
use crate::measure::rungs::min_weight::MinWeightFrame;
use crate::measure::rungs::samples::PatternRun;
use crate::rays::RayKind;

pub(super) const SPHERE_FORMULAS: &str = "sphere-formulas.svg";
pub(super) const TRIANGLE_FORMULAS: &str = "triangle-formulas.svg";
pub(super) const POLYGON_FORMULAS: &str = "polygon-formulas.svg";
pub(super) const WEAK_RAYS: &str = "weak-rays.svg";
pub(super) const SAMPLES: &str = "samples.svg";

/// A plot for each rung that the scene has.
pub(super) fn rung_figures(rungs: &Rungs) -> Result<Vec<Figure>, PlotError> {
    let primary = rungs.kernels.iter().find(|kernels| kernels.rays == RayKind::Primary);
    let mut figures = vec![];
    for rung in primary.iter().flat_map(|kernels| kernels.primitives()) {
        let (file, leaks) = match rung.primitive {
            "sphere" => (SPHERE_FORMULAS, None),
            "triangle" => (TRIANGLE_FORMULAS, rungs.leaks.as_ref()),
            _ => (POLYGON_FORMULAS, rungs.polygon_leaks.as_ref()),
        };
        figures.extend(formulas(file, rung, leaks)?);
    }
    figures.extend(weak_rays(rungs)?);
    figures.extend(samples(rungs)?);
    Ok(figures)
}

/// Time of a test over the error of t: a point for each formula; none where no formula hits what is hit in truth.
fn formulas(
    file: &'static str,
    rung: &KernelRung,
    leaks: Option<&LeakRung>,
) -> Result<Option<Figure>, PlotError> {
    let series: Vec<Series> = rung.formulas.iter().filter_map(|run| formula(rung, run, leaks)).collect();
    if series.is_empty() {
        return Ok(None);
    }
    let points = || series.iter().flat_map(|series| &series.points);
    let largest = points().map(|point| point.x).fold(0.0, f64::max);
    // Names are long and stand right of their points.
    let x = Axis::log(
        "error of t: 99th percentile, roundings of the primitive's place",
        points().map(|point| point.x).chain([8.0 * largest]),
    );
    let y = Axis::linear("time of a test (ns)", points().map(|point| point.y + point.y_spread));
    let svg = Chart { x, y, series, rules: vec![], guides: vec![] }.draw()?;
    let aimed = if leaks.is_some() { " Leaks are of rays aimed at what they share." } else { "" };
    Ok(Some(Figure {
        file,
        svg,
        caption: format!(
            "Formulas for {}s, on pairs that primary rays test: down is faster, left is nearer to the truth; the full circle is the \
             engine's. {} lanes, one thread, medians. A mistake is an answer that no rounding explains.{aimed}",
            rung.primitive, rung.lanes
        ),
    }))
}

fn formula(rung: &KernelRung, run: &FormulaRun, leaks: Option<&LeakRung>) -> Option<Series> {
    let [y, y_spread] = rung.nanoseconds(run)?;
    let x = run.errors.t_backward?.p99;
    let mut label = format!("{}: {}", run.name, counted(run.errors.mistakes(), "mistake"));
    if let Some(leaks) = leaks.and_then(|leaks| leaks.formulas.iter().find(|leaks| leaks.name == run.name)) {
        label += &format!(", {}", counted(leaks.at_edges + leaks.at_corners, "leak"));
    }
    let (colour, mark) =
        if run.is_engines { (Colour::LANES[3], Mark::Full) } else { (Colour::LANES[1], Mark::Open) };
    let points = vec![Point { x, y, y_spread, label }];
    (x.is_finite() && y.is_finite()).then_some(Series { points, colour, mark, is_line: false })
}

fn counted(count: u64, what: &str) -> String {
    match count {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        many => format!("{many} {what}s"),
    }
}

/// Time of a frame over its error: a point for each limit.
fn weak_rays(rungs: &Rungs) -> Result<Option<Figure>, PlotError> {
    let Some(rung) = &rungs.min_weight else { return Ok(None) };
    let point = |frame: &MinWeightFrame| {
        let seconds = frame.seconds?;
        let label = if frame.min_weight > 0.0 { limit(frame.min_weight) } else { "all rays".into() };
        let y_spread = seconds.median_absolute_deviation;
        frame.rms.is_finite().then_some(Point { x: frame.rms, y: seconds.median, y_spread, label })
    };
    let points: Vec<Point> = rung.frames.iter().filter_map(point).collect();
    if points.is_empty() {
        return Ok(None);
    }
    let x = Axis::log(
        "error of the picture: RMSE against the reference with all rays, linear colour",
        points.iter().map(|point| point.x),
    );
    let y = Axis::linear("time of the frame (s)", points.iter().map(|point| point.y + point.y_spread));
    // A line through the points would run through their labels.
    let series = vec![Series { points, colour: Colour::LANES[3], mark: Mark::Full, is_line: false }];
    let [width, height] = rung.size;
    Ok(Some(Figure {
        file: WEAK_RAYS,
        svg: Chart { x, y, series, rules: vec![], guides: vec![] }.draw()?,
        caption: format!(
            "Without the rays whose weight is below min_weight, which the points are labelled with: down is faster, left is nearer \
             to the truth. {width} × {height} pixels of one sample, medians."
        ),
    }))
}

/// Error of pictures over their time: a line for each way to place samples; none where no picture is off.
fn samples(rungs: &Rungs) -> Result<Option<Figure>, PlotError> {
    let rung = &rungs.samples;
    let colours = [Colour::LANES[1], Colour::LIMIT, Colour::LANES[3]];
    let series = rung.patterns.iter().zip(colours).map(|(pattern, colour)| line(pattern, colour));
    let series: Vec<Series> = series.filter(|series| !series.points.is_empty()).collect();
    if series.is_empty() {
        return Ok(None);
    }
    let points = || series.iter().flat_map(|series| &series.points);
    let longest = points().map(|point| point.x).fold(0.0, f64::max);
    // Lines have their names right of their ends.
    let x = Axis::log("time of the picture (s)", points().map(|point| point.x).chain([4.0 * longest]));
    let y = Axis::log("error: RMSE, linear colour", points().map(|point| point.y));
    let svg = Chart { x, y, series, rules: vec![], guides: vec![] }.draw()?;
    let [width, height] = rung.size;
    Ok(Some(Figure {
        file: SAMPLES,
        svg,
        caption: format!(
            "Samples a pixel, from 1 to 8 × 8, by where they lie: down is nearer to {} jittered samples of another seed, left is \
             faster. {width} × {height} pixels, medians. Slopes are of log error over log samples.",
            rung.truth_samples
        ),
    }))
}

fn line(pattern: &PatternRun, colour: Colour) -> Series {
    let plotted = pattern.pictures.iter().filter_map(|picture| {
        let seconds = picture.seconds?.median;
        let is_on_axes = picture.rms > 0.0 && picture.rms.is_finite() && seconds > 0.0;
        is_on_axes.then_some(Point { x: seconds, y: picture.rms, y_spread: 0.0, label: String::new() })
    });
    let mut points: Vec<Point> = plotted.collect();
    if let Some(last) = points.last_mut() {
        last.label = match pattern.slope {
            Some(_) => format!("{}, slope {}", pattern.sampling, slope(pattern.slope).replace('-', "−")),
            None => pattern.sampling.to_owned(),
        };
    }
    Series { points, colour, mark: Mark::Full, is_line: true }
}
