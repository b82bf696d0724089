//! Rays that walk together: at a node, its eight children are tested against bounds of all rays at once; the first group of
//! lanes with a ray that meets a child's box takes the packet into it; at a leaf, the lanes are rays.
//!
//! This file gathers rays and walks; `leaf` tests what is in a leaf and keeps the nearest hits; `picked` does so for few rays of
//! many, moved side by side.
//!
//! Sources: Wald, Boulos and Shirley, "Ray Tracing Deformable Scenes Using Dynamic Bounding Volume Hierarchies", 2007 (the
//! first active ray); Boulos, Wald and Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray Packets", 2006
//! (interval arithmetic).

mod leaf;
mod picked;

use super::coherence::{WIDEST_SLOPES, common_order};
use super::exact::Spot;
use super::sight::Sight;
use super::{Counts, DEAD, Ends, Rays, child};
use crate::kernel::bounds::{LEAST_COMPONENT, PADDING, Slabs};
use crate::lanes::{Lanes, Mask, RECORD, Single, Vector, least_of_each};
use crate::prepare::bvh::{DEPTH_LIMIT, Node, WIDTH};
use crate::prepare::{Hierarchy, Place};
use picked::Picked;

/// Rays of a packet.
pub(super) const PACKET: usize = 64;

/// A number for each ray.
type Column = [f32; PACKET];

/// Up to 64 rays, in groups of as many as there are lanes.
#[repr(C, align(64))]
pub(super) struct Packet {
    origin: [Column; 3],
    /// What the origins' rounding left out; not read where no ray starts on a primitive.
    origin_low: [Column; 3],
    direction: [Column; 3],
    near_origin: [Column; 3],
    far_origin: [Column; 3],
    inverse: [Column; 3],
    shear: [Column; 2],
    t_per_z: Column,
    a: Column,
    inverse_a: Column,
    /// Not read where rays start on primitives.
    t_min: Column,
    /// The nearest hit so far, or where hits end to be of interest.
    t: Column,
    error: Column,
    /// Nothing beyond this can be nearer: t + error.
    end: Column,
    /// Where the nearest hit lies in the hierarchy, as a [`Spot`].
    spot: [u32; PACKET],
    id: [u32; PACKET],
    /// By how much boxes are grown.
    padding: Column,
    departure: [u32; PACKET],
    /// Order of axes in ray space, the same for all.
    axes: [usize; 3],
    /// Whether the directions' components are negative, the same for all.
    backwards: [bool; 3],
    hull: Hull,
    /// What all of them see, if they start at one point and not on a primitive.
    sight: Option<Sight>,
    count: usize,
    picked: Picked,
    /// Whether a hit was taken in since the hull was made.
    is_changed: bool,
}

/// Bounds of what the slab tests use of all rays.
#[derive(Clone, Copy, Default)]
struct Hull {
    /// Of the near origins that which puts a near plane nearest, a coordinate an axis; of the far ones, farthest.
    near_origin: [f32; 3],
    far_origin: [f32; 3],
    inverse: [[f32; 2]; 3],
    /// No ray looks for hits beyond this.
    t_max: f32,
}

/// A child that waits: where its box is, what it leads to, the first group of rays that may meet it, and a t that none
/// enters it before.
#[derive(Clone, Copy)]
pub(super) struct Waiting {
    node: u32,
    slot: u8,
    first_group: u8,
    enters: f32,
}

/// Enough for the deepest tree.
pub(super) type Stack = [Waiting; DEPTH_LIMIT as usize * (WIDTH - 1) + 1];
pub(super) const EMPTY_STACK: Stack =
    [Waiting { node: 0, slot: 0, first_group: 0, enters: 0.0 }; DEPTH_LIMIT as usize * (WIDTH - 1) + 1];

impl Packet {
    pub(super) fn new() -> Self {
        let column = [0.0; PACKET];
        Self {
            origin: [column; 3],
            origin_low: [column; 3],
            direction: [column; 3],
            near_origin: [column; 3],
            far_origin: [column; 3],
            inverse: [column; 3],
            shear: [column; 2],
            t_per_z: column,
            a: column,
            inverse_a: column,
            t_min: column,
            t: [DEAD; PACKET],
            error: column,
            end: [DEAD; PACKET],
            spot: [Spot::NOTHING.0; PACKET],
            id: [super::NOTHING; PACKET],
            padding: column,
            departure: [super::NOWHERE; PACKET],
            axes: [0, 1, 2],
            backwards: [false; 3],
            hull: Hull::default(),
            sight: None,
            count: 0,
            picked: Picked::NONE,
            is_changed: false,
        }
    }

    /// Forgets what the rays before had that those to come may not have.
    pub(super) fn clear(&mut self) {
        self.origin_low = [[0.0; PACKET]; 3];
        self.t_min = [0.0; PACKET];
        self.departure = [super::NOWHERE; PACKET];
        self.is_changed = false;
    }

    /// Takes rays in, the run of [`PACKET`] rows from `first`; false if they are too unlike to walk together.
    pub(super) fn gather<F: Single>(
        &mut self,
        hierarchy: &Hierarchy,
        rays: &Rays<'_>,
        t: &[f32],
        first: usize,
        count: usize,
    ) -> bool {
        let run = first..first + PACKET;
        let direction = rays.direction.map(|column| &column[run.clone()]);
        let Some((axes, backwards)) = common_order::<F>(direction) else { return false };
        (self.axes, self.backwards, self.count) = (axes, backwards, count);
        for (axis, direction) in direction.into_iter().enumerate() {
            self.direction[axis].copy_from_slice(direction);
            self.origin[axis].copy_from_slice(&rays.origin[axis][run.clone()]);
        }
        self.t.copy_from_slice(&t[run.clone()]);
        let mut bounds = [F::splat(f32::INFINITY); RECORD];
        for row in (0..PACKET).step_by(F::WIDTH) {
            let t_per_z = F::splat(1.0) / F::load(&self.direction[axes[2]][row..]);
            t_per_z.store(&mut self.t_per_z[row..]);
            let shear = [0, 1].map(|axis| F::load(&self.direction[axes[axis]][row..]) * t_per_z);
            shear[0].store(&mut self.shear[0][row..]);
            shear[1].store(&mut self.shear[1][row..]);
            let [x, y] = shear;
            lower(&mut bounds, [x, -x, y, -y, -F::load(&self.t[row..])]);
        }
        let [x, minus_x, y, minus_y, minus_t, ..] = least_of_each(bounds);
        if -minus_x - x > WIDEST_SLOPES || -minus_y - y > WIDEST_SLOPES {
            return false;
        }
        self.hull.t_max = -minus_t;
        self.end = self.t;
        self.error = [0.0; PACKET];
        self.spot = [Spot::NOTHING.0; PACKET];
        self.id = [super::NOTHING; PACKET];
        if !rays.departure.is_empty() {
            for axis in 0..3 {
                self.origin_low[axis].copy_from_slice(&rays.origin_low[axis][run.clone()]);
            }
            self.departure.copy_from_slice(&rays.departure[run]);
        } else if !rays.t_min.is_empty() {
            self.t_min.copy_from_slice(&rays.t_min[run]);
        }
        self.derive::<F>(hierarchy);
        let has_one_origin = rays.departure.is_empty() && self.has_one_origin::<F>();
        self.pad::<F>(hierarchy, has_one_origin);
        self.sight = has_one_origin.then(|| Sight {
            origin: axes.map(|axis| [self.origin[axis][0]; 2]),
            origin_low: None,
            shear: [[x, -minus_x], [y, -minus_y]],
        });
        true
    }

    /// What the tests need beside origin, direction and ray space.
    fn derive<F: Single>(&mut self, hierarchy: &Hierarchy) {
        let one = F::splat(1.0);
        let mut bounds = [F::splat(f32::INFINITY); RECORD];
        for row in (0..PACKET).step_by(F::WIDTH) {
            let direction = self.direction.map_lanes::<F>(row);
            let a = direction.dot(direction);
            a.store(&mut self.a[row..]);
            if !hierarchy.spheres.is_empty() {
                (one / a).store(&mut self.inverse_a[row..]);
            }
            let direction = [direction.x, direction.y, direction.z];
            let least = direction[self.axes[2]].abs() * F::splat(LEAST_COMPONENT);
            let inverse = |axis: usize| {
                if axis == self.axes[2] {
                    return F::load(&self.t_per_z[row..]);
                }
                let size = direction[axis].abs().max(least);
                one / if self.backwards[axis] { -size } else { size }
            };
            let [x, y, z] = [inverse(0), inverse(1), inverse(2)];
            x.store(&mut self.inverse[0][row..]);
            y.store(&mut self.inverse[1][row..]);
            z.store(&mut self.inverse[2][row..]);
            lower(&mut bounds, [x, y, z, -x, -y, -z]);
        }
        let [x, y, z, minus_x, minus_y, minus_z, ..] = least_of_each(bounds);
        self.hull.inverse = [[x, -minus_x], [y, -minus_y], [z, -minus_z]];
    }

    /// Moves origins by as much as boxes are grown.
    fn pad<F: Single>(&mut self, hierarchy: &Hierarchy, has_one_origin: bool) {
        let backwards = self.backwards;
        let mut bounds = [F::splat(f32::INFINITY); RECORD];
        for row in (0..PACKET).step_by(F::WIDTH) {
            let Vector { x, y, z } = self.origin.map_lanes::<F>(row);
            let farthest = x.abs().max(y.abs()).max(z.abs());
            let padding = (F::splat(hierarchy.extent) + farthest) * F::splat(PADDING);
            let moved = [x, y, z].map(|origin| [origin - padding, origin + padding]);
            let rows = if has_one_origin { 0..PACKET } else { row..row + F::WIDTH };
            for row in rows.step_by(F::WIDTH) {
                padding.store(&mut self.padding[row..]);
                for (axis, [less, more]) in moved.into_iter().enumerate() {
                    let (near, far) = if backwards[axis] { (less, more) } else { (more, less) };
                    near.store(&mut self.near_origin[axis][row..]);
                    far.store(&mut self.far_origin[axis][row..]);
                }
            }
            let [[less_x, more_x], [less_y, more_y], [less_z, more_z]] = moved;
            lower(&mut bounds, [less_x, less_y, less_z, -more_x, -more_y, -more_z]);
            if has_one_origin {
                break;
            }
        }
        // The nearest near plane belongs to the origin that is farthest along, the farthest far plane to the other.
        let least = least_of_each(bounds);
        for axis in 0..3 {
            let (less, more) = (least[axis], -least[axis + 3]);
            let (near, far) = if backwards[axis] { (less, more) } else { (more, less) };
            (self.hull.near_origin[axis], self.hull.far_origin[axis]) = (near, far);
        }
    }

    /// As rays from an eye have.
    fn has_one_origin<F: Single>(&self) -> bool {
        let mut differs = F::Mask::NONE;
        for column in &self.origin {
            let first = F::splat(column[0]);
            for row in (0..PACKET).step_by(F::WIDTH) {
                differs = differs | !F::load(&column[row..]).eq(first);
            }
        }
        !differs.any()
    }

    /// Puts the results back.
    pub(super) fn scatter<const ANY: bool>(&self, ends: &mut Ends<'_>, first: usize) {
        ends.t[first..first + PACKET].copy_from_slice(&self.t);
        if !ANY {
            ends.id[first..first + PACKET].copy_from_slice(&self.id);
        }
    }

    /// Finds the nearest hit of each ray or, if ANY, which of them hit anything that casts a shadow.
    pub(super) fn walk<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        stack: &mut Stack,
        counts: &mut Counts,
    ) {
        counts.in_packets += self.count as u64;
        let mut waiting = self.push_children::<F>(hierarchy, 0, 0, stack, 0, counts);
        while waiting > 0 {
            waiting -= 1;
            let Waiting { node: parent, slot, first_group, enters } = stack[waiting];
            if enters > self.hull.t_max {
                continue;
            }
            let node = &hierarchy.nodes[parent as usize];
            let child = node.children[slot as usize];
            let Some((group, bits)) = self.first_group_in::<F>(node, slot, first_group, counts) else {
                continue;
            };
            match Hierarchy::place(child) {
                None => {}
                Some(Place::Node(index)) => {
                    waiting = self.push_children::<F>(hierarchy, index, group, stack, waiting, counts);
                }
                Some(leaf) => {
                    self.visit_leaf::<F, DEPARTING, ANY>(
                        hierarchy,
                        leaf,
                        (node, slot),
                        (group, bits),
                        counts,
                    );
                    if std::mem::take(&mut self.is_changed) {
                        self.hull.t_max = largest::<F>(&self.end);
                    }
                    if ANY && self.hull.t_max < 0.0 {
                        return;
                    }
                }
            }
        }
    }

    /// Puts the children that some ray may meet on the stack, the nearest on top.
    #[inline(always)]
    fn push_children<F: Single>(
        &self,
        hierarchy: &Hierarchy,
        index: usize,
        group: u8,
        stack: &mut Stack,
        bottom: usize,
        counts: &mut Counts,
    ) -> usize {
        let node = &hierarchy.nodes[index];
        let mut enters = [0.0; WIDTH];
        let mut bits = 0;
        for slot in (0..WIDTH).step_by(F::Node::WIDTH) {
            let (enter, meets) = self.hull_enters::<F::Node>(node, slot);
            enter.store(&mut enters[slot..]);
            bits |= meets.bits() << slot;
            counts.boxes.add(F::Node::WIDTH, F::Node::WIDTH);
        }
        let mut waiting = bottom;
        while bits != 0 {
            let slot = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            hierarchy.prefetch(node.children[slot]);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "a slot is below 8, and nodes are numbered in 32 bits"
            )]
            let entry =
                Waiting { node: index as u32, slot: slot as u8, first_group: group, enters: enters[slot] };
            let mut place = waiting;
            while place > bottom && stack[place - 1].enters < entry.enters {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = entry;
            waiting += 1;
        }
        waiting
    }

    /// Boxes of children against bounds of all rays: rounding is monotonic, so what a ray's own test lets through is let
    /// through here.
    #[inline(always)]
    fn hull_enters<L: Single>(&self, node: &Node, slot: usize) -> (L, L::Mask) {
        let mut enter = L::splat(0.0);
        let mut leave = L::splat(self.hull.t_max);
        for axis in 0..3 {
            let (near, far) = if self.backwards[axis] {
                (&node.high[axis], &node.low[axis])
            } else {
                (&node.low[axis], &node.high[axis])
            };
            let [least, largest] = self.hull.inverse[axis].map(L::splat);
            let near = L::load(&near[slot..]) - L::splat(self.hull.near_origin[axis]);
            let far = L::load(&far[slot..]) - L::splat(self.hull.far_origin[axis]);
            enter = (near * least).min(near * largest).max(enter);
            leave = (far * least).max(far * largest).min(leave);
        }
        (enter, enter.le(leave))
    }

    /// The first group from `from` on with a ray that meets a child's box, and which of its rays do.
    #[inline(always)]
    fn first_group_in<F: Single>(
        &self,
        node: &Node,
        slot: u8,
        from: u8,
        counts: &mut Counts,
    ) -> Option<(u8, u32)> {
        #[expect(clippy::cast_possible_truncation, reason = "at most 64 groups")]
        let groups = (PACKET / F::WIDTH) as u8;
        (from..groups).find_map(|group| {
            let bits = self.group_enters::<F>(node, slot, group, counts).bits();
            (bits != 0).then_some((group, bits))
        })
    }

    /// Which rays of a group meet a child's box.
    #[inline(always)]
    fn group_enters<F: Single>(&self, node: &Node, slot: u8, group: u8, counts: &mut Counts) -> F::Mask {
        let row = group as usize * F::WIDTH;
        let slot = slot as usize;
        let slabs = Slabs {
            near_origin: self.near_origin.map_lanes(row),
            far_origin: self.far_origin.map_lanes(row),
            inverse: self.inverse.map_lanes(row),
        };
        counts.boxes.add(F::WIDTH, self.count.saturating_sub(row).min(F::WIDTH));
        child::meet(&slabs, (node, slot), self.backwards, F::load(&self.end[row..]))
    }
}

/// Three columns as lanes of vectors.
trait Columns {
    fn map_lanes<F: Single>(&self, row: usize) -> Vector<F>;
}

impl Columns for [Column; 3] {
    #[inline(always)]
    fn map_lanes<F: Single>(&self, row: usize) -> Vector<F> {
        Vector::new(F::load(&self[0][row..]), F::load(&self[1][row..]), F::load(&self[2][row..]))
    }
}

#[inline(always)]
fn lower<F: Single, const N: usize>(bounds: &mut [F; RECORD], by: [F; N]) {
    for (bound, by) in bounds.iter_mut().zip(by) {
        *bound = by.min(*bound);
    }
}

/// The largest of a column.
#[inline(always)]
fn largest<F: Single>(column: &Column) -> f32 {
    let mut lanes = [0.0; 16];
    let first = F::load(column);
    let rows = (F::WIDTH..PACKET).step_by(F::WIDTH);
    rows.fold(first, |largest, row| F::load(&column[row..]).max(largest)).store(&mut lanes);
    for half in [8, 4, 2, 1] {
        if half < F::WIDTH {
            for lane in 0..half {
                lanes[lane] = Lanes::max(lanes[lane + half], lanes[lane]);
            }
        }
    }
    lanes[0]
}
