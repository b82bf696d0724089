//! How far a long piece of work is, on stderr.

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

/// Progress through a known number of units of work.
pub(super) enum Progress {
    Bar(ProgressBar),
    Json { total: u64, unit: &'static str, percent: AtomicU64 },
    Silent,
}

impl Progress {
    /// `unit` is a plural, such as `pixels`.
    pub(super) fn new(style: Style, total: u64, unit: &'static str) -> Self {
        match style {
            Style::Auto if io::stderr().is_terminal() => {
                let bar = ProgressBar::new(total);
                let template = format!(
                    "{{percent:>3}}% {{bar:40}} {{pos}}/{{len}} {unit}, {{elapsed}} elapsed, {{eta}} to go"
                );
                if let Ok(style) = ProgressStyle::with_template(&template) {
                    bar.set_style(style);
                }
                Self::Bar(bar)
            }
            Style::Json => Self::Json { total, unit, percent: AtomicU64::new(0) },
            Style::Auto | Style::None => Self::Silent,
        }
    }

    /// Called from any thread with the units done so far.
    pub(super) fn report(&self, done: u64) {
        match self {
            Self::Bar(bar) => bar.set_position(bar.position().max(done)),
            Self::Json { total, unit, percent } => {
                let now = done * 100 / (*total).max(1);
                if percent.fetch_max(now, Ordering::Relaxed) < now {
                    let line = serde_json::json!({ *unit: done, "total": total, "percent": now });
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
