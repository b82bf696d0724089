//! The box of one child against rays in lanes: those of a packet and those of a stream ask alike.

use crate::kernel::bounds::{self, Slabs};
use crate::lanes::{Single, Vector};
use crate::prepare::bvh::Node;

/// Which rays, whose directions have these signs, are in a child's box before `end`.
#[inline(always)]
pub(super) fn meet<L: Single>(
    slabs: &Slabs<L>,
    (node, slot): (&Node, usize),
    backwards: [bool; 3],
    end: L,
) -> L::Mask {
    let plane = |axis: usize, far: bool| {
        L::splat(if backwards[axis] == far { node.low[axis][slot] } else { node.high[axis][slot] })
    };
    let near = Vector::new(plane(0, false), plane(1, false), plane(2, false));
    let far = Vector::new(plane(0, true), plane(1, true), plane(2, true));
    bounds::enter(slabs, near, far, L::splat(0.0), end).1
}
