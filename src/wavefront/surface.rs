//! What the surfaces are like that rays have hit: the exact place, and normals.
//!
//! The kernels found in f32 which primitive is nearest; here the hit is computed anew in f64, once a ray, from the same f32
//! numbers, and rounded once. A point is put back onto its primitive rather than taken as origin + t·direction: with what its
//! rounding left out it lies within 2⁻⁴⁷ of the coordinates of it. A normal is within 2⁻²⁴ of the true one for the f32 ray.

use super::column::{Column, widen_vector};
use super::outline;
use super::queue::{
    DepartureQueue, HitQueue, NormalQueue, RadianceQueue, RadianceRecord, RayQueue, SurfaceQueue,
};
use super::statistics::Work;
use crate::kernel::UNIT_ROUNDOFF;
use crate::lanes::{Double, Lanes, Mask, Vector};
use crate::prepare::bvh::Kind;
use crate::prepare::{Prepared, material_of};
use crate::scene::{Geometry, Polygon};
use crate::traverse::NOTHING;
use glam::{DVec3, Vec3};
use std::ops::Range;

/// Rows of rays by what they hit. Each list has room for a batch.
pub(super) struct Sorted {
    by_kind: [Vec<HitRow>; Kind::COUNT],
}

/// A ray, and the primitive that it hits.
#[derive(Clone, Copy)]
struct HitRow {
    ray: u32,
    id: u32,
    /// In its column of the scene's geometry.
    index: u32,
}

impl Sorted {
    pub(super) fn with_capacity(rows: [usize; Kind::COUNT]) -> Self {
        Self { by_kind: rows.map(Vec::with_capacity) }
    }

    pub(super) fn bytes(&self) -> usize {
        self.by_kind.iter().map(|rows| rows.capacity() * size_of::<HitRow>()).sum()
    }

    /// Sorts a batch of rays, and gives those that hit nothing the background.
    fn sort(
        &mut self,
        prepared: &Prepared<'_>,
        first_ray: usize,
        hits: &HitQueue,
        radiance: &mut RadianceQueue,
    ) {
        self.by_kind.iter_mut().for_each(Vec::clear);
        let background = prepared.scene.image.background.to_array();
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a batch has some thousand rows, a kind 2³⁰ primitives"
        )]
        for (row, &id) in hits.id[..hits.len()].iter().enumerate() {
            let ray = first_ray + row;
            if id == NOTHING {
                radiance.put(ray, RadianceRecord { radiance: background });
            } else {
                let (kind, index) = prepared.directory.find(id);
                self.by_kind[kind as usize].push(HitRow { ray: ray as u32, id, index: index as u32 });
            }
        }
    }
}

/// Rays of a batch: `rays[first..]`, as many as there are hits.
pub(super) struct Batch<'a> {
    pub(super) first: usize,
    pub(super) rays: &'a RayQueue,
    /// Where the rays start; none for primary rays.
    pub(super) departures: Option<&'a DepartureQueue>,
    pub(super) hits: &'a HitQueue,
}

/// Appends a surface for each hit of a batch, spheres first, then triangles, then polygons. Rays that miss see the
/// background.
pub(super) fn surface<D: Double>(
    prepared: &Prepared<'_>,
    batch: &Batch<'_>,
    sorted: &mut Sorted,
    surfaces: &mut SurfaceQueue,
    normals: &mut NormalQueue,
    radiance: &mut RadianceQueue,
    work: &mut Work,
) {
    sorted.sort(prepared, batch.first, batch.hits, radiance);
    surfaces.clear();
    normals.clear();
    let mut out = Out { prepared, surfaces, normals, work };
    for chunk in sorted.by_kind[Kind::Sphere as usize].chunks(D::WIDTH) {
        let found = spheres::<D>(prepared, batch, chunk);
        out.append(batch, chunk, Kind::Sphere, &found);
    }
    for chunk in sorted.by_kind[Kind::Triangle as usize].chunks(D::WIDTH) {
        let found = triangles::<D>(prepared, batch, chunk);
        out.append(batch, chunk, Kind::Triangle, &found);
    }
    for chunk in sorted.by_kind[Kind::Polygon as usize].chunks(D::WIDTH) {
        let found = polygons::<D>(prepared, batch, chunk);
        out.append(batch, chunk, Kind::Polygon, &found);
    }
}

/// Surfaces in lanes.
struct Found<D: Double> {
    /// Whether the ray comes from the side of the geometric normal.
    entering: D::Mask,
    position: Vector<D>,
    /// Outward, unit.
    geometric_normal: Vector<D>,
    /// On the side of the geometric one, unit; none where they are the same.
    shading_normal: Option<Vector<D>>,
}

struct Out<'a, 'b> {
    prepared: &'a Prepared<'b>,
    surfaces: &'a mut SurfaceQueue,
    normals: &'a mut NormalQueue,
    work: &'a mut Work,
}

impl Out<'_, '_> {
    fn append<D: Double>(&mut self, batch: &Batch<'_>, chunk: &[HitRow], kind: Kind, found: &Found<D>) {
        let first = self.surfaces.len();
        self.surfaces.set_len(first + chunk.len());
        self.work.lanes.add(D::WIDTH, chunk.len());

        let facing = |normal: Vector<D>| Vector::select(found.entering, normal, -normal);
        round_rows(found.position, &mut self.surfaces.position, first, chunk.len());
        let left_out = found.position - rounded(found.position);
        round_rows(left_out, &mut self.surfaces.position_low, first, chunk.len());
        round_rows(facing(found.geometric_normal), &mut self.surfaces.geometric_normal, first, chunk.len());
        if self.prepared.plan.vertex_normals {
            self.normals.set_len(first + chunk.len());
            let normal = found.shading_normal.unwrap_or(found.geometric_normal);
            round_rows(facing(normal), &mut self.normals.shading_normal, first, chunk.len());
        }
        let entering = found.entering.bits();
        let geometry = &self.prepared.scene.geometry;
        for (lane, row) in chunk.iter().enumerate() {
            let at = first + lane;
            self.surfaces.ray[at] = row.ray;
            // A ray that stays on this side is outside if this one came from outside.
            self.surfaces.departure[at] = row.id << 1 | u32::from(entering >> lane & 1 == 0);
            self.surfaces.material[at] = material_of(geometry, (kind, row.index as usize)).0;
        }
        let run = first..first + chunk.len();
        for (to, from) in self.surfaces.direction.iter_mut().zip(&batch.rays.direction) {
            let to = &mut to[run.clone()];
            match run_of(chunk) {
                Some(rays) => to.copy_from_slice(&from[rays]),
                None => to.iter_mut().zip(chunk).for_each(|(to, row)| *to = from[row.ray as usize]),
            }
        }
    }
}

/// As f32 has it.
#[inline(always)]
fn rounded<D: Double>(vector: Vector<D>) -> Vector<D> {
    let round = |lanes: D| {
        let mut rounded = [0.0; 8];
        lanes.round(&mut rounded);
        D::widen(&rounded)
    };
    Vector::new(round(vector.x), round(vector.y), round(vector.z))
}

/// Lanes may reach beyond the last row of a column; only rows are written.
#[inline(always)]
fn round_rows<D: Double>(vector: Vector<D>, columns: &mut [Column<f32>; 3], row: usize, count: usize) {
    let mut rounded = [[0.0; 8]; 3];
    let [x, y, z] = &mut rounded;
    vector.x.round(x);
    vector.y.round(y);
    vector.z.round(z);
    for (column, rounded) in columns.iter_mut().zip(rounded) {
        column[row..row + count].copy_from_slice(&rounded[..count]);
    }
}

/// Values of rows in lanes; lanes without a row repeat the last.
#[inline(always)]
fn gather<D: Double, const N: usize>(chunk: &[HitRow], value: impl Fn(&HitRow) -> [f32; N]) -> [D; N] {
    let mut columns = [[0.0; 8]; N];
    for lane in 0..D::WIDTH {
        let values = value(&chunk[lane.min(chunk.len() - 1)]);
        for (column, value) in columns.iter_mut().zip(values) {
            column[lane] = value;
        }
    }
    columns.map(|column| D::widen(&column))
}

/// What rows have of their primitives, in lanes. Neighbours often hit the same, which is then read once.
#[inline(always)]
fn gather_primitives<D: Double, const N: usize>(
    chunk: &[HitRow],
    value: impl Fn(usize) -> [f32; N],
) -> [D; N] {
    let first = chunk[0].index;
    if chunk.iter().fold(0, |differs, row| differs | row.index ^ first) == 0 {
        value(first as usize).map(|value| D::splat(f64::from(value)))
    } else {
        gather(chunk, |row| value(row.index as usize))
    }
}

/// The rays of rows whose rays follow each other, as those of neighbours often do.
#[inline(always)]
fn run_of(chunk: &[HitRow]) -> Option<Range<usize>> {
    let (first, last) = (chunk[0].ray as usize, chunk[chunk.len() - 1].ray as usize);
    // They are in order.
    (last - first == chunk.len() - 1).then_some(first..last + 1)
}

#[inline(always)]
fn gather_rays<D: Double>(batch: &Batch<'_>, chunk: &[HitRow]) -> [Vector<D>; 2] {
    if let Some(run) = run_of(chunk).filter(|_| chunk.len() == D::WIDTH) {
        let (origin, direction) =
            (widen_vector(&batch.rays.origin, run.start), widen_vector(&batch.rays.direction, run.start));
        return match batch.departures {
            None => [origin, direction],
            Some(departures) => [origin + widen_vector(&departures.origin_low, run.start), direction],
        };
    }
    let [ox, oy, oz, dx, dy, dz] = gather::<D, 6>(chunk, |row| {
        let at = |column: &[f32]| column[row.ray as usize];
        let ([ox, oy, oz], [dx, dy, dz]) = (&batch.rays.origin, &batch.rays.direction);
        [at(ox), at(oy), at(oz), at(dx), at(dy), at(dz)]
    });
    let (origin, direction) = (Vector::new(ox, oy, oz), Vector::new(dx, dy, dz));
    let Some(departures) = batch.departures else { return [origin, direction] };
    let [x, y, z] =
        gather::<D, 3>(chunk, |row| departures.origin_low.each_ref().map(|column| column[row.ray as usize]));
    [origin + Vector::new(x, y, z), direction]
}

/// The root of the quadratic (see `kernel::sphere`) that the kernel chose, in f64; for a ray that starts on this sphere the
/// one that is not 0. By the nearer root the ray enters. At the outline, where both are one to f32, its angle to the normal is
/// nothing but rounding; and there the kernel's t may be nearer to the farther root, so that is only taken where the nearer one
/// is out of the question.
fn spheres<D: Double>(prepared: &Prepared<'_>, batch: &Batch<'_>, chunk: &[HitRow]) -> Found<D> {
    let [origin, direction] = gather_rays::<D>(batch, chunk);
    let [x, y, z, radius] = gather_primitives::<D, 4>(chunk, |index| {
        let sphere = &prepared.scene.geometry.spheres[index];
        let [x, y, z] = prepared.scale.position(sphere.center).to_array();
        [x, y, z, prepared.scale.length(sphere.radius)]
    });
    let [t, own] = gather::<D, 2>(chunk, |row| {
        let ray = row.ray as usize;
        let is_own = batch.departures.is_some_and(|departures| departures.departure[ray] >> 1 == row.id);
        [batch.hits.t[ray - batch.first], f32::from(u8::from(is_own))]
    });
    let zero = D::splat(0.0);
    let center = Vector::new(x, y, z);
    let from_center = origin - center;
    let a = direction.length_squared();
    let closest_t = -(from_center.dot(direction) / a);
    let closest = from_center + direction * closest_t;
    // The kernel may have met a sphere that the ray misses by rounding.
    let half_squared = (radius * radius - closest.length_squared()).max(zero);
    let half_t = (half_squared / a).sqrt();
    let (near, far) = (closest_t - half_t, closest_t + half_t);
    let is_own = own.gt(zero);
    let is_near = (near - t).abs().le((far - t).abs()) | (near + near).gt(t);
    let root = D::select(is_own, closest_t + closest_t, D::select(is_near, near, far));
    let normal = (from_center + direction * root).normalized(D::splat(1.0));
    Found {
        entering: is_near & !is_own,
        position: center + normal * radius,
        geometric_normal: normal,
        shading_normal: None,
    }
}

/// The barycentric weights of the hit, in f64. Source: Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", 1997. Weights that rounding has taken out of the triangle are brought back.
fn triangles<D: Double>(prepared: &Prepared<'_>, batch: &Batch<'_>, chunk: &[HitRow]) -> Found<D> {
    let geometry = &prepared.scene.geometry;
    let [origin, direction] = gather_rays::<D>(batch, chunk);
    let corner = |which: usize| {
        let [x, y, z] = gather_primitives::<D, 3>(chunk, |index| {
            let vertex = geometry.triangles[index].vertices[which];
            prepared.scale.position(geometry.vertices[vertex as usize]).to_array()
        });
        Vector::new(x, y, z)
    };
    let (zero, one) = (D::splat(0.0), D::splat(1.0));
    let first = corner(0);
    let [edge_1, edge_2] = [corner(1) - first, corner(2) - first];
    let from_first = origin - first;
    let across = direction.cross(edge_2);
    let determinant = edge_1.dot(across);
    let weight_1 = (from_first.dot(across) / determinant).max(zero).min(one);
    let weight_2 = direction.dot(from_first.cross(edge_1)) / determinant;
    let weight_2 = weight_2.max(zero).min(one - weight_1);
    let normal = edge_1.cross(edge_2).normalized(one);
    let shading_normal = prepared.plan.vertex_normals.then(|| {
        let weight_0 = one - weight_1 - weight_2;
        let at = |which: usize| {
            let [x, y, z] = gather_primitives::<D, 3>(chunk, |index| {
                geometry.triangles[index]
                    .normals
                    .map_or(Vec3::ZERO, |normals| geometry.normals[normals[which] as usize])
                    .to_array()
            });
            Vector::new(x, y, z)
        };
        on_side_of(normal, at(0) * weight_0 + at(1) * weight_1 + at(2) * weight_2)
    });
    Found {
        entering: direction.dot(normal).lt(zero),
        position: first + edge_1 * weight_1 + edge_2 * weight_2,
        geometric_normal: normal,
        shading_normal,
    }
}

/// Where the ray meets the plane, in f64, put onto the plane. Of a plane seen so nearly edge-on that f64 cannot tell where it
/// is met, between the polygon's edges.
fn polygons<D: Double>(prepared: &Prepared<'_>, batch: &Batch<'_>, chunk: &[HitRow]) -> Found<D> {
    let geometry = &prepared.scene.geometry;
    let [origin, direction] = gather_rays::<D>(batch, chunk);
    let [x, y, z] = gather_primitives::<D, 3>(chunk, |index| {
        let first = geometry.polygons[index].vertices.start as usize;
        prepared.scale.position(geometry.vertices[first]).to_array()
    });
    let [t] = gather::<D, 1>(chunk, |row| [batch.hits.t[row.ray as usize - batch.first]]);
    let point = Vector::new(x, y, z);
    let mut columns = [[0.0; 8]; 3];
    for lane in 0..D::WIDTH {
        let row = chunk[lane.min(chunk.len() - 1)];
        let normal = prepared.hierarchy.polygon_normals[row.index as usize].to_array();
        for (column, component) in columns.iter_mut().zip(normal) {
            column[lane] = component;
        }
    }
    let [nx, ny, nz] = columns.map(|column| D::load(&column));
    let normal = Vector::new(nx, ny, nz);
    let slope = normal.dot(direction);
    let is_edge_on = slope.abs().lt(D::splat(1.0 / f64::from(1 << 20)) * direction.length());
    let t = if is_edge_on.any() {
        let kept = kept_between_edges(prepared, chunk, [origin, direction], t);
        D::select(is_edge_on, kept, normal.dot(point - origin) / slope)
    } else {
        normal.dot(point - origin) / slope
    };
    let near = origin + direction * t;
    let flat = near - normal * (near - point).dot(normal);
    let position = match batch.departures {
        None => on_faces(prepared, chunk, flat),
        // For rays that leave a surface f64 has decided where f32 could not tell.
        Some(_) => flat,
    };
    let shading_normal = prepared.plan.vertex_normals.then(|| {
        let mean = patch_normals(prepared, chunk, position, normal);
        on_side_of(normal, mean)
    });
    Found { entering: slope.lt(D::splat(0.0)), position, geometric_normal: normal, shading_normal }
}

/// Row by row: see [`outline::kept_between_edges`].
#[cold]
fn kept_between_edges<D: Double>(
    prepared: &Prepared<'_>,
    chunk: &[HitRow],
    [origin, direction]: [Vector<D>; 2],
    t: D,
) -> D {
    let scale = f64::from(prepared.scale.factor());
    let [origins, directions] = [origin, direction].map(columns_of);
    let mut ts = [0.0; 8];
    t.store(&mut ts);
    for (lane, row) in chunk.iter().enumerate() {
        let [origin, direction] =
            [&origins, &directions].map(|columns| DVec3::from(columns.map(|column| column[lane])));
        // In world space, where the corners are.
        let ray = [origin / scale, direction / scale];
        ts[lane] = outline::kept_between_edges(corners_of(prepared, row), ray, ts[lane]);
    }
    D::load(&ts)
}

fn columns_of<D: Double>(vector: Vector<D>) -> [[f64; 8]; 3] {
    [vector.x, vector.y, vector.z].map(|lanes| {
        let mut column = [0.0; 8];
        lanes.store(&mut column);
        column
    })
}

/// Of a polygon, in world space.
fn corners_of<'a>(prepared: &'a Prepared<'_>, row: &HitRow) -> &'a [Vec3] {
    let geometry = &prepared.scene.geometry;
    let run = geometry.polygons[row.index as usize].vertices.clone();
    &geometry.vertices[run.start as usize..run.end as usize]
}

/// Brings points that rounding has put beside their polygon back to its nearest edge. The kernel decides from rounded numbers
/// that a ray from the eye meets the polygon, whose plane it may meet beyond the edge. A ray that goes inside a solid from there
/// would enter it a second time, by the face behind the edge, and one that goes on inside a room would have left it.
fn on_faces<D: Double>(prepared: &Prepared<'_>, chunk: &[HitRow], position: Vector<D>) -> Vector<D> {
    // In world space, where the corners are: the scale is a power of two.
    let scale = D::splat(f64::from(prepared.scale.factor()));
    let points = position * (D::splat(1.0) / scale);
    let mut is_beside = 0_u32;
    // Rows in turn, and with the first of a polygon all others of it: neighbours often meet the same.
    let mut waiting = (1_u32 << chunk.len()) - 1;
    while waiting != 0 {
        let row = &chunk[waiting.trailing_zeros() as usize];
        let is_same = chunk
            .iter()
            .enumerate()
            .fold(0, |bits, (lane, other)| bits | u32::from(other.index == row.index) << lane);
        let normal = prepared.hierarchy.polygon_normals[row.index as usize];
        is_beside |= is_same & !outline::holds(corners_of(prepared, row), points, normal).bits();
        waiting &= !is_same;
    }
    if is_beside == 0 { position } else { moved_to_outlines(prepared, chunk, points, is_beside) * scale }
}

#[cold]
fn moved_to_outlines<D: Double>(
    prepared: &Prepared<'_>,
    chunk: &[HitRow],
    points: Vector<D>,
    is_beside: u32,
) -> Vector<D> {
    let mut columns = columns_of(points);
    for (lane, row) in chunk.iter().enumerate().filter(|(lane, _)| is_beside >> lane & 1 == 1) {
        let point = DVec3::from(columns.map(|column| column[lane]));
        let nearest = outline::nearest(corners_of(prepared, row), point).to_array();
        for (column, component) in columns.iter_mut().zip(nearest) {
            column[lane] = component;
        }
    }
    let [x, y, z] = columns.map(|column| D::load(&column));
    Vector::new(x, y, z)
}

/// Unit and on the side of n_g; n_g itself where the mean of the vertices' normals has no direction.
fn on_side_of<D: Double>(geometric: Vector<D>, mean: Vector<D>) -> Vector<D> {
    let zero = D::splat(0.0);
    let length = mean.length();
    let has_direction = length.gt(zero);
    let unit = mean * (D::splat(1.0) / D::select(has_direction, length, D::splat(1.0)));
    let turned = Vector::select(unit.dot(geometric).lt(zero), -unit, unit);
    Vector::select(has_direction, turned, geometric)
}

/// The barycentric mean of a patch's normals, row by row; zero where a polygon has none.
fn patch_normals<D: Double>(
    prepared: &Prepared<'_>,
    chunk: &[HitRow],
    position: Vector<D>,
    normal: Vector<D>,
) -> Vector<D> {
    let mut rows = [[[0.0; 8]; 3]; 2];
    for (columns, vector) in rows.iter_mut().zip([position, normal]) {
        for (column, component) in columns.iter_mut().zip([vector.x, vector.y, vector.z]) {
            component.store(column);
        }
    }
    let mut means = [[0.0; 8]; 3];
    for (lane, row) in chunk.iter().enumerate() {
        let [position, plane] = rows.map(|columns| DVec3::from(columns.map(|column| column[lane])));
        let polygon = &prepared.scene.geometry.polygons[row.index as usize];
        let mean = patch_normal(prepared, polygon, position, plane);
        for (column, component) in means.iter_mut().zip(mean.to_array()) {
            column[lane] = component;
        }
    }
    let [x, y, z] = means.map(|column| D::load(&column));
    Vector::new(x, y, z)
}

/// The mean over the triangle of the fan (0, k, k + 1) that holds the point; where none does, over the one that it is least
/// outside of.
fn patch_normal(prepared: &Prepared<'_>, polygon: &Polygon, position: DVec3, plane: DVec3) -> DVec3 {
    let geometry: &Geometry = &prepared.scene.geometry;
    let Some(run) = polygon.normals.clone() else { return DVec3::ZERO };
    let normals = &geometry.normals[run.start as usize..run.end as usize];
    let corners = &geometry.vertices[polygon.vertices.start as usize..polygon.vertices.end as usize];
    let corner = |index: usize| prepared.scale.position(corners[index]).as_dvec3();
    let first = corner(0);
    let mut best = (f64::NEG_INFINITY, DVec3::ZERO);
    for k in 1..corners.len() - 1 {
        let (edge_1, edge_2, inside) = (corner(k) - first, corner(k + 1) - first, position - first);
        let area = plane.dot(edge_1.cross(edge_2));
        if area == 0.0 {
            continue;
        }
        let weight_1 = plane.dot(inside.cross(edge_2)) / area;
        let weight_2 = plane.dot(edge_1.cross(inside)) / area;
        let weight_0 = 1.0 - weight_1 - weight_2;
        let depth = Lanes::min(Lanes::min(weight_0, weight_1), weight_2);
        // Of equally deep ones the last, as in the reference.
        if depth >= best.0 {
            let [a, b, c] = [normals[0], normals[k], normals[k + 1]].map(Vec3::as_dvec3);
            best = (depth, weight_0 * a + weight_1 * b + weight_2 * c);
        }
    }
    best.1
}

/// Reads the surfaces' columns in lanes.
pub(super) struct SurfaceLanes<D> {
    pub(super) direction: Vector<D>,
    pub(super) position: Vector<D>,
    pub(super) geometric_normal: Vector<D>,
    pub(super) shading_normal: Vector<D>,
}

impl<D: Double> SurfaceLanes<D> {
    #[inline(always)]
    pub(super) fn read(surfaces: &SurfaceQueue, normals: &NormalQueue, row: usize) -> Self {
        let geometric_normal = widen_vector(&surfaces.geometric_normal, row);
        let shading_normal =
            if normals.len() == 0 { geometric_normal } else { widen_vector(&normals.shading_normal, row) };
        Self {
            direction: widen_vector(&surfaces.direction, row),
            position: widen_vector(&surfaces.position, row) + widen_vector(&surfaces.position_low, row),
            geometric_normal,
            shading_normal,
        }
    }

    /// A direction that leaves the surface on the side of a normal, n_g or −n_g, such that rounding it to f32 does not turn it
    /// to the other side. It may take u of its length from the height that it rises by, as rounding has done to the normal;
    /// what rises by less than 4u of its length is lifted to that.
    #[inline(always)]
    pub(super) fn kept_on_side(direction: Vector<D>, length: D, normal: Vector<D>) -> Vector<D> {
        let least_rise = length * D::splat(4.0 * f64::from(UNIT_ROUNDOFF));
        direction + normal * (least_rise - direction.dot(normal)).max(D::splat(0.0))
    }
}
