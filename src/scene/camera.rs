//! The eye, in the user's terms; an engine derives its own basis from them.

use glam::Vec3;
use thiserror::Error;

/// Where the eye is, where it looks, and how it projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World position of the eye.
    pub eye: Vec3,
    /// World position that falls on the middle of a symmetric window.
    pub target: Vec3,
    /// World direction that points up in the picture; it need be neither unit nor orthogonal to the view.
    pub up: Vec3,
    /// What the picture covers.
    pub projection: Projection,
}

/// What the picture covers, and whether rays fan out or run side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Perspective by the full vertical angle.
    PerspectiveAngle {
        /// Full vertical angle of view, degrees.
        vertical_degrees: f32,
    },
    /// Perspective by a window on the image plane.
    PerspectiveWindow {
        /// What the picture covers of the image plane.
        window: Window,
        /// From the eye to the image plane, d.
        distance: f32,
    },
    /// Orthographic by the height of the view; its width follows from the shape of the image.
    OrthographicHeight {
        /// Height of the view, world units.
        height: f32,
    },
    /// Orthographic by a window.
    OrthographicWindow {
        /// What the picture covers of the image plane.
        window: Window,
    },
}

/// A rectangle on the image plane, in world units from where the axis of view meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// l, along u.
    pub left: f32,
    /// r, along u.
    pub right: f32,
    /// b, along v.
    pub bottom: f32,
    /// t, along v.
    pub top: f32,
}

/// Why a camera cannot make a picture; each names the setting to change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum CameraProblem {
    /// There is no direction of view.
    #[error("eye and target are the same point, so there is no direction of view; move one of them")]
    NoDirection,
    /// There is no roll.
    #[error(
        "up is parallel to the line from eye to target (or zero), so it cannot say which way is up; choose another"
    )]
    UpAlongView,
    /// Angle out of range.
    #[error("fov must lie between 0 and 180 degrees, both excluded")]
    Angle,
    /// Height out of range.
    #[error("height must be greater than 0")]
    Height,
    /// An empty or reversed window.
    #[error("window is [left, right, bottom, top]; left must be below right and bottom below top")]
    Window,
    /// Distance out of range.
    #[error("distance must be greater than 0")]
    Distance,
}

impl Camera {
    /// Looks for what would leave the picture undefined.
    ///
    /// # Errors
    /// The first problem found, so that a loader can point at the setting's place.
    pub fn check(&self) -> Result<(), CameraProblem> {
        // Directions that differ by less than this are parallel as far as f32 input can tell: two roundings, 2⁻²⁴ each,
        // on each of the three vectors.
        const PARALLEL: f64 = 1e-6;
        let view = self.eye.as_dvec3() - self.target.as_dvec3();
        let up = self.up.as_dvec3();
        if view.length() == 0.0 {
            return Err(CameraProblem::NoDirection);
        }
        if up.cross(view).length() <= PARALLEL * up.length() * view.length() {
            return Err(CameraProblem::UpAlongView);
        }
        match self.projection {
            Projection::PerspectiveAngle { vertical_degrees }
                if !(vertical_degrees > 0.0 && vertical_degrees < 180.0) =>
            {
                Err(CameraProblem::Angle)
            }
            Projection::OrthographicHeight { height } if height <= 0.0 => Err(CameraProblem::Height),
            Projection::PerspectiveWindow { distance, .. } if distance <= 0.0 => Err(CameraProblem::Distance),
            Projection::PerspectiveWindow { window, .. } | Projection::OrthographicWindow { window }
                if window.left >= window.right || window.bottom >= window.top =>
            {
                Err(CameraProblem::Window)
            }
            _ => Ok(()),
        }
    }
}
