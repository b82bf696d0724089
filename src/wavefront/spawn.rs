//! Reflected and refracted rays of surfaces, for the next level.

use super::level::Level;
use super::optics::{Boundary, mirrored};
use super::queue::{ChildQueue, ChildRecord, NormalQueue, RefractionQueue, RefractionRecord, SurfaceQueue};
use super::queue::{DepartureRecord, RayRecord};
use super::statistics::Work;
use super::surface::SurfaceLanes;
use crate::lanes::{Double, Lanes, Mask, Vector};
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
        let mut columns = [[0.0; 8]; 10];
        for lane in 0..count {
            let row = first + lane;
            let material = &prepared.scene.materials[surfaces.material[row] as usize];
            let (transmission, ior, is_dielectric, is_schlick) = match material.dielectric {
                Some(dielectric) => {
                    let is_schlick = f32::from(u8::from(dielectric.fresnel == Fresnel::Schlick));
                    (dielectric.transmission, dielectric.ior, 1.0, is_schlick)
                }
                None => (Rgb::ZERO, 1.0, 0.0, 0.0),
            };
            let is_entering = f32::from(u8::from(surfaces.departure[row] & 1 == 0));
            let [mirror, transmission] = [material.mirror, transmission].map(|rgb| rgb.to_array());
            let [r, g, b] = mirror;
            let [tr, tg, tb] = transmission;
            let values = [r, g, b, tr, tg, tb, ior, is_dielectric, is_schlick, is_entering];
            for (column, value) in columns.iter_mut().zip(values) {
                column[lane] = value;
            }
        }
        let [r, g, b, tr, tg, tb, ior, is_dielectric, is_schlick, is_entering] =
            columns.map(|column| D::widen(&column));
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
            refract(&surface, &materials, prepared.plan.vertex_normals, first, count, queues.refractions)
        } else {
            if refracts {
                no_refractions(first, count, queues.refractions);
            }
            materials.mirror
        };
        let direction = reflected(&surface, prepared.plan.vertex_normals);
        let mut columns = [[0.0; 8]; 6];
        for (lanes, column) in
            [direction.x, direction.y, direction.z, share.x, share.y, share.z].into_iter().zip(&mut columns)
        {
            lanes.round(column);
        }
        for lane in 0..count {
            let [dx, dy, dz, r, g, b] = columns.map(|column| column[lane]);
            let is_pushed =
                queues.push(prepared, first + lane, Branch::Reflected, [dx, dy, dz], [r, g, b], is_primary);
            rays.reflect += u64::from(is_pushed);
        }
    }
    queues.deeper.reflected_rays = queues.deeper.rays.len();
    if refracts {
        for row in 0..count {
            let direction = [0, 1, 2].map(|axis| queues.refractions.direction[axis][row]);
            let share = [0, 1, 2].map(|axis| queues.refractions.share[axis][row]);
            let is_pushed = queues.push(prepared, row, Branch::Refracted, direction, share, is_primary);
            rays.refract += u64::from(is_pushed);
        }
    }
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
    count: usize,
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
    let mut rounded = [[0.0; 8]; 6];
    let values =
        [direction.x, direction.y, direction.z, refracted_share.x, refracted_share.y, refracted_share.z];
    for (lanes, column) in values.into_iter().zip(&mut rounded) {
        lanes.round(column);
    }
    for lane in 0..count {
        let [dx, dy, dz, r, g, b] = rounded.map(|column| column[lane]);
        refractions.put(first + lane, RefractionRecord { direction: [dx, dy, dz], share: [r, g, b] });
    }
    Vector::select(materials.is_dielectric, reflected_share, materials.mirror)
}

fn no_refractions(first: usize, count: usize, refractions: &mut RefractionQueue) {
    for row in first..first + count {
        refractions.put(row, RefractionRecord { direction: [0.0; 3], share: [0.0; 3] });
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Branch {
    Reflected,
    Refracted,
}

impl Spawning<'_> {
    /// Pushes a child of a surface if its weight makes it worth tracing.
    #[inline(always)]
    fn push(
        &mut self,
        prepared: &Prepared<'_>,
        row: usize,
        branch: Branch,
        direction: [f32; 3],
        share: [f32; 3],
        is_primary: bool,
    ) -> bool {
        let is_reflected = branch == Branch::Reflected;
        let ray = self.surfaces.ray[row] as usize;
        let mut weight = share;
        let mut largest = 0.0;
        for (channel, weight) in weight.iter_mut().enumerate() {
            if !is_primary {
                *weight *= self.level.departures.weight[channel][ray];
            }
            if prepared.plan.absorption {
                *weight *= self.level.attenuations.attenuation[channel][row];
            }
            largest = Lanes::max(*weight, largest);
        }
        let is_worth_tracing = largest > 0.0 && largest >= prepared.plan.min_weight;
        let child = if is_worth_tracing {
            // Another side, another lowest bit.
            let departure = self.surfaces.departure[row] ^ u32::from(!is_reflected);
            let origin = [0, 1, 2].map(|axis| self.surfaces.position[axis][row]);
            let origin_low = [0, 1, 2].map(|axis| self.surfaces.position_low[axis][row]);
            self.deeper.departures.push(DepartureRecord { departure, origin_low, weight });
            self.deeper.rays.push(RayRecord { origin, direction })
        } else {
            NOTHING
        };
        let children: &mut ChildQueue =
            if is_reflected { &mut self.level.reflected } else { &mut self.level.refracted };
        children.put(row, ChildRecord { row: child, share });
        is_worth_tracing
    }
}
