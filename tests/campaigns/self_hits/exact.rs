//! Signs without rounding.

use dashu_ratio::Relaxed;
use glam::DVec3;
use std::cmp::Ordering;

/// The sign of (p − q)·n.
///
/// In f64 where that is enough, its error being a few roundings of the largest numbers that take part; else in fractions,
/// which hold every f64.
pub(super) fn side(n: DVec3, p: DVec3, q: DVec3) -> Ordering {
    let sum = (p - q).dot(n);
    let most = (p.abs() + q.abs()).dot(n.abs());
    if sum.abs() > most / (1_u64 << 48) as f64 {
        return sum.total_cmp(&0.0);
    }
    let exact = |number: f64| Relaxed::try_from(number).expect("coordinates are finite");
    let term = |axis: usize| (exact(p[axis]) - exact(q[axis])) * exact(n[axis]);
    (term(0) + term(1) + term(2)).cmp(&Relaxed::ZERO)
}

/// The sign of d·n.
pub(super) fn slope(d: DVec3, n: DVec3) -> Ordering {
    side(n, d, DVec3::ZERO)
}
