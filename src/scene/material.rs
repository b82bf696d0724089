//! What light does at a surface, and where light comes from.

use super::Rgb;
use glam::Vec3;
use serde::Serialize;

/// An index into [`Scene::materials`](super::Scene::materials).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MaterialId(pub u32);

/// Coefficients of the Whitted model; per channel unless they say otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// ka.
    pub ambient: Rgb,
    /// kd.
    pub diffuse: Rgb,
    /// ks.
    pub specular: Rgb,
    /// α, the Blinn-Phong exponent.
    pub shininess: f32,
    /// km.
    pub mirror: Rgb,
    /// What makes it transparent, if it is.
    pub dielectric: Option<Dielectric>,
    /// Whether it hides lights.
    pub casts_shadow: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            ambient: Rgb::ZERO,
            diffuse: Rgb::ZERO,
            specular: Rgb::ZERO,
            shininess: 1.0,
            mirror: Rgb::ZERO,
            dielectric: None,
            casts_shadow: true,
        }
    }
}

impl Material {
    /// What geometry without a material is shown in.
    #[must_use]
    pub fn grey() -> Self {
        Self { diffuse: Rgb::splat(0.7), ..Self::default() }
    }
}

/// What lets light through a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// Index of refraction of the inside relative to the outside.
    pub ior: f32,
    /// a of Beer's law, per unit of world length.
    pub absorption: Rgb,
    /// kt.
    pub transmission: Rgb,
    /// What decides how light divides between reflection and refraction.
    pub fresnel: Fresnel,
}

/// What decides how light divides between reflection and refraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fresnel {
    /// Schlick's approximation.
    Schlick,
    /// The fixed shares km and kt.
    Fixed,
}

/// A light without fall-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Shines from a point.
    Point {
        /// World position.
        position: Vec3,
        /// Ii.
        intensity: Rgb,
    },
    /// Shines along a direction from infinitely far away.
    Directional {
        /// World direction in which the light travels; not zero, not necessarily unit.
        direction: Vec3,
        /// Ii.
        intensity: Rgb,
    },
}
