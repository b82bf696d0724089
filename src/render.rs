//! Renders a region of a scene: makes the scene ready, spreads pixels over threads, counts rays, and stops when told to.

use crate::film::{Image, Region};
use crate::rays::RayCounts;
use crate::reference::Tracer;
use crate::scene::Scene;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;
use thiserror::Error;

/// How to render, as opposed to what.
pub struct RenderOptions<'a> {
    /// The part of the image to render.
    pub region: Region,
    /// Worker threads; 0 for one a core.
    pub threads: usize,
    /// Called with the number of pixels done so far, from any thread.
    pub on_progress: &'a (dyn Fn(u64) + Sync),
    /// Set to true, makes the render stop soon.
    pub stop: &'a AtomicBool,
}

/// A finished render.
pub struct Rendered {
    /// The region's pixels.
    pub image: Image,
    /// Rays traced for them.
    pub rays: RayCounts,
    /// Worker threads that were used.
    pub threads: usize,
    /// Wall-clock time to make the scene ready.
    pub prepare_seconds: f64,
    /// Wall-clock time to trace all rays.
    pub trace_seconds: f64,
}

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum RenderError {
    /// The region is empty or reaches over the image's edge.
    #[error("the crop {},{},{},{} does not lie within the image of {width} x {height} pixels", region.x0, region.y0, region.x1, region.y1)]
    Region {
        /// What was asked for.
        region: Region,
        /// Columns of the image.
        width: u32,
        /// Rows of the image.
        height: u32,
    },
    /// The picture does not fit.
    #[error("there is not enough memory for {0} pixels; render it in crops (--crop)")]
    Memory(u64),
    /// No threads to be had.
    #[error("threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// [`RenderOptions::stop`] was set.
    #[error("interrupted")]
    Stopped,
}

/// Renders with the f64 reference.
///
/// # Errors
/// A region outside the image, too little memory, or a render that was told to stop.
pub fn render(scene: &Scene, options: &RenderOptions<'_>) -> Result<Rendered, RenderError> {
    let (region, size) = (options.region, scene.image);
    if !region.fits(size.width, size.height) {
        return Err(RenderError::Region { region, width: size.width, height: size.height });
    }
    let mut image = Image::black(&region).map_err(|_| RenderError::Memory(region.pixels()))?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;

    let start = Instant::now();
    let tracer = Tracer::new(scene, options.stop);
    let prepare_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let rays = pool.install(|| trace(&tracer, options, &mut image)).ok_or(RenderError::Stopped)?;
    let trace_seconds = start.elapsed().as_secs_f64();
    Ok(Rendered { image, rays, threads: pool.current_num_threads(), prepare_seconds, trace_seconds })
}

/// Fills the image in short runs of pixels, so that the last thread to finish is not long alone; none if told to stop.
fn trace(tracer: &Tracer<'_>, options: &RenderOptions<'_>, image: &mut Image) -> Option<RayCounts> {
    const RUN: usize = 64;
    let region = options.region;
    let width = region.width() as usize;
    let done = AtomicU64::new(0);
    let runs = image.pixels.par_chunks_mut(RUN).enumerate();
    let counted = runs.map(|(run, pixels)| {
        let mut counts = RayCounts::default();
        for (index, pixel) in (run * RUN..).zip(pixels.iter_mut()) {
            let (x, y) = (region.x0 + low_32(index % width), region.y0 + low_32(index / width));
            *pixel = tracer.pixel(x, y, &mut counts).map(rounded);
        }
        if options.stop.load(Ordering::Relaxed) {
            return None; // these pixels may be black
        }
        let pixels = pixels.len() as u64;
        (options.on_progress)(done.fetch_add(pixels, Ordering::Relaxed) + pixels);
        Some(counts)
    });
    counted.try_reduce(RayCounts::default, |mut a, b| {
        a += b;
        Some(a)
    })
}

/// Columns and rows are below 2³².
#[expect(clippy::cast_possible_truncation, reason = "a column or row of a region, whose sides are u32")]
fn low_32(index: usize) -> u32 {
    index as u32
}

/// The one rounding from the reference's f64 to the picture's f32.
#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
fn rounded(channel: f64) -> f32 {
    channel as f32
}
