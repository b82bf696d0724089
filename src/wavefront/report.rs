//! What the stages did, as a report says it.

use super::statistics::{Stage, Statistics};
use crate::prepare::Prepared;
use crate::traverse::LaneUse;
use serde::Serialize;
use std::collections::BTreeMap;

/// What one render did, summed over its workers.
#[derive(Clone, Debug, Serialize)]
pub struct WavefrontReport {
    /// Seconds of all workers together, by stage.
    pub stage_seconds: BTreeMap<&'static str, f64>,
    /// All stages over all depths, in the order in which rays go through them.
    pub stage_totals: Vec<StageTotal>,
    /// Stages at each depth at which they did something, in the order in which rays go through them.
    pub stages: Vec<StageReport>,
    /// What was done, whoever did it.
    pub counters: Counters,
    /// Bytes held.
    pub memory: MemoryReport,
}

/// A stage at one depth.
#[derive(Clone, Debug, Serialize)]
pub struct StageReport {
    /// Its name.
    pub stage: &'static str,
    /// Of the rays; primary rays are depth 0.
    pub depth: usize,
    /// Rows of the queue that it worked through.
    pub rows: u64,
    /// Seconds of all workers together.
    pub seconds: f64,
    /// Lanes that an operation worked on, and in how many of them there was something, in the mean; none where the stage
    /// has no lanes of its own.
    pub lanes: Option<LanesReport>,
}

/// A stage over all depths.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StageTotal {
    /// Its name.
    pub stage: &'static str,
    /// Rows of the queues that it worked through.
    pub rows: u64,
    /// Seconds of all workers together.
    pub seconds: f64,
    /// As of [`StageReport`].
    pub lanes: Option<LanesReport>,
}

/// How full lanes were.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LanesReport {
    /// Lanes of an operation, in the mean.
    pub width: f64,
    /// Lanes that held a row, or a ray and a primitive that it was to be tested against, in the mean.
    pub in_use: f64,
}

/// How often each thing was done that only some scenes need.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Counters {
    /// Pairs of a ray, or the bounds of a packet of rays, and a box.
    pub box_tests: u64,
    /// Pairs of a ray and a sphere.
    pub sphere_tests: u64,
    /// Pairs of a ray and a triangle.
    pub triangle_tests: u64,
    /// Pairs of a ray and an edge of a polygon.
    pub polygon_edge_tests: u64,
    /// Rays that walked the tree in packets.
    pub rays_in_packets: u64,
    /// Powers taken for highlights.
    pub powers: u64,
    /// Exponentials taken for absorption.
    pub exponentials: u64,
    /// Pairs of random numbers drawn for samples.
    pub random_pairs: u64,
}

/// Bytes held during a render.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MemoryReport {
    /// Queues of the worker that held most.
    pub queue_bytes_per_worker: usize,
    /// The hierarchy, with all that rays are tested against.
    pub hierarchy_bytes: usize,
}

impl WavefrontReport {
    pub(crate) fn new(statistics: &Statistics, prepared: &Prepared<'_>, queue_bytes: usize) -> Self {
        let mut stages = Vec::new();
        for (depth, works) in statistics.work.iter().enumerate() {
            for stage in Stage::ALL {
                let work = &works[stage as usize];
                let mut lanes = work.lanes;
                lanes += work.tests.all();
                if work.rows > 0 {
                    let seconds = work.time.as_secs_f64();
                    let (stage, rows) = (stage.name(), work.rows);
                    stages.push(StageReport { stage, depth, rows, seconds, lanes: LanesReport::new(&lanes) });
                }
            }
        }
        let total = |stage: Stage| {
            let work = statistics.total(stage);
            let mut lanes = work.lanes;
            lanes += work.tests.all();
            let seconds = work.time.as_secs_f64();
            StageTotal { stage: stage.name(), rows: work.rows, seconds, lanes: LanesReport::new(&lanes) }
        };
        let seconds = |stage: Stage| statistics.total(stage).time.as_secs_f64();
        let mut tests = statistics.total(Stage::Intersect).tests;
        tests += statistics.total(Stage::Occlude).tests;
        Self {
            stage_seconds: Stage::ALL.into_iter().map(|stage| (stage.name(), seconds(stage))).collect(),
            stage_totals: Stage::ALL.into_iter().map(total).collect(),
            stages,
            counters: Counters {
                box_tests: tests.boxes.used,
                sphere_tests: tests.spheres.used,
                triangle_tests: tests.triangles.used,
                polygon_edge_tests: tests.polygons.used,
                rays_in_packets: tests.in_packets,
                powers: statistics.powers,
                exponentials: statistics.exponentials,
                random_pairs: statistics.random_pairs,
            },
            memory: MemoryReport {
                queue_bytes_per_worker: queue_bytes,
                hierarchy_bytes: prepared.hierarchy.bytes().total(),
            },
        }
    }
}

impl LanesReport {
    fn new(lanes: &LaneUse) -> Option<Self> {
        let in_use = lanes.mean()?;
        Some(Self { width: lanes.lanes as f64 / lanes.calls as f64, in_use })
    }
}
