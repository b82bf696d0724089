//! Reflected and refracted rays of surfaces, for the next level.

use super::column::round_vector;
use super::level::Level;
use super::materials::columns_of;
use super::optics::{Boundary, mirrored};
use super::queue::{ChildQueue, NormalQueue, RefractionQueue, SurfaceQueue};
use super::statistics::Work;
use super::surface::SurfaceLanes;
use crate::lanes::{Double, Lanes, Mask, Packing, Vector};
use crate::prepare::Prepared;
use crate::rays::RayCounts;
use crate::scene::{Fresnel, Rgb};
use crate::traverse::NOTHING;

/// What surfaces do to light, in lanes.
struct Materials<D: Double> {
    mirror: Vector<D>,
    transmission: Vector<D>,
    /// 1 where there is no dielectric.
    ior: D,
    is_dielectric: D::Mask,
    /// Shares follow Schlick, not km and kt.
    is_schlick: D::Mask,
    /// From outside.
    entering: D::Mask,
}

impl<D: Double> Materials<D> {
    fn gather(prepared: &Prepared<'_>, surfaces: &SurfaceQueue, first: usize, count: usize) -> Self {
        let values = |of_row: usize| {
            let material = &prepared.scene.materials[of_row];
            let (transmission, ior, is_dielectric, is_schlick) = match material.dielectric {
                Some(dielectric) => {
                    let is_schlick = f32::from(u8::from(dielectric.fresnel == Fresnel::Schlick));
                    (dielectric.transmission, dielectric.ior, 1.0, is_schlick)
                }
                None => (Rgb::ZERO, 1.0, 0.0, 0.0),
            };
            let [mirror, transmission] = [material.mirror, transmission].map(|rgb| rgb.to_array());
            let [r, g, b] = mirror;
            let [tr, tg, tb] = transmission;
            [r, g, b, tr, tg, tb, ior, is_dielectric, is_schlick]
        };
        let columns = columns_of(&surfaces.material[first..first + count], values);
        let [r, g, b, tr, tg, tb, ior, is_dielectric, is_schlick] = columns.map(|column| D::widen(&column));
        let mut entering = [0.0; 8];
        for (entering, &departure) in entering.iter_mut().zip(&surfaces.departure[first..first + count]) {
            *entering = f32::from(u8::from(departure & 1 == 0));
        }
        let is_entering = D::widen(&entering);
        let zero = D::splat(0.0);
        Self {
            mirror: Vector::new(r, g, b),
            transmission: Vector::new(tr, tg, tb),
            ior: D::select(is_dielectric.gt(zero), ior, D::splat(1.0)),
            is_dielectric: is_dielectric.gt(zero),
            is_schlick: is_schlick.gt(zero),
            entering: is_entering.gt(zero),
        }
    }
}

/// Queues that a batch's surfaces stand in, and those that its children go to.
pub(super) struct Spawning<'a> {
    pub(super) surfaces: &'a SurfaceQueue,
    pub(super) normals: &'a NormalQueue,
    pub(super) refractions: &'a mut RefractionQueue,
    /// The level of the surfaces.
    pub(super) level: &'a mut Level,
    /// The one below, to be filled.
    pub(super) deeper: &'a mut Level,
}

/// Pushes the children of all surfaces: first the reflected rays, then the refracted ones.
///
/// A batch of n surfaces has at most 2n children, n where nothing refracts: that is the deeper level's capacity.
pub(super) fn spawn<D: Double>(
    prepared: &Prepared<'_>,
    queues: &mut Spawning<'_>,
    is_primary: bool,
    rays: &mut RayCounts,
    work: &mut Work,
) {
    queues.deeper.begin();
    let refracts = prepared.plan.refraction;
    let count = queues.surfaces.len();
    queues.level.reflected.clear();
    queues.level.reflected.set_len(count);
    queues.refractions.clear();
    queues.level.refracted.clear();
    if refracts {
        queues.refractions.set_len(count);
        queues.level.refracted.set_len(count);
    }
    for first in (0..count).step_by(D::WIDTH) {
        let count = (count - first).min(D::WIDTH);
        let surface = SurfaceLanes::<D>::read(queues.surfaces, queues.normals, first);
        let materials = Materials::<D>::gather(prepared, queues.surfaces, first, count);
        work.lanes.add(D::WIDTH, count);
        let share = if refracts && materials.is_dielectric.any() {
            refract(&surface, &materials, prepared.plan.vertex_normals, first, queues.refractions)
        } else {
            if refracts {
                no_refractions(first, count, queues.refractions);
            }
            materials.mirror
        };
        let direction = reflected(&surface, prepared.plan.vertex_normals);
        let children = Children {
            branch: Branch::Reflected,
            direction: rounded_columns(direction),
            share: rounded_columns(share),
        };
        rays.reflect += queues.push(prepared, (first, count), &children, is_primary);
    }
    queues.deeper.reflected_rays = queues.deeper.rays.len();
    if refracts {
        for first in (0..count).step_by(D::WIDTH) {
            let lanes = |column: &[f32]| {
                let mut lanes = [0.0; 8];
                lanes[..D::WIDTH].copy_from_slice(&column[first..first + D::WIDTH]);
                lanes
            };
            let children = Children {
                branch: Branch::Refracted,
                direction: queues.refractions.direction.each_ref().map(|column| lanes(column)),
                share: queues.refractions.share.each_ref().map(|column| lanes(column)),
            };
            let count = (count - first).min(D::WIDTH);
            rays.refract += queues.push(prepared, (first, count), &children, is_primary);
        }
    }
}

/// Rounded to f32, for queues.
#[inline(always)]
fn rounded_columns<D: Double>(vector: Vector<D>) -> [[f32; 8]; 3] {
    let mut columns = [[0.0; 8]; 3];
    let [x, y, z] = &mut columns;
    vector.x.round(x);
    vector.y.round(y);
    vector.z.round(z);
    columns
}

/// The mirrored direction; with the true normal where n_s would send it below the true surface.
fn reflected<D: Double>(surface: &SurfaceLanes<D>, has_vertex_normals: bool) -> Vector<D> {
    let mut direction = mirrored(surface.direction, surface.shading_normal);
    if has_vertex_normals {
        let stays = direction.dot(surface.geometric_normal).gt(D::splat(0.0));
        let other = mirrored(surface.direction, surface.geometric_normal);
        direction = Vector::select(stays, direction, other);
    }
    let one = D::splat(1.0);
    SurfaceLanes::kept_on_side(direction.normalized(one), one, surface.geometric_normal)
}

/// Writes the refracted rays of some surfaces, and returns the shares of the reflected ones.
fn refract<D: Double>(
    surface: &SurfaceLanes<D>,
    materials: &Materials<D>,
    has_vertex_normals: bool,
    first: usize,
    refractions: &mut RefractionQueue,
) -> Vector<D> {
    let (zero, one) = (D::splat(0.0), D::splat(1.0));
    let boundary_at = |normal| Boundary::new(surface.direction, normal, materials.ior, materials.entering);
    // A vertex normal that faces away from the ray has no angle of incidence.
    let faces_ray = surface.direction.dot(surface.shading_normal).lt(zero);
    let normal = Vector::select(faces_ray, surface.shading_normal, surface.geometric_normal);
    let boundary = boundary_at(normal);

    let reflectance = boundary.reflectance(materials.ior, materials.entering);
    let white = Vector::new(one, one, one);
    let total =
        Vector::select(boundary.is_total, materials.mirror + materials.transmission, materials.mirror);
    let reflected_share = Vector::select(materials.is_schlick, white * reflectance, total);
    let passed = Vector::select(
        materials.is_schlick,
        materials.transmission * (one - reflectance),
        materials.transmission,
    );
    let none = Vector::new(zero, zero, zero);
    let mut refracted_share = Vector::select(boundary.is_total | !materials.is_dielectric, none, passed);

    let mut direction = boundary.refracted(surface.direction, normal);
    if has_vertex_normals {
        // A refracted ray that stays on this side of the true surface is made with the true normal; where that reflects
        // totally there is none, and its share is lost.
        let leaves = direction.dot(surface.geometric_normal).lt(zero);
        let at_true_normal = boundary_at(surface.geometric_normal);
        let other = at_true_normal.refracted(surface.direction, surface.geometric_normal);
        direction = Vector::select(leaves, direction, other);
        refracted_share = Vector::select(!leaves & at_true_normal.is_total, none, refracted_share);
    }
    direction = SurfaceLanes::kept_on_side(direction, one, -surface.geometric_normal);
    round_vector(direction, &mut refractions.direction, first);
    round_vector(refracted_share, &mut refractions.share, first);
    Vector::select(materials.is_dielectric, reflected_share, materials.mirror)
}

fn no_refractions(first: usize, count: usize, refractions: &mut RefractionQueue) {
    for column in refractions.direction.iter_mut().chain(&mut refractions.share) {
        column[first..first + count].fill(0.0);
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Branch {
    Reflected,
    Refracted,
}

/// A child of each surface, in lanes.
struct Children {
    branch: Branch,
    direction: [[f32; 8]; 3],
    /// Of what they see.
    share: [[f32; 8]; 3],
}

impl Spawning<'_> {
    /// Pushes those children of `count` surfaces from `first` on whose weight makes them worth tracing; returns how many.
    #[inline(always)]
    fn push(
        &mut self,
        prepared: &Prepared<'_>,
        (first, count): (usize, usize),
        children: &Children,
        is_primary: bool,
    ) -> u64 {
        let Self { surfaces, level, deeper, .. } = self;
        let run = first..first + count;
        let parents = &surfaces.ray[run.clone()];
        let mut weight = children.share;
        for (channel, weight) in weight.iter_mut().enumerate() {
            if !is_primary {
                let of_parents = &level.departures.weight[channel][..];
                for (weight, &parent) in weight.iter_mut().zip(parents) {
                    *weight *= of_parents[parent as usize];
                }
            }
            if prepared.plan.absorption {
                for (weight, share) in
                    weight.iter_mut().zip(&level.attenuations.attenuation[channel][run.clone()])
                {
                    *weight *= share;
                }
            }
        }
        let mut bits = 0;
        let [red, green, blue] = &weight;
        for lane in 0..count {
            let largest = Lanes::max(blue[lane], Lanes::max(green[lane], Lanes::max(red[lane], 0.0)));
            bits |= u32::from(largest > 0.0 && largest >= prepared.plan.min_weight) << lane;
        }

        let is_reflected = children.branch == Branch::Reflected;
        let numbers: &mut ChildQueue = if is_reflected { &mut level.reflected } else { &mut level.refracted };
        let row = deeper.rays.len();
        for lane in 0..count {
            let before = (bits & ((1 << lane) - 1)).count_ones();
            #[expect(clippy::cast_possible_truncation, reason = "a batch has some thousand rows")]
            let number = row as u32 + before;
            numbers.row[first + lane] = if bits >> lane & 1 == 1 { number } else { NOTHING };
        }
        for (to, share) in numbers.share.iter_mut().zip(&children.share) {
            let to = &mut to[first..];
            match to.first_chunk_mut() {
                // What lies behind is written over later, or is no row; a length that is known beforehand is sooner copied.
                Some(to) => *to = *share,
                None => to[..count].copy_from_slice(&share[..count]),
            }
        }

        let packing = Packing::new(bits);
        deeper.rays.set_len(row + packing.count());
        deeper.departures.set_len(row + packing.count());
        // Another side, another lowest bit.
        let other_side = u32::from(!is_reflected);
        let mut departure = [0; Packing::MOST];
        for (departure, this_side) in departure.iter_mut().zip(&surfaces.departure[run]) {
            *departure = this_side ^ other_side;
        }
        packing.pack(&departure, &mut deeper.departures.departure[row..]);
        for (axis, weight) in weight.iter().enumerate() {
            packing.pack(&surfaces.position[axis][first..], &mut deeper.rays.origin[axis][row..]);
            packing
                .pack(&surfaces.position_low[axis][first..], &mut deeper.departures.origin_low[axis][row..]);
            packing.pack(&children.direction[axis], &mut deeper.rays.direction[axis][row..]);
            packing.pack(weight, &mut deeper.departures.weight[axis][row..]);
        }
        packing.count() as u64
    }
}
