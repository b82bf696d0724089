//! A ray, and the primitive that it leaves.

use crate::scene::PrimitiveId;
use glam::DVec3;

/// The half-line origin + t·direction, t > 0; world space, the direction of any length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// Hits are wanted beyond this; 0 but for rays that were recorded elsewhere.
    pub(super) t_min: f64,
    /// Where it starts, if that is on a surface.
    pub(super) departure: Option<Departure>,
    pub(super) ray_space: RaySpace,
}

/// A ray that starts on a surface meets that surface again only where geometry says so: a plane never, a sphere once if
/// the ray goes inside. Knowing this from the event that made the ray, not from the sign of a rounded number, is what
/// keeps a surface from shadowing or reflecting itself, without a tolerance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Departure {
    pub(super) from: PrimitiveId,
    pub(super) inward: bool,
    /// How far the origin may be off that surface, and off all that touches it there: a length.
    pub(super) off_surface: f64,
}

impl Ray {
    pub(super) fn new(origin: DVec3, direction: DVec3, departure: Option<Departure>) -> Self {
        Self { origin, direction, t_min: 0.0, departure, ray_space: RaySpace::new(direction) }
    }

    pub(super) fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// A point as seen along the ray: the ray itself is the third axis, and a point's third coordinate is its t.
    pub(super) fn project(&self, point: DVec3) -> DVec3 {
        self.ray_space.project(point - self.origin)
    }
}

/// The shear that turns the ray's direction into (0, 0, 1).
///
/// Every face that uses a vertex gets the same two coordinates for it, and questions of left or right are asked of these
/// alone, so neighbouring faces never disagree about their common edge: no ray slips between them.
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013. We keep x and y in their cyclic
/// order for directions of either sign, since faces are two-sided here.
#[derive(Clone, Copy, Debug)]
pub(super) struct RaySpace {
    /// x, y and z of ray space are these axes of the world; z is the one along which the ray is fastest.
    axes: [usize; 3],
    shear_x: f64,
    shear_y: f64,
    scale_z: f64,
}

impl RaySpace {
    fn new(direction: DVec3) -> Self {
        let z = direction.abs().max_position();
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        Self {
            axes: [x, y, z],
            shear_x: direction[x] / direction[z],
            shear_y: direction[y] / direction[z],
            scale_z: 1.0 / direction[z],
        }
    }

    fn project(&self, from_origin: DVec3) -> DVec3 {
        let [x, y, z] = self.axes.map(|axis| from_origin[axis]);
        DVec3::new(x - self.shear_x * z, y - self.shear_y * z, z * self.scale_z)
    }
}
