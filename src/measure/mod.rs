//! What is said of a result: how far two pictures lie apart; what a run did, how long it took, and where.

mod agreement;
mod difference;
mod machine;
mod report;
mod spread;

pub use agreement::{Agreement, Distance};
pub use difference::{Difference, heat_map};
pub use machine::{CacheBytes, Machine, peak_resident_bytes};
pub use report::{RenderReport, Seconds};
pub use spread::{Better, Spread};
