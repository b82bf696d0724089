//! Whether rays are alike enough to walk together.

use crate::kernel::axes_from;
use crate::lanes::{Lanes, Mask, Single};

/// Rays that walk together agree in the signs of their directions and in the axis along which they are fastest, and their
/// slopes against that axis lie within this of each other. Where they are wider a packet visits many nodes for the sake of a few
/// rays. With the limit at 0.03 to 0.5 speeds were the same within the noise, on five scenes, 2026-11.
pub(super) const WIDEST_SLOPES: f32 = 0.5;

/// The order of axes and the signs of the directions, if all have the same; of columns as long as whole lanes.
pub(super) fn common_order<F: Single>(direction: [&[f32]; 3]) -> Option<([usize; 3], [bool; 3])> {
    let none = F::Mask::NONE;
    let (mut negative, mut positive) = ([none; 3], [none; 3]);
    let mut fastest = [none; 3];
    let zero = F::splat(0.0);
    for row in (0..direction[0].len()).step_by(F::WIDTH) {
        let components = direction.map(|column| F::load(&column[row..]));
        for axis in 0..3 {
            let is_negative = components[axis].lt(zero);
            negative[axis] = negative[axis] | is_negative;
            positive[axis] = positive[axis] | !is_negative;
        }
        let [x, y, z] = components.map(Lanes::abs);
        let first = x.ge(y) & x.ge(z);
        let second = !first & y.ge(z);
        fastest = [fastest[0] | first, fastest[1] | second, fastest[2] | !(first | second)];
    }
    let is_mixed = (0..3).any(|axis| negative[axis].any() && positive[axis].any());
    let mut third = (0..3).filter(|&axis| fastest[axis].any());
    match (is_mixed, third.next(), third.next()) {
        (false, Some(third), None) => Some((axes_from(third), negative.map(Mask::any))),
        _ => None,
    }
}
