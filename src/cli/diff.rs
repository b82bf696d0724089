//! `wavelane diff A B`.

use super::{Failure, output};
use crate::film::{self, BitDepth, Format, Image};
use crate::measure::{Difference, heat_map};
use serde::Serialize;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A picture: .png, .exr or .npy
    a: PathBuf,
    /// Another of the same size
    b: PathBuf,
    /// Exit with 4 if a pixel differs by more than this in any channel
    #[arg(long, value_name = "X", value_parser = limit)]
    limit: Option<f64>,
    /// Write a picture of where they differ: black for equal, white for the largest difference
    #[arg(long, value_name = "FILE")]
    heat: Option<PathBuf>,
    /// Write the result as JSON, to stdout if FILE is -
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

fn limit(word: &str) -> Result<f64, String> {
    match word.parse() {
        Ok(limit) if limit >= 0.0 => Ok(limit),
        _ => Err("a limit is a number of at least 0".to_owned()),
    }
}

/// The JSON result.
#[derive(Serialize)]
struct Report<'a> {
    a: &'a Path,
    b: &'a Path,
    /// `linear`, or `srgb` where both are PNG: values 0–1.
    values: &'static str,
    #[serde(flatten)]
    difference: Difference,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.heat {
        film::check_writable(path)?;
    }
    let pictures = [Some(&arguments.a), Some(&arguments.b), arguments.heat.as_ref()];
    let pictures: Vec<&Path> = pictures.into_iter().flatten().map(PathBuf::as_path).collect();
    output::check_json(arguments.json.as_deref(), &pictures)?;
    let (a, b, values) = read_alike(&arguments.a, &arguments.b)?;
    let limit = arguments.limit.unwrap_or(0.0);
    let Some(difference) = Difference::between(&a, &b, limit) else {
        return Err(Failure::Refused(format!(
            "{}: its size is {} x {}, but that of {} is {} x {}; only pictures of one size can be compared",
            arguments.b.display(),
            b.width,
            b.height,
            arguments.a.display(),
            a.width,
            a.height
        )));
    };
    if let Some(path) = &arguments.heat {
        film::write(&heat_map(&a, &b, &difference), path, BitDepth::Eight)?;
    }
    let [x, y] = difference.largest_at;
    let summary = format!(
        "largest {:.6e} at ({x}, {y}), rms {:.6e}, {} of {} pixels over {limit}",
        difference.largest,
        difference.rms,
        difference.pixels_over,
        a.pixels.len(),
    );
    match &arguments.json {
        Some(path) => {
            output::json(&Report { a: &arguments.a, b: &arguments.b, values, difference }, path)?;
            if path != Path::new("-") {
                output::result(&summary)?;
            }
        }
        None => output::result(&summary)?,
    }
    match arguments.limit {
        Some(limit) if difference.pixels_over > 0 => Err(Failure::OverLimit(format!(
            "{} and {} differ by more than {limit} in {} pixels",
            arguments.a.display(),
            arguments.b.display(),
            difference.pixels_over
        ))),
        _ => Ok(()),
    }
}

/// Reads two pictures as values of one kind: two PNG are compared in sRGB, others in linear light.
fn read_alike(a: &Path, b: &Path) -> Result<(Image, Image, &'static str), Failure> {
    let (mut image_a, mut image_b) = (film::read(a)?, film::read(b)?);
    match (Format::of(a)?.is_linear(), Format::of(b)?.is_linear()) {
        (false, false) => return Ok((image_a, image_b, "srgb")),
        (false, true) => film::decode_srgb(&mut image_a),
        (true, false) => film::decode_srgb(&mut image_b),
        (true, true) => {}
    }
    Ok((image_a, image_b, "linear"))
}
