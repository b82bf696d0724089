//! The kinds of ray and how many of each were traced.

use serde::Serialize;
use std::ops::AddAssign;

/// How many rays of each kind were traced. A shadow ray is traced only where its light could add something.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RayCounts {
    /// From the eye.
    pub primary: u64,
    /// From a hit towards a light.
    pub shadow: u64,
    /// Reflected by a mirror or a dielectric.
    pub reflect: u64,
    /// Refracted by a dielectric.
    pub refract: u64,
}

impl RayCounts {
    /// All of them.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.primary + self.shadow + self.reflect + self.refract
    }
}

impl AddAssign for RayCounts {
    fn add_assign(&mut self, other: Self) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.reflect += other.reflect;
        self.refract += other.refract;
    }
}
