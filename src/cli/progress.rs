//! How far a render is, on stderr.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicU64, Ordering};

/// Where progress goes.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(super) enum Style {
    /// A bar where stderr is a terminal, else nothing
    Auto,
    /// A line of JSON at each percent
    Json,
    /// Nothing
    None,
}

/// Progress through a known number of pixels.
pub(super) enum Progress {
    Bar(ProgressBar),
    Json { total: u64, percent: AtomicU64 },
    Silent,
}

impl Progress {
    pub(super) fn new(style: Style, total: u64) -> Self {
        match style {
            Style::Auto if io::stderr().is_terminal() => {
                let bar = ProgressBar::new(total);
                let template = "{percent:>3}% {bar:40} {pos}/{len} pixels, {elapsed} elapsed, {eta} to go";
                if let Ok(style) = ProgressStyle::with_template(template) {
                    bar.set_style(style);
                }
                Self::Bar(bar)
            }
            Style::Json => Self::Json { total, percent: AtomicU64::new(0) },
            Style::Auto | Style::None => Self::Silent,
        }
    }

    /// Called from any thread with the pixels done so far.
    pub(super) fn report(&self, done: u64) {
        match self {
            Self::Bar(bar) => bar.set_position(bar.position().max(done)),
            Self::Json { total, percent } => {
                let now = done * 100 / (*total).max(1);
                if percent.fetch_max(now, Ordering::Relaxed) < now {
                    let line = serde_json::json!({ "pixels": done, "total": total, "percent": now });
                    let _ = writeln!(io::stderr().lock(), "{line}");
                }
            }
            Self::Silent => {}
        }
    }

    pub(super) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}
