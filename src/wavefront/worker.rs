//! The loop.

use super::absorb::absorb;
use super::generate::generate;
use super::illuminate;
use super::level::Level;
use super::queue::{HitQueue, NormalQueue, QueuePlan, RefractionQueue, ShadowQueue, SurfaceQueue};
use super::recorder::Recorder;
use super::resolve::{add_to_pixels, resolve};
use super::spawn::{Spawning, spawn};
use super::statistics::{Stage, Statistics};
use super::surface::{Batch, Sorted, surface};
use super::tiles::{Sample, Tiles};
use super::trail::{self, Keep, PixelRecord};
use crate::film::{Region, SamplePattern};
use crate::lanes::{Double, Single};
use crate::prepare::Prepared;
use crate::ray_tree::RayTree;
use crate::rays::RecordedRays;
use crate::traverse::{self, DEAD, Ends, NOTHING, Rays, Walker};
use std::sync::atomic::{AtomicBool, Ordering};

/// Rays of a batch. Their queues, up to 330 bytes a ray at the depth at hand, are meant to stay near a core's second-level
/// cache of 1 MiB or so.
pub const DEFAULT_BATCH: usize = 4096;

/// A region of the image as work for several workers.
pub(crate) struct TileGrid {
    tiles: Tiles,
}

impl TileGrid {
    pub(crate) fn new(region: Region, prepared: &Prepared<'_>, batch: usize) -> Self {
        Self { tiles: Tiles::new(region, prepared.plan.samples, batch) }
    }

    pub(crate) fn count(&self) -> u64 {
        self.tiles.count()
    }

    pub(crate) fn tile(&self, index: u64) -> Region {
        self.tiles.tile(index)
    }
}

/// A worker: its queues, used again for every batch, and what it has done.
pub(crate) struct Worker<'a> {
    prepared: &'a Prepared<'a>,
    pattern: SamplePattern,
    batch: usize,
    keep: Keep,
    /// It keeps more than colours.
    records: bool,
    samples: Vec<Sample>,
    /// By depth; made when a ray first gets so deep.
    levels: Vec<Level>,
    scratch: Scratch,
    walker: Walker,
    /// Where rays are to be kept.
    recorder: Option<Recorder>,
    stop: &'a AtomicBool,
    pub(crate) statistics: Statistics,
}

/// A tile, row by row.
pub(crate) struct TilePixels {
    pub(crate) colours: Vec<[f32; 3]>,
    /// Empty unless asked for.
    pub(crate) records: Vec<PixelRecord>,
}

/// Queues of the batch at hand, for whatever depth it is of.
struct Scratch {
    hits: HitQueue,
    sorted: Sorted,
    surfaces: SurfaceQueue,
    normals: NormalQueue,
    shadows: ShadowQueue,
    refractions: RefractionQueue,
}

impl Scratch {
    fn new(prepared: &Prepared<'_>, batch: usize) -> Self {
        let plan = &prepared.plan;
        let if_needed = |is_needed: bool| if is_needed { batch } else { 0 };
        let has_surfaces = plan.spheres + plan.triangles + plan.polygons > 0;
        Self {
            hits: HitQueue::with_capacity(batch),
            sorted: Sorted::with_capacity(
                [plan.spheres, plan.triangles, plan.polygons].map(|count| if_needed(count > 0)),
            ),
            surfaces: SurfaceQueue::with_capacity(if_needed(has_surfaces)),
            normals: NormalQueue::with_capacity(if_needed(plan.vertex_normals)),
            shadows: ShadowQueue::with_capacity(if_needed(plan.local_light)),
            refractions: RefractionQueue::with_capacity(if_needed(plan.refraction)),
        }
    }

    fn queues(&self) -> [QueuePlan; 5] {
        [
            self.hits.plan(),
            self.surfaces.plan(),
            self.normals.plan(),
            self.shadows.plan(),
            self.refractions.plan(),
        ]
    }
}

impl<'a> Worker<'a> {
    /// `batch` is a multiple of [`traverse::RUN`].
    pub(crate) fn new(prepared: &'a Prepared<'a>, batch: usize, keep: Keep, stop: &'a AtomicBool) -> Self {
        Self {
            prepared,
            pattern: SamplePattern::new(&prepared.scene.render),
            batch,
            keep,
            records: keep != Keep::Colours,
            samples: Vec::with_capacity(batch),
            levels: vec![Level::new(&prepared.plan, 0, batch, keep)],
            scratch: Scratch::new(prepared, batch),
            walker: Walker::new(),
            recorder: None,
            stop,
            statistics: Statistics::default(),
        }
    }

    /// Renders a tile of the grid, and keeps its rays.
    pub(crate) fn recorded_tile<F: Single>(
        &mut self,
        grid: &TileGrid,
        index: u64,
    ) -> (TilePixels, RecordedRays) {
        self.recorder = Some(Recorder::new(self.prepared));
        let pixels = self.tile::<F>(grid, index);
        (pixels, self.recorder.take().map(|recorder| recorder.rays).unwrap_or_default())
    }

    /// Renders a tile of the grid. Means nothing once the worker was told to stop.
    pub(crate) fn tile<F: Single>(&mut self, grid: &TileGrid, index: u64) -> TilePixels {
        let tile = grid.tile(index);
        let samples_per_pixel = self.prepared.plan.samples;
        let pixels = tile.width() as usize * tile.height() as usize;
        let mut sums = vec![[0.0; 3]; pixels];
        let mut records = vec![PixelRecord::NONE; if self.records { pixels } else { 0 }];
        let mut samples = grid.tiles.samples(tile);
        loop {
            samples.fill(&mut self.samples, self.batch);
            if self.samples.is_empty() || self.stop.load(Ordering::Relaxed) {
                break;
            }
            self.batch::<F>(&mut sums, &mut records);
        }
        let count = f64::from(samples_per_pixel);
        #[expect(clippy::cast_possible_truncation, reason = "the one rounding of a pixel to f32")]
        let mean = |sum: f64| (sum / count) as f32;
        TilePixels { colours: sums.into_iter().map(|sum| sum.map(mean)).collect(), records }
    }

    /// Traces the samples at hand.
    fn batch<F: Single>(&mut self, sums: &mut [[f64; 3]], records: &mut [PixelRecord]) {
        let (prepared, statistics) = (self.prepared, &mut self.statistics);
        statistics.rays.primary += self.samples.len() as u64;
        if prepared.plan.random_numbers {
            statistics.random_pairs += self.samples.len() as u64;
        }
        statistics.timed(0, Stage::Generate, |work| {
            work.rows += self.samples.len() as u64;
            let rays = &mut self.levels[0].rays;
            generate::<F::Double>(&prepared.view, &self.pattern, &self.samples, rays, &mut work.lanes);
        });
        self.trace::<F>(0);
        self.statistics.timed(0, Stage::Resolve, |_| {
            add_to_pixels(&self.samples, &self.levels[0].radiance, sums);
        });
        if self.records {
            trail::add_to_pixels(&self.samples, &self.levels[0].nodes, records);
        }
    }

    /// Finds what all rays of a level see: a batch of them at a time, each with all its descendants.
    fn trace<F: Single>(&mut self, depth: usize) {
        let count = self.levels[depth].rays.len();
        for first in (0..count).step_by(self.batch) {
            if self.stop.load(Ordering::Relaxed) {
                return;
            }
            self.intersect::<F>(depth, first, (count - first).min(self.batch));
            self.surface::<F::Double>(depth, first);
            if let Some(recorder) = &mut self.recorder {
                let Scratch { hits, surfaces, normals, .. } = &self.scratch;
                recorder.closest((&self.levels[depth], depth, first), hits, surfaces, normals);
            }
            self.illuminate::<F>(depth, first);
            let has_children = self.spawn::<F::Double>(depth);
            if has_children {
                self.trace::<F>(depth + 1);
            }
            self.resolve(depth, has_children);
        }
    }

    fn intersect<F: Single>(&mut self, depth: usize, first: usize, count: usize) {
        let (level, hits) = (&mut self.levels[depth], &mut self.scratch.hits);
        let walker = &mut self.walker;
        self.statistics.timed(depth, Stage::Intersect, |work| {
            work.rows += count as u64;
            let filled = count.next_multiple_of(traverse::RUN);
            fill_up(&mut level.rays.origin, first + count, first + filled);
            fill_up(&mut level.rays.direction, first + count, first + filled);
            hits.clear();
            hits.set_len(count);
            hits.t[..count].fill(f32::INFINITY);
            hits.t[count..filled].fill(DEAD);
            hits.id[..count].fill(NOTHING);
            let none = &[][..];
            let departures = &level.departures;
            let (departure, origin_low) = match depth {
                0 => (&[][..], [none; 3]),
                _ => (
                    &departures.departure[first..],
                    [0, 1, 2].map(|axis| &departures.origin_low[axis][first..]),
                ),
            };
            let rays = Rays {
                origin_low,
                origin: [0, 1, 2].map(|axis| &level.rays.origin[axis][first..]),
                direction: [0, 1, 2].map(|axis| &level.rays.direction[axis][first..]),
                departure,
                t_min: none,
                count,
            };
            let mut ends = Ends { t: &mut hits.t, id: &mut hits.id };
            walker.closest::<F>(&self.prepared.hierarchy, &rays, &mut ends, &mut work.tests);
        });
    }

    fn surface<D: Double>(&mut self, depth: usize, first: usize) {
        let prepared = self.prepared;
        let (level, scratch) = (&mut self.levels[depth], &mut self.scratch);
        let departures = (depth > 0).then_some(&level.departures);
        let batch = Batch { first, rays: &level.rays, departures, hits: &scratch.hits };
        self.statistics.timed(depth, Stage::Surface, |work| {
            let (sorted, surfaces, normals) =
                (&mut scratch.sorted, &mut scratch.surfaces, &mut scratch.normals);
            surface::<D>(prepared, &batch, sorted, surfaces, normals, &mut level.radiance, work);
            work.rows += surfaces.len() as u64;
        });
        if prepared.plan.absorption {
            let exponentials = self.statistics.timed(depth, Stage::Absorb, |work| {
                work.rows += scratch.surfaces.len() as u64;
                let departures = (depth > 0).then_some(&level.departures);
                absorb::<D>(
                    prepared,
                    (&level.rays, departures),
                    &scratch.surfaces,
                    &mut level.attenuations,
                    work,
                )
            });
            self.statistics.exponentials += exponentials;
        }
    }

    fn illuminate<F: Single>(&mut self, depth: usize, first: usize) {
        let prepared = self.prepared;
        let (level, scratch) = (&mut self.levels[depth], &mut self.scratch);
        let (surfaces, normals, shadows) = (&scratch.surfaces, &scratch.normals, &mut scratch.shadows);
        self.statistics.timed(depth, Stage::Illuminate, |_| {
            illuminate::begin(prepared, surfaces, &mut level.pending);
        });
        if self.records {
            trail::begin(prepared, level, first, &scratch.hits, surfaces, normals);
        }
        for light in &prepared.scene.lights {
            if !prepared.plan.local_light {
                if self.records {
                    trail::add_light(level, shadows);
                }
                continue;
            }
            let powers = self.statistics.timed(depth, Stage::Illuminate, |work| {
                work.rows += surfaces.len() as u64;
                illuminate::aim::<F::Double>(prepared, light, surfaces, normals, shadows, work)
            });
            self.statistics.powers += powers;
            self.statistics.rays.shadow += shadows.len() as u64;
            if let Some(recorder) = &mut self.recorder {
                recorder.shadow(shadows);
            }
            self.statistics.timed(depth, Stage::Occlude, |work| {
                work.rows += shadows.len() as u64;
                let count = shadows.len();
                let filled = count.next_multiple_of(traverse::RUN);
                fill_up(&mut shadows.origin, count, filled);
                fill_up(&mut shadows.direction, count, filled);
                shadows.t[count..filled].fill(DEAD);
                let rays = Rays {
                    origin: shadows.origin.each_ref().map(|column| &column[..]),
                    direction: shadows.direction.each_ref().map(|column| &column[..]),
                    origin_low: shadows.origin_low.each_ref().map(|column| &column[..]),
                    departure: &shadows.departure,
                    t_min: &[],
                    count,
                };
                let mut ends = Ends { t: &mut shadows.t, id: &mut [] };
                self.walker.occluded::<F>(&prepared.hierarchy, &rays, &mut ends, &mut work.tests);
            });
            self.statistics.timed(depth, Stage::Illuminate, |_| {
                illuminate::add_light(shadows, &mut level.pending);
            });
            if self.records {
                trail::add_light(level, shadows);
            }
        }
    }

    /// Fills the next level with the children of the surfaces at hand; false if there are none.
    fn spawn<D: Double>(&mut self, depth: usize) -> bool {
        let plan = &self.prepared.plan;
        if depth as u64 >= u64::from(plan.max_depth) || self.scratch.surfaces.len() == 0 {
            return false;
        }
        if self.levels.len() == depth + 1 {
            #[expect(clippy::cast_possible_truncation, reason = "a depth is at most 64")]
            self.levels.push(Level::new(plan, depth as u32 + 1, self.batch, self.keep));
        }
        let (upper, lower) = self.levels.split_at_mut(depth + 1);
        let (level, deeper) = (&mut upper[depth], &mut lower[0]);
        let scratch = &mut self.scratch;
        let mut counts = self.statistics.rays;
        self.statistics.timed(depth, Stage::Spawn, |work| {
            work.rows += scratch.surfaces.len() as u64;
            let mut queues = Spawning {
                surfaces: &scratch.surfaces,
                normals: &scratch.normals,
                refractions: &mut scratch.refractions,
                level,
                deeper,
            };
            spawn::<D>(self.prepared, &mut queues, depth == 0, &mut counts, work);
        });
        self.statistics.rays = counts;
        self.levels[depth + 1].rays.len() > 0
    }

    fn resolve(&mut self, depth: usize, has_children: bool) {
        let (upper, lower) = self.levels.split_at_mut(depth + 1);
        let level = &mut upper[depth];
        let deeper = lower.first().filter(|_| has_children);
        self.statistics.timed(depth, Stage::Resolve, |work| {
            work.rows += level.pending.len() as u64;
            resolve(level, deeper.map(|deeper| &deeper.radiance), self.prepared.plan.absorption);
        });
        if self.records {
            trail::resolve(level, lower.first_mut().filter(|_| has_children));
        }
    }

    /// Trees of the batch's samples, where they are kept.
    pub(super) fn primary_trees(&mut self) -> Vec<RayTree> {
        self.levels[0].trees.take().into_iter().flatten().flatten().collect()
    }

    /// The queues that all depths share.
    pub(super) fn shared_queues(&self) -> [QueuePlan; 5] {
        self.scratch.queues()
    }

    /// Memory of all queues.
    pub(crate) fn bytes(&self) -> usize {
        let samples = self.samples.capacity() * size_of::<Sample>();
        let shared: usize = self.shared_queues().iter().map(|queue| queue.bytes).sum();
        samples + self.scratch.sorted.bytes() + shared + self.levels.iter().map(Level::bytes).sum::<usize>()
    }
}

/// Repeats the last row to the end of a run, so that rows which only fill up go where the others go.
fn fill_up(columns: &mut [super::column::Column<f32>; 3], count: usize, filled: usize) {
    for column in columns {
        if let Some(&last) = count.checked_sub(1).and_then(|last| column.get(last)) {
            column[count..filled].fill(last);
        }
    }
}
