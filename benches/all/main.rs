//! All benches in one program. Their names are those of the parts that they time:
//!
//! - `kernel/KIND/LANES`: one formula, every ray against every primitive
//! - `traverse/SCENE/RAYS/ENGINE`: rays through a tree, from columns of rays to columns of hits
//! - `build/SCENE/BUILDER`: the tree
//! - `frame/SCENE/ENGINE`: all that traces and shades a picture
//!
//! Every bench first asks the f64 reference what the answer is, and ends there if it gets another one. `cargo test` runs each
//! once, on few rays.
//!
//! The stages of a frame have no benches of their own: what one takes depends on what the others leave in the caches and on
//! how full the queues are at its depth, and a render's `--json` says what each took where it runs.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::cast_possible_truncation,
    reason = "a bench may end where it finds what it does not expect"
)]

mod build;
mod frame;
mod kernel;
mod peer;
mod random;
mod rays;
mod scenes;
mod traverse;
mod truth;

use criterion::Criterion;
use std::time::Duration;

/// How much to do.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    /// Enough to be timed.
    Timed,
    /// Enough to see that it works.
    Tested,
}

impl Extent {
    /// By the rule that criterion goes by: `cargo bench` gives `--bench`, `cargo test` does not.
    fn of_this_run() -> Self {
        let is_given = |option: &str| std::env::args().any(|argument| argument == option);
        if is_given("--bench") && !is_given("--test") { Self::Timed } else { Self::Tested }
    }
}

fn main() {
    let mut criterion = Criterion::default()
        .without_plots()
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(3))
        .configure_from_args();
    let extent = Extent::of_this_run();
    // One thread for whatever is timed, so that figures are of the work and not of how it is spread.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let scenes = scenes::available();
    kernel::benches(&mut criterion);
    for scene in &scenes {
        traverse::benches(&mut criterion, scene, extent, &pool);
    }
    for scene in &scenes {
        build::benches(&mut criterion, scene, &pool);
    }
    for scene in &scenes {
        frame::benches(&mut criterion, scene, extent);
    }
    criterion.final_summary();
}
