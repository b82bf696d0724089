//! Axis-aligned boxes.

use glam::Vec3;

/// Axis-aligned box, world space of the prepared scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub low: Vec3,
    pub high: Vec3,
}

impl Bounds {
    /// Holds nothing, and no ray meets it.
    pub(crate) const EMPTY: Self = Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    pub(crate) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half of the surface area: what the chance of a random ray to meet the box is proportional to. In f64, which the
    /// square of no f32 overflows.
    pub(crate) fn half_area(self) -> f64 {
        let size = (self.high.as_dvec3() - self.low.as_dvec3()).max(glam::DVec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}
