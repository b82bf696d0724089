//! Beer's law: what is left of the light that a ray carries through a dielectric to the surface that it leaves by.
//!
//! The ends o and p of the way are taken with what their rounding to f32 left out, so e^(−a·s) is off by at most
//! a·2⁻⁴⁵·(|o| + |p|) of itself, with the largest components of o and p, and by its own rounding to f32.

use super::column::widen_vector;
use super::elementary::exp;
use super::queue::{AttenuationQueue, DepartureQueue, RayQueue, SurfaceQueue};
use super::statistics::Work;
use crate::lanes::{Double, Vector};
use crate::prepare::Prepared;
use crate::scene::Rgb;

/// Writes an attenuation for each surface, 1 where the ray came from outside; returns how many exponentials it took.
pub(super) fn absorb<D: Double>(
    prepared: &Prepared<'_>,
    (rays, departures): (&RayQueue, Option<&DepartureQueue>),
    surfaces: &SurfaceQueue,
    attenuations: &mut AttenuationQueue,
    work: &mut Work,
) -> u64 {
    let materials = &prepared.scene.materials;
    // Absorption is per unit of the world's length.
    let world_from_scene = D::splat(1.0 / f64::from(prepared.scale.factor()));
    attenuations.clear();
    attenuations.set_len(surfaces.len());
    let mut exponentials = 0;
    for first in (0..surfaces.len()).step_by(D::WIDTH) {
        let count = (surfaces.len() - first).min(D::WIDTH);
        let mut absorption = [[0.0; 8]; 3];
        let (mut origin, mut origin_low) = ([[0.0; 8]; 3], [[0.0; 8]; 3]);
        for lane in 0..count {
            let row = first + lane;
            // A ray that stays inside came from inside.
            let from_inside = surfaces.departure[row] & 1 == 1;
            let dielectric = materials[surfaces.material[row] as usize].dielectric;
            let coefficients = match dielectric {
                Some(dielectric) if from_inside => dielectric.absorption,
                _ => Rgb::ZERO,
            };
            let ray = surfaces.ray[row] as usize;
            for channel in 0..3 {
                absorption[channel][lane] = coefficients[channel];
                origin[channel][lane] = rays.origin[channel][ray];
                if let Some(departures) = departures {
                    origin_low[channel][lane] = departures.origin_low[channel][ray];
                }
            }
        }
        work.lanes.add(D::WIDTH, count);
        let [x, y, z] = [0, 1, 2].map(|axis| D::widen(&origin[axis]) + D::widen(&origin_low[axis]));
        let position: Vector<D> =
            widen_vector(&surfaces.position, first) + widen_vector(&surfaces.position_low, first);
        let length = (position - Vector::new(x, y, z)).length() * world_from_scene;
        for (column, absorption) in attenuations.attenuation.iter_mut().zip(absorption) {
            if absorption == [0.0; 8] {
                column[first..first + count].fill(1.0);
                continue;
            }
            exponentials += count as u64;
            let mut rounded = [0.0; 8];
            exp(-(D::widen(&absorption) * length)).round(&mut rounded);
            column[first..first + count].copy_from_slice(&rounded[..count]);
        }
    }
    exponentials
}
