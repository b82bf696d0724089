//! A ray against a triangle by Möller and Trumbore's test.

use crate::lanes::{Lanes, Vector};

/// Cramer's rule on o + t·d = a + u·(b − a) + v·(c − a): t, and whether the triangle is hit at a t > 0. Both sides count, and
/// edges and corners.
///
/// Each triangle rounds u and v of its own, so two that share an edge may both take a ray for the other's. Source: Möller and
/// Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools, 1997; its tolerance of the
/// determinant is left out, since no fixed one suits every scale.
#[inline(always)]
pub(crate) fn nearest<L: Lanes>(
    [origin, direction]: [Vector<L>; 2],
    [a, b, c]: [Vector<L>; 3],
    zero: L,
    one: L,
) -> (L, L::Mask) {
    let (edge_1, edge_2) = (b - a, c - a);
    let p = direction.cross(edge_2);
    let determinant = edge_1.dot(p);
    let inverse = one / determinant;
    let from_a = origin - a;
    let u = from_a.dot(p) * inverse;
    let q = from_a.cross(edge_1);
    let v = direction.dot(q) * inverse;
    let t = edge_2.dot(q) * inverse;
    // Seen edge-on, u is not a number or infinite, and no comparison holds.
    let inside = u.ge(zero) & v.ge(zero) & (u + v).le(one);
    (t, inside & t.gt(zero))
}
