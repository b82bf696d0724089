//! How cost grows with primitives, with pixels and with threads.

use super::super::race::Race;
use super::super::{Better, Spread};
use super::scene::{BenchOptions, SceneBench};
use crate::lanes::Width;
use crate::render::RenderError;
use crate::scene::Scene;
use serde::Serialize;

/// Cost over one thing that grows.
#[derive(Clone, Debug, Serialize)]
pub struct Growth {
    /// What grows: `primitives`, `pixels` or `threads`.
    pub over: &'static str,
    /// Of which scene.
    pub scene: String,
    /// In increasing order.
    pub points: Vec<GrowthPoint>,
    /// e of seconds ~ countᵉ for making the scene ready, by least squares of the logarithms; none of fewer than two points.
    pub build_exponent: Option<f64>,
    /// The same for a frame.
    pub frame_exponent: Option<f64>,
}

/// A point of it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct GrowthPoint {
    /// Primitives, pixels or threads.
    pub count: u64,
    /// To make the scene ready.
    pub build_seconds: Option<Spread>,
    /// To trace and shade a frame; simd.
    pub frame_seconds: Option<Spread>,
}

/// Quarters of the picture's sides that pixels grow over.
const QUARTERS: [u32; 4] = [1, 2, 4, 8];

impl Growth {
    fn new(over: &'static str, scene: &str, points: Vec<GrowthPoint>) -> Self {
        let exponent = |of: fn(&GrowthPoint) -> Option<Spread>| {
            let logarithms = points.iter().filter_map(|point| {
                let seconds = of(point)?.median;
                (seconds > 0.0 && point.count > 0).then(|| ((point.count as f64).ln(), seconds.ln()))
            });
            slope(&logarithms.collect::<Vec<_>>())
        };
        let build_exponent = exponent(|point| point.build_seconds);
        let frame_exponent = exponent(|point| point.frame_seconds);
        Self { over, scene: scene.to_owned(), points, build_exponent, frame_exponent }
    }

    /// Over scenes that are one scene in several sizes.
    #[must_use]
    pub fn over_primitives(scene: &str, sizes: &[SceneBench]) -> Self {
        let point = |bench: &SceneBench| GrowthPoint {
            count: bench.primitives as u64,
            build_seconds: bench.seconds.build,
            frame_seconds: bench.simd.frame_seconds,
        };
        Self::new("primitives", scene, sizes.iter().map(point).collect())
    }

    /// How often [`BenchOptions::on_step`] is called by [`Self::over_pixels`].
    #[must_use]
    pub fn steps_over_pixels(repeat: usize) -> u64 {
        QUARTERS.len() as u64 * Race::steps(1, repeat)
    }

    /// Pictures of one scene, from a quarter of its sides to twice.
    ///
    /// # Errors
    /// What keeps the wavefront engine from rendering it.
    pub fn over_pixels(name: &str, scene: &Scene, options: &BenchOptions<'_>) -> Result<Self, RenderError> {
        let mut scene = scene.clone();
        let sides = [scene.image.width, scene.image.height];
        let points = QUARTERS.into_iter().map(|quarters| {
            let [width, height] = sides.map(|side| (side.saturating_mul(quarters) / 4).max(1));
            (scene.image.width, scene.image.height) = (width, height);
            point(u64::from(width) * u64::from(height), &scene, options.pool, options)
        });
        Ok(Self::new("pixels", name, points.collect::<Result<_, _>>()?))
    }

    /// 1, 2, 4 and so on, up to those of the pool.
    #[must_use]
    pub fn thread_counts(pool: &rayon::ThreadPool) -> Vec<usize> {
        let most = pool.current_num_threads();
        let powers = (0..usize::BITS).map(|power| 1 << power).take_while(|&count| count < most);
        powers.chain([most]).collect()
    }

    /// Numbers of threads.
    ///
    /// # Errors
    /// What keeps the wavefront engine from rendering it.
    pub fn over_threads(name: &str, scene: &Scene, options: &BenchOptions<'_>) -> Result<Self, RenderError> {
        let points = Self::thread_counts(options.pool).into_iter().map(|count| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
            point(count as u64, scene, &pool, options)
        });
        Ok(Self::new("threads", name, points.collect::<Result<_, _>>()?))
    }
}

fn point(
    count: u64,
    scene: &Scene,
    pool: &rayon::ThreadPool,
    options: &BenchOptions<'_>,
) -> Result<GrowthPoint, RenderError> {
    let &BenchOptions { repeat, stop, on_step, .. } = options;
    let frames = Race { scene, widths: &[Width::BEST], repeat, pool, stop, on_step }.frames()?;
    let prepare_seconds = frames.iter().flat_map(|frames| frames.prepare_seconds.iter().copied());
    Ok(GrowthPoint {
        count,
        build_seconds: Spread::of(prepare_seconds.collect(), Better::Less),
        frame_seconds: frames.first().and_then(|frames| frames.trace_seconds),
    })
}

/// Of the line that is nearest to points in the sense of least squares; none where there is no one line.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (mean_x, mean_y) = (mean(|point| point.0), mean(|point| point.1));
    let covariance: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let variance: f64 = points.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    (points.len() > 1 && variance > 0.0).then(|| covariance / variance)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(count: u64, seconds: f64) -> GrowthPoint {
        let seconds = Spread::of(vec![seconds], Better::Less);
        GrowthPoint { count, build_seconds: seconds, frame_seconds: seconds }
    }

    #[test]
    fn the_exponent_is_that_of_the_power() {
        let points = [10_u64, 100, 1000].map(|count| point(count, 3e-6 * (count as f64).powf(1.25)));
        let growth = Growth::new("primitives", "any", points.to_vec());
        assert!((growth.frame_exponent.unwrap() - 1.25).abs() < 1e-12, "{growth:?}");
    }

    #[test]
    fn too_few_points_have_no_exponent() {
        for points in
            [vec![], vec![point(10, 1.0)], vec![point(10, 1.0); 2], vec![point(10, 0.0), point(20, 0.0)]]
        {
            assert_eq!(Growth::new("pixels", "any", points).build_exponent, None);
        }
    }
}
