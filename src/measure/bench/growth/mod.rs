//! How cost grows: with primitives, and for one scene with pixels, threads, samples, lights and levels of rays.
//!
//! - `frames`: frames of one scene, of more and more of one thing
//! - `lights`: as many lights as wanted

mod frames;
mod lights;

use super::super::Spread;
use super::super::race::Race;
use super::scene::{BenchOptions, SceneBench};
use crate::rays::RayCounts;
use crate::render::RenderError;
use crate::scene::Scene;
use serde::Serialize;

/// Cost over one thing that grows.
#[derive(Clone, Debug, Serialize)]
pub struct Growth {
    /// What grows: `primitives`, `pixels`, `threads`, `samples` of a pixel, `lights`, or `levels` of rays, of which there is
    /// one more than the depth of the deepest. The last three are of pictures of half the scene's sides.
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
    /// Of [`Growth::over`].
    pub count: u64,
    /// Of a frame.
    pub rays: RayCounts,
    /// To make the scene ready, of primitives and threads: nothing else makes a difference to it.
    pub build_seconds: Option<Spread>,
    /// To trace and shade a frame; simd.
    pub frame_seconds: Option<Spread>,
}

/// Points of a scene; none where nothing would grow.
type Measure = fn(&Scene, &BenchOptions<'_>) -> Result<Vec<GrowthPoint>, RenderError>;

/// What frames of one scene are measured over.
const OVER: [(&str, Measure); 5] = [
    ("pixels", frames::over_pixels),
    ("threads", frames::over_threads),
    ("samples", frames::over_samples),
    ("lights", frames::over_lights),
    ("levels", frames::over_levels),
];

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
            rays: bench.rays,
            build_seconds: bench.seconds.build,
            frame_seconds: bench.simd.frame_seconds,
        };
        Self::new("primitives", scene, sizes.iter().map(point).collect())
    }

    /// How often [`BenchOptions::on_step`] is called by [`Self::of_frames`].
    #[must_use]
    pub fn steps(pool: &rayon::ThreadPool, repeat: usize) -> u64 {
        frames::points(pool) * Race::steps(1, repeat)
    }

    /// Over all but primitives. Lights are left out where no light adds to anything, levels where nothing reflects or refracts.
    ///
    /// # Errors
    /// What keeps the wavefront engine from rendering it.
    pub fn of_frames(
        name: &str,
        scene: &Scene,
        options: &BenchOptions<'_>,
    ) -> Result<Vec<Self>, RenderError> {
        let mut growth = Vec::new();
        for (over, measure) in OVER {
            let points = measure(scene, options)?;
            if !points.is_empty() {
                growth.push(Self::new(over, name, points));
            }
        }
        Ok(growth)
    }
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
    use super::super::super::Better;
    use super::*;
    use crate::generate::{StandardScene, generate};
    use crate::scene::Geometry;
    use std::cell::Cell;
    use std::sync::atomic::AtomicBool;

    fn point(count: u64, seconds: f64) -> GrowthPoint {
        let seconds = Spread::of(vec![seconds], Better::Less);
        GrowthPoint { count, rays: RayCounts::default(), build_seconds: seconds, frame_seconds: seconds }
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

    /// Of a small picture: what growth is over, with its points, and the steps that were said and done.
    fn of_frames(mut scene: Scene) -> (Vec<(&'static str, Vec<GrowthPoint>)>, [u64; 2]) {
        (scene.image.width, scene.image.height) = (16, 8);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let steps = Cell::new(0);
        let options = BenchOptions {
            pool: &pool,
            repeat: 1,
            rays: 1,
            scratch: "".as_ref(),
            on_step: &|| steps.set(steps.get() + 1),
            stop: &AtomicBool::new(false),
        };
        let growth = Growth::of_frames("any", &scene, &options).unwrap();
        let growth = growth.into_iter().map(|growth| (growth.over, growth.points)).collect();
        (growth, [Growth::steps(&pool, 1), steps.get()])
    }

    #[test]
    fn rays_grow_with_what_grows() {
        let (growth, [said, done]) = of_frames(generate(StandardScene::Glass, 10).unwrap());
        assert_eq!(said, done);
        let over: Vec<_> = growth.iter().map(|(over, _)| *over).collect();
        assert_eq!(over, ["pixels", "threads", "samples", "lights", "levels"]);
        let counts = |of: usize| growth[of].1.iter().map(|point| point.count).collect::<Vec<_>>();
        let rays = |of: usize, kind: fn(&RayCounts) -> u64| {
            growth[of].1.iter().map(|point| kind(&point.rays)).collect::<Vec<_>>()
        };
        assert_eq!(counts(0), [4 * 2, 8 * 4, 16 * 8, 32 * 16]);
        assert_eq!(rays(0, |rays| rays.primary), counts(0));
        assert_eq!(counts(1), [1, 2]);
        assert_eq!(counts(2), [1, 4, 16]);
        assert_eq!(rays(2, |rays| rays.primary), [32, 4 * 32, 16 * 32]);
        assert_eq!(counts(3), [1, 2, 4, 8, 16]);
        assert_eq!(rays(3, |rays| rays.primary), [32; 5]);
        let shadow = rays(3, |rays| rays.shadow);
        assert!(shadow.is_sorted() && shadow[4] > 8 * shadow[0], "{shadow:?}");
        assert_eq!(counts(4)[..5], [1, 2, 3, 5, 9]);
        let (reflected, refracted) = (rays(4, |rays| rays.reflect), rays(4, |rays| rays.refract));
        assert_eq!((reflected[0], refracted[0]), (0, 0));
        assert!(reflected[1] > 0 && refracted[4] > refracted[1], "{reflected:?} {refracted:?}");
    }

    #[test]
    fn what_nothing_grows_with_is_left_out_and_its_steps_are_not() {
        let (growth, [said, done]) = of_frames(Scene::unlit(Geometry::default(), vec![]));
        let over: Vec<_> = growth.iter().map(|(over, _)| *over).collect();
        assert_eq!(over, ["pixels", "threads", "samples"]);
        assert_eq!(said, done);
    }
}
