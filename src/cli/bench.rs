//! `wavelane bench [SCENE…]`.

use super::measuring::MeasuringArguments;
use super::progress::Progress;
use super::{Failure, interrupt, output};
use crate::generate::{StandardScene, generate};
use crate::load::{self, Loaded};
use crate::measure::Machine;
use crate::measure::bench::{Baseline, BenchOptions, BenchReport, Growth, SceneBench};
use crate::render::RenderError;
use crate::report::{Table, benched, growth_figure, number};
use crate::save::{self, SaveError};
use crate::scene::Scene;
use std::cell::Cell;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scene files [default: a standard set that the program makes, see --only and --sizes]
    scenes: Vec<PathBuf>,
    /// Of the standard set, only these scenes
    #[arg(long, value_name = "NAME,…", value_enum, value_delimiter = ',', conflicts_with = "scenes")]
    only: Vec<StandardScene>,
    /// Sizes of the standard set, primitives
    #[arg(long, value_name = "K,…", value_delimiter = ',', default_values_t = [1000, 10_000, 100_000, 1_000_000],
          conflicts_with = "scenes", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    sizes: Vec<u32>,
    #[command(flatten)]
    measuring: MeasuringArguments,
    /// Draw how cost grows: seconds over primitives, pixels and so on, logarithmic, beside lines that are linear; an .svg
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// An earlier result (--json) to compare with
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Exit with 4 if anything is slower than in the baseline by more than this, in the median and at best
    #[arg(long, value_name = "P%", value_parser = percent, requires = "baseline")]
    fail_if_slower: Option<f64>,
}

/// `5%` as a share.
fn percent(word: &str) -> Result<f64, String> {
    let number = word.strip_suffix('%').and_then(|number| number.trim().parse::<f64>().ok());
    match number {
        Some(percent) if percent >= 0.0 && percent.is_finite() => Ok(percent / 100.0),
        _ => Err("it is written as a percentage, like 5%".to_owned()),
    }
}

/// Side of the standard set's pictures, pixels.
const STANDARD_SIDE: u32 = 512;
/// Of the standard set, cost over all but primitives is measured on this scene, at its largest size up to a limit.
const GROWN: (StandardScene, u32) = (StandardScene::Terrain, 100_000);

/// Primitives of a TOML file. To read one takes about 5 KB for each, so ten times as many would take 50 GB.
const LARGEST_TOML: u32 = 1_000_000;

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let inputs = arguments.scenes.iter().chain(&arguments.baseline);
    let mut others: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    output::check_svg(arguments.plot.as_deref(), &others)?;
    others.extend(arguments.plot.as_deref());
    output::check_json(arguments.measuring.json.as_deref(), &others)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.measuring.threads()).build();
    let pool = pool.map_err(RenderError::from)?;
    let baseline = arguments.baseline.as_deref().map(|path| baseline(path, pool.current_num_threads()));
    let baseline = baseline.transpose()?;

    let report = interrupt::watched(|stop| {
        let scratch =
            tempfile::tempdir().map_err(|why| Failure::Write { path: std::env::temp_dir(), why })?;
        let (work, steps) = work(arguments, &pool);
        let progress = Progress::new(arguments.measuring.progress, steps, "steps");
        let done = Cell::new(0);
        let on_step = || progress.report(done.replace(done.get() + 1) + 1);
        let options = BenchOptions {
            pool: &pool,
            repeat: arguments.measuring.repeat as usize,
            rays: arguments.measuring.rays,
            scratch: scratch.path(),
            on_step: &on_step,
            stop,
        };
        let report = measured(arguments, &work, &options);
        progress.finish();
        report
    })?;
    interrupt::end_if_asked();

    if let Some(path) = &arguments.measuring.json {
        output::json(&report, path)?;
    }
    if let Some(path) = &arguments.plot {
        let svg = growth_figure(&report)
            .map_err(|error| Failure::Write { path: path.clone(), why: io::Error::other(error) })?;
        output::svg(&svg, path)?;
    }
    if !arguments.measuring.json_is_stdout() {
        output::result(&benched(&report).trim_end())?;
    }
    let mistakes: u64 = report.scenes.iter().map(SceneBench::mistakes).sum();
    if mistakes > 0 {
        return Err(Failure::OverLimit(format!(
            "{mistakes} rays have an answer that is wrong beyond rounding; `wavelane compare` says more"
        )));
    }
    baseline.map_or(Ok(()), |baseline| hold_against(arguments, &baseline, &report))
}

fn baseline(path: &Path, threads: usize) -> Result<Baseline, Failure> {
    let refused = |why: &dyn std::fmt::Display| Failure::Refused(format!("{}: {why}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|why| refused(&format!("cannot be opened: {why}")))?;
    Baseline::parse(&text, threads).map_err(|why| refused(&why))
}

/// A scene to be measured.
enum Work {
    File(PathBuf),
    Standard(StandardScene, u32),
}

/// What is to be done, and in how many steps.
fn work(arguments: &Arguments, pool: &rayon::ThreadPool) -> (Vec<Work>, u64) {
    let work: Vec<Work> = if arguments.scenes.is_empty() {
        let chosen = if arguments.only.is_empty() { &StandardScene::ALL[..] } else { &arguments.only };
        let mut sizes = arguments.sizes.clone();
        sizes.sort_unstable();
        sizes.dedup();
        chosen.iter().flat_map(|&scene| sizes.iter().map(move |&size| Work::Standard(scene, size))).collect()
    } else {
        arguments.scenes.iter().cloned().map(Work::File).collect()
    };
    let repeat = arguments.measuring.repeat as usize;
    let grown = work.iter().filter(|work| work.is_grown(arguments)).count() as u64;
    let steps = work.len() as u64 * SceneBench::steps(repeat) + grown * Growth::steps(pool, repeat);
    (work, steps)
}

impl Work {
    /// Whether cost over all but primitives is measured on it: on each file, and on one of the standard set.
    fn is_grown(&self, arguments: &Arguments) -> bool {
        match self {
            Self::File(_) => true,
            Self::Standard(scene, size) => {
                let chosen = if arguments.only.is_empty() { GROWN.0 } else { arguments.only[0] };
                let least = arguments.sizes.iter().min().copied();
                let largest = arguments.sizes.iter().filter(|&&size| size <= GROWN.1).max().copied();
                *scene == chosen && largest.or(least) == Some(*size)
            }
        }
    }

    fn name(&self) -> String {
        match self {
            Self::File(path) => path.display().to_string(),
            Self::Standard(scene, _) => scene.name().to_owned(),
        }
    }

    /// The scene and the seconds to load it; none where there is no file that it could be read from.
    fn load(&self, arguments: &Arguments, scratch: &Path) -> Result<(Scene, Option<f64>), Failure> {
        let (mut scene, seconds) = match self {
            Self::File(path) => {
                let (loaded, seconds) = timed(path)?;
                loaded.warnings.iter().for_each(output::diagnostic);
                (loaded.scene, Some(seconds))
            }
            Self::Standard(which, size) => {
                let mut scene = generate(*which, *size as usize)?;
                let mut seconds = None;
                if let Some(path) = saved(&scene, *size, scratch)? {
                    let (loaded, loading) = timed(&path)?;
                    (scene, seconds) = (loaded.scene, Some(loading));
                }
                (scene.image.width, scene.image.height) = (STANDARD_SIDE, STANDARD_SIDE);
                (scene, seconds)
            }
        };
        arguments.measuring.settings.apply(&mut scene);
        Ok((scene, seconds))
    }
}

/// A file of a scene of the standard set: NFF where that can say it, else TOML unless it is too large for that.
fn saved(scene: &Scene, size: u32, scratch: &Path) -> Result<Option<PathBuf>, Failure> {
    let nff = scratch.join("scene.nff");
    match save::save(scene, &nff) {
        Err(SaveError::CannotSay { .. }) if size > LARGEST_TOML => Ok(None),
        Err(SaveError::CannotSay { .. }) => {
            let toml = scratch.join("scene.toml");
            save::save(scene, &toml)?;
            Ok(Some(toml))
        }
        saved => Ok(saved.map(|()| Some(nff))?),
    }
}

/// A file read, and the seconds that took.
fn timed(path: &Path) -> Result<(Loaded, f64), Failure> {
    let start = Instant::now();
    let loaded = load::load(path)?;
    Ok((loaded, start.elapsed().as_secs_f64()))
}

fn measured(
    arguments: &Arguments,
    work: &[Work],
    options: &BenchOptions<'_>,
) -> Result<BenchReport, Failure> {
    let (mut scenes, mut growth): (Vec<SceneBench>, Vec<Growth>) = Default::default();
    for work in work {
        let (scene, load_seconds) = work.load(arguments, options.scratch)?;
        let name = work.name();
        scenes.push(SceneBench::measure(&name, &scene, load_seconds, options)?);
        if work.is_grown(arguments) {
            growth.extend(Growth::of_frames(&name, &scene, options)?);
        }
    }
    if arguments.scenes.is_empty() {
        let of_one_name = scenes.chunk_by(|a, b| a.scene == b.scene);
        growth.splice(0..0, of_one_name.map(|sizes| Growth::over_primitives(&sizes[0].scene, sizes)));
    }
    Ok(BenchReport {
        format: BenchReport::FORMAT,
        machine: Machine::here_and_now(),
        threads: options.pool.current_num_threads(),
        scenes,
        growth,
    })
}

fn hold_against(arguments: &Arguments, baseline: &Baseline, report: &BenchReport) -> Result<(), Failure> {
    for doubt in baseline.doubts(report) {
        output::diagnostic(&format!("warning: {doubt}"));
    }
    let changes = baseline.changes(report);
    let mut table = Table::new(2, ["scene", "", "before", "after", "times slower", "at best"]);
    for change in &changes {
        table.push(vec![
            change.scene.clone(),
            change.what.clone(),
            number(change.before),
            number(change.after),
            format!("{:.3}", change.slower),
            format!("{:.3}", change.best_slower),
        ]);
    }
    let words = format!("\nAgainst the baseline.\n\n{}", table.lines());
    if arguments.measuring.json_is_stdout() {
        output::diagnostic(&words.trim_end());
    } else {
        output::result(&words.trim_end())?;
    }
    let Some(share) = arguments.fail_if_slower else { return Ok(()) };
    if changes.is_empty() {
        let message = "nothing in the baseline was measured in this run; compare runs of the same scenes";
        return Err(Failure::Refused(message.into()));
    }
    match changes.iter().filter(|change| change.is_slower(share)).count() {
        0 => Ok(()),
        count => Err(Failure::OverLimit(format!(
            "{count} of {} measurements are slower than in the baseline by more than {} %",
            changes.len(),
            number(100.0 * share)
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_go_through_a_file_unless_only_toml_says_them_and_they_are_large() {
        let scratch = tempfile::tempdir().unwrap();
        let file = |which, size| {
            let scene = generate(which, 100).unwrap();
            let path = saved(&scene, size, scratch.path()).unwrap();
            path.map(|path| path.file_name().unwrap().to_owned())
        };
        assert_eq!(file(StandardScene::Sphereflake, LARGEST_TOML + 1), Some("scene.nff".into()));
        assert_eq!(file(StandardScene::Terrain, LARGEST_TOML), Some("scene.toml".into()));
        assert_eq!(file(StandardScene::Terrain, LARGEST_TOML + 1), None);
    }
}
