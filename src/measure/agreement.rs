//! How far the wavefront engine is from the truth, beside how far f32 queues alone would put it.

use super::Difference;
use crate::film::{Image, Region};
use crate::lanes::Width;
use crate::reference::{Precision, Tracer};
use crate::render::{DEFAULT_BATCH, Engine, RenderError, RenderOptions, Rendered, render};
use crate::scene::Scene;
use rayon::prelude::*;
use serde::Serialize;
use std::sync::atomic::AtomicBool;

/// The wavefront engine against the f64 reference, on one picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Agreement {
    /// Pixels of the picture.
    pub pixels: u64,
    /// The engine's picture against the truth.
    pub engine: Distance,
    /// The floor: the reference with what the queues hold of rays and hits rounded to f32, against the truth.
    pub floor: Distance,
    /// Pixels whose first primary ray hits another primitive than in truth, though no rounding of f32 explains it.
    pub wrong_primaries: u64,
    /// Pixels whose first primary ray hits another primitive within rounding of an edge.
    pub uncertain_primaries: u64,
    /// Pixels in which every ray hits what it hits in truth, and every hit sees the lights that it sees in truth.
    pub same_trees: u64,
    /// Those of them that are over the limit.
    pub same_trees_over: u64,
}

/// How far a picture is from the truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distance {
    /// Root of the mean of the squared differences of all channels, linear.
    pub rms: f64,
    /// The largest difference of a channel, linear.
    pub largest: f64,
    /// Pixels with a channel that differs by more than [`Self::LIMIT`].
    pub pixels_over: u64,
}

impl Agreement {
    /// Renders a scene three times and compares.
    ///
    /// # Errors
    /// What keeps the wavefront engine from rendering it.
    pub fn measure(scene: &Scene, width: Width) -> Result<Self, RenderError> {
        let engine = Engine::Wavefront { width, batch: DEFAULT_BATCH, records: true, rays: None };
        let found = rendered(scene, engine)?;
        let stop = AtomicBool::new(false);
        let exact = Tracer::new(scene, &stop);
        let rounded = Tracer::with_precision(scene, Precision::F32Queues, &stop);
        let truth = picture(scene, &exact)?;
        let floor = picture(scene, &rounded)?;

        let image_width = scene.image.width as usize;
        let at = |index: usize| {
            let [x, y] =
                [index % image_width, index / image_width].map(|place| u32::try_from(place).unwrap_or(0));
            (x, y)
        };
        let counts = found.records.par_iter().enumerate().map(|(index, record)| {
            let (x, y) = at(index);
            let primary = exact.primary_hit(x, y, 0);
            let differs = primary.id != record.primary;
            let is_same_tree = exact.signature(x, y) == record.signature;
            let is_over = (0..3).any(|channel| {
                let [a, b] = [&truth, &found.image].map(|image| f64::from(image.pixels[index][channel]));
                (a - b).abs() > Distance::LIMIT
            });
            [
                differs && primary.is_certain,
                differs && !primary.is_certain,
                is_same_tree,
                is_same_tree && is_over,
            ]
            .map(u64::from)
        });
        let [wrong_primaries, uncertain_primaries, same_trees, same_trees_over] =
            counts.reduce(|| [0; 4], |a, b| [0, 1, 2, 3].map(|which| a[which] + b[which]));
        Ok(Self {
            pixels: truth.pixels.len() as u64,
            engine: Distance::between(&truth, &found.image),
            floor: Distance::between(&truth, &floor),
            wrong_primaries,
            uncertain_primaries,
            same_trees,
            same_trees_over,
        })
    }
}

impl Distance {
    /// What shows: a step of an 8-bit channel.
    pub const LIMIT: f64 = 1.0 / 255.0;

    pub(super) const ZERO: Self = Self { rms: 0.0, largest: 0.0, pixels_over: 0 };

    pub(super) fn between(truth: &Image, image: &Image) -> Self {
        let none = Self { rms: f64::NAN, largest: f64::NAN, pixels_over: 0 };
        Difference::between(truth, image, Self::LIMIT).map_or(none, |difference| Self {
            rms: difference.rms,
            largest: difference.largest,
            pixels_over: difference.pixels_over,
        })
    }
}

fn rendered(scene: &Scene, engine: Engine) -> Result<Rendered, RenderError> {
    let options = RenderOptions {
        engine,
        region: Region::whole(scene.image.width, scene.image.height),
        threads: 0,
        on_progress: &|_| {},
        stop: &AtomicBool::new(false),
    };
    render(scene, &options)
}

pub(super) fn picture(scene: &Scene, tracer: &Tracer<'_>) -> Result<Image, RenderError> {
    let region = Region::whole(scene.image.width, scene.image.height);
    let mut image = Image::black(&region).map_err(|_| RenderError::Memory(region.pixels()))?;
    let width = scene.image.width as usize;
    image.pixels.par_chunks_mut(width).zip(0..scene.image.height).for_each(|(row, y)| {
        for (pixel, x) in row.iter_mut().zip(0..) {
            #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
            let rounded = |channel: f64| channel as f32;
            *pixel = tracer.pixel(x, y, &mut crate::rays::RayCounts::default()).map(rounded);
        }
    });
    Ok(image)
}
