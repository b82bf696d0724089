//! One ray at a time: its lanes are the children of a node and the primitives of a block.

use super::candidate::{self, Start};
use super::{Counts, DEAD, NOTHING, Rays};
use crate::kernel::bounds::{self, LEAST_COMPONENT, PADDING, Slabs};
use crate::kernel::polygon::Outline;
use crate::kernel::sphere::Line;
use crate::kernel::{RaySpace, axes_from};
use crate::lanes::{Lanes, Mask, Single, Vector};
use crate::prepare::bvh::{Child, DEPTH_LIMIT, Node, WIDTH};
use crate::prepare::{BLOCK, Hierarchy, Place, PolygonFace, SphereBlock, TriangleBlock};

/// What the tests need of a ray.
pub(super) struct Ray {
    origin: [f32; 3],
    direction: [f32; 3],
    /// Whether the direction's component is negative.
    backwards: [bool; 3],
    near_origin: [f32; 3],
    far_origin: [f32; 3],
    inverse: [f32; 3],
    /// Order of axes in ray space.
    axes: [usize; 3],
    shear: [f32; 2],
    t_per_z: f32,
    /// d·d.
    a: f32,
    departure: u32,
}

impl Ray {
    #[inline(always)]
    pub(super) fn new(hierarchy: &Hierarchy, rays: &Rays<'_>, row: usize) -> Self {
        let origin = rays.origin.map(|column| column[row]);
        let direction = rays.direction.map(|column| column[row]);
        let sizes = direction.map(f32::abs);
        let third = if sizes[0] >= sizes[1] && sizes[0] >= sizes[2] {
            0
        } else if sizes[1] >= sizes[2] {
            1
        } else {
            2
        };
        let axes = axes_from(third);
        let backwards = direction.map(|component| component < 0.0);
        let least = sizes[third] * LEAST_COMPONENT;
        let farthest = Lanes::max(Lanes::max(origin[0].abs(), origin[1].abs()), origin[2].abs());
        let padding = (hierarchy.extent + farthest) * PADDING;
        let padded = |axis: usize, padding: f32| {
            if backwards[axis] { origin[axis] - padding } else { origin[axis] + padding }
        };
        Self {
            origin,
            direction,
            backwards,
            near_origin: [0, 1, 2].map(|axis| padded(axis, padding)),
            far_origin: [0, 1, 2].map(|axis| padded(axis, -padding)),
            inverse: [0, 1, 2].map(|axis| {
                let size = Lanes::max(sizes[axis], least);
                1.0 / if backwards[axis] { -size } else { size }
            }),
            axes,
            shear: [direction[axes[0]] / direction[third], direction[axes[1]] / direction[third]],
            t_per_z: 1.0 / direction[third],
            a: direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2],
            departure: rays.departure.get(row).copied().unwrap_or(super::NOWHERE),
        }
    }

    fn slabs<L: Lanes<Scalar = f32>>(&self) -> Slabs<L> {
        Slabs {
            near_origin: Vector::splat(self.near_origin),
            far_origin: Vector::splat(self.far_origin),
            inverse: Vector::splat(self.inverse),
        }
    }

    fn space<L: Lanes<Scalar = f32>>(&self) -> RaySpace<L> {
        RaySpace {
            origin: self.axes.map(|axis| L::splat(self.origin[axis])),
            shear: self.shear.map(L::splat),
            t_per_z: L::splat(self.t_per_z),
        }
    }

    fn line<L: Lanes<Scalar = f32>>(&self) -> Line<L> {
        Line {
            origin: Vector::splat(self.origin),
            direction: Vector::splat(self.direction),
            a: L::splat(self.a),
            inverse_a: L::splat(1.0 / self.a),
        }
    }

    /// Whether the ray starts on primitives of these ids, and then which way it goes.
    #[inline(always)]
    fn start<F: Single>(&self, ids: F::Ids) -> Start<F> {
        let own = F::ids_eq(ids, F::splat_ids(self.departure >> 1));
        let inward = F::first(if self.departure & 1 == 1 { F::WIDTH } else { 0 });
        Start { own, inward }
    }
}

/// The closest hit so far.
struct Nearest {
    t: f32,
    id: u32,
}

impl Nearest {
    #[inline(always)]
    fn offer(&mut self, t: f32, id: u32) {
        if t < self.t || (t == self.t && id < self.id && self.id != NOTHING) {
            *self = Self { t, id };
        }
    }

    /// Offers the lanes of a block that hit.
    #[inline(always)]
    fn offer_lanes<F: Single>(&mut self, (t, hit): (F, F::Mask), ids: &[u32]) {
        let mut bits = (hit & t.le(F::splat(self.t))).bits();
        if bits == 0 {
            return;
        }
        let mut ts = [0.0; BLOCK];
        t.store(&mut ts);
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            self.offer(ts[lane], ids[lane]);
        }
    }
}

/// Children that wait, each with the t at which the ray enters it.
const STACK: usize = DEPTH_LIMIT as usize * (WIDTH - 1) + 1;

/// The nearest hit at 0 < t < `t_max`: t and id. If ANY, whether there is one that casts a shadow: then t is [`DEAD`].
pub(super) fn walk<F: Single, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    ray: &Ray,
    t_max: f32,
    counts: &mut Counts,
) -> (f32, u32) {
    let mut nearest = Nearest { t: t_max, id: NOTHING };
    let slabs: Slabs<F::Node> = ray.slabs();
    let mut stack = [(Child::EMPTY, 0.0_f32); STACK];
    stack[0] = (Child::inner(0), 0.0);
    let mut waiting = 1;
    while waiting > 0 {
        waiting -= 1;
        let (child, enters) = stack[waiting];
        if enters > nearest.t {
            continue;
        }
        let Some(place) = Hierarchy::place(child) else { continue };
        match place {
            Place::Node(index) => {
                let node = &hierarchy.nodes[index];
                waiting = push_children::<F>(node, ray, &slabs, nearest.t, &mut stack, waiting, counts);
                continue;
            }
            Place::Triangles(index) => {
                test_triangles::<F::Block, DEPARTING>(
                    &hierarchy.triangles[index],
                    ray,
                    &mut nearest,
                    hierarchy,
                    ANY,
                );
                counts.triangles.add(F::Block::WIDTH, BLOCK.min(F::Block::WIDTH));
            }
            Place::Spheres(index) => {
                test_spheres::<F::Block, DEPARTING>(
                    &hierarchy.spheres[index],
                    ray,
                    &mut nearest,
                    hierarchy,
                    ANY,
                );
                counts.spheres.add(F::Block::WIDTH, BLOCK.min(F::Block::WIDTH));
            }
            Place::Polygons(first, count) => {
                for face in &hierarchy.polygons[first..first + count] {
                    test_polygon::<F::Node, DEPARTING>(hierarchy, face, ray, &mut nearest, counts, ANY);
                }
            }
        }
        if ANY && nearest.id != NOTHING {
            return (DEAD, nearest.id);
        }
    }
    (nearest.t, nearest.id)
}

/// Puts the children that the ray meets on the stack, the nearest on top.
#[inline(always)]
fn push_children<F: Single>(
    node: &Node,
    ray: &Ray,
    slabs: &Slabs<F::Node>,
    t_max: f32,
    stack: &mut [(Child, f32); STACK],
    waiting: usize,
    counts: &mut Counts,
) -> usize {
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
    let bottom = waiting;
    let mut waiting = waiting;
    while bits != 0 {
        let slot = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        // Insertion: the farther a child, the deeper it lies.
        let entry = (node.children[slot], enters[slot]);
        let mut place = waiting;
        while place > bottom && stack[place - 1].1 < entry.1 {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = entry;
        waiting += 1;
    }
    waiting
}

#[inline(always)]
fn test_triangles<F: Single, const DEPARTING: bool>(
    block: &TriangleBlock,
    ray: &Ray,
    nearest: &mut Nearest,
    hierarchy: &Hierarchy,
    any: bool,
) {
    let space = ray.space::<F>();
    for lane in (0..BLOCK).step_by(F::WIDTH) {
        let vertices =
            [0, 1, 2].map(|vertex| ray.axes.map(|axis| F::load(&block.vertices[vertex][axis][lane..])));
        let ids = F::load_ids(&block.ids[lane..]);
        let slack = F::load(&block.slack[lane..]);
        let (t, hit) = candidate::triangle::<F, DEPARTING>(&space, vertices, slack, ray.start(ids));
        offer_block(nearest, (t, hit), &block.ids[lane..], hierarchy, any);
    }
}

#[inline(always)]
fn test_spheres<F: Single, const DEPARTING: bool>(
    block: &SphereBlock,
    ray: &Ray,
    nearest: &mut Nearest,
    hierarchy: &Hierarchy,
    any: bool,
) {
    let line = ray.line::<F>();
    for lane in (0..BLOCK).step_by(F::WIDTH) {
        let [x, y, z] = [0, 1, 2].map(|axis| F::load(&block.centers[axis][lane..]));
        let radius_squared = F::load(&block.radii_squared[lane..]);
        let ids = F::load_ids(&block.ids[lane..]);
        let slack = F::load(&block.slack[lane..]);
        let center = Vector::new(x, y, z);
        let candidate =
            candidate::sphere::<F, DEPARTING>(&line, center, radius_squared, slack, ray.start(ids));
        offer_block(nearest, candidate, &block.ids[lane..], hierarchy, any);
    }
}

/// For an occlusion query, what casts no shadow is not there.
#[inline(always)]
fn offer_block<F: Single>(
    nearest: &mut Nearest,
    (t, hit): (F, F::Mask),
    ids: &[u32],
    hierarchy: &Hierarchy,
    any: bool,
) {
    if any && !hierarchy.shadowless.is_empty() {
        let hides: [bool; BLOCK] =
            std::array::from_fn(|lane| ids.get(lane).is_some_and(|&id| hierarchy.casts_shadow(id)));
        let mut bits = hit.bits();
        let mut ts = [0.0; BLOCK];
        t.store(&mut ts);
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            if hides[lane] {
                nearest.offer(ts[lane], ids[lane]);
            }
        }
    } else {
        nearest.offer_lanes((t, hit), ids);
    }
}

/// The edges of one polygon in lanes; at the end there is one answer.
#[inline(always)]
fn test_polygon<F: Single, const DEPARTING: bool>(
    hierarchy: &Hierarchy,
    face: &PolygonFace,
    ray: &Ray,
    nearest: &mut Nearest,
    counts: &mut Counts,
    any: bool,
) {
    if any && !hierarchy.casts_shadow(face.id) {
        return;
    }
    let space = ray.space::<F>();
    let mut outline = Outline::<F>::new();
    let first = face.first_corner as usize;
    let edges = face.edges as usize;
    let zero = F::splat(0.0);
    let corners = |from: usize| space.see(ray.axes.map(|axis| F::load(&hierarchy.corners[axis][from..])));
    for edge in (first..first + edges).step_by(F::WIDTH) {
        // Beyond the last edge there are edges from the first corner to itself, which nothing crosses.
        outline.add_edge(&corners(edge), &corners(edge + 1), zero);
        counts.polygons.add(F::WIDTH, (first + edges - edge).min(F::WIDTH));
    }
    let is_odd = outline.odd.bits().count_ones() % 2 == 1;
    if !is_odd {
        return;
    }
    let outline = Outline {
        odd: true,
        least_z: fold(outline.least_z, Lanes::min),
        largest_z: fold(outline.largest_z, Lanes::max),
    };
    let line = ray.line::<f32>();
    let plane = [Vector::splat(face.point), Vector::splat(face.normal)];
    let start = ray.start::<f32>(face.id);
    let (t, hit) =
        candidate::polygon::<f32, DEPARTING>(&line, ray.t_per_z, plane, &outline, face.slack, start);
    if hit {
        nearest.offer(t, face.id);
    }
}

/// The least or the largest of all lanes: the same in any order, unlike a sum.
#[inline(always)]
fn fold<F: Single>(lanes: F, which: fn(f32, f32) -> f32) -> f32 {
    let mut array = [0.0; 16];
    lanes.store(&mut array);
    array[1..F::WIDTH].iter().fold(array[0], |a, &b| which(a, b))
}
