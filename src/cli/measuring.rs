//! The options of the commands that measure speed.

use super::progress::Style;
use super::settings::SceneSettings;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct MeasuringArguments {
    #[command(flatten)]
    pub(super) settings: SceneSettings,
    /// Worker threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Timed frames, and passes over recorded rays, of each wavefront engine; the reference has one
    #[arg(long, value_name = "K", default_value = "5", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) repeat: u32,
    /// About so many rays of each kind are traced on their own
    #[arg(long, value_name = "R", default_value = "262144", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) rays: u64,
    /// How far it is, on stderr
    #[arg(long, value_enum, default_value = "auto")]
    pub(super) progress: Style,
    /// Write the result as JSON, to stdout instead of the tables if FILE is -
    #[arg(long, value_name = "FILE")]
    pub(super) json: Option<PathBuf>,
}

impl MeasuringArguments {
    /// 0 for one a core.
    pub(super) fn threads(&self) -> usize {
        self.threads.map_or(0, usize::from)
    }

    /// Whether stdout is for the JSON alone.
    pub(super) fn json_is_stdout(&self) -> bool {
        self.json.as_ref().is_some_and(|path| path.as_os_str() == "-")
    }
}
