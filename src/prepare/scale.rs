//! The power of two that brings a scene to the size of 1.

use crate::scene::{Geometry, Projection, Scene};
use glam::Vec3;
use rayon::prelude::*;

/// What every length of a scene is multiplied by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    /// A power of two.
    factor: f32,
}

impl Scale {
    /// Brings the largest coordinate of the geometry and the eye into [1, 2).
    pub(crate) fn of(scene: &Scene) -> Self {
        let window = match scene.camera.projection {
            Projection::OrthographicHeight { height } => f64::from(height),
            Projection::OrthographicWindow { window } => {
                let edges = [window.left, window.right, window.bottom, window.top];
                edges.into_iter().map(|edge| f64::from(edge.abs())).fold(0.0, f64::max)
            }
            Projection::PerspectiveAngle { .. } | Projection::PerspectiveWindow { .. } => 0.0,
        };
        let eye = scene.camera.eye.as_dvec3().abs().max_element();
        Self::bringing_to_one(farthest_coordinate(&scene.geometry).max(eye).max(window))
    }

    fn bringing_to_one(largest: f64) -> Self {
        // Subnormal numbers, below 2⁻¹²⁶, keep being small; so does 0.
        let exponent = ((largest.to_bits() >> 52).cast_signed() - 1023).clamp(-126, 126);
        Self { factor: f32::from_bits(u32::try_from(127 - exponent).unwrap_or(127) << 23) }
    }

    pub(crate) fn factor(self) -> f32 {
        self.factor
    }

    /// A world position or length to the engine's. Exact, unless it is 2⁻¹⁰⁰ of the largest or less.
    pub(crate) fn position(self, world: Vec3) -> Vec3 {
        world * self.factor
    }

    pub(crate) fn length(self, world: f32) -> f32 {
        world * self.factor
    }
}

/// Largest magnitude of a coordinate of a sphere or vertex, on the threads of the current pool.
fn farthest_coordinate(geometry: &Geometry) -> f64 {
    let of_spheres = geometry.spheres.par_iter().map(|sphere| {
        let farthest = sphere.center.as_dvec3().abs() + f64::from(sphere.radius);
        farthest.max_element()
    });
    let of_vertices = geometry.vertices.par_iter().map(|vertex| f64::from(vertex.abs().max_element()));
    of_spheres.reduce(|| 0.0, f64::max).max(of_vertices.reduce(|| 0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_coordinate_comes_to_lie_between_one_and_two() {
        for largest in [1e18, 3.0, 2.0, 1.999, 1.0, 0.3, 1e-20, 1.2e-38] {
            let scaled = largest * f64::from(Scale::bringing_to_one(largest).factor());
            assert!((1.0..2.0).contains(&scaled), "{largest} became {scaled}");
        }
        for largest in [0.0, 1e-44] {
            assert!(Scale::bringing_to_one(largest).factor().is_finite(), "of {largest}");
        }
    }
}
