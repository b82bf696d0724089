//! Which edges of a polygon rays that lie side by side have to do with: of a gear's hundred edges only those that are level with
//! the rays' feet can be crossed, or pass so near to a foot that it is in doubt. To leave out an edge that lies above all feet,
//! or below all, leaves the crossing number of each as it is.

use super::sight::{Bounds, SeenBounds, Sight};
use crate::lanes::{Mask, RECORD, Single, least_of_each};

/// Of polygons with fewer edges than this each edge is tested.
pub(super) const MANY: u32 = 12;

/// Visits those edges of a polygon, by number, that any of the rays may have to do with, and returns the bounds of its corners
/// along the third axis. `corners` are y and z in the rays' order of axes from the polygon's first corner on, its first again
/// after its last, and then as many as there are lanes. Where `size` is given, the longest distance of two corners, it visits
/// also what passes a foot so closely that rounding counts.
#[inline(always)]
pub(super) fn each_near<F: Single>(
    sight: &Sight,
    [y, z]: [&[f32]; 2],
    edges: usize,
    size: Option<f32>,
    mut visit: impl FnMut(usize),
) -> Bounds {
    let none = F::splat(f32::INFINITY);
    let mut depths = [none; RECORD];
    // With n corners in lanes there are n − 1 edges between them.
    for first in (0..edges).step_by(F::WIDTH - 1) {
        let (y, z) = (F::load(&y[first..]), F::load(&z[first..]));
        depths[0] = z.min(depths[0]);
        depths[1] = (-z).min(depths[1]);
        let seen = sight.see([y, y, z]);
        let SeenBounds { y: [least, largest], .. } = seen;
        let doubt = size.map_or(F::splat(0.0), |size| seen.doubt(F::splat(size)));
        // A corner level with a foot counts as above it.
        let (above, below) = (least.ge(doubt).bits(), largest.lt(-doubt).bits());
        let is_apart = (above & above >> 1) | (below & below >> 1);
        let count = (edges - first).min(F::WIDTH - 1);
        let mut near = !is_apart & ((1 << count) - 1);
        while near != 0 {
            visit(first + near.trailing_zeros() as usize);
            near &= near - 1;
        }
    }
    let [least, minus_largest, ..] = least_of_each(depths);
    [least, -minus_largest]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{RaySpace, UNIT_ROUNDOFF, unclear_area};
    use crate::lanes::{Job, Width};
    use crate::random::random_unit;

    /// Numbers in [−0.5, 0.5).
    struct Numbers(u32);

    impl Numbers {
        #[expect(clippy::cast_possible_truncation, reason = "any number will do")]
        fn next(&mut self) -> f32 {
            self.0 += 1;
            random_unit([self.0, 17]) as f32 - 0.5
        }

        fn lanes<F: Single>(&mut self, middle: f32, spread: f32) -> F {
            let lanes: [f32; 16] = std::array::from_fn(|_| middle + spread * self.next());
            F::load(&lanes)
        }
    }

    /// Rays from near a point along z, past a round polygon.
    struct LeavesOut {
        spread: f32,
        has_low_part: bool,
    }

    const EDGES: usize = 40;

    impl Job for LeavesOut {
        /// How many edges of how many are left out.
        type Output = [usize; 2];

        fn run<F: Single>(self) -> [usize; 2] {
            let mut numbers = Numbers(0);
            let mut left_out = [0, 0];
            for _ in 0..100 {
                let middle = [0, 1, 2].map(|_| numbers.next());
                let slopes = [numbers.next(), numbers.next()].map(|slope| 0.3 * slope);
                let mut corners = [const { Vec::new() }; 3];
                for corner in 0..EDGES {
                    let (sin, cos) = (corner as f32 * std::f32::consts::TAU / EDGES as f32).sin_cos();
                    let radius = 1.0 + 0.3 * numbers.next();
                    let z = 3.0 + numbers.next();
                    let foot = middle[1] + slopes[1] * (z - middle[2]);
                    // Some are level with a foot but for rounding.
                    let y = match corner {
                        10..14 => foot + 64.0 * UNIT_ROUNDOFF * numbers.next(),
                        _ => radius * sin,
                    };
                    for (column, component) in corners.iter_mut().zip([radius * cos, y, z]) {
                        column.push(component);
                    }
                }
                for column in &mut corners {
                    let first = column[0];
                    column.extend([first; 16]);
                }
                let lanes = |numbers: &mut Numbers, middle| numbers.lanes::<F>(middle, self.spread);
                let space = RaySpace {
                    origin: middle.map(|middle| lanes(&mut numbers, middle)),
                    origin_low: self
                        .has_low_part
                        .then(|| [0; 3].map(|_| numbers.lanes::<F>(0.0, UNIT_ROUNDOFF))),
                    shear: slopes.map(|slope| lanes(&mut numbers, slope)),
                    t_per_z: F::splat(1.0),
                };
                // One of them is not asked about.
                let mask = F::first(F::WIDTH - 1);
                let size = self.has_low_part.then_some(3.0);
                let mut is_visited = [false; EDGES];
                let columns = [&corners[1][..], &corners[2][..]];
                let [least, largest] =
                    each_near::<F>(&Sight::of(&space, mask), columns, EDGES, size, |edge| {
                        assert!(!is_visited[edge]);
                        is_visited[edge] = true;
                    });
                assert_eq!(least, corners[2].iter().copied().fold(f32::INFINITY, f32::min));
                assert_eq!(largest, corners[2].iter().copied().fold(f32::NEG_INFINITY, f32::max));
                let corner =
                    |index: usize| space.see([0, 1, 2].map(|axis: usize| F::splat(corners[axis][index])));
                let zero = F::splat(0.0);
                left_out[1] += EDGES;
                for edge in (0..EDGES).filter(|&edge| !is_visited[edge]) {
                    left_out[0] += 1;
                    let (from, to) = (corner(edge), corner(edge + 1));
                    let apart = (from.y.ge(zero) & to.y.ge(zero)) | (from.y.lt(zero) & to.y.lt(zero));
                    assert!(!(!apart & mask).any(), "edge {edge} is crossed");
                    if self.has_low_part {
                        // So far off that an edge of length 1 which passed at that distance would leave no doubt.
                        let doubt = unclear_area(&from, [F::splat(3.0), F::splat(1.0)]);
                        let is_far = from.y.abs().gt(doubt) & to.y.abs().gt(doubt);
                        assert!(!(!is_far & mask).any(), "edge {edge} may be touched");
                    }
                }
            }
            left_out
        }
    }

    #[test]
    fn edges_that_are_left_out_lie_above_all_feet_or_below_all() {
        for has_low_part in [false, true] {
            for (spread, least) in [(0.0, 0.8), (1e-6, 0.8), (0.05, 0.7), (0.5, 0.15), (5.0, 0.0)] {
                for width in Width::ALL.into_iter().filter(|width| width.lanes() > 2) {
                    let [out, of] = width.run(LeavesOut { spread, has_low_part });
                    assert!(out as f64 >= least * of as f64, "{out} of {of}: spread {spread}, {width:?}");
                }
            }
        }
    }
}
