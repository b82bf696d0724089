//! Three coordinates of lanes: many vectors side by side.

use super::Lanes;
use std::ops::{Add, Mul, Neg, Sub};

/// x, y and z of as many vectors as there are lanes.
#[derive(Clone, Copy)]
pub(crate) struct Vector<L> {
    pub(crate) x: L,
    pub(crate) y: L,
    pub(crate) z: L,
}

impl<L: Lanes> Vector<L> {
    #[inline(always)]
    pub(crate) fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub(crate) fn splat([x, y, z]: [L::Scalar; 3]) -> Self {
        Self { x: L::splat(x), y: L::splat(y), z: L::splat(z) }
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    #[inline(always)]
    pub(crate) fn length_squared(self) -> L {
        self.dot(self)
    }

    #[inline(always)]
    pub(crate) fn length(self) -> L {
        self.length_squared().sqrt()
    }

    /// One division, and three products with its result: each within 2 ulp of the exact coordinate.
    #[inline(always)]
    pub(crate) fn normalized(self, one: L) -> Self {
        self * (one / self.length())
    }

    /// Coordinate by coordinate.
    #[inline(always)]
    pub(crate) fn times(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }

    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, then: Self, otherwise: Self) -> Self {
        Self {
            x: L::select(mask, then.x, otherwise.x),
            y: L::select(mask, then.y, otherwise.y),
            z: L::select(mask, then.z, otherwise.z),
        }
    }
}

impl<L: Lanes> Add for Vector<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<L: Lanes> Sub for Vector<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<L: Lanes> Mul<L> for Vector<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<L: Lanes> Neg for Vector<L> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}
