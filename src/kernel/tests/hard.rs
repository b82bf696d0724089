//! Bounds that docs/accuracy.md proves or states as measured, over pairs that are made to come near them.

use super::sight::{self, Sight};
use super::{U, reach, single};
use crate::kernel::{bounds, triangle};
use crate::random::random_unit;
use glam::DVec3;

/// Numbers of no pattern, the same in every run.
struct Numbers {
    seed: u32,
    count: u32,
}

impl Numbers {
    fn new(seed: u32) -> Self {
        Self { seed, count: 0 }
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.count += 1;
        low + (high - low) * random_unit([self.seed, self.count])
    }

    /// A power of two between these.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.between(low, high).exp2()
    }

    fn vector(&mut self) -> DVec3 {
        [(); 3].map(|()| self.between(-1.0, 1.0)).into()
    }
}

/// The box test lets through every ray that passes a box by no more than this share of the largest coordinates, by proof: the
/// padding, less what rounding takes of it.
const LET_THROUGH: f64 = 11.9 * U;

/// Beyond this it may not let rays through, by proof: the padding, and what rounding adds to it.
const KEPT_OUT: f64 = 20.1 * U;

/// A ray that passes the box's corner by a share of the coordinates on each axis, and whether it is let through.
fn passes_corner(numbers: &mut Numbers, share: f64) -> bool {
    loop {
        let origin = numbers.scale(-4.0, 8.0) * numbers.vector();
        let at = numbers.vector();
        let ray = Sight::new(origin, at - origin);
        let (o, d) = (ray.o(), ray.d());
        if d.abs().min_element() == 0.0 {
            continue;
        }
        let point = o + d * numbers.between(0.9, 1.1);
        let extent = 1.0;
        if point.abs().max_element() > 0.9 {
            continue;
        }
        let off = share * (extent + o.abs().max_element());
        // The ray leaves two axes' slabs where it enters the third's: outside of all of them by as much. Planes are rounded
        // towards the ray if they may be that far away, and away from it if they have to be.
        let (mut low, mut high) = ([-1.0_f32; 3], [1.0_f32; 3]);
        let number = numbers.between(0.0, 3.0);
        let entered = usize::from(number >= 1.0) + usize::from(number >= 2.0);
        let nearer = share < 16.0 * U;
        for axis in 0..3 {
            // Behind the plane that is met first, or that is met last, as the ray goes.
            let is_low = (axis == entered) == (d[axis] > 0.0);
            let plane = if is_low { point[axis] + off } else { point[axis] - off };
            let rounded = single(plane);
            let is_off = |rounded: f32| (f64::from(rounded) - plane).is_sign_positive() == is_low;
            let rounded = match (is_off(rounded), nearer, is_low) {
                (true, true, true) | (false, false, false) => rounded.next_down(),
                (true, true, false) | (false, false, true) => rounded.next_up(),
                _ => rounded,
            };
            if is_low {
                low[axis] = rounded;
            } else {
                high[axis] = rounded;
            }
        }
        let slabs = sight::slabs::<f32>(&[ray], single(extent));
        let [near, far] = sight::planes(&[ray], &[[low, high]]);
        return bounds::enter(&slabs, near, far, 0.0, f32::INFINITY).1;
    }
}

#[test]
fn boxes_let_through_rays_that_pass_them_by_less_than_the_padding_without_its_rounding() {
    let numbers = &mut Numbers::new(1);
    for pair in 0..300_000 {
        assert!(passes_corner(numbers, LET_THROUGH), "pair {pair}");
    }
}

#[test]
fn boxes_keep_out_rays_that_pass_them_by_more_than_the_padding_and_its_rounding() {
    let numbers = &mut Numbers::new(2);
    for pair in 0..300_000 {
        assert!(!passes_corner(numbers, KEPT_OUT), "pair {pair}");
    }
}

/// Of triangles down to 2⁻¹⁴ as wide as long, met inside at angles down to 2⁻⁸: the error of the height over the plane, in
/// u·(L + s²/h). Proven is 23 for L and 18 for s²/h; the engine relies on 6.
#[test]
fn t_of_needles_is_within_six_roundings_of_their_length_squared_by_their_width() {
    let (numbers, mut worst, mut pairs) = (&mut Numbers::new(3), 0.0_f64, 0);
    while pairs < 300_000 {
        let along = numbers.scale(-8.0, 0.0) * numbers.vector();
        let sideways = numbers.vector().reject_from(along).normalize_or_zero();
        let across = numbers.scale(-14.0, 0.0) * along.length() * sideways;
        let first = 0.5 * numbers.vector();
        let corners = [first, first + along, first + numbers.between(0.0, 1.0) * along + across];
        let corners = corners.map(|corner| corner.as_vec3().as_dvec3());
        let [a, b, c] = corners;
        let double_area = (b - a).cross(c - a);
        let normal = double_area.normalize_or_zero();
        let [v, w] = [numbers.between(0.0, 1.0), numbers.between(0.0, 1.0)];
        let target = a + v * (b - a) + w * (1.0 - v) * (c - a);
        let way =
            numbers.vector().reject_from(normal).normalize_or_zero() + numbers.scale(-8.0, 0.0) * normal;
        let ray = Sight::new(target + numbers.scale(-4.0, 2.0) * way, -way);
        let (space, axes) = (sight::space::<f32>(&[ray]), ray.axes());
        let found = triangle::meet(&space, corners.map(|corner| axes.map(|axis| corner.as_vec3()[axis])));
        if !found.inside(0.0) {
            continue;
        }
        let height = normal.dot(ray.o() + f64::from(found.t(&space)) * ray.d() - a).abs();
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        worst = worst.max(height / (U * (reach(&ray, &corners) + longest.powi(3) / double_area.length())));
        pairs += 1;
    }
    assert!(worst <= 6.0, "{worst} roundings");
    assert!(worst > 0.5, "the cases are hard: {worst}");
}
