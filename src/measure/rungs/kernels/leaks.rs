//! Leaks: rays aimed at what faces share that hit none of them.
//!
//! Random rays do not find cracks; aimed ones do (Schirra, "How Reliable Are Practical Point-in-Polygon Strategies?", 2008).

use super::super::RungOptions;
use super::aimed::{Mesh, Target};
use super::pairs::{PolygonPair, triangle_pair};
use super::{Formula, Tiles, answers, polygon, triangle};
use crate::prepare::Prepared;
use crate::render::RenderError;
use crate::traverse::SingleRay;
use serde::Serialize;
use std::ops::Range;

/// Leaks between triangles or polygons, formula by formula. Rays start at the eye; they are aimed at points of edges that two
/// faces share and at corners that faces lie all around, as seen from there.
#[derive(Clone, Debug, Serialize)]
pub struct LeakRung {
    /// What shares edges and corners.
    pub primitive: &'static str,
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
    /// Aims rays at triangles and counts those that get through; none for a scene in which no two triangles share an edge, as
    /// far as it can be seen from the eye.
    ///
    /// # Errors
    /// Told to stop.
    pub fn of_triangles(
        prepared: &Prepared<'_>,
        options: &RungOptions<'_>,
    ) -> Result<Option<Self>, RenderError> {
        let mesh = Mesh::of_triangles(&prepared.scene.geometry);
        Self::measure::<triangle::Formula>(prepared, &mesh, options, |ray, face, pairs| {
            pairs.push(triangle_pair(ray, mesh.triangle(prepared, face)));
        })
    }

    /// Likewise for polygons.
    ///
    /// # Errors
    /// Told to stop.
    pub fn of_polygons(
        prepared: &Prepared<'_>,
        options: &RungOptions<'_>,
    ) -> Result<Option<Self>, RenderError> {
        let mesh = Mesh::of_polygons(&prepared.scene.geometry);
        let hierarchy = &prepared.hierarchy;
        let mut by_source = vec![0; hierarchy.polygons.len()];
        for (index, face) in hierarchy.polygons.iter().enumerate() {
            by_source[face.source as usize] = index;
        }
        Self::measure::<polygon::Formula>(prepared, &mesh, options, |ray, face, pairs| {
            PolygonPair::new(hierarchy, ray, by_source[face as usize]).push_to(hierarchy, pairs);
        })
    }

    /// `push` appends a pair of a ray and a face.
    fn measure<F: Formula<Pairs: Default>>(
        prepared: &Prepared<'_>,
        mesh: &Mesh,
        options: &RungOptions<'_>,
        push: impl Fn(&SingleRay, u32, &mut F::Pairs),
    ) -> Result<Option<Self>, RenderError> {
        let aimed = |targets: &[Target]| {
            let (mut pairs, mut rays) = (F::Pairs::default(), Vec::new());
            mesh.aim(prepared, targets, |ray, faces| {
                let first = pairs.pairs();
                faces.iter().for_each(|&face| push(ray, face, &mut pairs));
                rays.push(first..pairs.pairs());
            });
            (pairs, rays)
        };
        options.step("aiming rays at edges", 0, 2)?;
        let (edge_pairs, edge_rays) = aimed(&mesh.edges());
        options.step("aiming rays at corners", 1, 2)?;
        let (corner_pairs, corner_rays) = aimed(&mesh.corners());
        if edge_rays.is_empty() && corner_rays.is_empty() {
            return Ok(None);
        }
        let leaks = |formula: F, pairs: &F::Pairs, rays: &[Range<usize>]| {
            let ts = answers(formula, options.width, pairs);
            let gets_through = |pairs: &&Range<usize>| ts[(*pairs).clone()].iter().all(|t| t.is_infinite());
            rays.iter().filter(gets_through).count() as u64
        };
        let formulas = F::ALL.iter().map(|&formula| Leaks {
            name: formula.name(),
            is_engines: formula == F::ENGINES,
            at_edges: leaks(formula, &edge_pairs, &edge_rays),
            at_corners: leaks(formula, &corner_pairs, &corner_rays),
        });
        Ok(Some(Self {
            primitive: F::PRIMITIVE,
            edge_rays: edge_rays.len() as u64,
            corner_rays: corner_rays.len() as u64,
            formulas: formulas.collect(),
        }))
    }
}
