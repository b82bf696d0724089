//! Formulas that the engine does not use: what textbooks have, and what would be more exact. `measure::rungs` plays recorded
//! rays back through them, so that what the engine's own formulas buy, and what better ones would, is measured and not
//! believed.

pub(crate) mod axis_polygon;
pub(crate) mod compensated_sphere;
pub(crate) mod moller_trumbore;
pub(crate) mod quadratic;
pub(crate) mod slabs;
