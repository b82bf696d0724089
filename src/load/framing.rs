//! The camera and the light of a file that brings none: from in front, above and to the right, and all of it in view.

use super::number::rounded_3;
use crate::scene::{Camera, Light, Projection, Rgb};
use glam::{DVec3, Vec3};

/// Where to look from and what to light it with.
pub(super) struct Framing {
    pub(super) camera: Camera,
    pub(super) light: Light,
}

/// Frames what lies between two corners; where there is nothing, a unit cube around the origin.
pub(super) fn framed(bounds: Option<(DVec3, DVec3)>) -> Framing {
    let (low, high) = bounds.unwrap_or((DVec3::splat(-0.5), DVec3::splat(0.5)));
    let center = (low + high) / 2.0;
    // A single point has no extent to step back by.
    let extent = Some((high - low).length()).filter(|&extent| extent > 0.0).unwrap_or(1.0);
    let at = |offset: [f64; 3]| rounded_3(center + DVec3::from(offset) * extent);
    Framing {
        camera: Camera {
            eye: at([0.45, 0.35, 0.75]),
            target: rounded_3(center),
            up: Vec3::Y,
            projection: Projection::PerspectiveAngle { vertical_degrees: 45.0 },
        },
        light: Light::Point { position: at([-1.0, 2.0, 1.5]), intensity: Rgb::ONE },
    }
}

/// Bounds that also hold a point.
pub(super) fn widened(bounds: Option<(DVec3, DVec3)>, point: DVec3) -> Option<(DVec3, DVec3)> {
    let (low, high) = bounds.unwrap_or((point, point));
    Some((low.min(point), high.max(point)))
}
