//! What a scene is: plain data in the user's units, every number an f32 rounded once.
//!
//! A scene is one flat list of primitives; there is no nesting and no transform left to apply. Lengths and positions
//! are in world space, colours are linear RGB, angles are in degrees.

mod camera;
mod geometry;
mod material;
mod settings;

pub use camera::{Camera, CameraProblem, Projection, Window};
pub use geometry::{Added, Geometry, GeometryProblem, Polygon, PrimitiveId, Sphere, Triangle};
pub(crate) use geometry::{polygon_normal, widened};
pub use material::{Dielectric, Fresnel, Light, Material, MaterialId};
pub use settings::{ImageSettings, MAX_COORDINATE, MAX_PIXELS, RenderSettings, Sampling};

use glam::Vec3;

/// A colour or a per-channel factor, linear RGB.
pub type Rgb = Vec3;

/// Everything that defines the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Size of the picture and what lies behind everything.
    pub image: ImageSettings,
    /// How rays are spread over a pixel and how deep they are followed.
    pub render: RenderSettings,
    /// The eye.
    pub camera: Camera,
    /// Ambient intensity, Ia.
    pub ambient: Rgb,
    /// In file order, which is the order in which their light is summed.
    pub lights: Vec<Light>,
    /// What primitives refer to by [`MaterialId`].
    pub materials: Vec<Material>,
    /// Spheres, triangles and polygons.
    pub geometry: Geometry,
}

#[cfg(test)]
impl Scene {
    /// Geometry seen from the origin along −z, without lights, and everything else as it is by default: for tests.
    pub(crate) fn unlit(geometry: Geometry, materials: Vec<Material>) -> Self {
        Self {
            image: ImageSettings::default(),
            render: RenderSettings::default(),
            camera: Camera {
                eye: Vec3::ZERO,
                target: Vec3::NEG_Z,
                up: Vec3::Y,
                projection: Projection::PerspectiveAngle { vertical_degrees: 45.0 },
            },
            ambient: Rgb::ZERO,
            lights: Vec::new(),
            materials,
            geometry,
        }
    }
}
