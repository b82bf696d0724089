//! What it took to find hits: counted, not timed, so the same at any time and on any machine with as many lanes and threads. With
//! threads it changes a little, since each is given a share of the rays and puts those together that it has.

use crate::traverse::{Counts, LaneUse};
use serde::Serialize;
use std::fmt;

/// Runs of the kernels in a pass, and who walked how.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TestsMade {
    /// Share of the rays that walked in packets; the others walked in streams.
    pub in_packets: f64,
    /// Of boxes; bounds of all rays of a packet are tested against eight boxes at a time.
    pub boxes: Option<KernelRuns>,
    /// Of spheres.
    pub spheres: Option<KernelRuns>,
    /// Of triangles.
    pub triangles: Option<KernelRuns>,
    /// Of edges of polygons.
    pub edges: Option<KernelRuns>,
}

/// Runs of one kernel. A run tests as many pairs of a ray and a primitive as it has lanes.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct KernelRuns {
    /// For each ray, in the mean.
    pub per_ray: f64,
    /// Lanes of a run, in the mean.
    pub lanes: f64,
    /// Those of them that held a pair that was asked for.
    pub in_use: f64,
}

impl TestsMade {
    pub(super) fn new(counts: &Counts, rays: usize) -> Option<Self> {
        let of = |kernel: &LaneUse| KernelRuns::new(kernel, rays);
        (rays > 0).then(|| Self {
            in_packets: counts.in_packets as f64 / rays as f64,
            boxes: of(&counts.boxes),
            spheres: of(&counts.spheres),
            triangles: of(&counts.triangles),
            edges: of(&counts.polygons),
        })
    }
}

impl KernelRuns {
    /// None where the kernel did not run.
    fn new(kernel: &LaneUse, rays: usize) -> Option<Self> {
        let calls = kernel.calls as f64;
        Some(Self {
            per_ray: calls / rays as f64,
            lanes: kernel.lanes as f64 / calls,
            in_use: kernel.mean()?,
        })
    }
}

impl fmt::Display for TestsMade {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "kernel runs for each ray (lanes, those in use):")?;
        let kinds = [
            ("boxes", self.boxes),
            ("spheres", self.spheres),
            ("triangles", self.triangles),
            ("edges", self.edges),
        ];
        for (name, runs) in kinds {
            if let Some(KernelRuns { per_ray, lanes, in_use }) = runs {
                write!(f, " {name} {per_ray:.2} ({lanes:.1}, {in_use:.1}),")?;
            }
        }
        write!(f, " {:.0} % of the rays in packets", 100.0 * self.in_packets)
    }
}
