//! The kinds of ray, how many of each were traced, and rays on their own, as they are handed from one engine to another.

mod set;

pub use set::{Found, RaySet, RecordedRays, Start};

use crate::scene::PrimitiveId;
use glam::DVec3;
use serde::Serialize;
use std::ops::AddAssign;

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RayKind {
    /// From the eye.
    Primary,
    /// From a hit towards a light.
    Shadow,
    /// Reflected by a mirror or a dielectric.
    Reflect,
    /// Refracted by a dielectric.
    Refract,
}

impl RayKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Primary, Self::Shadow, Self::Reflect, Self::Refract];

    /// As reports have it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Reflect => "reflect",
            Self::Refract => "refract",
        }
    }
}

/// A stretch of a ray, without rounding: origin + t·direction, `t_min` < t < `t_max`; world space, the direction of any length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// World position.
    pub origin: DVec3,
    /// Not 0.
    pub direction: DVec3,
    /// At least 0; 0 where there is a departure.
    pub t_min: f64,
    /// May be infinite.
    pub t_max: f64,
    /// Where it starts, if that is known to be on a primitive.
    pub departure: Option<Departure>,
}

/// The start of a ray on a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Departure {
    /// The primitive.
    pub from: PrimitiveId,
    /// Whether the ray goes to its inner side.
    pub inward: bool,
}

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
    /// Of one kind.
    #[must_use]
    pub fn of(&self, kind: RayKind) -> u64 {
        match kind {
            RayKind::Primary => self.primary,
            RayKind::Shadow => self.shadow,
            RayKind::Reflect => self.reflect,
            RayKind::Refract => self.refract,
        }
    }

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
