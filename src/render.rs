//! Renders a region of a scene: makes the scene ready, spreads pixels over threads, counts rays, and stops when told to.

use crate::film::{Image, Region};
use crate::lanes::{self, Single, Width};
use crate::prepare::{PrepareError, Prepared};
use crate::ray_tree::{PixelTree, TreeTooLarge};
use crate::rays::{RayCounts, RecordedRays};
use crate::reference::Tracer;
use crate::scene::{ImageSettings, Scene};
use crate::traverse::RUN;
use crate::wavefront::{self, Keep, Statistics, TileGrid, TilePixels, WavefrontReport, Worker};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::num::NonZeroU64;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use thiserror::Error;

pub use crate::wavefront::{DEFAULT_BATCH, PixelRecord};

/// What traces the rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// The scalar f64 reference, one pixel at a time.
    Reference,
    /// The wavefront engine.
    Wavefront {
        /// Lanes of its kernels; they do not change the picture.
        width: Width,
        /// Rays of a batch, rounded up to a multiple of 64; they do not change the picture either.
        batch: usize,
        /// Whether to keep a record of what the rays of each pixel hit.
        records: bool,
        /// Whether to keep the rays themselves: those of every n-th tile of the image, or of none.
        rays: Option<NonZeroU64>,
    },
}

impl Engine {
    /// The wavefront engine as it is meant to be used.
    #[must_use]
    pub fn wavefront(width: Width) -> Self {
        Self::Wavefront { width, batch: DEFAULT_BATCH, records: false, rays: None }
    }
}

/// How to render, as opposed to what.
pub struct RenderOptions<'a> {
    /// What traces the rays.
    pub engine: Engine,
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
    /// What the rays of each pixel hit; empty unless asked for.
    pub records: Vec<PixelRecord>,
    /// The rays that were to be kept.
    pub recorded: RecordedRays,
    /// What the stages of the wavefront engine did; none for the reference.
    pub wavefront: Option<WavefrontReport>,
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
    /// The scene does not fit.
    #[error(transparent)]
    Prepare(#[from] PrepareError),
    /// No threads to be had.
    #[error("threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// Not a pixel of the image.
    #[error(
        "the pixel {x},{y} does not lie within the image of {width} x {height} pixels; the first is 0,0 at the top left and \
         the last {},{}",
        width.saturating_sub(1),
        height.saturating_sub(1)
    )]
    Pixel {
        /// Column that was asked for.
        x: u32,
        /// Row that was asked for.
        y: u32,
        /// Columns of the image.
        width: u32,
        /// Rows of the image.
        height: u32,
    },
    /// One pixel's tree of rays does not fit.
    #[error(transparent)]
    Tree(#[from] TreeTooLarge),
    /// [`RenderOptions::stop`] was set.
    #[error("interrupted")]
    Stopped,
}

/// Renders a region of a scene.
///
/// # Errors
/// A region outside the image, too little memory, or a render that was told to stop.
pub fn render(scene: &Scene, options: &RenderOptions<'_>) -> Result<Rendered, RenderError> {
    let (region, size) = (options.region, scene.image);
    if !region.fits(size.width, size.height) {
        return Err(RenderError::Region { region, width: size.width, height: size.height });
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
    let image = pool.install(|| Image::black(&region)).map_err(|_| RenderError::Memory(region.pixels()))?;
    match options.engine {
        Engine::Reference => with_reference(scene, options, &pool, image),
        Engine::Wavefront { width, batch, records, rays } => {
            let batch = batch.max(1).next_multiple_of(RUN);
            with_wavefront(scene, options, &pool, image, (width, batch, records, rays))
        }
    }
}

/// Every ray of one pixel, x and y from the full image's top left, and all that it meets: why the pixel is as it is.
///
/// # Errors
/// A pixel outside the image, a tree that is too large to be kept, or a render that was told to stop.
pub fn pixel_tree(
    scene: &Scene,
    engine: Engine,
    pixel @ [x, y]: [u32; 2],
    stop: &AtomicBool,
) -> Result<PixelTree, RenderError> {
    let ImageSettings { width, height, .. } = scene.image;
    if x >= width || y >= height {
        return Err(RenderError::Pixel { x, y, width, height });
    }
    let tree = match engine {
        Engine::Reference => {
            let tracer = Tracer::new(scene, stop);
            let mut counts = RayCounts::default();
            tracer.pixel(x, y, &mut counts);
            PixelTree::check_size(&counts, scene.lights.len()).map(|()| tracer.tree(x, y))
        }
        Engine::Wavefront { width, .. } => {
            let prepared = Prepared::new(scene)?;
            width.run(TracePixel { prepared: &prepared, pixel, stop })
        }
    };
    if stop.load(Ordering::Relaxed) { Err(RenderError::Stopped) } else { Ok(tree?) }
}

/// One pixel, for lanes of any width.
struct TracePixel<'a> {
    prepared: &'a Prepared<'a>,
    pixel: [u32; 2],
    stop: &'a AtomicBool,
}

impl lanes::Job for TracePixel<'_> {
    type Output = Result<PixelTree, TreeTooLarge>;

    fn run<F: Single>(self) -> Self::Output {
        wavefront::pixel_tree::<F>(self.prepared, self.pixel, self.stop)
    }
}

fn with_reference(
    scene: &Scene,
    options: &RenderOptions<'_>,
    pool: &rayon::ThreadPool,
    mut image: Image,
) -> Result<Rendered, RenderError> {
    let start = Instant::now();
    let tracer = Tracer::new(scene, options.stop);
    let prepare_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let rays = pool.install(|| trace_pixels(&tracer, options, &mut image)).ok_or(RenderError::Stopped)?;
    let trace_seconds = start.elapsed().as_secs_f64();
    let threads = pool.current_num_threads();
    Ok(Rendered {
        image,
        rays,
        threads,
        prepare_seconds,
        trace_seconds,
        records: Vec::new(),
        recorded: RecordedRays::default(),
        wavefront: None,
    })
}

/// Fills the image in short runs of pixels, so that the last thread to finish is not long alone; none if told to stop.
fn trace_pixels(tracer: &Tracer<'_>, options: &RenderOptions<'_>, image: &mut Image) -> Option<RayCounts> {
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

fn with_wavefront(
    scene: &Scene,
    options: &RenderOptions<'_>,
    pool: &rayon::ThreadPool,
    image: Image,
    (width, batch, wants_records, wants_rays): (Width, usize, bool, Option<NonZeroU64>),
) -> Result<Rendered, RenderError> {
    let start = Instant::now();
    let prepared = pool.install(|| Prepared::new(scene))?;
    let prepare_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let records = vec![PixelRecord::NONE; if wants_records { image.pixels.len() } else { 0 }];
    let tiles = TiledRender {
        prepared: &prepared,
        grid: TileGrid::new(options.region, &prepared, batch),
        batch,
        wants_records,
        wants_rays,
        options,
        next: AtomicU64::new(0),
        pixels_done: AtomicU64::new(0),
        result: Mutex::new((image, records)),
        recorded: Mutex::default(),
    };
    // One worker a thread, each with queues of its own.
    let workers = pool.broadcast(|_| width.run(RunWorker(&tiles)));
    let trace_seconds = start.elapsed().as_secs_f64();
    if options.stop.load(Ordering::Relaxed) {
        return Err(RenderError::Stopped);
    }
    let mut statistics = Statistics::default();
    let mut queue_bytes = 0;
    for (of_worker, bytes) in &workers {
        statistics += of_worker;
        queue_bytes = queue_bytes.max(*bytes);
    }
    let report = WavefrontReport::new(&statistics, &prepared, queue_bytes);
    let (image, records) = tiles.result.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut recorded = RecordedRays::default();
    for (_, rays) in tiles.recorded.into_inner().unwrap_or_else(PoisonError::into_inner) {
        recorded.append(rays);
    }
    Ok(Rendered {
        image,
        records,
        recorded,
        rays: statistics.rays,
        threads: pool.current_num_threads(),
        prepare_seconds,
        trace_seconds,
        wavefront: Some(report),
    })
}

/// A render that several workers take tiles of.
struct TiledRender<'a> {
    prepared: &'a Prepared<'a>,
    grid: TileGrid,
    batch: usize,
    wants_records: bool,
    wants_rays: Option<NonZeroU64>,
    options: &'a RenderOptions<'a>,
    /// The tile to be taken next.
    next: AtomicU64,
    pixels_done: AtomicU64,
    result: Mutex<(Image, Vec<PixelRecord>)>,
    /// By tile.
    recorded: Mutex<BTreeMap<u64, RecordedRays>>,
}

impl TiledRender<'_> {
    fn paste(&self, pixels: &TilePixels, tile: Region) {
        let region = self.options.region;
        let (image, records) = &mut *self.result.lock().unwrap_or_else(PoisonError::into_inner);
        let width = tile.width() as usize;
        for (row, y) in (tile.y0..tile.y1).enumerate() {
            let at = image.index(tile.x0 - region.x0, y - region.y0);
            let run = row * width..(row + 1) * width;
            image.pixels[at..at + width].copy_from_slice(&pixels.colours[run.clone()]);
            if self.wants_records {
                records[at..at + width].copy_from_slice(&pixels.records[run]);
            }
        }
    }
}

/// One worker, for lanes of any width: what it has done, and the bytes of its queues.
struct RunWorker<'a>(&'a TiledRender<'a>);

impl lanes::Job for RunWorker<'_> {
    type Output = (Statistics, usize);

    fn run<F: Single>(self) -> Self::Output {
        let RunWorker(render) = self;
        let keep = if render.wants_records { Keep::Signatures } else { Keep::Colours };
        let mut worker = Worker::new(render.prepared, render.batch, keep, render.options.stop);
        loop {
            let index = render.next.fetch_add(1, Ordering::Relaxed);
            if index >= render.grid.count() || render.options.stop.load(Ordering::Relaxed) {
                break;
            }
            let pixels = if render.wants_rays.is_some_and(|every| index % every == 0) {
                let (pixels, rays) = worker.recorded_tile::<F>(&render.grid, index);
                render.recorded.lock().unwrap_or_else(PoisonError::into_inner).insert(index, rays);
                pixels
            } else {
                worker.tile::<F>(&render.grid, index)
            };
            render.paste(&pixels, render.grid.tile(index));
            let pixels = render.grid.tile(index).pixels();
            let done = render.pixels_done.fetch_add(pixels, Ordering::Relaxed) + pixels;
            (render.options.on_progress)(done);
        }
        let bytes = worker.bytes();
        (worker.statistics, bytes)
    }
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
