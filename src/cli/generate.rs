//! `wavelane generate NAME --size K -o FILE`.

use super::{Failure, output};
use crate::generate::{StandardScene, generate};
use crate::save;
use clap::ValueEnum;
use clap::builder::PossibleValue;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Which scene
    #[arg(value_enum)]
    name: StandardScene,
    /// How many primitives, 1–10000000; the scene comes as near to it as its construction allows
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    size: u32,
    /// Scene file to write: .toml, or .nff for sphereflake, tetrahedra and gears
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

impl ValueEnum for StandardScene {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()).help(self.description()))
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    save::check_writable(&arguments.output)?;
    let scene = generate(arguments.name, arguments.size as usize)?;
    save::save(&scene, &arguments.output)?;
    output::result(&format!(
        "{}: {}, {} primitives",
        arguments.output.display(),
        arguments.name.name(),
        scene.geometry.primitive_count()
    ))
}
