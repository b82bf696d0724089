//! A ray against a sphere by the quadratic formula as it stands.

use crate::kernel::sphere::Line;
use crate::lanes::{Lanes, Vector};

/// a·t² + 2b·t + c = 0 with b = (o − c)·d and c = |o − c|² − r²: the smallest t > 0, and whether there is one.
///
/// Far from a small sphere, b² and a·c agree in all the digits that the radius would show in.
#[inline(always)]
pub(crate) fn nearest<L: Lanes>(line: &Line<L>, center: Vector<L>, radius: L, zero: L) -> (L, L::Mask) {
    let from_center = line.origin - center;
    let b = from_center.dot(line.direction);
    let c = from_center.length_squared() - radius * radius;
    let discriminant = b * b - line.a * c;
    let root = discriminant.max(zero).sqrt();
    let near = (-b - root) * line.inverse_a;
    let far = (root - b) * line.inverse_a;
    let t = L::select(near.gt(zero), near, far);
    (t, discriminant.ge(zero) & t.gt(zero))
}
