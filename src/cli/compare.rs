//! `wavelane compare SCENE`.

use super::measuring::MeasuringArguments;
use super::progress::Progress;
use super::{Failure, interrupt, on_threads, output};
use crate::lanes::Width;
use crate::load;
use crate::measure::rungs::{self, RungOptions, Rungs};
use crate::measure::{ComparedImages, Comparison, ComparisonOptions};
use crate::rays::RayCounts;
use crate::render::RenderError;
use crate::report::{self, Compared, Folder};
use crate::scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Scene file: .toml, .nff, .obj or .ply, or a folder of .npy
    scene: PathBuf,
    #[command(flatten)]
    measuring: MeasuringArguments,
    /// Measure what accuracy costs, too: other formulas, fewer weak rays, more samples; takes several times as long
    #[arg(long)]
    rungs: bool,
    /// Write a page with plots, tables and pictures to a folder, which is made if need be: DIR/index.html
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut loaded = load::load(&arguments.scene)?;
    output::warnings(&loaded);
    arguments.measuring.settings.apply(&mut loaded.scene);
    let folder = arguments.report.as_deref().map(Folder::open).transpose()?;
    check_json(arguments, folder.as_ref())?;
    let scene = &loaded.scene;
    let (comparison, images) = compare(arguments, scene)?;

    let rungs =
        arguments.rungs.then(|| measure_rungs(arguments, scene, comparison.frame_rays)).transpose()?;

    let name = arguments.scene.display().to_string();
    let command = command(arguments, scene, comparison.threads);
    let compared = Compared::new(scene, name, command, comparison, rungs);
    if let Some(path) = &arguments.measuring.json {
        output::json(&compared, path)?;
    }
    if !arguments.measuring.json_is_stdout() {
        let mut tables = report::tables(&compared.comparison);
        tables.extend(compared.rungs.iter().flat_map(report::rungs));
        let tables = report::text(&tables);
        output::result(&format!("{}\n\n{tables}", compared.title()))?;
    }
    if let Some(folder) = folder {
        on_threads(arguments.measuring.threads(), || folder.write(&compared, images))??;
        output::diagnostic(&format!("{}: the report", folder.page().display()));
    }
    match compared.comparison.mistakes() {
        0 => Ok(()),
        mistakes => Err(Failure::OverLimit(format!(
            "{mistakes} rays have an answer that is wrong beyond rounding; please report this with the scene"
        ))),
    }
}

/// The JSON may take the place of neither the scene nor a file of the report.
fn check_json(arguments: &Arguments, folder: Option<&Folder>) -> Result<(), Failure> {
    let others: Vec<PathBuf> = folder.iter().flat_map(|folder| folder.files()).collect();
    let others: Vec<&Path> = others.iter().map(PathBuf::as_path).chain([arguments.scene.as_path()]).collect();
    output::check_json(arguments.measuring.json.as_deref(), &others)
}

/// A command line that compares the same again, whatever becomes of the scene's own settings and of the defaults.
fn command(arguments: &Arguments, scene: &Scene, threads: usize) -> String {
    let (image, render) = (&scene.image, &scene.render);
    let mut command = format!(
        "wavelane compare {} --size {}x{} --sampling {} --samples {} --seed {} --max-depth {} --threads {threads} --repeat {} \
         --rays {}",
        quoted(&arguments.scene),
        image.width,
        image.height,
        render.sampling.name(),
        render.samples,
        render.seed,
        render.max_depth,
        arguments.measuring.repeat,
        arguments.measuring.rays,
    );
    if arguments.rungs {
        command += " --rungs";
    }
    if let Some(path) = &arguments.report {
        command += &format!(" --report {}", quoted(path));
    }
    command
}

/// A path as a shell takes it.
fn quoted(path: &Path) -> String {
    let path = path.display().to_string();
    let is_plain = |character: char| character.is_alphanumeric() || "/._-+,:@".contains(character);
    if !path.is_empty() && path.chars().all(is_plain) {
        return path;
    }
    format!("'{}'", path.replace('\'', "'\\''"))
}

fn compare(arguments: &Arguments, scene: &Scene) -> Result<(Comparison, ComparedImages), Failure> {
    measured(arguments, "steps", |on_progress, stop| {
        let options = ComparisonOptions {
            threads: arguments.measuring.threads(),
            repeat: arguments.measuring.repeat as usize,
            rays: arguments.measuring.rays,
            on_progress,
            stop,
        };
        Comparison::measure(scene, &options)
    })
}

fn measure_rungs(arguments: &Arguments, scene: &Scene, frame: RayCounts) -> Result<Rungs, Failure> {
    measured(arguments, "steps of rungs", |on_progress, stop| {
        let options = RungOptions {
            width: Width::BEST,
            threads: arguments.measuring.threads(),
            repeats: arguments.measuring.repeat as usize,
            on_progress: &|rungs::Progress { done, steps, .. }| on_progress(done as u64, steps as u64),
            stop,
        };
        Rungs::measure(scene, frame, arguments.measuring.rays, &options)
    })
}

/// Measures with progress, until it is done or Ctrl-C comes. The measurement gets what to call with the steps done and those
/// there will be, and what makes it stop.
fn measured<T>(
    arguments: &Arguments,
    unit: &'static str,
    measure: impl FnOnce(&(dyn Fn(u64, u64) + Sync), &AtomicBool) -> Result<T, RenderError>,
) -> Result<T, Failure> {
    let progress: OnceLock<Progress> = OnceLock::new();
    let on_progress = |done: u64, total: u64| {
        progress.get_or_init(|| Progress::new(arguments.measuring.progress, total, unit)).report(done);
    };
    let found = interrupt::watched(|stop| measure(&on_progress, stop));
    if let Some(progress) = progress.get() {
        progress.finish();
    }
    let found = found?;
    interrupt::end_if_asked();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_one_word_to_a_shell() {
        for (path, word) in [
            ("scenes/glass.toml", "scenes/glass.toml"),
            ("my scene.toml", "'my scene.toml'"),
            ("it's.toml", "'it'\\''s.toml'"),
            ("a$b;c", "'a$b;c'"),
        ] {
            assert_eq!(quoted(Path::new(path)), word);
        }
    }
}
