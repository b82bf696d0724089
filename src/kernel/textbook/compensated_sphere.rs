//! A ray against a sphere, keeping what rounding takes from the ray's distance to the surface.

use crate::kernel::sphere::{self, Line};
use crate::lanes::{Lanes, Vector};

/// The engine's test ([`sphere::meet`]) with the root of smaller magnitude taken from the product of the roots,
/// (|o − c|² − r²) / a, as a sum of twice the digits of f32: the smallest t > 0, and whether there is one.
///
/// Where o is near the surface of a large sphere, both other forms subtract numbers as large as the radius to get a t as
/// small as the height. Sources: Dekker, "A Floating-Point Technique for Extending the Available Precision", 1971, for the
/// error of a product without a fused multiply-add; Knuth, "The Art of Computer Programming", volume 2, for that of a sum.
/// No product may come near the largest number: coordinates are below 2⁵⁰.
#[inline(always)]
pub(crate) fn nearest<L: Lanes<Scalar = f32>>(
    line: &Line<L>,
    center: Vector<L>,
    radius: L,
    zero: L,
) -> (L, L::Mask) {
    let meeting = sphere::meet(line, center, radius * radius, zero);
    let (middle, half) = (meeting.closest_t, meeting.half_t);
    let larger = L::select(middle.lt(zero), middle - half, middle + half);
    let smaller = height_product(line, center, radius) * line.inverse_a / larger;
    let (near, far) = (smaller.min(larger), smaller.max(larger));
    let t = L::select(near.gt(zero), near, far);
    (t, meeting.meets & !larger.eq(zero) & t.gt(zero))
}

/// |o − c|² − r²: the height above the surface times about twice the radius.
#[inline(always)]
fn height_product<L: Lanes<Scalar = f32>>(line: &Line<L>, center: Vector<L>, radius: L) -> L {
    let (x, x_low) = sum(line.origin.x, -center.x);
    let (y, y_low) = sum(line.origin.y, -center.y);
    let (z, z_low) = sum(line.origin.z, -center.z);
    let [(xx, xx_low), (yy, yy_low), (zz, zz_low), (rr, rr_low)] =
        [square(x), square(y), square(z), square(radius)];
    let (high, first_low) = sum(xx, -rr);
    let (high, second_low) = sum(high, yy);
    let (high, third_low) = sum(high, zz);
    let cross = x * x_low + y * y_low + z * z_low;
    let low = (first_low + second_low + third_low) + (xx_low + yy_low + zz_low - rr_low) + (cross + cross);
    high + low
}

/// a + b as f32 has it, and what it leaves out.
#[inline(always)]
fn sum<L: Lanes>(a: L, b: L) -> (L, L) {
    let high = a + b;
    let b_part = high - a;
    let a_part = high - b_part;
    (high, (a - a_part) + (b - b_part))
}

/// a² as f32 has it, and what it leaves out.
#[inline(always)]
fn square<L: Lanes<Scalar = f32>>(a: L) -> (L, L) {
    let high = a * a;
    let (head, tail) = halves(a);
    let cross = head * tail;
    (high, (head * head - high) + (cross + cross) + tail * tail)
}

/// A number as the sum of two of 12 bits.
#[inline(always)]
fn halves<L: Lanes<Scalar = f32>>(a: L) -> (L, L) {
    const SPLITTER: f32 = 4097.0; // 2¹² + 1
    let scaled = a * L::splat(SPLITTER);
    let head = scaled - (scaled - a);
    (head, a - head)
}
