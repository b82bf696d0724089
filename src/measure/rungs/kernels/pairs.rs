//! Which pairs of ray and primitive a frame's rays test.

use super::columns::Columns;
use crate::lanes::{Vector, Width};
use crate::prepare::{BLOCK, Hierarchy, Place, Prepared};
use crate::rays::RaySet;
use crate::trace::{Query, RayColumns, Run};
use crate::traverse::{NOTHING, NOWHERE, SingleRay, leaves};
use rayon::prelude::*;
use std::ops::Range;

/// Origin, direction, a = d·d, 1/a, centre, radius; the scale of the prepared scene.
pub(super) type SpherePair = [f32; 12];
/// Origin, direction, shear, t per z, and three vertices, all in the ray's order of axes; the scale of the prepared scene.
pub(super) type TrianglePair = [f32; 18];

/// Pairs of one kind of primitive.
pub(super) struct Sample<const N: usize> {
    pub(super) columns: Columns<N>,
    /// Pairs that these were taken from.
    pub(super) tested: u64,
}

/// Pairs that rays test, each ray up to its nearest hit.
pub(super) struct Pairs {
    pub(super) spheres: Sample<12>,
    pub(super) triangles: Sample<18>,
}

/// Rays that a thread walks before it looks for more.
const CHUNK: usize = 4096;

impl Pairs {
    /// Walks rays through the hierarchy. If there are more than `most` pairs of a kind, every n-th is taken, with the least n
    /// that brings them down to as many.
    ///
    /// Left out are primitives that rays start on: whether these are hit is not a question for a formula.
    pub(super) fn collect(
        prepared: &Prepared<'_>,
        rays: &RaySet,
        width: Width,
        pool: &rayon::ThreadPool,
        most: u64,
    ) -> Self {
        let columns = RayColumns::new(prepared, rays);
        let mut run = Run::new(prepared, &columns, Query::Closest);
        run.pass(width, pool);
        let walk = Walk { hierarchy: &prepared.hierarchy, columns: &columns, ends: run.ends() };
        pool.install(|| walk.pairs(rays.len(), most))
    }
}

/// A ray and what it is tested against.
enum Pair {
    Sphere(SpherePair),
    Triangle(TrianglePair),
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
        // Pairs of each kind before each chunk.
        let mut before = Vec::with_capacity(chunks.len());
        let counts: Vec<[u64; 2]> = chunks.par_iter().map(|rows| self.count(rows.clone())).collect();
        let mut tested = [0, 0];
        for count in counts {
            before.push(tested);
            tested = [tested[0] + count[0], tested[1] + count[1]];
        }
        let stride = tested.map(|tested| tested.div_ceil(most.max(1)).max(1));
        let taken: Vec<(Vec<SpherePair>, Vec<TrianglePair>)> = chunks
            .par_iter()
            .zip(&before)
            .map(|(rows, &before)| self.take(rows.clone(), before, stride))
            .collect();
        let (mut spheres, mut triangles) = (Columns::new(), Columns::new());
        for (of_spheres, of_triangles) in taken {
            of_spheres.into_iter().for_each(|row| spheres.push(row));
            of_triangles.into_iter().for_each(|row| triangles.push(row));
        }
        let [tested_spheres, tested_triangles] = tested;
        Pairs {
            spheres: Sample { columns: spheres, tested: tested_spheres },
            triangles: Sample { columns: triangles, tested: tested_triangles },
        }
    }

    fn count(&self, rows: Range<usize>) -> [u64; 2] {
        let mut counts = [0, 0];
        self.visit(rows, |pair| match pair {
            Pair::Sphere(_) => counts[0] += 1,
            Pair::Triangle(_) => counts[1] += 1,
        });
        counts
    }

    /// The pairs whose number is a multiple of the stride of their kind.
    fn take(
        &self,
        rows: Range<usize>,
        mut number: [u64; 2],
        stride: [u64; 2],
    ) -> (Vec<SpherePair>, Vec<TrianglePair>) {
        let (mut spheres, mut triangles) = (Vec::new(), Vec::new());
        let mut is_taken = |kind: usize| {
            number[kind] += 1;
            (number[kind] - 1).is_multiple_of(stride[kind])
        };
        self.visit(rows, |pair| match pair {
            Pair::Sphere(row) if is_taken(0) => spheres.push(row),
            Pair::Triangle(row) if is_taken(1) => triangles.push(row),
            Pair::Sphere(_) | Pair::Triangle(_) => {}
        });
        (spheres, triangles)
    }

    fn visit(&self, rows: Range<usize>, mut visit: impl FnMut(Pair)) {
        let all = self.columns.rays(&(0..self.columns.filled()));
        for row in rows.filter(|&row| self.ends[row] >= 0.0) {
            let ray = SingleRay::new(self.hierarchy, &all, row);
            let own = all.departure.get(row).map_or(NOTHING, |&departure| match departure {
                NOWHERE => NOTHING,
                departure => departure >> 1,
            });
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
                Place::Node(_) | Place::Polygons(..) => {}
            });
        }
    }
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

fn array(Vector { x, y, z }: Vector<f32>) -> [f32; 3] {
    [x, y, z]
}

#[cfg(test)]
mod tests {
    use super::super::{Formula, answers, sphere};
    use super::*;
    use crate::rays::{Departure, Start};
    use crate::scene::{Geometry, Material, MaterialId, PrimitiveId, Scene};
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

    fn collected(geometry: Geometry, rays: &RaySet, most: u64) -> Sample<12> {
        let scene = scene_of(geometry);
        let prepared = Prepared::new(&scene).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        Pairs::collect(&prepared, rays, Width::BEST, &pool, most).spheres
    }

    #[test]
    fn every_hit_is_among_its_ray_s_pairs_and_is_the_nearest_of_them() {
        let (scene, rays) = (scene_of(spheres()), rays());
        let prepared = Prepared::new(&scene).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let columns = RayColumns::new(&prepared, &rays);
        let mut run = Run::new(&prepared, &columns, Query::Closest);
        run.pass(Width::BEST, &pool);
        let pairs = collected(spheres(), &rays, u64::MAX).columns;
        let ts = answers(sphere::Formula::ENGINES, Width::BEST, &pairs);
        let mut hits = 0;
        for (ray, &end) in rays.rows.iter().zip(run.ends()).filter(|(_, end)| end.is_finite()) {
            let scale = prepared.scale.factor();
            let of_ray = |row: &usize| {
                let [ox, oy, ..] = pairs.row(*row);
                (ox, oy) == (ray[0] * scale, ray[1] * scale)
            };
            let nearest = (0..pairs.len()).filter(of_ray).map(|row| ts[row]).fold(f32::INFINITY, f32::min);
            assert_eq!(nearest, end, "{ray:?}");
            hits += 1;
        }
        assert!(hits > 300, "{hits}");
    }

    #[test]
    fn every_nth_pair_is_taken_of_too_many() {
        let all = collected(spheres(), &rays(), u64::MAX);
        let most = all.tested / 3;
        let some = collected(spheres(), &rays(), most);
        assert_eq!((some.tested, all.columns.len() as u64), (all.tested, all.tested));
        assert!(some.columns.len() as u64 <= most && some.columns.len() as u64 >= most / 2);
        let stride = all.columns.len().div_ceil(some.columns.len());
        for row in 0..some.columns.len() {
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
        // The scene's scale is ¼. The one ends at the far side of the first sphere, the other at the second.
        let centers = |starts| {
            let sample = pairs(starts);
            (0..sample.columns.len()).map(|row| sample.columns.row(row)[10]).collect::<Vec<_>>()
        };
        assert_eq!(centers(vec![]), [0.0]);
        assert_eq!(centers(start(0)), [-0.75]);
    }
}
