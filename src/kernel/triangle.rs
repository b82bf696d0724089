//! A ray against a triangle.

use super::ray_space::{RaySpace, Seen, cross};
use crate::lanes::Lanes;

/// Where a ray meets the plane of a triangle, and whether that is inside.
pub(crate) struct Meeting<L: Lanes> {
    /// Edges and corners count as inside.
    pub(crate) inside: L::Mask,
    /// The least and the largest of the areas that the ray's foot spans with the edges.
    least: L,
    largest: L,
    /// Distance of the ray's origin from the plane, times twice the triangle's area; of either sign.
    pub(crate) volume: L,
    /// Twice the triangle's area as seen along the ray, sheared; of either sign.
    pub(crate) seen_double_area: L,
    corners: [Seen<L>; 3],
}

/// Seen along the ray, the triangle is hit where its signed areas to the ray's foot are all of one sign; t is the mean of
/// the vertices' t by these areas, so it never lies outside of theirs: |δt| ≤ 6u·(L + s²/h)/cos θ by measurement, with L the
/// largest distance of a vertex from the origin, s the longest edge and h the height above it, which matters for needles
/// (Woop, Benthin and Wald 2013; see [`RaySpace`]).
///
/// Vertices are in the ray's order of axes.
#[inline(always)]
pub(crate) fn meet<L: Lanes>(ray: &RaySpace<L>, vertices: [[L; 3]; 3], zero: L) -> Meeting<L> {
    let [a, b, c] = [ray.see(vertices[0]), ray.see(vertices[1]), ray.see(vertices[2])];
    let (u, v, w) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
    let area = u + v + w;
    let volume = u * a.z + v * b.z + w * c.z;
    let least = u.min(v).min(w);
    let largest = u.max(v).max(w);
    let one_sided = least.ge(zero) | largest.le(zero);
    // Seen edge-on there is no area, and t is not a number.
    let inside = one_sided & !area.eq(zero);
    Meeting { inside, least, largest, volume, seen_double_area: area, corners: [a, b, c] }
}

impl<L: Lanes> Meeting<L> {
    /// Whether the foot is inside or not farther outside than a margin, an area.
    #[inline(always)]
    pub(crate) fn is_inside(&self, margin: L) -> L::Mask {
        self.least.ge(-margin) | self.largest.le(margin)
    }

    /// The seen area, less what rounding may have added to it if each corner is off by `off`; not below 0. The foot is inside,
    /// so no edge is longer than twice the largest coordinate.
    #[inline(always)]
    pub(crate) fn least_seen_area(&self, off: L, zero: L) -> L {
        let [a, b, c] = &self.corners;
        let reach = |corner: &Seen<L>| corner.x.abs().max(corner.y.abs());
        let reach = reach(a).max(reach(b)).max(reach(c)) * off;
        let rounding = reach + reach + reach + reach + reach + reach;
        (self.seen_double_area.abs() - rounding).max(zero)
    }

    /// Divides: for those that are inside.
    #[inline(always)]
    pub(crate) fn t(&self, ray: &RaySpace<L>) -> L {
        self.volume * ray.t_per_z / self.seen_double_area
    }
}
