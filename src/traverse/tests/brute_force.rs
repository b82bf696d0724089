//! One ray against every primitive of every leaf, by the functions that say what a hit is, in plain f32.

use crate::kernel::bounds::{self, PADDING};
use crate::kernel::polygon::Outline;
use crate::kernel::tests::sight::{self, Sight};
use crate::kernel::unclear_area;
use crate::lanes::Vector;
use crate::prepare::bvh::{Bounds, WIDTH};
use crate::prepare::{Hierarchy, Place};
use crate::traverse::candidate::{self, Candidate, Start, View};
use crate::traverse::exact::{self, Nearest, Spot};
use crate::traverse::{DEAD, NOTHING, NOWHERE};

/// Every leaf of a tree, with its box.
fn leaves(hierarchy: &Hierarchy) -> impl Iterator<Item = (Place, Bounds)> {
    let slots = hierarchy.nodes.iter().flat_map(|node| (0..WIDTH).map(move |slot| (node, slot)));
    slots.filter_map(|(node, slot)| Some((Hierarchy::place(node.children[slot])?, node.bounds(slot))))
}

/// A ray with all that a query knows of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Query {
    pub(super) sight: Sight,
    /// What the origin's rounding left out.
    pub(super) origin_low: [f32; 3],
    pub(super) departure: u32,
    /// 0 for a ray that starts on a primitive.
    pub(super) t_min: f32,
    pub(super) t_max: f32,
}

impl Query {
    pub(super) fn new(sight: Sight) -> Self {
        Self { sight, origin_low: [0.0; 3], departure: NOWHERE, t_min: 0.0, t_max: f32::INFINITY }
    }

    fn exact(&self) -> exact::Line {
        let vectors = [self.sight.origin, self.origin_low, self.sight.direction];
        exact::Line::new(vectors, self.departure, self.t_min)
    }

    /// Every hit at `t_min` < t: t as the kernel has it, how far it may be off, and where.
    pub(super) fn hits<const DEPARTING: bool>(&self, hierarchy: &Hierarchy) -> Vec<(f32, f32, Spot)> {
        let rays = [self.sight];
        let axes = self.sight.axes();
        let (mut space, mut line) = (sight::space::<f32>(&rays), sight::line::<f32>(&rays));
        if DEPARTING {
            space.origin_low = Some(axes.map(|axis| self.origin_low[axis]));
            line.origin_low = Some(Vector::splat(self.origin_low));
        }
        let farthest = self.sight.origin.into_iter().fold(0.0, |a: f32, b| a.max(b.abs()));
        let padding = (hierarchy.extent + farthest) * PADDING;
        let start = |id: u32| Start::<f32> {
            own: self.departure != NOWHERE && self.departure / 2 == id,
            inward: self.departure % 2 == 1,
            t_min: self.t_min,
        };
        let mut hits = Vec::new();
        let mut offer = |candidate: Candidate<f32>, spot: Spot| {
            if candidate.unclear {
                hits.extend(self.exact().meets::<DEPARTING>(hierarchy, spot));
            } else if candidate.hit {
                hits.push((candidate.t, candidate.error, spot));
            }
        };
        for (place, bounds) in leaves(hierarchy) {
            // That boxes let all hits through but those of triangles seen edge-on, which some rays only seem to hit, is for
            // the kernels' tests.
            let [low, high] = [bounds.low, bounds.high].map(|corner| corner.to_array());
            let [near, far] = sight::planes::<f32>(&rays, &[[low, high]]);
            let slabs = sight::slabs::<f32>(&rays, hierarchy.extent);
            if !bounds::enter(&slabs, near, far, 0.0, f32::INFINITY).1 {
                continue;
            }
            match place {
                Place::Node(_) => {}
                Place::Triangles(index) => {
                    let block = &hierarchy.triangles[index];
                    for (lane, &id) in block.ids.iter().enumerate().filter(|(_, id)| **id != NOTHING) {
                        let corners = block.vertices.map(|corner| axes.map(|axis| corner[axis][lane]));
                        let sizes = || [block.size[lane], block.error_area[lane]];
                        let found = candidate::triangle::<f32, DEPARTING>(
                            &space,
                            padding,
                            corners,
                            sizes,
                            (true, start(id)),
                        );
                        found.into_iter().for_each(|found| offer(found, Spot::triangle(index, lane)));
                    }
                }
                Place::Spheres(index) => {
                    let block = &hierarchy.spheres[index];
                    for (lane, &id) in block.ids.iter().enumerate().filter(|(_, id)| **id != NOTHING) {
                        let center = Vector::splat(block.centers.map(|column| column[lane]));
                        let found = candidate::sphere::<f32, DEPARTING>(
                            &line,
                            padding,
                            center,
                            block.radii[lane],
                            (true, start(id)),
                        );
                        found.into_iter().for_each(|found| offer(found, Spot::sphere(index, lane)));
                    }
                }
                Place::Polygons(first, count) => {
                    for index in first..first + count {
                        let face = &hierarchy.polygons[index];
                        let corner = |at: u32| {
                            let index = (face.first_corner + at % face.edges) as usize;
                            space.see(axes.map(|axis| hierarchy.corners[axis][index]))
                        };
                        let mut outline = Outline::<f32>::new();
                        let doubt = unclear_area(&corner(0), [face.size, face.longest_edge]);
                        for edge in 0..face.edges {
                            let (from, to) = (corner(edge), corner(edge + 1));
                            if DEPARTING {
                                outline.add_edge_with_doubt(&from, &to, (doubt, true), 0.0);
                            } else {
                                outline.add_edge(&from, &to, 0.0);
                            }
                        }
                        if !DEPARTING {
                            let (before, beyond) = outline.sides_of(self.t_min, space.t_per_z);
                            outline.unclear = before & beyond;
                        }
                        let plane = [Vector::splat(face.point), Vector::splat(face.normal)];
                        let view = View { space, line, padding };
                        let (slack, start) = (face.slack, start(face.id));
                        let found =
                            candidate::polygon::<f32, DEPARTING>(&view, plane, &outline, slack, start);
                        offer(found, Spot::polygon(index));
                    }
                }
            }
        }
        hits
    }

    /// The nearest in f64, whatever the kernels' errors.
    pub(super) fn closest<const DEPARTING: bool>(&self, hierarchy: &Hierarchy) -> (f32, u32) {
        let hits = self.hits::<DEPARTING>(hierarchy).into_iter().map(|(t, _, spot)| (spot, t));
        let before_end = hits.filter(|&(_, t)| t < self.t_max);
        let nearest =
            before_end.reduce(|old, new| if self.exact().is_nearer(hierarchy, new, old) { new } else { old });
        nearest.map_or((self.t_max, NOTHING), |(spot, t)| (t, spot.id(hierarchy)))
    }

    /// What is left of t_max: nothing if anything hides the end of the ray.
    pub(super) fn occluded<const DEPARTING: bool>(&self, hierarchy: &Hierarchy) -> f32 {
        let is_hidden = self.hits::<DEPARTING>(hierarchy).into_iter().any(|(t, error, spot)| {
            let end = Nearest { t: self.t_max, error: 0.0, spot: Spot::NOTHING };
            let is_before_end = end.yields_to::<true>(hierarchy, || self.exact(), (t, error, spot));
            is_before_end && hierarchy.casts_shadow(spot.id(hierarchy))
        });
        if is_hidden { DEAD } else { self.t_max }
    }
}
