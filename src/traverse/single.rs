//! One ray at a time: its lanes are the children of a node and the primitives of a block.

use super::candidate::{self, View};
use super::exact::{self, Nearest, Spot};
use super::terms::Terms;
use super::tile::{self, Origin, TileLines, TileRays};
use super::{Counts, Rays};
use crate::kernel::bounds::{self, Slabs};
use crate::kernel::polygon::Outline;
use crate::kernel::sphere::Line;
use crate::kernel::{RaySpace, axes_along, unclear_area};
use crate::lanes::{Lanes, Mask, Single, Vector};
use crate::prepare::bvh::{Child, Node, WIDTH};
use crate::prepare::{Hierarchy, Place};

/// What the tests need of a ray.
pub(crate) struct Ray {
    pub(super) origin: [f32; 3],
    pub(super) origin_low: [f32; 3],
    pub(super) direction: [f32; 3],
    /// Whether the direction's component is negative.
    pub(super) backwards: [bool; 3],
    pub(super) near_origin: [f32; 3],
    pub(super) far_origin: [f32; 3],
    pub(super) inverse: [f32; 3],
    /// Order of axes in ray space.
    pub(super) axes: [usize; 3],
    pub(super) shear: [f32; 2],
    pub(super) t_per_z: f32,
    /// d·d.
    pub(super) a: f32,
    /// By how much boxes are grown.
    pub(super) padding: f32,
    pub(super) t_min: f32,
    pub(super) departure: u32,
}

impl Ray {
    /// None.
    pub(super) const NONE: Self = Self {
        origin: [0.0; 3],
        origin_low: [0.0; 3],
        direction: [0.0; 3],
        backwards: [false; 3],
        near_origin: [0.0; 3],
        far_origin: [0.0; 3],
        inverse: [0.0; 3],
        axes: [0, 1, 2],
        shear: [0.0; 2],
        t_per_z: 0.0,
        a: 0.0,
        padding: 0.0,
        t_min: 0.0,
        departure: super::NOWHERE,
    };

    #[inline(always)]
    pub(crate) fn new(hierarchy: &Hierarchy, rays: &Rays<'_>, row: usize) -> Self {
        let origin = rays.origin.map(|column| column[row]);
        let direction = rays.direction.map(|column| column[row]);
        let axes = axes_along(direction);
        let backwards = direction.map(|component| component < 0.0);
        let terms = Terms::new(hierarchy.extent, [origin, direction], axes[2], backwards);
        let Terms { padding, inverse, shear, t_per_z, a } = terms;
        let padded = |axis: usize, padding: f32| {
            if backwards[axis] { origin[axis] - padding } else { origin[axis] + padding }
        };
        Self {
            origin,
            origin_low: rays.origin_low.map(|column| column.get(row).copied().unwrap_or(0.0)),
            direction,
            backwards,
            near_origin: [0, 1, 2].map(|axis| padded(axis, padding)),
            far_origin: [0, 1, 2].map(|axis| padded(axis, -padding)),
            inverse,
            axes,
            shear,
            t_per_z,
            a,
            padding,
            t_min: rays.t_min.get(row).copied().unwrap_or(0.0),
            departure: rays.departure.get(row).copied().unwrap_or(super::NOWHERE),
        }
    }

    pub(crate) fn slabs<L: Lanes<Scalar = f32>>(&self) -> Slabs<L> {
        Slabs {
            near_origin: Vector::splat(self.near_origin),
            far_origin: Vector::splat(self.far_origin),
            inverse: Vector::splat(self.inverse),
        }
    }

    pub(crate) fn space<L: Lanes<Scalar = f32>, const DEPARTING: bool>(&self) -> RaySpace<L> {
        RaySpace {
            origin: self.axes.map(|axis| L::splat(self.origin[axis])),
            origin_low: DEPARTING.then(|| self.axes.map(|axis| L::splat(self.origin_low[axis]))),
            shear: self.shear.map(L::splat),
            t_per_z: L::splat(self.t_per_z),
        }
    }

    pub(crate) fn line<L: Lanes<Scalar = f32>, const DEPARTING: bool>(&self) -> Line<L> {
        Line {
            origin: Vector::splat(self.origin),
            origin_low: DEPARTING.then(|| Vector::splat(self.origin_low)),
            direction: Vector::splat(self.direction),
            a: L::splat(self.a),
            inverse_a: L::splat(1.0 / self.a),
        }
    }

    /// Order of axes in ray space.
    pub(crate) fn axes(&self) -> [usize; 3] {
        self.axes
    }

    pub(super) fn exact(&self) -> exact::Line {
        exact::Line::new([self.origin, self.origin_low, self.direction], self.departure, self.t_min)
    }

    #[inline(always)]
    fn start<L: Single>(&self) -> Origin<L> {
        Origin {
            padding: L::splat(self.padding),
            t_min: L::splat(self.t_min),
            departure: L::splat(f32::from_bits(self.departure)),
        }
    }
}

/// What takes a candidate, and how.
struct Target<'a> {
    hierarchy: &'a Hierarchy,
    ray: &'a Ray,
    nearest: Nearest,
    /// Nothing beyond this can be nearer: t + error.
    end: f32,
}

impl<'a> Target<'a> {
    #[inline(always)]
    fn new(hierarchy: &'a Hierarchy, ray: &'a Ray, nearest: Nearest) -> Self {
        Self { hierarchy, ray, nearest, end: nearest.end() }
    }
}

impl Target<'_> {
    /// Takes a hit in if it is nearer, or if any will do and it casts a shadow.
    #[inline(always)]
    fn offer<const ANY: bool>(&mut self, found: (f32, f32, Spot)) {
        let (t, error, spot) = found;
        let is_taken = self.nearest.yields_to::<ANY>(self.hierarchy, || self.ray.exact(), found)
            && (!ANY || self.hierarchy.casts_shadow(spot.id(self.hierarchy)));
        if is_taken {
            self.nearest = Nearest { t, error, spot };
            self.end = t + error;
        }
    }

    /// Takes in what is met of a primitive for which f32 cannot tell.
    #[cold]
    fn offer_exact<const DEPARTING: bool, const ANY: bool>(&mut self, spot: Spot) {
        if let Some(found) = self.ray.exact().meets::<DEPARTING>(self.hierarchy, spot) {
            self.offer::<ANY>(found);
        }
    }
}

impl TileRays for Target<'_> {
    #[inline(always)]
    fn axes(&self) -> [usize; 3] {
        self.ray.axes
    }

    #[inline(always)]
    fn space<L: Single, const DEPARTING: bool>(&self, _: usize) -> (RaySpace<L>, Origin<L>) {
        (self.ray.space::<L, DEPARTING>(), self.ray.start())
    }

    #[inline(always)]
    fn offer<const ANY: bool>(&mut self, _: &Hierarchy, _: usize, found: (f32, f32, Spot)) {
        self.offer::<ANY>(found);
    }

    #[inline(always)]
    fn offer_exact<const DEPARTING: bool, const ANY: bool>(&mut self, _: &Hierarchy, _: usize, spot: Spot) {
        self.offer_exact::<DEPARTING, ANY>(spot);
    }
}

impl TileLines for Target<'_> {
    #[inline(always)]
    fn line<L: Single, const DEPARTING: bool>(&self, _: usize) -> (Line<L>, Origin<L>) {
        (self.ray.line::<L, DEPARTING>(), self.ray.start())
    }
}

/// Tests what is in a leaf, and returns what is nearest then: a hit beyond `t_min` that is nearer than what is given. If ANY, one
/// that casts a shadow, before the t that is given.
#[inline(always)]
pub(super) fn visit_leaf<F: Single, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    ray: &Ray,
    (leaf, nearest): (Place, Nearest),
    counts: &mut Counts,
) -> Nearest {
    let mut target = Target::new(hierarchy, ray, nearest);
    target.visit_leaf::<F, DEPARTING, ANY>(leaf, counts);
    target.nearest
}

/// Visits the leaves that a ray enters before `end`, the nearer first.
pub(crate) fn leaves(hierarchy: &Hierarchy, ray: &Ray, end: f32, mut visit: impl FnMut(Place)) {
    if hierarchy.nodes.is_empty() {
        return;
    }
    let (slabs, mut counts) = (ray.slabs(), Counts::default());
    let mut waiting = vec![Child::inner(0)];
    while let Some(child) = waiting.pop() {
        match Hierarchy::place(child) {
            Some(Place::Node(index)) => {
                let node = &hierarchy.nodes[index];
                let (enters, bits) = enter_children::<f32>(node, ray, &slabs, end, &mut counts);
                let mut slots: Vec<usize> = (0..WIDTH).filter(|slot| bits >> slot & 1 == 1).collect();
                slots.sort_by(|&one, &other| enters[other].total_cmp(&enters[one]));
                waiting.extend(slots.into_iter().map(|slot| node.children[slot]));
            }
            Some(leaf) => visit(leaf),
            None => {}
        }
    }
}

/// Where a ray enters the children of a node, and those that it meets before `t_max`, as bits.
#[inline(always)]
pub(super) fn enter_children<F: Single>(
    node: &Node,
    ray: &Ray,
    slabs: &Slabs<F::Node>,
    t_max: f32,
    counts: &mut Counts,
) -> ([f32; WIDTH], u32) {
    let mut enters = [0.0; WIDTH];
    let mut bits = 0;
    let (zero, t_max) = (F::Node::splat(0.0), F::Node::splat(t_max));
    for slot in (0..WIDTH).step_by(F::Node::WIDTH) {
        let plane = |axis: usize, far: bool| {
            let planes = if ray.backwards[axis] == far { &node.low[axis] } else { &node.high[axis] };
            F::Node::load(&planes[slot..])
        };
        let near = Vector::new(plane(0, false), plane(1, false), plane(2, false));
        let far = Vector::new(plane(0, true), plane(1, true), plane(2, true));
        let (enter, meets) = bounds::enter(slabs, near, far, zero, t_max);
        enter.store(&mut enters[slot..]);
        bits |= meets.bits() << slot;
        counts.boxes.add(F::Node::WIDTH, F::Node::WIDTH);
    }
    (enters, bits)
}

impl Target<'_> {
    #[inline(always)]
    fn visit_leaf<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        leaf: Place,
        counts: &mut Counts,
    ) {
        match leaf {
            Place::Node(_) => {}
            Place::Triangles(block) => {
                tile::triangles::<F::Block, DEPARTING, ANY>(self.hierarchy, block, (self, 1), counts);
            }
            Place::Spheres(block) => {
                tile::spheres::<F::Block, DEPARTING, ANY>(self.hierarchy, block, (self, 1), counts);
            }
            Place::Polygons(first, count) => {
                for index in first..first + count {
                    self.test_polygon::<F::Node, DEPARTING, ANY>(index, counts);
                }
            }
        }
    }

    /// The edges of one polygon in lanes; at the end there is one answer.
    #[inline(always)]
    fn test_polygon<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        index: usize,
        counts: &mut Counts,
    ) {
        let (ray, hierarchy) = (self.ray, self.hierarchy);
        let face = &hierarchy.polygons[index];
        let space = ray.space::<F, DEPARTING>();
        let mut outline = Outline::<F>::new();
        let first = face.first_corner as usize;
        let edges = face.edges as usize;
        let zero = F::splat(0.0);
        let [x, y, z] = ray.axes.map(|axis| &hierarchy.corners[axis][..]);
        let corners =
            |from: usize| space.see([F::load(&x[from..]), F::load(&y[from..]), F::load(&z[from..])]);
        let doubt = if DEPARTING {
            let corner = ray.space::<f32, DEPARTING>().see([x[first], y[first], z[first]]);
            unclear_area(&corner, [face.size, face.longest_edge])
        } else {
            0.0
        };
        for edge in (first..first + edges).step_by(F::WIDTH) {
            // Beyond the last edge there are edges from the first corner to itself, which nothing crosses.
            let (from, to, in_use) = (corners(edge), corners(edge + 1), (first + edges - edge).min(F::WIDTH));
            if DEPARTING {
                outline.add_edge_with_doubt(&from, &to, (F::splat(doubt), F::first(in_use)), zero);
            } else {
                outline.add_edge(&from, &to, zero);
            }
            counts.polygons.add(F::WIDTH, in_use);
        }
        let odd = !outline.odd.bits().count_ones().is_multiple_of(2);
        let unclear = if DEPARTING {
            outline.unclear.any()
        } else {
            let (before, beyond) = outline.sides_of(F::splat(ray.t_min), F::splat(ray.t_per_z));
            before.any() && beyond.any()
        };
        if !(odd | unclear) {
            return;
        }
        let outline = Outline {
            odd,
            unclear,
            least_z: fold(outline.least_z, Lanes::min),
            largest_z: fold(outline.largest_z, Lanes::max),
        };
        let view = View {
            space: ray.space::<f32, DEPARTING>(),
            line: ray.line::<f32, DEPARTING>(),
            padding: ray.padding,
        };
        let plane = [Vector::splat(face.point), Vector::splat(face.normal)];
        let start = ray.start::<f32>().on::<DEPARTING>(face.id);
        let candidate = candidate::polygon::<f32, DEPARTING>(&view, plane, &outline, face.slack, start);
        let spot = Spot::polygon(index);
        if candidate.unclear {
            self.offer_exact::<DEPARTING, ANY>(spot);
        } else if candidate.hit {
            self.offer::<ANY>((candidate.t, candidate.error, spot));
        }
    }
}

/// The least or the largest of all lanes: the same in any order, unlike a sum.
#[inline(always)]
fn fold<F: Single>(lanes: F, which: fn(f32, f32) -> f32) -> f32 {
    let mut array = [0.0; 16];
    lanes.store(&mut array);
    array[1..F::WIDTH].iter().fold(array[0], |a, &b| which(a, b))
}
