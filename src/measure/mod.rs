//! What is said of a result: how far two pictures lie apart; what a run did, how long it took, and where; where two engines
//! part over one pixel.

mod agreement;
pub mod bench;
mod comparison;
mod difference;
mod hit_errors;
mod machine;
mod race;
mod report;
pub mod rungs;
mod spread;
mod tree_comparison;

pub use agreement::{Agreement, Distance};
pub use comparison::{ComparedImages, Comparison, ComparisonOptions, EngineResult};
pub use difference::{Difference, heat_map};
pub use hit_errors::{HitErrors, Percentiles, Wrong};
pub use machine::{CacheBytes, Machine, peak_resident_bytes};
pub use report::{RenderReport, Seconds};
pub use spread::{Better, Spread};
pub use tree_comparison::{HitDecision, Match, Quantity, Reading, Row, TreeComparison};
