//! The rungs: each choice that trades speed for accuracy, run as variants, each with its speed beside its error.
//!
//! - `kernels`: formulas for the tests of rays against boxes, spheres, triangles and polygons, on a frame's own rays
//! - `min_weight`: leaving out rays that carry little light
//! - `samples`: how many samples a pixel, and where they lie
//! - `all`: every rung that a scene has
//!
//! All is the same from run to run but for times. Nothing that is undefined gets a number: a rung that a scene does not have
//! is none, and so is a percentile of nothing.

pub mod kernels;
pub mod min_weight;
pub mod samples;

mod all;

pub use all::Rungs;

use crate::film::Region;
use crate::lanes::Width;
use crate::render::{Engine, RenderError, RenderOptions, Rendered, render};
use crate::scene::Scene;
use std::sync::atomic::{AtomicBool, Ordering};

/// How to measure.
pub struct RungOptions<'a> {
    /// Lanes of the wavefront engine and of its kernels.
    pub width: Width,
    /// Threads for whatever is not timed on one; 0 for one a core.
    pub threads: usize,
    /// How often each variant is timed, in turn with the others; at least once.
    pub repeats: usize,
    /// Called before each step.
    pub on_progress: &'a (dyn Fn(Progress) + Sync),
    /// Set to true, makes the measurement stop soon.
    pub stop: &'a AtomicBool,
}

/// How far a measurement is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is being done.
    pub what: &'static str,
    /// Steps that are done.
    pub done: usize,
    /// Steps of the rung.
    pub steps: usize,
}

impl RungOptions<'_> {
    fn rounds(&self) -> usize {
        self.repeats.max(1)
    }

    /// Says what comes next, unless it is told to stop.
    fn step(&self, what: &'static str, done: usize, steps: usize) -> Result<(), RenderError> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(RenderError::Stopped);
        }
        (self.on_progress)(Progress { what, done, steps });
        Ok(())
    }
}

/// A whole frame.
fn rendered(scene: &Scene, engine: Engine, options: &RungOptions<'_>) -> Result<Rendered, RenderError> {
    let region = Region::whole(scene.image.width, scene.image.height);
    let (threads, stop) = (options.threads, options.stop);
    render(scene, &RenderOptions { engine, region, threads, on_progress: &|_| {}, stop })
}

/// The same view on so many pixels at most, of the same shape as far as whole pixels go.
fn shrunk(scene: &Scene, most_pixels: u32) -> Scene {
    let mut scene = scene.clone();
    let [width, height] = [scene.image.width, scene.image.height].map(f64::from);
    let factor = (f64::from(most_pixels) / (width * height)).sqrt();
    if factor < 1.0 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "less than it was")]
        let side = |length: f64, most: u32| ((length * factor) as u32).clamp(1, most);
        let width = side(width, most_pixels);
        (scene.image.width, scene.image.height) = (width, side(height, most_pixels / width));
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Geometry;

    #[test]
    fn a_large_picture_shrinks_to_so_many_pixels_and_keeps_its_shape_and_a_small_one_stays() {
        let sizes = [
            ([800, 600], [104, 78]),
            ([512, 512], [90, 90]),
            ([64, 48], [64, 48]),
            ([100_000, 1], [8192, 1]),
        ];
        for ([width, height], expected) in sizes.into_iter().chain([([1, 100_000], [1, 8192])]) {
            let mut scene = Scene::unlit(Geometry::default(), Vec::new());
            (scene.image.width, scene.image.height) = (width, height);
            let image = shrunk(&scene, 1 << 13).image;
            assert_eq!([image.width, image.height], expected, "of {width} x {height}");
        }
    }
}
