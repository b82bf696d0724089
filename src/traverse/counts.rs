//! What a walk did.

use std::ops::{Add, AddAssign};

/// Operations of lanes, and how many lanes held something that was wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LaneUse {
    /// Times that a kernel ran.
    pub(crate) calls: u64,
    /// Lanes of those calls.
    pub(crate) lanes: u64,
    /// Pairs of ray and primitive, or rows of a queue, that were in them.
    pub(crate) used: u64,
}

/// Tests made, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) boxes: LaneUse,
    pub(crate) spheres: LaneUse,
    pub(crate) triangles: LaneUse,
    pub(crate) polygons: LaneUse,
    /// Rays that walked in packets; the others walked alone.
    pub(crate) in_packets: u64,
}

impl LaneUse {
    /// One call.
    #[inline(always)]
    pub(crate) fn add(&mut self, lanes: usize, used: usize) {
        self.add_runs(1, lanes, used);
    }

    /// Calls that are alike.
    #[inline(always)]
    pub(crate) fn add_runs(&mut self, calls: usize, lanes: usize, used: usize) {
        self.calls += calls as u64;
        self.lanes += (calls * lanes) as u64;
        self.used += (calls * used) as u64;
    }

    /// Lanes in use in a call, in the mean; none where nothing was called.
    pub(crate) fn mean(&self) -> Option<f64> {
        (self.calls > 0).then(|| self.used as f64 / self.calls as f64)
    }
}

impl Counts {
    pub(crate) fn all(&self) -> LaneUse {
        let mut sum = self.boxes;
        sum += self.spheres;
        sum += self.triangles;
        sum += self.polygons;
        sum
    }
}

impl AddAssign for LaneUse {
    fn add_assign(&mut self, other: Self) {
        self.calls += other.calls;
        self.lanes += other.lanes;
        self.used += other.used;
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.boxes += other.boxes;
        self.spheres += other.spheres;
        self.triangles += other.triangles;
        self.polygons += other.polygons;
        self.in_packets += other.in_packets;
    }
}

impl Add for Counts {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}
