//! A ray in the forms that the kernels take: derived here once more, from what the kernels say they want, so that tests
//! do not take over a traversal's mistakes.

use crate::certified;
use crate::kernel::bounds::{LEAST_COMPONENT, PADDING, Slabs};
use crate::kernel::sphere::Line;
use crate::kernel::{RaySpace, axes_from};
use crate::lanes::{Lanes, Vector};
use glam::DVec3;

/// A ray of f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sight {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
}

impl Sight {
    pub(crate) fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin: origin.as_vec3().to_array(), direction: direction.as_vec3().to_array() }
    }

    /// The origin in f64.
    pub(crate) fn o(&self) -> DVec3 {
        DVec3::from(self.origin.map(f64::from))
    }

    /// The direction in f64.
    pub(crate) fn d(&self) -> DVec3 {
        DVec3::from(self.direction.map(f64::from))
    }

    /// For the judge.
    pub(crate) fn judged(&self) -> certified::Line {
        certified::Line::new(self.origin, self.direction)
    }

    /// A point relative to the origin without its part along the ray.
    pub(crate) fn seen_along(&self, point: DVec3) -> DVec3 {
        let d = self.d();
        let from_origin = point - self.o();
        from_origin - d * (from_origin.dot(d) / d.length_squared())
    }

    /// The axis of the largest component of the direction, of equal ones the first.
    pub(crate) fn third(&self) -> usize {
        let size = self.direction.map(f32::abs);
        (1..3).fold(0, |third, axis| if size[axis] > size[third] { axis } else { third })
    }

    pub(crate) fn axes(&self) -> [usize; 3] {
        axes_from(self.third())
    }
}

/// The rays of as many lanes; all have one order of axes.
pub(crate) fn space<L: Lanes<Scalar = f32>>(rays: &[Sight]) -> RaySpace<L> {
    let axes = rays[0].axes();
    let direction = axes.map(|axis| lanes(rays, |ray| ray.direction[axis]));
    let [x, y, z]: [L; 3] = direction;
    let t_per_z = L::splat(1.0) / z;
    RaySpace {
        origin: axes.map(|axis| lanes(rays, |ray| ray.origin[axis])),
        origin_low: None,
        shear: [x * t_per_z, y * t_per_z],
        t_per_z,
    }
}

pub(crate) fn line<L: Lanes<Scalar = f32>>(rays: &[Sight]) -> Line<L> {
    let direction: Vector<L> = vectors(rays, |ray| ray.direction);
    let a = direction.dot(direction);
    Line {
        origin: vectors(rays, |ray| ray.origin),
        origin_low: None,
        direction,
        a,
        inverse_a: L::splat(1.0) / a,
    }
}

pub(crate) fn slabs<L: Lanes<Scalar = f32>>(rays: &[Sight], extent: f32) -> Slabs<L> {
    let padded = |ray: &Sight, sign: f32| {
        let farthest = ray.origin.map(f32::abs).into_iter().fold(0.0, f32::max);
        let padding = sign * ((extent + farthest) * PADDING);
        [0, 1, 2].map(|axis| {
            if ray.direction[axis] < 0.0 { ray.origin[axis] - padding } else { ray.origin[axis] + padding }
        })
    };
    let inverse = |ray: &Sight| {
        let least = ray.direction[ray.third()].abs() * LEAST_COMPONENT;
        ray.direction.map(|component| {
            let size = component.abs().max(least);
            1.0 / if component < 0.0 { -size } else { size }
        })
    };
    Slabs {
        near_origin: vectors(rays, |ray| padded(ray, 1.0)),
        far_origin: vectors(rays, |ray| padded(ray, -1.0)),
        inverse: vectors(rays, inverse),
    }
}

/// The planes of boxes that rays meet first and last.
pub(crate) fn planes<L: Lanes<Scalar = f32>>(rays: &[Sight], boxes: &[[[f32; 3]; 2]]) -> [Vector<L>; 2] {
    let plane =
        |first: bool| {
            let rows: Vec<[f32; 3]> =
                rays.iter()
                    .zip(boxes)
                    .map(|(ray, [low, high])| {
                        [0, 1, 2].map(|axis| {
                            if (ray.direction[axis] < 0.0) == first { high[axis] } else { low[axis] }
                        })
                    })
                    .collect();
            vectors(&rows, |row| *row)
        };
    [plane(true), plane(false)]
}

/// A number of each of some things, as lanes.
pub(crate) fn lanes<L: Lanes<Scalar = f32>, T>(of: &[T], number: impl Fn(&T) -> f32) -> L {
    let mut row = [0.0; 16];
    for (lane, thing) in row.iter_mut().zip(of) {
        *lane = number(thing);
    }
    L::load(&row)
}

pub(crate) fn vectors<L: Lanes<Scalar = f32>, T>(of: &[T], vector: impl Fn(&T) -> [f32; 3]) -> Vector<L> {
    let [x, y, z] = [0, 1, 2].map(|axis| lanes(of, |thing| vector(thing)[axis]));
    Vector::new(x, y, z)
}
