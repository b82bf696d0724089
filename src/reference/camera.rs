//! From a point of the image to the ray that sees it.

use crate::scene::{Camera, ImageSettings, Projection, Window};
use glam::{DVec2, DVec3};

/// The camera's basis and window: Shirley and Marschner, "Fundamentals of Computer Graphics", the chapter on ray tracing.
pub(super) struct View {
    eye: DVec3,
    /// Right, up and backwards; an orthonormal basis.
    u: DVec3,
    v: DVec3,
    w: DVec3,
    /// (l, b) and (r, t) on the image plane.
    low: DVec2,
    high: DVec2,
    /// From the eye to the image plane; none for an orthographic view.
    distance: Option<f64>,
    /// nx and ny.
    pixels: DVec2,
}

impl View {
    pub(super) fn new(camera: &Camera, image: &ImageSettings) -> Self {
        let eye = camera.eye.as_dvec3();
        let w = (eye - camera.target.as_dvec3()).normalize();
        let u = camera.up.as_dvec3().cross(w).normalize();
        let v = w.cross(u);
        let pixels = DVec2::new(f64::from(image.width), f64::from(image.height));
        let symmetric = |top: f64| DVec2::new(top * pixels.x / pixels.y, top);
        let corners = |window: Window| {
            let [left, right, bottom, top] =
                [window.left, window.right, window.bottom, window.top].map(f64::from);
            (DVec2::new(left, bottom), DVec2::new(right, top))
        };
        let ((low, high), distance) = match camera.projection {
            Projection::PerspectiveAngle { vertical_degrees } => {
                let high = symmetric((f64::from(vertical_degrees).to_radians() / 2.0).tan());
                ((-high, high), Some(1.0))
            }
            Projection::PerspectiveWindow { window, distance } => {
                (corners(window), Some(f64::from(distance)))
            }
            Projection::OrthographicHeight { height } => {
                let high = symmetric(f64::from(height) / 2.0);
                ((-high, high), None)
            }
            Projection::OrthographicWindow { window } => (corners(window), None),
        };
        Self { eye, u, v, w, low, high, distance, pixels }
    }

    /// Origin and direction of the ray through a point of the image, in pixels from its bottom left corner; the direction
    /// has unit length.
    pub(super) fn ray(&self, point: DVec2) -> (DVec3, DVec3) {
        let on_plane = self.low + (self.high - self.low) * point / self.pixels;
        let offset = on_plane.x * self.u + on_plane.y * self.v;
        match self.distance {
            Some(distance) => (self.eye, (offset - distance * self.w).normalize()),
            None => (self.eye + offset, -self.w),
        }
    }
}
