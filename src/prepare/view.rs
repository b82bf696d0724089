//! The camera as the engine generates rays from it.

use super::Scale;
use crate::math::sin_cos_degrees;
use crate::scene::{Camera, ImageSettings, Projection, Window};
use glam::DVec3;

/// The camera's basis and window, in the engine's scale: Shirley and Marschner, "Fundamentals of Computer Graphics", the
/// chapter on ray tracing.
///
/// In f64: the direction of a primary ray is rounded once, where it enters a queue.
pub(crate) struct View {
    pub(crate) eye: DVec3,
    /// Right, up and backwards; an orthonormal basis.
    pub(crate) u: DVec3,
    pub(crate) v: DVec3,
    pub(crate) w: DVec3,
    /// l and b on the image plane.
    pub(crate) low: [f64; 2],
    /// r − l and t − b.
    pub(crate) extent: [f64; 2],
    /// From the eye to the image plane; none for an orthographic view.
    pub(crate) distance: Option<f64>,
    /// nx and ny.
    pub(crate) pixels: [f64; 2],
}

impl View {
    pub(super) fn new(camera: &Camera, image: &ImageSettings, scale: Scale) -> Self {
        let backwards = camera.eye.as_dvec3() - camera.target.as_dvec3();
        let w = backwards.normalize();
        let u = camera.up.as_dvec3().cross(w).normalize();
        let v = w.cross(u);
        let pixels = [f64::from(image.width), f64::from(image.height)];
        let symmetric = |top: f64| {
            let right = top * pixels[0] / pixels[1];
            ([-right, -top], [2.0 * right, 2.0 * top])
        };
        let of = |window: Window| {
            let [left, right, bottom, top] =
                [window.left, window.right, window.bottom, window.top].map(f64::from);
            ([left, bottom], [right - left, top - bottom])
        };
        let factor = f64::from(scale.factor());
        let scaled = |(low, extent): ([f64; 2], [f64; 2])| {
            (low.map(|edge| edge * factor), extent.map(|length| length * factor))
        };
        let ((low, extent), distance) = match camera.projection {
            Projection::PerspectiveAngle { vertical_degrees } => {
                let (sin, cos) = sin_cos_degrees(f64::from(vertical_degrees) / 2.0);
                (symmetric(sin / cos), Some(1.0))
            }
            Projection::PerspectiveWindow { window, distance } => (of(window), Some(f64::from(distance))),
            Projection::OrthographicHeight { height } => (scaled(symmetric(f64::from(height) / 2.0)), None),
            Projection::OrthographicWindow { window } => (scaled(of(window)), None),
        };
        Self { eye: scale.position(camera.eye).as_dvec3(), u, v, w, low, extent, distance, pixels }
    }
}
