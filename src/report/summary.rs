//! What a comparison says, in sentences.

use super::table::number;
use crate::measure::{Comparison, Distance, EngineResult, HitErrors};

/// How an engine is called in plots and sentences.
pub(super) fn name(engine: &EngineResult) -> String {
    match (engine.engine, engine.lanes) {
        ("reference", _) => "f64 reference".into(),
        (name, 1) => name.into(),
        (name, lanes) => format!("{name}, {lanes} lanes"),
    }
}

/// The same within a sentence.
fn called(engine: &EngineResult) -> String {
    match (engine.engine, engine.lanes) {
        ("reference", _) => "the f64 reference".into(),
        (name, 1) => name.into(),
        (name, lanes) => format!("{name} at {lanes} lanes"),
    }
}

/// Millions of rays of the frame a second, whatever they are for; the frame is traced and shaded in this time.
pub(super) fn frame_mrays_per_second(comparison: &Comparison, engine: &EngineResult) -> Option<f64> {
    let seconds = engine.frame_seconds?.median;
    Some(comparison.frame_rays.total() as f64 / seconds / 1e6).filter(|rate| rate.is_finite())
}

/// The sentences.
pub(super) fn sentences(comparison: &Comparison) -> String {
    let sentences = [fastest(comparison), picture(comparison), bits(comparison), mistakes(comparison)];
    sentences.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

fn fastest(comparison: &Comparison) -> Option<String> {
    let rate = |engine| frame_mrays_per_second(comparison, engine);
    let rates = comparison.engines.iter().filter_map(|engine| Some((engine, rate(engine)?)));
    let (engine, best) = rates.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let times = |other: &str| {
        let other = comparison.engines.iter().find(|engine| engine.engine == other)?;
        let ratio = best / rate(other).filter(|&rate| rate > 0.0)?;
        (other.engine != engine.engine).then(|| format!("{} × {}", number(ratio), called(other)))
    };
    let times: Vec<String> = ["scalar", "reference"].into_iter().filter_map(times).collect();
    let times = if times.is_empty() { String::new() } else { format!(", {}", times.join(" and ")) };
    Some(format!(
        "Fastest is {}: {} million rays a second over the whole frame{times}.",
        called(engine),
        number(best)
    ))
}

fn picture(comparison: &Comparison) -> Option<String> {
    let Distance { rms, pixels_over, .. } = comparison.engines.last()?.image;
    let floor = comparison.floor.rms;
    let against_floor = if floor > 0.0 && floor.is_finite() && rms.is_finite() {
        format!("{} × the floor, which is what f32 queues alone put a picture off", number(rms / floor))
    } else {
        format!("where f32 queues alone, the floor, put a picture off by {}", number(floor))
    };
    let pixels = comparison.pixels;
    let over = match pixels_over {
        0 => format!("none of {pixels} pixels differs"),
        1 => format!("1 of {pixels} pixels differs"),
        many => format!("{many} of {pixels} pixels differ"),
    };
    Some(match rms {
        0.0 => "The wavefront engine's picture has the reference's every bit.".into(),
        _ => format!(
            "The wavefront engine's picture is off the reference's by an RMSE of {}, {against_floor}; {over} by more than 1/255.",
            number(rms)
        ),
    })
}

fn bits(comparison: &Comparison) -> Option<String> {
    let differs =
        |engine: &&EngineResult| engine.engine != "scalar" && engine.same_bits_as_scalar == Some(false);
    let different: Vec<String> = comparison.engines.iter().filter(differs).map(called).collect();
    Some(if different.is_empty() {
        "At every width the picture and the hits have the same bits, so the points stand one above another: lanes add speed and \
         no error."
            .into()
    } else {
        format!("The bits of {} differ from those of scalar, which they should not.", different.join(" and "))
    })
}

fn mistakes(comparison: &Comparison) -> Option<String> {
    let scalar = comparison.engines.iter().find(|engine| engine.engine == "scalar")?;
    let rays: u64 = scalar.hits.values().map(|errors| errors.rays).sum();
    let near: u64 = scalar.hits.values().map(HitErrors::near_edges).sum();
    let wrong = match comparison.mistakes() {
        0 => "none has an answer that rounding does not explain".to_owned(),
        mistakes => format!("{mistakes} answers are wrong beyond rounding"),
    };
    (rays > 0).then(|| {
        format!("Of {rays} rays looked at one by one {wrong}; {near} differ within rounding of an edge.")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
}
