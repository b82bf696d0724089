//! What is said of a result: how far two pictures lie apart, and what a run did and how long it took.

mod agreement;
mod difference;
mod hit_errors;
mod report;
pub mod rungs;

pub use agreement::{Agreement, Distance};
pub use difference::{Difference, heat_map};
pub use hit_errors::{HitErrors, Percentiles, Wrong};
pub use report::{RenderReport, Seconds, peak_resident_bytes};
