//! What the stages did, by depth.

use crate::rays::RayCounts;
use crate::traverse::{Counts, LaneUse};
use std::ops::AddAssign;
use std::time::{Duration, Instant};

/// The stages, in the order in which a batch goes through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    Generate,
    Intersect,
    Surface,
    Absorb,
    Illuminate,
    Occlude,
    Spawn,
    Resolve,
}

impl Stage {
    pub(crate) const ALL: [Self; 8] = [
        Self::Generate,
        Self::Intersect,
        Self::Surface,
        Self::Absorb,
        Self::Illuminate,
        Self::Occlude,
        Self::Spawn,
        Self::Resolve,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Generate => "generate",
            Self::Intersect => "intersect",
            Self::Surface => "surface",
            Self::Absorb => "absorb",
            Self::Illuminate => "illuminate",
            Self::Occlude => "occlude",
            Self::Spawn => "spawn",
            Self::Resolve => "resolve",
        }
    }
}

/// What a stage did at one depth.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Rows of its queue.
    pub(crate) rows: u64,
    /// Lanes of its own arithmetic; what the kernels did stands in [`Work::tests`].
    pub(crate) lanes: LaneUse,
    /// What the kernels did for it.
    pub(crate) tests: Counts,
    pub(crate) time: Duration,
}

/// What a worker did, or all of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Statistics {
    /// By depth, then by stage.
    pub(crate) work: Vec<[Work; Stage::ALL.len()]>,
    pub(crate) rays: RayCounts,
    /// Powers taken for highlights.
    pub(crate) powers: u64,
    /// Exponentials taken for absorption.
    pub(crate) exponentials: u64,
    /// Pairs of random numbers drawn.
    pub(crate) random_pairs: u64,
}

impl Statistics {
    /// What a stage has done so far at a depth.
    pub(crate) fn at(&mut self, depth: usize, stage: Stage) -> &mut Work {
        if self.work.len() <= depth {
            self.work.resize(depth + 1, Default::default());
        }
        &mut self.work[depth][stage as usize]
    }

    /// Does a stage's work and takes its time.
    pub(crate) fn timed<T>(&mut self, depth: usize, stage: Stage, work: impl FnOnce(&mut Work) -> T) -> T {
        let start = Instant::now();
        let at = self.at(depth, stage);
        let result = work(at);
        at.time += start.elapsed();
        result
    }

    /// The sum over all depths.
    pub(crate) fn total(&self, stage: Stage) -> Work {
        let mut sum = Work::default();
        for work in &self.work {
            sum += work[stage as usize];
        }
        sum
    }
}

impl AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.rows += other.rows;
        self.lanes += other.lanes;
        self.tests += other.tests;
        self.time += other.time;
    }
}

impl AddAssign<&Statistics> for Statistics {
    fn add_assign(&mut self, other: &Statistics) {
        for (depth, stages) in other.work.iter().enumerate() {
            for stage in Stage::ALL {
                *self.at(depth, stage) += stages[stage as usize];
            }
        }
        self.rays += other.rays;
        self.powers += other.powers;
        self.exponentials += other.exponentials;
        self.random_pairs += other.random_pairs;
    }
}
