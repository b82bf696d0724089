//! All integration tests in one program, so that it is linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::cast_possible_truncation,
    reason = "a test may end where it finds what it does not expect"
)]

mod agreement;
mod bad_input;
mod bounds;
mod certified;
mod command_line;
mod example_scenes;
mod floor;
mod folder;
mod formats;
mod hard_cases;
mod hard_cases_light;
mod measuring;
mod model;
mod pixel_tree;
mod real_scenes;
mod recorded;
mod report;
mod robustness;
mod rungs;
mod saving;
mod standard_scenes;
mod support;
mod trace;
mod wavefront;
