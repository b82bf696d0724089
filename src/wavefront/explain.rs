//! What will run for a scene, and on what memory, without running it.

use super::level::Level;
use super::queue::QueuePlan;
use super::statistics::Stage;
use super::trail::Keep;
use super::worker::{DEFAULT_BATCH, Worker};
use crate::prepare::{Plan, Prepared};
use serde::Serialize;
use std::sync::atomic::AtomicBool;

/// What a scene needs of the engine, and so what will run.
#[derive(Clone, Debug, Serialize)]
pub struct Explanation {
    /// The very object that the loop goes by.
    pub plan: Plan,
    /// Rays of a batch.
    pub batch: usize,
    /// In the order in which a batch goes through them; those that do not run are left out.
    pub stages: Vec<StagePlan>,
    /// Queues of one worker that all depths share.
    pub shared_queues: Vec<QueuePlan>,
    /// Queues of one worker for primary rays.
    pub primary_queues: Vec<QueuePlan>,
    /// Queues of one worker for each further depth that rays get to; empty where there is none.
    pub deeper_queues: Vec<QueuePlan>,
    /// Bytes of a worker's queues, if rays get as deep as they may.
    pub most_queue_bytes: usize,
    /// What rays walk.
    pub hierarchy: HierarchyPlan,
    /// What is computed in which numbers.
    pub accuracy: AccuracyPlan,
}

/// What is computed in which numbers. Nothing of it is chosen for a scene: one kernel serves each kind of primitive, since none
/// of those that are faster is right often enough, and none that is more exact shows (docs/accuracy.md).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct AccuracyPlan {
    /// Rays against boxes and primitives.
    pub tests: &'static str,
    /// Where the tests cannot tell which of two hits is nearer, or on which side of an edge or of a surface a ray is.
    pub undecided: &'static str,
    /// What follows a hit: its place, normals, directions and light; rounded to f32 once.
    pub surfaces: &'static str,
    /// Kernels that could be chosen for a kind of primitive.
    pub kernels_to_choose_from: u32,
}

impl AccuracyPlan {
    const ALWAYS: Self = Self { tests: "f32", undecided: "f64", surfaces: "f64", kernels_to_choose_from: 1 };
}

/// A stage that will run.
#[derive(Clone, Debug, Serialize)]
pub struct StagePlan {
    /// Its name.
    pub stage: &'static str,
    /// The kernels and functions that it needs for this scene.
    pub kernels: Vec<&'static str>,
}

/// The tree over all primitives.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct HierarchyPlan {
    /// Nodes of eight children.
    pub nodes: usize,
    /// Nodes on the longest way down.
    pub depth: u32,
    /// Visits of a node that a random ray through the scene is expected to cost, leaves included.
    pub cost: f64,
    /// Memory of the nodes.
    pub node_bytes: usize,
    /// Memory of the blocks of spheres.
    pub sphere_bytes: usize,
    /// Memory of the blocks of triangles.
    pub triangle_bytes: usize,
    /// Memory of the polygons and their corners.
    pub polygon_bytes: usize,
    /// Memory of the table from ids to primitives.
    pub directory_bytes: usize,
}

impl Explanation {
    /// Looks at what a prepared scene will need.
    #[must_use]
    pub fn new(prepared: &Prepared<'_>) -> Self {
        let plan = prepared.plan;
        let stop = AtomicBool::new(false);
        let worker = Worker::new(prepared, DEFAULT_BATCH, Keep::Colours, &stop);
        let deeper = (plan.max_depth > 0).then(|| Level::new(&plan, 1, DEFAULT_BATCH, Keep::Colours));
        let deeper_bytes = deeper.as_ref().map_or(0, Level::bytes);
        let needed =
            |queues: &[QueuePlan]| queues.iter().filter(|queue| queue.rows > 0).cloned().collect::<Vec<_>>();
        let bytes = prepared.hierarchy.bytes();
        Self {
            plan,
            batch: DEFAULT_BATCH,
            stages: Stage::ALL.into_iter().filter_map(|stage| stage_plan(&plan, stage)).collect(),
            shared_queues: needed(&worker.shared_queues()),
            primary_queues: needed(&Level::new(&plan, 0, DEFAULT_BATCH, Keep::Colours).queues()),
            deeper_queues: deeper.map_or(Vec::new(), |level| needed(&level.queues())),
            most_queue_bytes: worker.bytes() + plan.max_depth as usize * deeper_bytes,
            hierarchy: HierarchyPlan {
                nodes: prepared.hierarchy.nodes.len(),
                depth: prepared.hierarchy.depth,
                cost: prepared.hierarchy.cost,
                node_bytes: bytes.nodes,
                sphere_bytes: bytes.spheres,
                triangle_bytes: bytes.triangles,
                polygon_bytes: bytes.polygons,
                directory_bytes: prepared.directory.bytes(),
            },
            accuracy: AccuracyPlan::ALWAYS,
        }
    }
}

/// What a stage needs for a scene; none where it does not run.
fn stage_plan(plan: &Plan, stage: Stage) -> Option<StagePlan> {
    let has_surfaces = plan.spheres + plan.triangles + plan.polygons > 0;
    let tests = [
        (has_surfaces, "box"),
        (plan.spheres > 0, "sphere"),
        (plan.triangles > 0, "triangle"),
        (plan.polygons > 0, "polygon"),
    ];
    let (runs, kernels): (bool, &[(bool, &'static str)]) = match stage {
        Stage::Generate => (true, &[(plan.random_numbers, "random numbers")]),
        Stage::Intersect => (true, &tests),
        Stage::Surface => {
            (has_surfaces, &[tests[1], tests[2], tests[3], (plan.vertex_normals, "vertex normals")])
        }
        Stage::Absorb => (plan.absorption, &[(true, "exponential")]),
        Stage::Illuminate => (
            has_surfaces,
            &[(true, "ambient"), (plan.local_light, "diffuse"), (plan.highlights, "highlights: power")],
        ),
        Stage::Occlude => (plan.local_light, &tests),
        Stage::Spawn => {
            (plan.max_depth > 0, &[(plan.reflection, "reflection"), (plan.refraction, "refraction")])
        }
        Stage::Resolve => (true, &[]),
    };
    let kernels = kernels.iter().filter(|(is_needed, _)| *is_needed).map(|(_, kernel)| *kernel).collect();
    runs.then(|| StagePlan { stage: stage.name(), kernels })
}
