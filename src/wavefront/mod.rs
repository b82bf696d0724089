//! The wavefront engine: rays in queues, worked through stage by stage.
//!
//! A worker takes a tile of the image and runs it to the end, a batch of rays at a time, with queues of its own:
//!
//! | stage | from | to |
//! |---|---|---|
//! | `generate` | samples | rays |
//! | intersect (`traverse::Walker::closest`) | rays | hits |
//! | `surface` | rays, hits | surfaces; what misses sees the background |
//! | `absorb` | surfaces | attenuations |
//! | `illuminate` | surfaces, a light | shadow rays; once they are traced, local light |
//! | occlude (`traverse::Walker::occluded`) | shadow rays | which of them are occluded |
//! | `spawn` | surfaces | reflected and refracted rays, one level deeper |
//! | `resolve` | local light, what the children see | what the rays see |
//!
//! The children of a batch are traced to the end before the next batch, so the memory is that of one batch a depth, however
//! many rays there are. What an image is made of does not depend on batches, tiles, threads or lanes: hits do not (see
//! `traverse`), everything else is computed row by row, and sums have an order of their own.

mod absorb;
mod column;
mod elementary;
mod explain;
mod generate;
mod illuminate;
mod level;
mod materials;
mod optics;
mod outline;
mod queue;
mod recorder;
mod report;
mod resolve;
mod spawn;
mod statistics;
mod surface;
mod tiles;
mod trail;
mod tree;
#[cfg(test)]
mod twofold;
mod worker;

pub use explain::{AccuracyPlan, Explanation, HierarchyPlan, StagePlan};
pub use queue::{ColumnPlan, QueuePlan};
pub use report::{Counters, LanesReport, MemoryReport, StageReport, StageTotal, WavefrontReport};
pub(crate) use statistics::Statistics;
pub(crate) use trail::Keep;
pub use trail::PixelRecord;
pub(crate) use tree::pixel_tree;
pub use worker::DEFAULT_BATCH;
pub(crate) use worker::{TileGrid, TilePixels, Worker};
