//! Leaks: rays aimed at what triangles share that hit none of them.
//!
//! Random rays do not find cracks; aimed ones do (Schirra, "How Reliable Are Practical Point-in-Polygon Strategies?", 2008).

use super::super::RungOptions;
use super::aimed::{Aimed, Mesh};
use super::{Formula, answers, triangle};
use crate::lanes::Width;
use crate::prepare::Prepared;
use crate::render::RenderError;
use serde::Serialize;

/// Leaks between triangles, formula by formula. Rays start at the eye; they are aimed at points of edges that two triangles
/// share and at corners that triangles lie all around, as seen from there.
#[derive(Clone, Debug, Serialize)]
pub struct LeakRung {
    /// Rays aimed at edges.
    pub edge_rays: u64,
    /// Rays aimed at corners.
    pub corner_rays: u64,
    /// Formula by formula.
    pub formulas: Vec<Leaks>,
}

/// Rays that get through, by one formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Leaks {
    /// The formula's name.
    pub name: &'static str,
    /// Whether the engine uses it.
    pub is_engines: bool,
    /// Of the rays aimed at edges.
    pub at_edges: u64,
    /// Of the rays aimed at corners.
    pub at_corners: u64,
}

impl LeakRung {
    /// Aims rays and counts those that get through; none for a scene in which no two triangles share an edge, as far as it can
    /// be seen from the eye.
    ///
    /// # Errors
    /// Told to stop.
    pub fn measure(prepared: &Prepared<'_>, options: &RungOptions<'_>) -> Result<Option<Self>, RenderError> {
        options.step("aiming rays at edges", 0, 2)?;
        let mesh = Mesh::new(&prepared.scene.geometry);
        let edges = mesh.edges(prepared);
        options.step("aiming rays at corners", 1, 2)?;
        let corners = mesh.corners(prepared);
        if edges.rays.is_empty() && corners.rays.is_empty() {
            return Ok(None);
        }
        let formulas = triangle::Formula::ALL.iter().map(|&formula| Leaks {
            name: formula.name(),
            is_engines: formula == triangle::Formula::ENGINES,
            at_edges: leaks(formula, options.width, &edges),
            at_corners: leaks(formula, options.width, &corners),
        });
        Ok(Some(Self {
            edge_rays: edges.rays.len() as u64,
            corner_rays: corners.rays.len() as u64,
            formulas: formulas.collect(),
        }))
    }
}

fn leaks(formula: triangle::Formula, width: Width, aimed: &Aimed) -> u64 {
    let ts = answers(formula, width, &aimed.pairs);
    let gets_through = |pairs: &&std::ops::Range<usize>| ts[(*pairs).clone()].iter().all(|t| t.is_infinite());
    aimed.rays.iter().filter(gets_through).count() as u64
}
