//! What is said of a result: how far two pictures lie apart, and what a run did and how long it
//! took, and where two engines part over one pixel.

mod agreement;
mod difference;
mod report;
mod tree_comparison;

pub use agreement::{Agreement, Distance};
pub use difference::{Difference, heat_map};
pub use report::{RenderReport, Seconds, peak_resident_bytes};
pub use tree_comparison::{HitDecision, Match, Quantity, RayKind, Reading, Row, TreeComparison};
