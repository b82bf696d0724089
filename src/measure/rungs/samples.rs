//! The rung of samples: how far a picture of few samples a pixel is from one of very many, and at what cost.

use super::{RungOptions, rendered, shrunk};
use crate::film::Image;
use crate::measure::{Better, Difference, Spread};
use crate::render::{Engine, RenderError};
use crate::scene::{RenderSettings, Sampling, Scene};
use serde::Serialize;

/// Pictures of one scene by samples a pixel and by where these lie.
#[derive(Clone, Debug, Serialize)]
pub struct SamplesRung {
    /// Columns and rows: the scene's picture made small.
    pub size: [u32; 2],
    /// Samples a pixel of what counts as the truth.
    pub truth_samples: u32,
    /// The distance of the wavefront engine's picture of one sample a pixel from the reference's, as [`SampledPicture::rms`]:
    /// the engine's own error, without that of sampling.
    pub numerical_rms: f64,
    /// By where samples lie.
    pub patterns: Vec<PatternRun>,
}

/// Pictures whose samples lie by one pattern.
#[derive(Clone, Debug, Serialize)]
pub struct PatternRun {
    /// Its name.
    pub sampling: &'static str,
    /// From one sample a pixel up.
    pub pictures: Vec<SampledPicture>,
    /// d log RMSE / d log samples by least squares, from 2 × 2 samples up, since a single sample lies in the middle whatever the
    /// pattern: −½ where samples are independent. None where fewer than two pictures are off the truth.
    pub slope: Option<f64>,
}

/// A picture of n × n samples a pixel.
#[derive(Clone, Debug, Serialize)]
pub struct SampledPicture {
    /// n.
    pub n: u32,
    /// To trace all rays; of the rounds.
    pub seconds: Option<Spread>,
    /// Root of the mean of the squared differences of all channels from the truth, linear.
    pub rms: f64,
}

/// Pixels of the small picture, at most: 4096 samples each take two cores some ten seconds.
const PIXELS: u32 = 1 << 13;

/// n of the pictures.
const LARGEST_N: u32 = 8;

/// n of the truth.
const TRUTH_N: u32 = RenderSettings::MAX_SAMPLES;

impl SamplesRung {
    /// Renders a scene small, by the wavefront engine: the truth once, from points that no other picture has, and each picture
    /// in turn with the others.
    ///
    /// # Errors
    /// What keeps a scene from being rendered.
    pub fn measure(scene: &Scene, options: &RungOptions<'_>) -> Result<Self, RenderError> {
        let steps = 2 + options.rounds();
        let engine = Engine::wavefront(options.width);
        let mut scene = shrunk(scene, PIXELS);
        options.step("the truth, of many samples", 0, steps)?;
        let seed = scene.render.seed;
        let truth = {
            let other = RenderSettings {
                sampling: Sampling::Jittered,
                samples: TRUTH_N,
                seed: seed.wrapping_add(1),
                ..scene.render
            };
            scene.render = other;
            rendered(&scene, engine, options)?.image
        };
        options.step("one sample a pixel by the reference", 1, steps)?;
        (scene.render.samples, scene.render.seed) = (1, seed);
        let by_reference = rendered(&scene, Engine::Reference, options)?.image;
        let numerical_rms = rms(&by_reference, &rendered(&scene, engine, options)?.image);

        let new = |(sampling, _)| PatternRun { sampling, pictures: Vec::new(), slope: None };
        let mut patterns: Vec<PatternRun> = Sampling::NAMES.map(new).into();
        let mut seconds = vec![Vec::new(); patterns.len() * LARGEST_N as usize];
        for round in 0..options.rounds() {
            options.step("few samples a pixel", 2 + round, steps)?;
            for n in 1..=LARGEST_N {
                for (place, (_, sampling)) in Sampling::NAMES.into_iter().enumerate() {
                    (scene.render.sampling, scene.render.samples) = (sampling, n);
                    let picture = rendered(&scene, engine, options)?;
                    if round == 0 {
                        let rms = rms(&truth, &picture.image);
                        patterns[place].pictures.push(SampledPicture { n, seconds: None, rms });
                    }
                    seconds[place * LARGEST_N as usize + n as usize - 1].push(picture.trace_seconds);
                }
            }
        }
        let pictures = patterns.iter_mut().flat_map(|pattern| &mut pattern.pictures);
        for (picture, seconds) in pictures.zip(seconds) {
            picture.seconds = Spread::of(seconds, Better::Less);
        }
        for pattern in &mut patterns {
            let points = pattern.pictures.iter().filter(|picture| picture.n > 1);
            let points: Vec<_> =
                points.map(|picture| (f64::from(picture.n * picture.n), picture.rms)).collect();
            pattern.slope = log_slope(&points);
        }
        let size = [scene.image.width, scene.image.height];
        Ok(Self { size, truth_samples: TRUTH_N * TRUTH_N, numerical_rms, patterns })
    }

    /// The smallest distance from the truth in units of the engine's own error; none where the engine makes none.
    #[must_use]
    pub fn least_over_numerical(&self) -> Option<f64> {
        let pictures = self.patterns.iter().flat_map(|pattern| &pattern.pictures);
        let least = pictures.map(|picture| picture.rms).min_by(f64::total_cmp)?;
        (self.numerical_rms > 0.0).then(|| least / self.numerical_rms)
    }
}

fn rms(truth: &Image, image: &Image) -> f64 {
    Difference::between(truth, image, 0.0).map_or(f64::INFINITY, |difference| difference.rms)
}

/// The slope of log y over log x by least squares, of points with y > 0; none where they are fewer than two.
fn log_slope(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> =
        points.iter().filter(|(_, y)| *y > 0.0 && y.is_finite()).map(|(x, y)| (x.ln(), y.ln())).collect();
    if logs.len() < 2 {
        return None;
    }
    let count = logs.len() as f64;
    let (x_mean, y_mean) = logs.iter().fold((0.0, 0.0), |(x, y), log| (x + log.0 / count, y + log.1 / count));
    let covariance: f64 = logs.iter().map(|(x, y)| (x - x_mean) * (y - y_mean)).sum();
    let variance: f64 = logs.iter().map(|(x, _)| (x - x_mean) * (x - x_mean)).sum();
    (variance > 0.0).then(|| covariance / variance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_has_its_exponent_as_slope() {
        let law =
            |exponent: f64| [4.0, 9.0, 64.0].map(|samples: f64| (samples, 3.0 * samples.powf(exponent)));
        for exponent in [-0.5, -0.75, -1.0] {
            let slope = log_slope(&law(exponent)).unwrap();
            assert!((slope - exponent).abs() < 1e-12, "{slope} for {exponent}");
        }
    }

    #[test]
    fn there_is_no_slope_through_less_than_two_points() {
        assert_eq!(log_slope(&[]), None);
        assert_eq!(log_slope(&[(4.0, 0.1), (9.0, 0.0)]), None);
        assert_eq!(log_slope(&[(4.0, 0.1), (4.0, 0.2)]), None);
    }
}
