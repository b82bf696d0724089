//! The page of a comparison. A section a question; what else is measured of a scene becomes a section of its own, with the
//! plots of [`plot`](super::plot), after those on speed and error and before the pictures.

use super::figures::{self, Figure};
use super::plot::PlotError;
use super::rung_figures::rung_figures;
use super::rungs::rungs;
use super::summary::sentences;
use super::table::number;
use super::tables::tables;
use super::{Compared, html};
use crate::film::Image;
use crate::measure::{ComparedImages, Comparison, Difference, Machine, heat_map};

/// The page and what it shows.
pub(super) struct Page {
    pub(super) html: String,
    pub(super) figures: Vec<Figure>,
    pub(super) pictures: Vec<Picture>,
}

/// A picture in a file of its own.
pub(super) struct Picture {
    /// Name of the file.
    pub(super) file: &'static str,
    pub(super) image: Image,
    caption: String,
}

pub(super) const TRUTH: &str = "truth.png";
pub(super) const ENGINE: &str = "engine.png";
pub(super) const ENGINE_ERROR: &str = "engine-error.png";
pub(super) const FLOOR_ERROR: &str = "floor-error.png";

impl Page {
    /// Puts it together.
    ///
    /// # Errors
    /// A plot that cannot be drawn.
    pub(super) fn new(compared: &Compared, images: ComparedImages, data: &str) -> Result<Self, PlotError> {
        let comparison = &compared.comparison;
        let headline = figures::speed_over_error(comparison)?;
        let kinds = figures::speed_by_kind(comparison)?;
        let errors = figures::hit_errors(comparison)?;
        let choices = compared.rungs.as_ref().map(rung_figures).transpose()?.unwrap_or_default();
        let pictures = pictures(images);

        let mut content = html::paragraph(&settings(compared));
        content += &plots([&headline]);
        content += &html::paragraph(&sentences(comparison));
        if kinds.is_some() || errors.is_some() {
            content += &html::section("By kind of ray", &plots(kinds.iter().chain(&errors)));
        }
        content += &html::section("In numbers", &html::blocks(&tables(comparison)));
        if let Some(found) = &compared.rungs {
            let shown = plots(&choices) + &html::blocks(&rungs(found));
            content += &html::section("What accuracy costs", &shown);
        }
        content += &html::section("Where the pictures differ", &shown(&pictures));
        content += &html::section("Made by", &origin(compared, data));
        let html = html::document(&format!("Speed and error: {}", compared.scene), &content);
        let figures = [Some(headline), kinds, errors].into_iter().flatten().chain(choices).collect();
        Ok(Self { html, figures, pictures })
    }

    /// Names of the files that it shows.
    pub(super) fn files(&self) -> Vec<&'static str> {
        let figures = self.figures.iter().map(|figure| figure.file);
        figures.chain(self.pictures.iter().map(|picture| picture.file)).collect()
    }
}

fn plots<'a>(figures: impl IntoIterator<Item = &'a Figure>) -> String {
    figures.into_iter().map(|figure| html::plot(&figure.svg, figure.file, &figure.caption)).collect()
}

fn settings(compared: &Compared) -> String {
    let [width, height] = compared.size;
    let samples = match compared.samples {
        1 => "1 sample a pixel".to_owned(),
        n => format!("{n} × {n} {} samples a pixel", compared.sampling),
    };
    format!(
        "{width} × {height} pixels, {samples}, rays to depth {}; primitives: {}; threads: {}; {}, built for {}.",
        compared.max_depth,
        compared.primitives,
        compared.comparison.threads,
        compared.machine.processor.as_deref().unwrap_or("unknown processor"),
        compared.machine.isa,
    )
}

fn pictures(images: ComparedImages) -> Vec<Picture> {
    let ComparedImages { truth, floor, engine } = images;
    let of = |image: &Image| Difference::between(&truth, image, Comparison::LIMIT);
    let (engine_off, floor_off) = (of(&engine), of(&floor));
    // Both on one scale, so that they can be held side by side.
    let largest = [engine_off, floor_off].iter().flatten().map(|off| off.largest).fold(0.0, f64::max);
    let heat = |image: &Image, off: Option<Difference>| {
        let off = off?;
        let caption = if off.largest > 0.0 {
            let [x, y] = off.largest_at;
            let (rms, of_this, of_both) = (number(off.rms), number(off.largest), number(largest));
            format!(
                "RMSE {rms}, largest difference {of_this} in column {x}, row {y}. Black is no difference, dark red a small one, \
                 white {of_both}."
            )
        } else {
            "No pixel differs.".to_owned()
        };
        Some((heat_map(&truth, image, &Difference { largest, ..off }), caption))
    };
    let (engine_error, floor_error) = (heat(&engine, engine_off), heat(&floor, floor_off));
    let picture = |file, image, caption: String| Picture { file, image, caption };
    let mut pictures = vec![
        picture(TRUTH, truth, "The truth: the f64 reference's picture.".into()),
        picture(ENGINE, engine, "The wavefront engine's picture.".into()),
    ];
    pictures.extend(engine_error.map(|(image, caption)| {
        picture(ENGINE_ERROR, image, format!("Where the engine's picture is off the truth. {caption}"))
    }));
    pictures.extend(floor_error.map(|(image, caption)| {
        let caption = format!("Where f32 queues alone would put a picture off it: the floor. {caption}");
        picture(FLOOR_ERROR, image, caption)
    }));
    pictures
}

fn shown(pictures: &[Picture]) -> String {
    let figure = |Picture { file, image, caption }: &Picture| {
        html::picture(file, [image.width, image.height], caption)
    };
    format!("<div class=\"pictures\">\n{}</div>\n", pictures.iter().map(figure).collect::<String>())
}

/// The command, and what it ran on.
fn origin(compared: &Compared, data: &str) -> String {
    let Machine {
        processor,
        logical_processors,
        cache_bytes,
        memory_bytes,
        operating_system,
        kernel,
        architecture,
        isa,
        compiler,
        opt_level,
        debug_assertions,
        version,
        utc,
    } = &compared.machine;
    let known = |text: Option<String>| text.unwrap_or_else(|| "unknown".into());
    let caches = [("L1d", cache_bytes.l1_data), ("L2", cache_bytes.l2), ("L3", cache_bytes.l3)];
    let caches: Vec<String> =
        caches.iter().filter_map(|(name, bytes)| Some(format!("{name} {}", binary((*bytes)?)))).collect();
    let checks = if *debug_assertions { "; with debug assertions, which take time" } else { "" };
    let facts = [
        ("scene", compared.scene.clone()),
        ("size", format!("{} × {} pixels", compared.size[0], compared.size[1])),
        (
            "samples a pixel",
            format!("{0} × {0}, {1}, seed {2}", compared.samples, compared.sampling, compared.seed),
        ),
        ("deepest ray", compared.max_depth.to_string()),
        ("least weight of a ray", compared.min_weight.to_string()),
        ("primitives", compared.primitives.to_string()),
        ("rays of the frame", compared.comparison.frame_rays.total().to_string()),
        ("threads", compared.comparison.threads.to_string()),
        ("processor", known(processor.clone())),
        ("logical processors", known(logical_processors.map(|count| count.to_string()))),
        ("caches", known((!caches.is_empty()).then(|| caches.join(", ")))),
        ("memory", known(memory_bytes.map(binary))),
        ("system", format!("{operating_system} {}, {architecture}", kernel.as_deref().unwrap_or_default())),
        ("instruction set of the build", isa.to_string()),
        (
            "compiler",
            format!(
                "{}, opt-level {}{checks}",
                compiler.unwrap_or("unknown"),
                opt_level.unwrap_or("unknown")
            ),
        ),
        ("wavelane", (*version).to_owned()),
        ("time", known(utc.clone())),
    ];
    format!(
        "<p>This page is made by</p>\n<pre>{}</pre>\n{}<p>All numbers: <a href=\"{data}\">{data}</a>.</p>\n",
        html::escaped(&compared.command),
        html::definitions(&facts)
    )
}

/// Bytes in powers of 1024.
fn binary(bytes: u64) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < units.len() {
        (value, unit) = (value / 1024.0, unit + 1);
    }
    format!("{} {}", number(value), units[unit])
}
