//! `wavelane render SCENE -o OUT`, and `--pixel X,Y` instead of `-o OUT`.

use super::progress::{Progress, Style};
use super::{Failure, interrupt, output, pixel};
use crate::film::{self, BitDepth, Region};
use crate::lanes::Isa;
use crate::lanes::Width;
use crate::load;
use crate::measure::{self, RenderReport, Seconds};
use crate::render::{self, RenderOptions, Rendered};
use crate::scene::{ImageSettings, RenderSettings, Sampling, Scene};
use clap::ValueEnum;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scene file: .toml, .nff, .obj or .ply
    scene: PathBuf,
    /// Picture to write: .png (sRGB), .exr or .npy (linear f32)
    #[arg(short, long, value_name = "OUT", required_unless_present = "pixel")]
    output: Option<PathBuf>,
    /// What traces the rays
    #[arg(long, value_enum, default_value = "simd")]
    engine: Engine,
    /// Lanes of the simd engine's kernels; they do not change the picture [default: the widest that pays]
    #[arg(long, value_name = "N", value_parser = ["4", "8", "16"])]
    lanes: Option<String>,
    /// Worker threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Size of the image, pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Render only this part, pixels from the top left, X1 and Y1 excluded; the file holds the part alone
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop)]
    crop: Option<Region>,
    /// Instead of a picture, print every ray of one pixel (from the top left) and what it met, the f64 reference beside the
    /// engine; --json then writes both trees
    #[arg(long, value_name = "X,Y", value_parser = pixel::place, conflicts_with_all = ["output", "crop", "bits", "threads", "progress"])]
    pixel: Option<[u32; 2]>,
    /// Where the samples of a pixel lie [default: the scene's]
    #[arg(long, value_enum)]
    sampling: Option<SamplingName>,
    /// n × n samples a pixel, 1–64 [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(RenderSettings::MAX_SAMPLES)))]
    samples: Option<u32>,
    /// What random samples start from [default: the scene's]
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
    /// The deepest ray, 0–64; primary rays are depth 0 [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=i64::from(RenderSettings::MAX_DEPTH)))]
    max_depth: Option<u32>,
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

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum Engine {
    /// Wavefront, SIMD lanes
    Simd,
    /// Wavefront, one lane
    Scalar,
    /// Recursive, f64, from the textbook
    Reference,
}

impl Engine {
    fn name(self) -> &'static str {
        match self {
            Self::Simd => "simd",
            Self::Scalar => "scalar",
            Self::Reference => "reference",
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SamplingName {
    Regular,
    Random,
    Jittered,
}

fn size(word: &str) -> Result<(u32, u32), String> {
    let sides = word.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height) = sides.ok_or("a size is written like 800x600")?;
    ImageSettings::check_size(width, height)
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
    if arguments.lanes.is_some() && arguments.engine != Engine::Simd {
        output::diagnostic(&"warning: --lanes belongs to the simd engine and changes nothing here");
    }
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
    apply(arguments, &mut loaded.scene);
    Ok(loaded.scene)
}

fn print_pixel(arguments: &Arguments, place: [u32; 2]) -> Result<(), Failure> {
    let render::Engine::Wavefront { width, .. } = engine(arguments) else {
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
    let start = Instant::now();
    let scene = load_scene(arguments)?;
    let load = start.elapsed().as_secs_f64();
    film::check_writable(output)?;
    output::check_json(arguments.json.as_deref(), &[output])?;

    if let Some(warning) = unused_instructions(arguments.engine, arguments.progress, Isa::of_this_machine()) {
        output::diagnostic(&warning);
    }

    let whole = Region::whole(scene.image.width, scene.image.height);
    let region = arguments.crop.unwrap_or(whole);
    let progress = Progress::new(arguments.progress, region.pixels());
    let rendered = interrupt::watched(|stop| {
        let options = RenderOptions {
            engine: engine(arguments),
            region,
            threads: arguments.threads.map_or(0, usize::from),
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
    film::write(&rendered.image, output, depth)?;
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

fn engine(arguments: &Arguments) -> render::Engine {
    let width = match (arguments.engine, arguments.lanes.as_deref()) {
        (Engine::Reference, _) => return render::Engine::Reference,
        (Engine::Scalar, _) => Width::One,
        (Engine::Simd, Some("4")) => Width::Four,
        (Engine::Simd, Some("8")) => Width::Eight,
        (Engine::Simd, Some("16")) => Width::Sixteen,
        (Engine::Simd, _) => Width::BEST,
    };
    render::Engine::wavefront(width)
}

/// A warning that another build would be faster on this machine.
///
/// Only the simd engine gains by it (docs/design.md). It goes to the log of a batch job as to a terminal, since it is in
/// batches that the time is lost; with `--progress json` a program reads stderr, and `--progress none` is how to ask for
/// silence where one build serves many machines on purpose.
fn unused_instructions(engine: Engine, progress: Style, machine: Isa) -> Option<String> {
    let is_told = engine == Engine::Simd && matches!(progress, Style::Auto) && machine != Isa::BUILT_FOR;
    is_told.then(|| {
        format!(
            "warning: built for {}, and this machine has {machine}: build on it (cargo build --release) for more speed",
            Isa::BUILT_FOR
        )
    })
}

/// The command line's settings take the place of the scene's.
fn apply(arguments: &Arguments, scene: &mut Scene) {
    let (image, render) = (&mut scene.image, &mut scene.render);
    if let Some((width, height)) = arguments.size {
        (image.width, image.height) = (width, height);
    }
    if let Some(sampling) = arguments.sampling {
        render.sampling = match sampling {
            SamplingName::Regular => Sampling::Regular,
            SamplingName::Random => Sampling::Random,
            SamplingName::Jittered => Sampling::Jittered,
        };
    }
    render.samples = arguments.samples.unwrap_or(render.samples);
    render.seed = arguments.seed.unwrap_or(render.seed);
    render.max_depth = arguments.max_depth.unwrap_or(render.max_depth);
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
        lanes: match engine(arguments) {
            render::Engine::Reference => 1,
            render::Engine::Wavefront { width, .. } => width.lanes(),
        },
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
        wavefront: rendered.wavefront.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_who_can_gain_speed_is_told_so() {
        // Any but the one that the build is for.
        let other = if Isa::BUILT_FOR == Isa::Avx512 { Isa::Avx2 } else { Isa::Avx512 };
        let said = unused_instructions(Engine::Simd, Style::Auto, other).unwrap();
        assert!(
            said.contains(&format!("built for {}, and this machine has {other}", Isa::BUILT_FOR)),
            "{said}"
        );
        for (engine, progress, machine) in [
            (Engine::Simd, Style::Auto, Isa::BUILT_FOR),
            (Engine::Simd, Style::Json, other),
            (Engine::Simd, Style::None, other),
            (Engine::Scalar, Style::Auto, other),
            (Engine::Reference, Style::Auto, other),
        ] {
            assert_eq!(unused_instructions(engine, progress, machine), None);
        }
    }
}
