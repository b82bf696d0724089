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
    comparison.engines.first()?;
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
    use crate::measure::{Better, Spread, Wrong};
    use crate::rays::{RayCounts, RayKind};
    use std::collections::BTreeMap;

    fn engine(name: &'static str, lanes: u32, seconds: f64, rms: f64) -> EngineResult {
        let errors =
            HitErrors { rays: 500, false_hits: Wrong { near_edges: 2, certain: 0 }, ..HitErrors::default() };
        EngineResult {
            engine: name,
            lanes,
            frame_seconds: Spread::of(vec![seconds], Better::Less),
            speed_up: None,
            mrays_per_second: BTreeMap::new(),
            hits: if name == "reference" {
                BTreeMap::new()
            } else {
                BTreeMap::from([(RayKind::Primary, errors)])
            },
            image: Distance { rms, largest: rms, pixels_over: u64::from(rms > 1e-3) },
            same_bits_as_scalar: (name != "reference").then_some(true),
        }
    }

    fn comparison(rms: f64, floor: f64) -> Comparison {
        Comparison {
            pixels: 100,
            frame_rays: RayCounts { primary: 3_000_000, ..RayCounts::default() },
            recorded_rays: RayCounts { primary: 500, ..RayCounts::default() },
            threads: 1,
            build_seconds: None,
            engines: vec![
                engine("reference", 1, 6.0, 0.0),
                engine("scalar", 1, 2.0, rms),
                engine("simd", 4, 1.0, rms),
                engine("simd", 8, 0.5, rms),
            ],
            floor: Distance { rms: floor, largest: floor, pixels_over: 0 },
        }
    }

    #[track_caller]
    fn assert_says(comparison: &Comparison, words: &[&str]) {
        let sentences = sentences(comparison);
        for words in words {
            assert!(sentences.contains(words), "{words:?} in {sentences:?}");
        }
        assert!(!sentences.contains("NaN") && !sentences.contains(" inf"), "{sentences}");
    }

    /// 3 million rays in half a second are 6 a microsecond; 2 s and 6 s are 4 and 12 times as long; 3e-6 over 2e-6 is 1.5.
    #[test]
    fn the_fastest_is_held_against_scalar_reference_and_floor() {
        assert_says(
            &comparison(3e-6, 2e-6),
            &[
                "Fastest is simd at 8 lanes: 6.00 million rays a second",
                "4.00 × scalar and 12.0 × the f64 reference",
                "RMSE of 3.0e-6, 1.50 × the floor",
                "none of 100 pixels differs",
                "no error",
                "Of 500 rays looked at one by one none has",
                "2 differ within rounding",
            ],
        );
    }

    #[test]
    fn errors_of_zero_and_without_bound_have_words_too() {
        assert_says(&comparison(0.0, 0.0), &["the reference's every bit"]);
        assert_says(&comparison(1e-8, 0.0), &["RMSE of 1.0e-8", "off by 0;"]);
        assert_says(&comparison(f64::INFINITY, f64::INFINITY), &["RMSE of ∞", "1 of 100 pixels differs"]);
        assert_says(&comparison(f64::NAN, f64::NAN), &["Fastest"]);
    }

    #[test]
    fn what_was_not_measured_is_not_said() {
        let mut nothing = comparison(1e-6, 1e-6);
        nothing.engines.iter_mut().for_each(|engine| engine.frame_seconds = None);
        assert!(!sentences(&nothing).contains("Fastest"));
        nothing.engines.clear();
        assert!(!sentences(&nothing).contains("rays"), "{}", sentences(&nothing));
    }

    #[test]
    fn mistakes_and_other_bits_are_not_passed_over() {
        let mut wrong = comparison(1e-6, 1e-6);
        wrong.engines[2].same_bits_as_scalar = Some(false);
        wrong.engines[1].hits.values_mut().for_each(|errors| errors.false_misses.certain = 7);
        assert_says(&wrong, &["The bits of simd at 4 lanes differ", "7 answers are wrong beyond rounding"]);
        assert!(!sentences(&wrong).contains("no error"));
    }
}
