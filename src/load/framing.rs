//! The camera and the light of a file that brings none: from in front, above and to the right, and all of it in view.

use super::error::{InputError, Place};
use super::number::rounded_3;
use crate::scene::{
    Camera, Geometry, ImageSettings, Light, Material, Projection, RenderSettings, Rgb, Scene,
};
use glam::{DVec3, Vec3};
use std::path::Path;

/// Where to look from and what to light it with.
pub(super) struct Framing {
    pub(super) camera: Camera,
    pub(super) light: Light,
}

/// Frames what lies between two corners; where there is nothing, a unit cube around the origin.
///
/// # Errors
/// What is so small for its distance from the origin that an f32 has no room for a camera beside it.
pub(super) fn framed(path: &Path, bounds: Option<(DVec3, DVec3)>) -> Result<Framing, InputError> {
    let (low, high) = bounds.unwrap_or((DVec3::splat(-0.5), DVec3::splat(0.5)));
    let center = (low + high) / 2.0;
    // A single point has no extent to step back by.
    let extent = Some((high - low).length()).filter(|&extent| extent > 0.0).unwrap_or(1.0);
    let at = |offset: [f64; 3]| rounded_3(center + DVec3::from(offset) * extent);
    let camera = Camera {
        eye: at([0.45, 0.35, 0.75]),
        target: rounded_3(center),
        up: Vec3::Y,
        projection: Projection::PerspectiveAngle { vertical_degrees: 45.0 },
    };
    if camera.check().is_err() || !camera.eye.is_finite() {
        let message =
            "this cannot be framed: it is too small for its distance from the origin; give a camera";
        return Err(InputError::refused(path, Place::File, message));
    }
    let light = Light::Point { position: at([-1.0, 2.0, 1.5]), intensity: Rgb::ONE };
    Ok(Framing { camera, light })
}

/// A scene of nothing but geometry and what it is made of: framed, lit, and everything else as it is by default.
///
/// # Errors
/// What cannot be framed.
pub(super) fn framed_scene(
    path: &Path,
    bounds: Option<(DVec3, DVec3)>,
    geometry: Geometry,
    materials: Vec<Material>,
) -> Result<Scene, InputError> {
    let framing = framed(path, bounds)?;
    Ok(Scene {
        image: ImageSettings::default(),
        render: RenderSettings::default(),
        camera: framing.camera,
        ambient: Rgb::ZERO,
        lights: vec![framing.light],
        materials,
        geometry,
    })
}
