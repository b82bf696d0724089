//! Which pairs of ray and primitive a frame's rays test.

use super::columns::Columns;
use super::outlines::{Head, Outlines, Shape};
use crate::lanes::Vector;
use crate::prepare::{BLOCK, Hierarchy, Place, Prepared};
use crate::trace::RayColumns;
use crate::traverse::{NOTHING, NOWHERE, Rays, SingleRay, leaves};
use rayon::prelude::*;
use std::ops::Range;

/// Origin, direction, a = d·d, 1/a, centre, radius; the scale of the prepared scene.
pub(super) type SpherePair = [f32; 12];
/// Origin, direction, shear, t per z, and three vertices, all in the ray's order of axes; the scale of the prepared scene.
pub(super) type TrianglePair = [f32; 18];

/// A ray, and a polygon of the hierarchy.
pub(super) struct PolygonPair {
    head: Head,
    third: usize,
    /// Index into the hierarchy's polygons.
    polygon: usize,
}

/// Pairs of one kind of primitive.
pub(super) struct Sample<P> {
    pub(super) columns: P,
    /// Pairs that these were taken from.
    pub(super) tested: u64,
}

/// Pairs that rays test, each ray up to its nearest hit.
pub(super) struct Pairs {
    pub(super) spheres: Sample<Columns<12>>,
    pub(super) triangles: Sample<Columns<18>>,
    pub(super) polygons: Sample<Outlines>,
}

/// Rays that a thread walks before it looks for more.
const CHUNK: usize = 4096;

/// Edges for each polygon that may be taken, on average: they take the memory.
const EDGES: u64 = 4;

impl Pairs {
    /// Walks rays through the hierarchy; `ends` says where each ends. If there are more than `most` pairs of a kind, every n-th
    /// is taken, with the least n that brings them down to as many; of polygons, with the least that also brings their edges
    /// down to [`EDGES`] times as many.
    ///
    /// Left out are primitives that rays start on: whether these are hit is not a question for a formula.
    pub(super) fn collect(
        prepared: &Prepared<'_>,
        (columns, ends): (&RayColumns, &[f32]),
        pool: &rayon::ThreadPool,
        most: u64,
    ) -> Self {
        let walk = Walk { hierarchy: &prepared.hierarchy, columns, ends };
        pool.install(|| walk.pairs(columns.filled().min(ends.len()), most))
    }
}

/// A ray and what it is tested against.
enum Pair {
    Sphere(SpherePair),
    Triangle(TrianglePair),
    Polygon(PolygonPair),
}

/// Pairs of each kind, and the edges of the polygons among them.
#[derive(Clone, Copy, Default)]
struct Tally {
    spheres: u64,
    triangles: u64,
    polygons: u64,
    edges: u64,
}

impl Tally {
    fn plus(self, other: Self) -> Self {
        Self {
            spheres: self.spheres + other.spheres,
            triangles: self.triangles + other.triangles,
            polygons: self.polygons + other.polygons,
            edges: self.edges + other.edges,
        }
    }
}

#[derive(Default)]
struct Taken {
    spheres: Vec<SpherePair>,
    triangles: Vec<TrianglePair>,
    polygons: Vec<PolygonPair>,
}

struct Walk<'a> {
    hierarchy: &'a Hierarchy,
    columns: &'a RayColumns,
    /// Where rays end.
    ends: &'a [f32],
}

impl Walk<'_> {
    fn pairs(&self, rays: usize, most: u64) -> Pairs {
        let chunks: Vec<Range<usize>> =
            (0..rays).step_by(CHUNK).map(|first| first..(first + CHUNK).min(rays)).collect();
        // Pairs before each chunk.
        let mut before = Vec::with_capacity(chunks.len());
        let counts: Vec<Tally> = chunks.par_iter().map(|rows| self.count(rows.clone())).collect();
        let mut tested = Tally::default();
        for count in counts {
            before.push(tested);
            tested = tested.plus(count);
        }
        let most = most.max(1);
        let step = |count: u64, most: u64| count.div_ceil(most).max(1);
        let stride = Tally {
            spheres: step(tested.spheres, most),
            triangles: step(tested.triangles, most),
            polygons: step(tested.polygons, most).max(step(tested.edges, most.saturating_mul(EDGES))),
            edges: 1,
        };
        let taken: Vec<Taken> = chunks
            .par_iter()
            .zip(&before)
            .map(|(rows, &before)| self.take(rows.clone(), before, &stride))
            .collect();
        let (mut spheres, mut triangles, mut polygons) =
            (Columns::default(), Columns::default(), Outlines::default());
        for taken in taken {
            taken.spheres.into_iter().for_each(|row| spheres.push(row));
            taken.triangles.into_iter().for_each(|row| triangles.push(row));
            taken.polygons.iter().for_each(|pair| pair.push_to(self.hierarchy, &mut polygons));
        }
        Pairs {
            spheres: Sample { columns: spheres, tested: tested.spheres },
            triangles: Sample { columns: triangles, tested: tested.triangles },
            polygons: Sample { columns: polygons, tested: tested.polygons },
        }
    }

    fn count(&self, rows: Range<usize>) -> Tally {
        let mut counts = Tally::default();
        self.visit(rows, |pair| match pair {
            Pair::Sphere(_) => counts.spheres += 1,
            Pair::Triangle(_) => counts.triangles += 1,
            Pair::Polygon(pair) => {
                counts.polygons += 1;
                counts.edges += u64::from(self.hierarchy.polygons[pair.polygon].edges);
            }
        });
        counts
    }

    /// The pairs whose number is a multiple of the stride of their kind.
    fn take(&self, rows: Range<usize>, mut number: Tally, stride: &Tally) -> Taken {
        let mut taken = Taken::default();
        let is_taken = |number: &mut u64, stride: u64| {
            *number += 1;
            (*number - 1).is_multiple_of(stride)
        };
        self.visit(rows, |pair| match pair {
            Pair::Sphere(row) => {
                if is_taken(&mut number.spheres, stride.spheres) {
                    taken.spheres.push(row);
                }
            }
            Pair::Triangle(row) => {
                if is_taken(&mut number.triangles, stride.triangles) {
                    taken.triangles.push(row);
                }
            }
            Pair::Polygon(pair) => {
                if is_taken(&mut number.polygons, stride.polygons) {
                    taken.polygons.push(pair);
                }
            }
        });
        taken
    }

    fn visit(&self, rows: Range<usize>, mut visit: impl FnMut(Pair)) {
        let all = self.columns.rays();
        for row in rows.filter(|&row| self.ends[row] >= 0.0) {
            let ray = SingleRay::new(self.hierarchy, &all, row);
            let own = left(&all, row);
            let is_wanted = |id: u32| id != NOTHING && id != own;
            leaves(self.hierarchy, &ray, self.ends[row], |place| match place {
                Place::Spheres(block) => {
                    let block = &self.hierarchy.spheres[block];
                    for lane in (0..BLOCK).filter(|&lane| is_wanted(block.ids[lane])) {
                        let center = block.centers.map(|column| column[lane]);
                        visit(Pair::Sphere(sphere_pair(&ray, center, block.radii[lane])));
                    }
                }
                Place::Triangles(block) => {
                    let block = &self.hierarchy.triangles[block];
                    for lane in (0..BLOCK).filter(|&lane| is_wanted(block.ids[lane])) {
                        let vertices = block.vertices.map(|vertex| vertex.map(|column| column[lane]));
                        visit(Pair::Triangle(triangle_pair(&ray, vertices)));
                    }
                }
                Place::Polygons(first, count) => {
                    let wanted = |&polygon: &usize| is_wanted(self.hierarchy.polygons[polygon].id);
                    for polygon in (first..first + count).filter(wanted) {
                        visit(Pair::Polygon(PolygonPair::new(self.hierarchy, &ray, polygon)));
                    }
                }
                Place::Node(_) => {}
            });
        }
    }
}

/// The primitive that a ray starts on; [`NOTHING`] if it starts on none.
pub(super) fn left(rays: &Rays<'_>, row: usize) -> u32 {
    rays.departure.get(row).map_or(NOTHING, |&departure| match departure {
        NOWHERE => NOTHING,
        departure => departure >> 1,
    })
}

fn sphere_pair(ray: &SingleRay, center: [f32; 3], radius: f32) -> SpherePair {
    let line = ray.line::<f32, false>();
    let ([ox, oy, oz], [dx, dy, dz]) = (array(line.origin), array(line.direction));
    let [cx, cy, cz] = center;
    [ox, oy, oz, dx, dy, dz, line.a, line.inverse_a, cx, cy, cz, radius]
}

/// Vertices in the world's order of axes.
pub(super) fn triangle_pair(ray: &SingleRay, vertices: [[f32; 3]; 3]) -> TrianglePair {
    let (space, direction, axes) =
        (ray.space::<f32, false>(), array(ray.line::<f32, false>().direction), ray.axes());
    let turned = |point: [f32; 3]| axes.map(|axis| point[axis]);
    let ([ox, oy, oz], [dx, dy, dz], [shear_x, shear_y]) = (space.origin, turned(direction), space.shear);
    let [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = vertices.map(turned);
    [ox, oy, oz, dx, dy, dz, shear_x, shear_y, space.t_per_z, ax, ay, az, bx, by, bz, cx, cy, cz]
}

impl PolygonPair {
    pub(super) fn new(hierarchy: &Hierarchy, ray: &SingleRay, polygon: usize) -> Self {
        let (space, line, face) =
            (ray.space::<f32, false>(), ray.line::<f32, false>(), &hierarchy.polygons[polygon]);
        let ([ox, oy, oz], [dx, dy, dz]) = (array(line.origin), array(line.direction));
        let ([shear_x, shear_y], [px, py, pz], [nx, ny, nz]) = (space.shear, face.point, face.normal);
        let head = [ox, oy, oz, dx, dy, dz, shear_x, shear_y, space.t_per_z, px, py, pz, nx, ny, nz];
        Self { head, third: ray.axes()[2], polygon }
    }

    pub(super) fn push_to(&self, hierarchy: &Hierarchy, outlines: &mut Outlines) {
        let face = &hierarchy.polygons[self.polygon];
        let size = face.normal.map(f32::abs);
        // Of equal ones the first.
        let steepest =
            (1..3).fold(0, |steepest, axis| if size[axis] > size[steepest] { axis } else { steepest });
        let shape = Shape { corners: face.edges as usize, third: self.third, steepest };
        let first = face.first_corner as usize;
        let corner = |corner: usize| hierarchy.corners.each_ref().map(|column| column[first + corner]);
        outlines.push(&self.head, shape, corner);
    }
}

pub(super) fn array(Vector { x, y, z }: Vector<f32>) -> [f32; 3] {
    [x, y, z]
}

#[cfg(test)]
mod tests {
    use super::super::columns::Tiles;
    use super::super::{Formula, answers, polygon, sphere};
    use super::*;
    use crate::lanes::Width;
    use crate::rays::{Departure, RaySet, Start};
    use crate::scene::{Geometry, Material, MaterialId, PrimitiveId, Scene};
    use crate::trace::{Query, Run};
    use glam::Vec3;

    fn spheres() -> Geometry {
        let mut geometry = Geometry::default();
        for at in 0..300_u16 {
            let number = |factor: f32| (f32::from(at) * factor).sin() * 2.0;
            let center = Vec3::new(number(12.9), number(78.2), number(37.7));
            geometry.add_sphere(center, 0.2, MaterialId(0)).unwrap();
        }
        geometry
    }

    /// Concave decagons, pentagons and squares, one behind the other.
    fn stars() -> Geometry {
        let mut geometry = Geometry::default();
        for (at, count) in (0..60_u16).zip([10, 5, 4].into_iter().cycle()) {
            let number = |factor: f32| (f32::from(at) * factor).sin() * 2.0;
            let middle = Vec3::new(number(12.9), number(78.2), number(37.7));
            let corner = |corner: u16| {
                let (sin, cos) = (f32::from(corner) * std::f32::consts::TAU / f32::from(count)).sin_cos();
                let radius = if count == 10 && corner.is_multiple_of(2) { 0.3 } else { 0.8 };
                middle + radius * Vec3::new(cos, sin, 0.0)
            };
            let corners: Vec<Vec3> = (0..count).map(corner).collect();
            geometry.add_polygon(&corners, None, MaterialId(0)).unwrap();
        }
        geometry
    }

    fn scene_of(geometry: Geometry) -> Scene {
        Scene::unlit(geometry, vec![Material::grey()])
    }

    fn rays() -> RaySet {
        let rows = (0..900_u16).map(|at| {
            let [x, y] = [at % 30, at / 30].map(|step| f32::from(step) * 0.13 - 2.0);
            [x, y, 9.0, 0.0, 0.01 * y, -0.02 * x, -1.0, f32::INFINITY]
        });
        RaySet { rows: rows.collect(), ..RaySet::default() }
    }

    /// Pairs, and where rays end.
    fn walked(geometry: Geometry, rays: &RaySet, most: u64) -> (Pairs, Vec<f32>) {
        let scene = scene_of(geometry);
        let prepared = Prepared::new(&scene).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let columns = RayColumns::new(&prepared, rays);
        let mut run = Run::new(&prepared, &columns, Query::Closest);
        run.pass(Width::BEST, &pool);
        (Pairs::collect(&prepared, (&columns, run.ends()), &pool, most), run.ends().to_vec())
    }

    fn collected(geometry: Geometry, rays: &RaySet, most: u64) -> Sample<Columns<12>> {
        walked(geometry, rays, most).0.spheres
    }

    /// A scene's largest coordinate lies in [2, 4): its scale is ½.
    const SCALE: f32 = 0.5;

    /// `origins` are those of the pairs, in their order.
    #[track_caller]
    fn assert_nearest(rays: &RaySet, ends: &[f32], origins: &[[f32; 2]], ts: &[f32]) {
        let mut hits = 0;
        for (ray, &end) in rays.rows.iter().zip(ends).filter(|(_, end)| end.is_finite()) {
            let of_ray =
                origins.iter().zip(ts).filter(|([ox, oy], _)| (*ox, *oy) == (ray[0] * SCALE, ray[1] * SCALE));
            let nearest = of_ray.map(|(_, &t)| t).fold(f32::INFINITY, f32::min);
            assert_eq!(nearest, end, "{ray:?}");
            hits += 1;
        }
        assert!(hits > 300, "{hits}");
    }

    #[test]
    fn every_hit_is_among_its_ray_s_pairs_and_is_the_nearest_of_them() {
        let rays = rays();
        let (pairs, ends) = walked(spheres(), &rays, u64::MAX);
        let pairs = pairs.spheres.columns;
        let origin = |row| {
            let [ox, oy, ..] = pairs.row(row);
            [ox, oy]
        };
        let origins: Vec<[f32; 2]> = (0..pairs.pairs()).map(origin).collect();
        assert_nearest(&rays, &ends, &origins, &answers(sphere::Formula::ENGINES, Width::BEST, &pairs));
    }

    #[test]
    fn of_polygons_too() {
        let rays = rays();
        let (pairs, ends) = walked(stars(), &rays, u64::MAX);
        let pairs = pairs.polygons.columns;
        let origins: Vec<[f32; 2]> =
            (0..pairs.pairs()).map(|row| pairs.row(row).0).map(|[ox, oy, ..]| [ox, oy]).collect();
        assert_nearest(&rays, &ends, &origins, &answers(polygon::Formula::ENGINES, Width::BEST, &pairs));
    }

    #[test]
    fn polygons_of_many_edges_are_taken_more_seldom() {
        let all = walked(stars(), &rays(), u64::MAX).0.polygons;
        let most = all.tested;
        let some = walked(stars(), &rays(), most).0.polygons;
        assert!(all.columns.edges() > EDGES * most && some.columns.edges() < all.columns.edges());
        assert_eq!((some.tested, all.columns.pairs() as u64), (most, most));
    }

    #[test]
    fn every_nth_pair_is_taken_of_too_many() {
        let all = collected(spheres(), &rays(), u64::MAX);
        let most = all.tested / 3;
        let some = collected(spheres(), &rays(), most);
        assert_eq!((some.tested, all.columns.pairs() as u64), (all.tested, all.tested));
        assert!(some.columns.pairs() as u64 <= most && some.columns.pairs() as u64 >= most / 2);
        let stride = all.columns.pairs().div_ceil(some.columns.pairs());
        for row in 0..some.columns.pairs() {
            assert_eq!(some.columns.row(row), all.columns.row(row * stride));
        }
    }

    #[test]
    fn what_a_ray_starts_on_is_no_pair() {
        let mut geometry = Geometry::default();
        geometry.add_sphere(Vec3::ZERO, 1.0, MaterialId(0)).unwrap();
        geometry.add_sphere(Vec3::new(0.0, 0.0, -3.0), 1.0, MaterialId(0)).unwrap();
        let departure = |id| Departure { from: PrimitiveId(id), inward: false };
        let start = |id| vec![Start { origin_low: [0.0; 3], departure: departure(id) }];
        let rows = vec![[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0, f32::INFINITY]];
        let pairs =
            |starts| collected(geometry.clone(), &RaySet { rows: rows.clone(), starts, found: vec![] }, 10);
        // The scene's scale is ¼. Both spheres are in one leaf.
        let centers = |starts| {
            let sample = pairs(starts);
            (0..sample.columns.pairs()).map(|row| sample.columns.row(row)[10]).collect::<Vec<_>>()
        };
        assert_eq!(centers(vec![]), [0.0, -0.75]);
        assert_eq!(centers(start(0)), [-0.75]);
    }
}
