//! The options that say what traces rays, which several commands have.

use super::output;
use super::progress::Style;
use crate::lanes::{Isa, Width};
use clap::ValueEnum;

#[derive(Debug, clap::Args)]
pub(super) struct EngineArguments {
    /// What traces the rays
    #[arg(long, value_enum, default_value = "simd")]
    engine: Engine,
    /// Lanes of the simd engine's kernels; they do not change what is found [default: the widest that pays]
    #[arg(long, value_name = "N", value_parser = ["4", "8", "16"])]
    lanes: Option<String>,
    /// Worker threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
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

impl EngineArguments {
    /// As the command line has it.
    pub(super) fn name(&self) -> &'static str {
        match self.engine {
            Engine::Simd => "simd",
            Engine::Scalar => "scalar",
            Engine::Reference => "reference",
        }
    }

    /// Lanes of the wavefront engine; none for the reference.
    pub(super) fn width(&self) -> Option<Width> {
        match (self.engine, self.lanes.as_deref()) {
            (Engine::Reference, _) => None,
            (Engine::Scalar, _) => Some(Width::One),
            (Engine::Simd, Some("4")) => Some(Width::Four),
            (Engine::Simd, Some("8")) => Some(Width::Eight),
            (Engine::Simd, Some("16")) => Some(Width::Sixteen),
            (Engine::Simd, _) => Some(Width::BEST),
        }
    }

    /// 0 for one a core.
    pub(super) fn threads(&self) -> usize {
        self.threads.map_or(0, usize::from)
    }

    pub(super) fn warn_of_useless_lanes(&self) {
        if self.lanes.is_some() && self.engine != Engine::Simd {
            output::diagnostic(&"warning: --lanes belongs to the simd engine and changes nothing here");
        }
    }

    pub(super) fn warn_of_unused_instructions(&self, progress: Style) {
        if let Some(warning) = unused_instructions(self.engine, progress, Isa::of_this_machine()) {
            output::diagnostic(&warning);
        }
    }
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
