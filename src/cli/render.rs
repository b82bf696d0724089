//! `wavelane render SCENE -o OUT`, and `--pixel X,Y` instead of `-o OUT`.

use super::engine::EngineArguments;
use super::progress::{Progress, Style};
use super::settings::SceneSettings;
use super::{Failure, interrupt, on_threads, output, pixel};
use crate::film::{self, BitDepth, Region};
use crate::lanes::Isa;
use crate::lanes::Width;
use crate::load;
use crate::measure::{self, Machine, RenderReport, Seconds};
use crate::rays::RayKind;
use crate::render::{self, RenderOptions, Rendered};
use crate::scene::Scene;
use crate::trace;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scene: a .toml, .nff, .obj or .ply file, or a folder of .npy arrays
    scene: PathBuf,
    /// Picture to write: .png (sRGB), .exr or .npy (linear f32)
    #[arg(short, long, value_name = "OUT", required_unless_present = "pixel")]
    output: Option<PathBuf>,
    #[command(flatten)]
    engine: EngineArguments,
    #[command(flatten)]
    settings: SceneSettings,
    /// Render only this part, pixels from the top left, X1 and Y1 excluded; the file holds the part alone
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop)]
    crop: Option<Region>,
    /// Instead of a picture, print every ray of one pixel (from the top left) and what it met, the f64 reference beside the
    /// engine; --json then writes both trees
    #[arg(long, value_name = "X,Y", value_parser = pixel::place,
          conflicts_with_all = ["output", "crop", "bits", "threads", "progress", "record_rays"])]
    pixel: Option<[u32; 2]>,
    /// Write the rays of the frame into this folder, by kind: primary.npy, shadow.npy, reflect.npy and refract.npy, of shape
    /// (R, 8), f32: origin xyz, tmin, direction xyz, tmax. They are kept in memory until then: 52 to 64 bytes a ray
    #[arg(long, value_name = "DIR")]
    record_rays: Option<PathBuf>,
    /// Bits a channel of a PNG
    #[arg(long, value_name = "BITS", value_parser = ["8", "16"], default_value = "8")]
    bits: String,
    /// How far the render is, on stderr
    #[arg(long, value_enum, default_value = "auto")]
    progress: Style,
    /// Write a report of the run as JSON, to stdout if FILE is -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

fn crop(word: &str) -> Result<Region, String> {
    let edges: Option<Vec<u32>> = word.split(',').map(|edge| edge.trim().parse().ok()).collect();
    match edges.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Region { x0, y0, x1, y1 }),
        Some([_, _, _, _]) => Err("a crop X0,Y0,X1,Y1 needs X0 < X1 and Y0 < Y1".to_owned()),
        _ => Err("a crop is written X0,Y0,X1,Y1, like 0,0,320,240".to_owned()),
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.engine.warn_of_useless_lanes();
    match (arguments.pixel, &arguments.output) {
        (Some(place), _) => print_pixel(arguments, place),
        (None, Some(output)) => write_picture(arguments, output),
        (None, None) => Err(Failure::Usage("a picture to write is missing: -o OUT".to_owned())),
    }
}

/// Loads the scene, with the command line's settings in the place of its own.
fn load_scene(arguments: &Arguments) -> Result<Scene, Failure> {
    let mut loaded = load::load(&arguments.scene)?;
    output::warnings(&loaded);
    arguments.settings.apply(&mut loaded.scene);
    Ok(loaded.scene)
}

fn print_pixel(arguments: &Arguments, place: [u32; 2]) -> Result<(), Failure> {
    let Some(width) = arguments.engine.width() else {
        let message =
            "--pixel shows an engine beside the reference, which is no such engine: --engine simd or scalar";
        return Err(Failure::Usage(message.to_owned()));
    };
    output::check_json(arguments.json.as_deref(), &[&arguments.scene])?;
    let scene = load_scene(arguments)?;
    let engine = pixel::WavefrontEngine { name: arguments.engine.name(), width };
    pixel::print(&arguments.scene, &scene, place, engine, arguments.json.as_deref())
}

fn write_picture(arguments: &Arguments, output: &Path) -> Result<(), Failure> {
    film::Format::of(output)?;
    if arguments.record_rays.is_some() && arguments.engine.width().is_none() {
        let message =
            "--record-rays: rays are recorded from the simd or the scalar engine, not from the reference";
        return Err(Failure::Usage(message.into()));
    }
    let start = Instant::now();
    let scene = load_scene(arguments)?;
    let load = start.elapsed().as_secs_f64();
    film::check_writable(output)?;
    let recorded =
        arguments.record_rays.as_deref().map(|folder| RayKind::ALL.map(|kind| trace::ray_file(folder, kind)));
    let mut written = vec![output];
    written.extend(recorded.iter().flatten().map(PathBuf::as_path));
    let read = [arguments.scene.as_path()];
    output::check_distinct(&written, &read)?;
    output::check_json(arguments.json.as_deref(), &[&written[..], &read].concat())?;

    arguments.engine.warn_of_unused_instructions(arguments.progress);

    let whole = Region::whole(scene.image.width, scene.image.height);
    let region = arguments.crop.unwrap_or(whole);
    let progress = Progress::new(arguments.progress, region.pixels(), "pixels");
    let rendered = interrupt::watched(|stop| {
        let options = RenderOptions {
            engine: match arguments.engine.width() {
                Some(width) => render::Engine::Wavefront {
                    width,
                    batch: render::DEFAULT_BATCH,
                    records: false,
                    rays: arguments.record_rays.as_ref().map(|_| NonZeroU64::MIN),
                },
                None => render::Engine::Reference,
            },
            region,
            threads: arguments.engine.threads(),
            on_progress: &|done| progress.report(done),
            stop,
        };
        render::render(&scene, &options)
    });
    progress.finish();
    let rendered = rendered?;
    interrupt::end_if_asked();

    let write_start = Instant::now();
    let depth = if arguments.bits == "16" { BitDepth::Sixteen } else { BitDepth::Eight };
    on_threads(arguments.engine.threads(), || film::write(&rendered.image, output, depth))??;
    if let Some(folder) = &arguments.record_rays {
        trace::write_rays(&scene.geometry, &rendered.recorded, folder)
            .map_err(|(path, why)| Failure::Write { path, why })?;
    }
    let seconds = Seconds {
        load,
        prepare: rendered.prepare_seconds,
        trace: rendered.trace_seconds,
        write: write_start.elapsed().as_secs_f64(),
        total: start.elapsed().as_secs_f64(),
    };
    match &arguments.json {
        Some(path) => output::json(&report(arguments, output, &scene, &rendered, seconds), path),
        None => Ok(()),
    }
}

fn report(
    arguments: &Arguments,
    output: &Path,
    scene: &Scene,
    rendered: &Rendered,
    seconds: Seconds,
) -> RenderReport {
    RenderReport {
        version: env!("CARGO_PKG_VERSION"),
        scene: arguments.scene.display().to_string(),
        output: output.display().to_string(),
        engine: arguments.engine.name(),
        lanes: arguments.engine.width().map_or(1, Width::lanes),
        isa: Isa::BUILT_FOR,
        threads: rendered.threads,
        size: [scene.image.width, scene.image.height],
        rendered: [rendered.image.width, rendered.image.height],
        sampling: scene.render.sampling.name(),
        samples: scene.render.samples,
        max_depth: scene.render.max_depth,
        primitives: scene.geometry.primitive_count(),
        rays: rendered.rays,
        seconds,
        peak_resident_bytes: measure::peak_resident_bytes(),
        machine: Machine::here_and_now(),
        wavefront: rendered.wavefront.clone(),
    }
}
