//! A ray against a triangle.

use super::UNIT_ROUNDOFF;
use super::ray_space::{RaySpace, Seen, cross, crosses, unclear_area};
use crate::lanes::{Lanes, Mask};

/// Where a ray meets the plane of a triangle, and whether that is inside.
pub(crate) struct Meeting<L: Lanes> {
    /// Signed areas that the ray's foot spans with the edges that lie opposite to the corners.
    areas: [L; 3],
    /// The least, the middle and the largest of them.
    least: L,
    middle: L,
    largest: L,
    /// Distance of the ray's origin from the plane, times twice the triangle's area; of either sign.
    pub(crate) volume: L,
    /// Twice the triangle's area as seen along the ray, sheared; of either sign.
    pub(crate) seen_double_area: L,
    corners: [Seen<L>; 3],
}

/// Seen along the ray, the triangle is hit where its signed areas to the ray's foot are all of one sign. Where one of them is
/// 0 the edges decide as those of a polygon do, see [`crosses`], which is the same question: all faces that meet at an edge or
/// at a corner answer it from the same numbers, and however these are rounded, a closed surface is crossed an even number of
/// times. t is the mean of the vertices' t by these areas, so it never lies outside of theirs: |δt| ≤ 6u·(L + s²/h)/cos θ by measurement, 23u·L and
/// 18u·s²/h over cos θ by proof (docs/accuracy.md), with L the largest distance of a vertex from the origin, s the longest edge and h the height above it, which matters for needles
/// (Woop, Benthin and Wald 2013; see [`RaySpace`]).
///
/// Vertices are in the ray's order of axes.
#[inline(always)]
pub(crate) fn meet<L: Lanes>(ray: &RaySpace<L>, vertices: [[L; 3]; 3]) -> Meeting<L> {
    let [a, b, c] = [ray.see(vertices[0]), ray.see(vertices[1]), ray.see(vertices[2])];
    let (u, v, w) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
    let area = u + v + w;
    let volume = u * a.z + v * b.z + w * c.z;
    let (lesser, greater) = (u.min(v), u.max(v));
    let (least, largest) = (lesser.min(w), greater.max(w));
    let middle = lesser.max(greater.min(w));
    Meeting { areas: [u, v, w], least, middle, largest, volume, seen_double_area: area, corners: [a, b, c] }
}

impl<L: Lanes> Meeting<L> {
    /// Where [`Self::inside`] may hold: there, and where an area is 0.
    #[inline(always)]
    pub(crate) fn is_inside_or_tied(&self, zero: L) -> L::Mask {
        self.least.ge(zero) | self.largest.le(zero) | self.middle.eq(zero)
    }

    /// Of what falls on an edge, one of the two triangles there holds it.
    #[inline(always)]
    pub(crate) fn inside(&self, zero: L) -> L::Mask {
        let inside = self.least.gt(zero) | self.largest.lt(zero);
        let tied = self.least.eq(zero) | self.middle.eq(zero) | self.largest.eq(zero);
        if !tied.any() {
            return inside;
        }
        let ([a, b, c], [u, v, w]) = (&self.corners, self.areas);
        let odd = crosses(b, c, u, zero).xor(crosses(c, a, v, zero)).xor(crosses(a, b, w, zero));
        inside | (tied & odd)
    }

    /// Whether the foot may be inside, and whether it is for certain; `size` is the length of the longest edge.
    #[inline(always)]
    pub(crate) fn may_be_inside(&self, size: L) -> (L::Mask, L::Mask)
    where
        L: Lanes<Scalar = f32>,
    {
        let error = unclear_area(&self.corners[0], [size, size]);
        let may_be = self.least.ge(-error) | self.largest.le(error);
        (may_be, self.least.gt(error) | self.largest.lt(-error))
    }

    /// Whether the ray's origin, if the foot is inside, is so near to the plane that rounding may have put it on the other
    /// side; `size` is the length of the longest edge.
    ///
    /// Where the plane is met that near, no corner is deeper than about the longest edge s, so each coordinate is off by at most
    /// 18.3u·s (see [`unclear_area`]), an area by 6 times that s and its own rounding, 112u·s², and the volume by
    /// 350u·s³.
    #[inline(always)]
    pub(crate) fn touches(&self, size: L) -> L::Mask
    where
        L: Lanes<Scalar = f32>,
    {
        !self.volume.abs().gt(size * L::splat(384.0 * UNIT_ROUNDOFF) * size * size)
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

    /// Divides: for those that are inside. No point of the triangle is before its nearest corner or beyond its farthest; of one
    /// that is seen edge-on the areas may be nothing but rounding, with a mean anywhere, or none.
    #[inline(always)]
    pub(crate) fn t(&self, ray: &RaySpace<L>) -> L {
        let t = self.volume * ray.t_per_z / self.seen_double_area;
        let [a, b, c] = self.corners.each_ref().map(|corner| corner.z * ray.t_per_z);
        t.max(a.min(b).min(c)).min(a.max(b).max(c))
    }
}
