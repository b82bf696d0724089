//! `wavelane render SCENE --pixel X,Y`: why one pixel is as it is.

mod number;
mod text;

use super::{Failure, interrupt, output};
use crate::lanes::{Isa, Width};
use crate::measure::{Row, TreeComparison};
use crate::ray_tree::PixelTree;
use crate::render::{self, Engine};
use crate::scene::Scene;
use serde::Serialize;
use std::path::Path;

/// What is set beside the reference.
#[derive(Clone, Copy)]
pub(super) struct WavefrontEngine {
    pub(super) name: &'static str,
    pub(super) width: Width,
}

/// The pixel of the command line.
pub(super) fn place(word: &str) -> Result<[u32; 2], String> {
    let place =
        word.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    place.ok_or_else(|| "a pixel is written X,Y, column and row from the top left, like 400,300".to_owned())
}

/// The JSON result.
#[derive(Serialize)]
struct Report<'a> {
    version: &'static str,
    scene: &'a Path,
    /// Width and height of the full image.
    size: [u32; 2],
    /// Column and row from its top left.
    pixel: [u32; 2],
    sampling: &'static str,
    /// n of n × n samples.
    samples: u32,
    max_depth: u32,
    engine: &'static str,
    lanes: u32,
    isa: Isa,
    verdict: &'a str,
    first_difference: Option<&'a Row>,
    parting: Option<&'a Row>,
    reference_tree: &'a PixelTree,
    engine_tree: &'a PixelTree,
}

/// Prints the trees of a pixel; writes them as JSON where that is asked for, instead of the text if to stdout.
pub(super) fn print(
    path: &Path,
    scene: &Scene,
    pixel: [u32; 2],
    engine: WavefrontEngine,
    json: Option<&Path>,
) -> Result<(), Failure> {
    let [reference_tree, engine_tree] = interrupt::watched(|stop| {
        let tree = |engine| render::pixel_tree(scene, engine, pixel, stop);
        Ok::<_, Failure>([tree(Engine::Reference)?, tree(Engine::wavefront(engine.width))?])
    })?;
    interrupt::end_if_asked();
    let comparison = TreeComparison::new(&reference_tree, &engine_tree);
    let verdict = text::verdict(&comparison);
    if let Some(json) = json {
        let row = |index: Option<usize>| index.and_then(|index| comparison.rows.get(index));
        let report = Report {
            version: env!("CARGO_PKG_VERSION"),
            scene: path,
            size: [scene.image.width, scene.image.height],
            pixel,
            sampling: scene.render.sampling.name(),
            samples: scene.render.samples,
            max_depth: scene.render.max_depth,
            engine: engine.name,
            lanes: engine.width.lanes(),
            isa: Isa::BUILT_FOR,
            verdict: &verdict,
            first_difference: row(comparison.first_difference),
            parting: row(comparison.parting),
            reference_tree: &reference_tree,
            engine_tree: &engine_tree,
        };
        output::json(&report, json)?;
        if json == Path::new("-") {
            return Ok(());
        }
    }
    let [x, y] = pixel;
    let heading = format!(
        "{}: pixel {x},{y} of {} x {}, samples: {}\nf64 is the reference, f32 the {} engine ({}); where they agree to \
         f32, one line\n",
        path.display(),
        scene.image.width,
        scene.image.height,
        reference_tree.samples.len(),
        engine.name,
        match engine.width.lanes() {
            1 => "1 lane".to_owned(),
            lanes => format!("{lanes} lanes"),
        }
    );
    let rows = text::rows(&comparison, scene);
    let rays = text::rays([&reference_tree, &engine_tree]);
    output::result(&format!("{heading}{rows}\n{rays}\n{verdict}"))
}
