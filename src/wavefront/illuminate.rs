//! Local light: ambient, Lambert's law, and highlights (Blinn, "Models of Light Reflection for Computer Synthesized
//! Pictures", 1977); a light at a time, so that one shadow queue does for any number of them.

use super::elementary::pow;
use super::materials::columns_of;
use super::queue::{NormalQueue, PendingQueue, ShadowQueue, SurfaceQueue};
use super::statistics::Work;
use super::surface::SurfaceLanes;
use crate::lanes::{Double, Mask, Packing, Vector};
use crate::prepare::Prepared;
use crate::scene::{Light, Material, Rgb};

/// Makes a pending row of each surface, with ambient light.
pub(super) fn begin(prepared: &Prepared<'_>, surfaces: &SurfaceQueue, pending: &mut PendingQueue) {
    let count = surfaces.len();
    pending.clear();
    pending.set_len(count);
    pending.ray[..count].copy_from_slice(&surfaces.ray[..count]);
    for (channel, light) in pending.light.iter_mut().enumerate() {
        let ambient: Vec<f32> = prepared
            .scene
            .materials
            .iter()
            .map(|material| (material.ambient * prepared.scene.ambient)[channel])
            .collect();
        for (light, &material) in light[..count].iter_mut().zip(&surfaces.material[..count]) {
            *light = ambient[material as usize];
        }
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
        let columns = columns_of(&surfaces.material[first..first + count], |of_row| {
            let material = &materials[of_row];
            let (diffuse, specular) = (material.diffuse, material.specular);
            let adds = f32::from(u8::from(adds(material)));
            [diffuse.x, diffuse.y, diffuse.z, specular.x, specular.y, specular.z, material.shininess, adds]
        });
        let [red, green, blue, specular_red, specular_green, specular_blue, shininess, adds] =
            columns.map(|column| D::widen(&column));
        let bits = (is_before & adds.gt(zero)).bits() & ((1 << count) - 1);
        let has_highlight = !(specular_red.eq(zero) & specular_green.eq(zero) & specular_blue.eq(zero));
        let used = bits.count_ones() as usize;
        work.lanes.add(D::WIDTH, used);
        if used == 0 {
            continue;
        }
        let mut added = Vector::new(red, green, blue) * cos_light;
        if prepared.plan.highlights && has_highlight.bits() & bits != 0 {
            let half = (l - surface.direction).normalized(one);
            // Where v = −l there is no half vector, and a maximum with NaN first is 0.
            let cos_half = surface.shading_normal.dot(half).max(zero);
            let highlight = pow(cos_half, shininess);
            powers += used as u64;
            added = added + Vector::new(specular_red, specular_green, specular_blue) * highlight;
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

/// Pushes the lanes whose bits are set, from the surface of the first lane on.
#[inline(always)]
fn push_rows<D: Double>(
    bits: u32,
    first: usize,
    segment: &Segment<D>,
    light: Vector<D>,
    surfaces: &SurfaceQueue,
    shadows: &mut ShadowQueue,
) {
    let packing = Packing::new(bits);
    let row = shadows.len();
    shadows.set_len(row + packing.count());
    for axis in 0..3 {
        packing.pack(&surfaces.position[axis][first..], &mut shadows.origin[axis][row..]);
        packing.pack(&surfaces.position_low[axis][first..], &mut shadows.origin_low[axis][row..]);
    }
    packing.pack(&surfaces.departure[first..], &mut shadows.departure[row..]);
    #[expect(clippy::cast_possible_truncation, reason = "a batch has some thousand rows")]
    let numbers = [0, 1, 2, 3, 4, 5, 6, 7].map(|lane| first as u32 + lane);
    packing.pack(&numbers, &mut shadows.surface[row..]);
    let [dx, dy, dz] = &mut shadows.direction;
    let [red, green, blue] = &mut shadows.light;
    let Segment { direction, end } = segment;
    let columns = [dx, dy, dz, red, green, blue, &mut shadows.t];
    let lanes = [direction.x, direction.y, direction.z, light.x, light.y, light.z, *end];
    for (lanes, column) in lanes.into_iter().zip(columns) {
        let mut rounded = [0.0; Packing::MOST];
        lanes.round(&mut rounded);
        packing.pack(&rounded, &mut column[row..]);
    }
}

/// Adds the light of those shadow rays that are not occluded. Without a branch, since nobody can guess which these are: to add
/// 0 changes no light.
pub(super) fn add_light(shadows: &ShadowQueue, pending: &mut PendingQueue) {
    let count = shadows.len();
    let (t, surface) = (&shadows.t[..count], &shadows.surface[..count]);
    for (light, pending) in shadows.light.iter().zip(&mut pending.light) {
        let pending = &mut pending[..];
        for ((&light, &t), &surface) in light[..count].iter().zip(t).zip(surface) {
            pending[surface as usize] += if t >= 0.0 { light } else { 0.0 };
        }
    }
}
