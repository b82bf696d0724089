//! Wide nodes as they lie in memory.

use super::{Bounds, Kind};
use crate::lanes::Arrangement;

/// Children of a wide node: as many as the lanes of a 256-bit vector of f32.
pub(crate) const WIDTH: usize = 8;

/// A node of up to eight children, one array a plane of their boxes, so that a ray meets eight boxes at once.
///
/// | bytes | field |
/// |---|---|
/// | 0–95 | `low`: x, y, z of eight children each |
/// | 96–191 | `high`: likewise |
/// | 192–223 | `children` |
/// | 224–255 | `orders`: for rays of each octant of directions, the slots from near to far |
///
/// Children come first, in the order of their leaves; what is left over has the box from +∞ to −∞, which no ray meets,
/// and [`Child::EMPTY`].
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub low: [[f32; WIDTH]; 3],
    pub high: [[f32; WIDTH]; 3],
    pub children: [Child; WIDTH],
    pub orders: [Order; 8],
}

const _: () = assert!(size_of::<Node>() == 256 && align_of::<Node>() == 64);

impl Node {
    pub(crate) const EMPTY: Self = Self {
        low: [[f32::INFINITY; WIDTH]; 3],
        high: [[f32::NEG_INFINITY; WIDTH]; 3],
        children: [Child::EMPTY; WIDTH],
        orders: [Order(0); 8],
    };

    pub(super) fn set(&mut self, slot: usize, bounds: Bounds, child: Child) {
        for axis in 0..3 {
            self.low[axis][slot] = bounds.low[axis];
            self.high[axis][slot] = bounds.high[axis];
        }
        self.children[slot] = child;
    }

    /// Says in which order rays meet the children, once all are set: that of their middles along the octant's diagonal, so the
    /// opposite octant has the reverse.
    pub(super) fn set_orders(&mut self) {
        let used = self.children.iter().map(|&child| u32::from(child != Child::EMPTY)).sum();
        let mut middles = [[0.0; WIDTH]; 3];
        for (axis, middles) in middles.iter_mut().enumerate() {
            for (slot, middle) in middles.iter_mut().enumerate() {
                *middle = 0.5 * self.low[axis][slot] + 0.5 * self.high[axis][slot];
            }
        }
        let [x, y, z] = &middles;
        for octant in 0..4 {
            let sign = |axis: usize| if octant >> axis & 1 == 1 { -1.0 } else { 1.0 };
            // Slots that are not used come last.
            let mut along = [f32::INFINITY; WIDTH];
            for slot in 0..WIDTH {
                let is_used = slot < used as usize;
                along[slot] =
                    if is_used { sign(0) * x[slot] + sign(1) * y[slot] + z[slot] } else { along[slot] };
            }
            let ranks = ranks(&along);
            self.orders[octant] = Order::of_ranks(&ranks, used);
            let mut reverse = [0; WIDTH];
            for slot in 0..WIDTH {
                reverse[slot] = (used + 7 - ranks[slot]) & 7;
            }
            self.orders[7 - octant] = Order::of_ranks(&reverse, used);
        }
    }

    pub(crate) fn bounds(&self, slot: usize) -> Bounds {
        let corner = |planes: &[[f32; WIDTH]; 3]| glam::Vec3::from(planes.map(|plane| plane[slot]));
        Bounds { low: corner(&self.low), high: corner(&self.high) }
    }
}

/// How many numbers lie before each; of equals the one before is first.
fn ranks(numbers: &[f32; WIDTH]) -> [u32; WIDTH] {
    let mut ranks = [0; WIDTH];
    for (place, &other) in numbers.iter().enumerate() {
        for slot in 0..WIDTH {
            let (is_less, is_equal) = (other < numbers[slot], other == numbers[slot]);
            ranks[slot] += u32::from(is_less | (is_equal & (place < slot)));
        }
    }
    ranks
}

/// Slots of a node that lead somewhere, in an order: each in 3 bits, the first lowest; how many there are in the 4 high bits.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Order(u32);

impl Order {
    /// Of the first `used` slots, by their ranks.
    fn of_ranks(ranks: &[u32; WIDTH], used: u32) -> Self {
        let mut list = 0;
        for (slot, rank) in (0..).zip(ranks) {
            list |= if slot < used { slot << (3 * (rank & 7)) } else { 0 };
        }
        Self(used << 28 | list)
    }

    /// How many slots there are.
    #[inline(always)]
    pub(crate) fn count(self) -> usize {
        (self.0 >> 28) as usize
    }

    /// Those of its slots whose bits are set, the last first.
    #[inline(always)]
    pub(crate) fn reversed(self, bits: u32) -> Arrangement {
        Arrangement::reversed(self.0, self.count(), bits)
    }

    /// The slot of a rank.
    #[inline(always)]
    pub(crate) fn slot(self, rank: usize) -> usize {
        (self.0 >> (3 * rank) & 7) as usize
    }
}

/// What a slot of a node leads to, in a word: the 2 high bits say what, 0 a node, 1 a leaf of spheres, 2 of triangles,
/// 3 of polygons; the 30 low bits are its index.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Child(u32);

/// A [`Child`] taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unpacked {
    Empty,
    /// Index into [`Tree::nodes`](super::Tree::nodes).
    Inner(u32),
    /// Index into the leaves of its kind, [`Tree::leaves`](super::Tree::leaves).
    Leaf(Kind, u32),
}

impl Child {
    const INDEX_BITS: u32 = 30;
    const INDEX: u32 = (1 << Self::INDEX_BITS) - 1;

    /// Indices are less than this.
    pub(crate) const LIMIT: u32 = Self::INDEX;

    /// Nothing: the node of the index that none has.
    pub(crate) const EMPTY: Self = Self(Self::INDEX);

    pub(crate) fn inner(index: u32) -> Self {
        debug_assert!(index < Self::LIMIT);
        Self(index)
    }

    pub(crate) fn leaf(kind: Kind, index: u32) -> Self {
        debug_assert!(index < Self::LIMIT);
        Self((kind as u32 + 1) << Self::INDEX_BITS | index)
    }

    /// The two high bits, which say what it leads to, and the index.
    #[inline(always)]
    pub(crate) fn parts(self) -> (usize, usize) {
        ((self.0 >> Self::INDEX_BITS) as usize, (self.0 & Self::INDEX) as usize)
    }

    pub(crate) fn unpack(self) -> Unpacked {
        let index = self.0 & Self::INDEX;
        match self.0 >> Self::INDEX_BITS {
            0 if self == Self::EMPTY => Unpacked::Empty,
            0 => Unpacked::Inner(index),
            1 => Unpacked::Leaf(Kind::Sphere, index),
            2 => Unpacked::Leaf(Kind::Triangle, index),
            _ => Unpacked::Leaf(Kind::Polygon, index),
        }
    }
}

/// Primitives of one kind that are tested together: a run of [`Tree::order`](super::Tree::order).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Leaf {
    pub first: u32,
    pub count: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use proptest::prelude::*;

    proptest! {
        /// Whole numbers, so that middles and their sums are exact and often equal.
        #[test]
        fn orders_go_from_near_to_far_in_every_octant(corners in prop::collection::vec(prop::array::uniform3(-3_i8..4), 1..=WIDTH)) {
            let mut node = Node::EMPTY;
            let corners: Vec<Vec3> = corners.into_iter().map(|corner| Vec3::from(corner.map(f32::from))).collect();
            for (slot, &low) in corners.iter().enumerate() {
                node.set(slot, Bounds { low, high: low + 2.0 }, Child::leaf(Kind::Sphere, 0));
            }
            node.set_orders();
            for (octant, order) in node.orders.iter().enumerate() {
                let sign = |axis: usize| if octant >> axis & 1 == 1 { -1.0 } else { 1.0 };
                let diagonal = Vec3::new(sign(0), sign(1), sign(2));
                let mut expected: Vec<usize> = (0..corners.len()).collect();
                expected.sort_by(|&one, &other| {
                    // −0 is none less than 0.
                    let along = |slot: usize| diagonal.dot(corners[slot]) + 0.0;
                    // The opposite octant has the reverse, of equals too.
                    let by_slot = if octant < 4 { one.cmp(&other) } else { other.cmp(&one) };
                    along(one).total_cmp(&along(other)).then(by_slot)
                });
                let slots: Vec<usize> = (0..order.count()).map(|rank| order.slot(rank)).collect();
                prop_assert_eq!(slots, expected, "octant {}", octant);
            }
        }
    }

    #[test]
    fn children_unpack_to_what_they_were_made_of() {
        for index in [0, 1, Child::LIMIT - 1] {
            assert_eq!(Child::inner(index).unpack(), Unpacked::Inner(index));
            for kind in [Kind::Sphere, Kind::Triangle, Kind::Polygon] {
                assert_eq!(Child::leaf(kind, index).unpack(), Unpacked::Leaf(kind, index));
            }
        }
        assert_eq!(Child::EMPTY.unpack(), Unpacked::Empty);
    }

    #[test]
    fn fields_lie_where_the_table_says() {
        use std::mem::offset_of;
        let offsets = [
            offset_of!(Node, low),
            offset_of!(Node, high),
            offset_of!(Node, children),
            offset_of!(Node, orders),
        ];
        assert_eq!(offsets, [0, 96, 192, 224]);
    }
}
