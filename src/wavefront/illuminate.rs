//! Local light: ambient, Lambert's law, and highlights (Blinn, "Models of Light Reflection for Computer Synthesized
//! Pictures", 1977); a light at a time, so that one shadow queue does for any number of them.

use super::elementary::pow;
use super::queue::{NormalQueue, PendingQueue, PendingRecord, ShadowQueue, ShadowRecord, SurfaceQueue};
use super::statistics::Work;
use super::surface::SurfaceLanes;
use crate::lanes::{Double, Mask, Vector};
use crate::prepare::Prepared;
use crate::scene::{Light, Material, Rgb};

/// Makes a pending row of each surface, with ambient light.
pub(super) fn begin(prepared: &Prepared<'_>, surfaces: &SurfaceQueue, pending: &mut PendingQueue) {
    pending.clear();
    let ambient: Vec<[f32; 3]> = prepared
        .scene
        .materials
        .iter()
        .map(|material| (material.ambient * prepared.scene.ambient).to_array())
        .collect();
    for row in 0..surfaces.len() {
        let light = ambient[surfaces.material[row] as usize];
        pending.push(PendingRecord { ray: surfaces.ray[row], light });
    }
}

/// Pushes a shadow ray from each surface that a light could add to, with what it would add:
/// kd·I·(n·l) + ks·I·max(0, n·h)^α. Returns how many powers it took.
pub(super) fn aim<D: Double>(
    prepared: &Prepared<'_>,
    light: &Light,
    surfaces: &SurfaceQueue,
    normals: &NormalQueue,
    shadows: &mut ShadowQueue,
    work: &mut Work,
) -> u64 {
    shadows.clear();
    let (Light::Point { intensity, .. } | Light::Directional { intensity, .. }) = *light;
    let light_is_near = matches!(light, Light::Point { .. });
    let materials = &prepared.scene.materials;
    let adds = |material: &Material| {
        material.diffuse * intensity != Rgb::ZERO || material.specular * intensity != Rgb::ZERO
    };
    let zero = D::splat(0.0);
    let one = D::splat(1.0);
    let mut powers = 0;
    for first in (0..surfaces.len()).step_by(D::WIDTH) {
        let count = (surfaces.len() - first).min(D::WIDTH);
        let surface = SurfaceLanes::<D>::read(surfaces, normals, first);
        let to_light = match *light {
            Light::Point { position, .. } => {
                Vector::splat(prepared.scale.position(position).as_dvec3().to_array()) - surface.position
            }
            Light::Directional { direction, .. } => {
                Vector::splat((-direction.as_dvec3().normalize()).to_array())
            }
        };
        // A light at the very point lies in no direction, and no comparison with NaN is true.
        let distance = to_light.length();
        let l = to_light * (one / distance);
        let cos_light = surface.shading_normal.dot(l);
        let is_before = cos_light.gt(zero) & surface.geometric_normal.dot(l).gt(zero);
        let mut bits = is_before.bits();
        let mut coefficients = [[0.0; 8]; 7];
        for lane in 0..D::WIDTH {
            if lane >= count || bits >> lane & 1 == 0 {
                bits &= !(1 << lane);
                continue;
            }
            let material = &materials[surfaces.material[first + lane] as usize];
            if !adds(material) {
                bits &= !(1 << lane);
                continue;
            }
            let (diffuse, specular) = (material.diffuse, material.specular);
            let values =
                [diffuse.x, diffuse.y, diffuse.z, specular.x, specular.y, specular.z, material.shininess];
            for (column, value) in coefficients.iter_mut().zip(values) {
                column[lane] = value;
            }
        }
        let used = bits.count_ones() as usize;
        work.lanes.add(D::WIDTH, used);
        if used == 0 {
            continue;
        }
        let [diffuse_r, diffuse_g, diffuse_b, specular_r, specular_g, specular_b, shininess] =
            coefficients.map(|column| D::widen(&column));
        let mut added = Vector::new(diffuse_r, diffuse_g, diffuse_b) * cos_light;
        if prepared.plan.highlights && coefficients[3..6].iter().any(|column| *column != [0.0; 8]) {
            let half = (l - surface.direction).normalized(one);
            // Where v = −l there is no half vector, and a maximum with NaN first is 0.
            let cos_half = surface.shading_normal.dot(half).max(zero);
            let highlight = pow(cos_half, shininess);
            powers += used as u64;
            added = added + Vector::new(specular_r, specular_g, specular_b) * highlight;
        }
        let added = added.times(Vector::splat(intensity.as_dvec3().to_array()));
        let segment = if light_is_near {
            Segment::to_point(SurfaceLanes::kept_on_side(to_light, distance, surface.geometric_normal))
        } else {
            let direction = SurfaceLanes::kept_on_side(l, one, surface.geometric_normal);
            Segment { direction, end: D::splat(f64::INFINITY) }
        };
        push_rows(bits, first, &segment, added, surfaces, shadows);
    }
    powers
}

/// The way from a surface to a light.
struct Segment<D> {
    direction: Vector<D>,
    /// t of the light.
    end: D,
}

impl<D: Double> Segment<D> {
    /// A light may be so far away that squares overflow f32: the direction is brought to the size of 1 by a power of two,
    /// which leaves its bits as they are.
    fn to_point(to_light: Vector<D>) -> Self {
        let zero = D::splat(0.0);
        let largest = to_light.x.abs().max(to_light.y.abs()).max(to_light.z.abs());
        let (exponent, _) = D::select(largest.gt(zero), largest, D::splat(1.0)).split_exponent();
        let one = D::splat(1.0);
        Self {
            direction: to_light * one.times_power_of_two(-exponent),
            end: one.times_power_of_two(exponent),
        }
    }
}

/// Pushes the lanes whose bits are set.
fn push_rows<D: Double>(
    mut bits: u32,
    first: usize,
    segment: &Segment<D>,
    light: Vector<D>,
    surfaces: &SurfaceQueue,
    shadows: &mut ShadowQueue,
) {
    let mut rounded = [[0.0; 8]; 7];
    let Segment { direction, end } = segment;
    for (lanes, column) in
        [direction.x, direction.y, direction.z, light.x, light.y, light.z, *end].into_iter().zip(&mut rounded)
    {
        lanes.round(column);
    }
    while bits != 0 {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        let row = first + lane;
        let [dx, dy, dz, r, g, b, t] = rounded.map(|column| column[lane]);
        #[expect(clippy::cast_possible_truncation, reason = "a batch has some thousand rows")]
        let surface = row as u32;
        shadows.push(ShadowRecord {
            origin: [0, 1, 2].map(|axis| surfaces.position[axis][row]),
            origin_low: [0, 1, 2].map(|axis| surfaces.position_low[axis][row]),
            direction: [dx, dy, dz],
            departure: surfaces.departure[row],
            t,
            surface,
            light: [r, g, b],
        });
    }
}

/// Adds the light of those shadow rays that are not occluded.
pub(super) fn add_light(shadows: &ShadowQueue, pending: &mut PendingQueue) {
    for row in 0..shadows.len() {
        if shadows.t[row] >= 0.0 {
            let surface = shadows.surface[row] as usize;
            for channel in 0..3 {
                pending.light[channel][surface] += shadows.light[channel][row];
            }
        }
    }
}
