//! `wavelane explain SCENE`.

use super::{Failure, output};
use crate::lanes::{Isa, Width};
use crate::load;
use crate::prepare::Prepared;
use crate::render::RenderError;
use crate::wavefront::{AccuracyPlan, Explanation, QueuePlan};
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scene: a .toml, .nff, .obj or .ply file, or a folder of .npy arrays
    scene: PathBuf,
    /// Write the same as JSON, to stdout instead of the text if FILE is -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    output::check_json(arguments.json.as_deref(), &[&arguments.scene])?;
    let loaded = load::load(&arguments.scene)?;
    output::warnings(&loaded);
    let prepared = Prepared::new(&loaded.scene).map_err(RenderError::from)?;
    let explanation = Explanation::new(&prepared);
    if let Some(path) = &arguments.json {
        output::json(&explanation, path)?;
        if path.as_os_str() == "-" {
            return Ok(());
        }
    }
    let image = loaded.scene.image;
    let mut text = format!(
        "{}: {} x {} pixels, samples a pixel: {}\n",
        arguments.scene.display(),
        image.width,
        image.height,
        explanation.plan.samples
    );
    // Writing to a string does not fail.
    let _ = describe(&explanation, &mut text);
    output::result(&text.trim_end())
}

fn describe(explanation: &Explanation, text: &mut String) -> std::fmt::Result {
    let Explanation { plan, hierarchy, .. } = explanation;
    let primitives = plan.spheres + plan.triangles + plan.polygons;
    writeln!(
        text,
        "\ngeometry: {} spheres, {} triangles, {} polygons; {} lights; rays to depth {}",
        plan.spheres, plan.triangles, plan.polygons, plan.lights, plan.max_depth
    )?;
    let bytes = hierarchy.directory_bytes
        + hierarchy.node_bytes
        + hierarchy.sphere_bytes
        + hierarchy.triangle_bytes
        + hierarchy.polygon_bytes;
    writeln!(
        text,
        "hierarchy: {} nodes of 8 children, {} deep; {} bytes{}; a random ray costs {:.1} visits",
        hierarchy.nodes,
        hierarchy.depth,
        bytes,
        if primitives > 0 {
            format!(", {:.0} a primitive", bytes as f64 / primitives as f64)
        } else {
            String::new()
        },
        hierarchy.cost
    )?;
    writeln!(text, "lanes: {} of f32 ({})", Width::BEST.lanes(), Isa::BUILT_FOR)?;
    let AccuracyPlan { tests, undecided, surfaces, .. } = explanation.accuracy;
    writeln!(
        text,
        "accuracy: tests in {tests}, {undecided} where {tests} cannot tell, what follows a hit in {surfaces}; the same for every \
         scene, since there is one kernel for each kind of primitive"
    )?;
    writeln!(text, "\nstages, for a batch of {} rays:", explanation.batch)?;
    for stage in &explanation.stages {
        writeln!(text, "{}", format!("  {:<11} {}", stage.stage, stage.kernels.join(", ")).trim_end())?;
    }
    queues(text, "queues of a worker, shared by all depths", &explanation.shared_queues)?;
    queues(text, "queues of a worker, for primary rays", &explanation.primary_queues)?;
    queues(text, "queues of a worker, for each further depth", &explanation.deeper_queues)?;
    writeln!(text, "\na worker's queues take at most {} bytes", explanation.most_queue_bytes)
}

fn queues(text: &mut String, title: &str, queues: &[QueuePlan]) -> std::fmt::Result {
    if queues.is_empty() {
        return Ok(());
    }
    writeln!(text, "\n{title}:")?;
    for queue in queues {
        let row: usize = queue.columns.iter().map(|column| column.bytes).sum();
        writeln!(text, "  {}: {} rows of {row} bytes", queue.name, queue.rows)?;
        for column in queue.columns {
            writeln!(text, "    {:<16} {:<7} {}", column.name, column.r#type, column.what)?;
        }
    }
    Ok(())
}
