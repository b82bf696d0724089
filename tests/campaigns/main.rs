//! Campaigns: so many rays that what goes wrong once in millions shows. Each runs at a size that a test run can afford;
//! `WAVELANE_CAMPAIGN_RAYS` sets another, and the build should then be a release build:
//!
//! ```sh
//! WAVELANE_CAMPAIGN_RAYS=1000000000 cargo test --release --test campaigns watertight -- --nocapture
//! WAVELANE_CAMPAIGN_RAYS=100000000 cargo test --release --test campaigns self_hits -- --nocapture
//! ```
//!
//! What such runs found is written down in docs/accuracy.md, with the bound that it proves: 0 of N says, with 95 %
//! confidence, fewer than 3/N.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test may end where it finds what it does not expect, and a campaign shows what it counted"
)]

mod random;
mod self_hits;
mod watertight;

/// How many rays a campaign traces: what the environment says, or else as many as given.
fn ray_budget(usual: u64) -> u64 {
    let Ok(number) = std::env::var("WAVELANE_CAMPAIGN_RAYS") else { return usual };
    number.parse().unwrap_or_else(|_| panic!("WAVELANE_CAMPAIGN_RAYS is {number}, not a number of rays"))
}
