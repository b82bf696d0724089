//! What a formula asks of its numbers, so that it is written once: first for f64 with a bound of its error, then exactly.

use std::cmp::Ordering;

/// A number that may not know its own sign.
pub(super) trait Number: Clone {
    /// A finite number of f64, as it is.
    fn of(number: f64) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    /// How it compares with 0; none where that cannot be told.
    fn sign(&self) -> Option<Ordering>;
}

/// A vector of such numbers.
pub(super) type Vector<N> = [N; 3];

pub(super) fn vector<N: Number>(of: glam::DVec3) -> Vector<N> {
    of.to_array().map(N::of)
}

pub(super) fn minus<N: Number>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    [0, 1, 2].map(|axis| a[axis].minus(&b[axis]))
}

pub(super) fn plus<N: Number>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    [0, 1, 2].map(|axis| a[axis].plus(&b[axis]))
}

pub(super) fn dot<N: Number>(a: &Vector<N>, b: &Vector<N>) -> N {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

/// a_i·b_j − a_j·b_i.
pub(super) fn minor<N: Number>(a: &Vector<N>, b: &Vector<N>, [i, j]: [usize; 2]) -> N {
    a[i].times(&b[j]).minus(&a[j].times(&b[i]))
}

pub(super) fn cross<N: Number>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    [[1, 2], [2, 0], [0, 1]].map(|axes| minor(a, b, axes))
}

/// det[a, b, c]: six times the volume of the tetrahedron (0, a, b, c).
pub(super) fn determinant<N: Number>(a: &Vector<N>, b: &Vector<N>, c: &Vector<N>) -> N {
    dot(a, &cross(b, c))
}
