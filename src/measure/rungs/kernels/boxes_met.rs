//! Which boxes rays test, and which boxes hold what rays hit in truth.

use super::boxes::box_pair;
use super::columns::Columns;
use super::pairs::{array, left};
use crate::kernel::bounds::{PADDING, Slabs};
use crate::prepare::bvh::{Bounds, Node, WIDTH};
use crate::prepare::{BLOCK, Hierarchy, Place, Prepared};
use crate::rays::RaySet;
use crate::reference::PairTruth;
use crate::trace::RayColumns;
use crate::traverse::{NOTHING, SingleRay};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Planes that the ray meets first and last, 1/d, the padded origins of these planes, the origin, and o/d.
pub(super) type BoxPair = [f32; 21];

/// Pairs of ray and box.
pub(super) struct BoxesMet {
    /// Boxes of nodes that rays test, up to their nearest hits.
    pub(super) tested: Columns<21>,
    /// For each true hit, the box of the leaf that it is in.
    pub(super) of_true_hits: Columns<21>,
}

/// Rays that are walked, at most.
const MOST_RAYS: usize = 1 << 16;
/// Pairs of either kind, at most: what is beyond belongs to the last rays.
const MOST_PAIRS: usize = 1 << 20;
/// Rays that a thread walks before it looks for more.
const CHUNK: usize = 256;

/// By how much more than the engine this walk grows boxes. It is in f64, so that what it passes by is no true hit.
const GROWN: f64 = 4.0 * PADDING as f64;

impl BoxesMet {
    /// Walks some of the rays, in whole runs of 64; `ends` says where each ends.
    pub(super) fn collect(
        prepared: &Prepared<'_>,
        (columns, ends): (&RayColumns, &[f32]),
        pool: &rayon::ThreadPool,
    ) -> Self {
        const RUN: usize = 64;
        let runs = columns.filled().min(ends.len()) / RUN;
        let kept = runs.min(MOST_RAYS / RUN);
        let rows: Vec<usize> =
            (0..kept).flat_map(|index| (0..RUN).map(move |row| index * runs / kept * RUN + row)).collect();
        let walk = |rows: &[usize]| {
            let all = columns.rays();
            let mut found = Found::default();
            for &row in rows.iter().filter(|&&row| ends[row] >= 0.0) {
                let ray = Ray::new(&prepared.hierarchy, &SingleRay::new(&prepared.hierarchy, &all, row));
                ray.test_boxes(&prepared.hierarchy, f64::from(ends[row]), &mut found.tested);
                ray.true_hits(&prepared.hierarchy, left(&all, row), &mut found.of_true_hits);
            }
            found
        };
        let found: Vec<Found> = pool.install(|| rows.par_chunks(CHUNK).map(walk).collect());
        let columns = |rows: fn(&Found) -> &Vec<BoxPair>| {
            let mut columns = Columns::default();
            found.iter().flat_map(rows).take(MOST_PAIRS).for_each(|row| columns.push(*row));
            columns
        };
        Self { tested: columns(|found| &found.tested), of_true_hits: columns(|found| &found.of_true_hits) }
    }

    /// Boxes of true hits of rays from the eye to corners that lie on an edge of their leaf's box, where rounding would have
    /// the ray enter the box after it has left it.
    pub(super) fn at_corners(prepared: &Prepared<'_>, pool: &rayon::ThreadPool) -> Self {
        let targets = corners_on_boxes(&prepared.hierarchy);
        let stride = targets.len().div_ceil(MOST_RAYS).max(1);
        let eye = prepared.scene.camera.eye;
        let row = |target: &Vec3| {
            let at = *target / prepared.scale.factor();
            let [ox, oy, oz] = eye.to_array();
            let [dx, dy, dz] = (at.as_dvec3() - eye.as_dvec3()).as_vec3().to_array();
            [ox, oy, oz, 0.0, dx, dy, dz, f32::INFINITY]
        };
        let set = RaySet { rows: targets.iter().step_by(stride).map(row).collect(), ..RaySet::default() };
        let columns = RayColumns::new(prepared, &set);
        let usable = |row: usize| if set.stretch(row).is_some() { f32::MAX } else { -1.0 };
        let mut ends: Vec<f32> = (0..set.len()).map(usable).collect();
        ends.resize(columns.filled(), -1.0);
        Self::collect(prepared, (&columns, &ends), pool)
    }
}

#[derive(Default)]
struct Found {
    tested: Vec<BoxPair>,
    of_true_hits: Vec<BoxPair>,
}

/// A ray as it walks the tree in f64.
struct Ray {
    slabs: Slabs<f32>,
    line: [[f32; 3]; 2],
    /// By how much boxes are grown.
    grown: f64,
}

impl Ray {
    fn new(hierarchy: &Hierarchy, ray: &SingleRay) -> Self {
        let line = ray.line::<f32, false>();
        let line = [array(line.origin), array(line.direction)];
        let farthest = line[0]
            .into_iter()
            .fold(hierarchy.extent, |farthest, o| if o.abs() > farthest { o.abs() } else { farthest });
        Self { slabs: ray.slabs(), line, grown: GROWN * (f64::from(hierarchy.extent) + f64::from(farthest)) }
    }

    fn pair(&self, Bounds { low, high }: Bounds) -> BoxPair {
        let [origin, direction] = self.line;
        let backwards = direction.map(|component| component < 0.0);
        box_pair(&self.slabs, origin, backwards, [low.to_array(), high.to_array()])
    }

    /// Whether the ray passes through a grown box before `end`.
    fn meets(&self, Bounds { low, high }: Bounds, end: f64) -> bool {
        let [origin, direction] = self.line.map(|vector| DVec3::from(vector.map(f64::from)));
        let (mut enter, mut leave) = (0.0, end);
        for axis in 0..3 {
            let [low, high] = [f64::from(low[axis]) - self.grown, f64::from(high[axis]) + self.grown]
                .map(|plane| plane - origin[axis]);
            if direction[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let [one, other] = [low, high].map(|plane| plane / direction[axis]);
            let (near, far) = if one < other { (one, other) } else { (other, one) };
            (enter, leave) = (if near > enter { near } else { enter }, if far < leave { far } else { leave });
        }
        enter <= leave
    }

    /// Visits the boxes of all nodes that the ray meets before `end`, each with what is in it.
    fn walk(&self, hierarchy: &Hierarchy, end: f64, mut visit: impl FnMut(Bounds, Place)) {
        let mut waiting: Vec<&Node> = hierarchy.nodes.first().into_iter().collect();
        while let Some(node) = waiting.pop() {
            for slot in 0..WIDTH {
                let Some(place) = Hierarchy::place(node.children[slot]) else { continue };
                let bounds = node.bounds(slot);
                visit(bounds, place);
                if let (Place::Node(index), true) = (place, self.meets(bounds, end)) {
                    waiting.push(&hierarchy.nodes[index]);
                }
            }
        }
    }

    fn test_boxes(&self, hierarchy: &Hierarchy, end: f64, tested: &mut Vec<BoxPair>) {
        self.walk(hierarchy, end, |bounds, _| tested.push(self.pair(bounds)));
    }

    /// `own` is what the ray starts on: whether it meets that again is no question for a box.
    fn true_hits(&self, hierarchy: &Hierarchy, own: u32, hits: &mut Vec<BoxPair>) {
        self.walk(hierarchy, f64::INFINITY, |bounds, place| {
            if !self.meets(bounds, f64::INFINITY) {
                return;
            }
            for primitive in Primitive::all(hierarchy, place) {
                let truth = || primitive.truth(self.line);
                if primitive.id != own && truth().t.is_some() {
                    hits.push(self.pair(bounds));
                }
            }
        });
    }
}

/// A primitive of a leaf.
struct Primitive {
    id: u32,
    shape: Shape,
}

enum Shape {
    Sphere {
        center: [f32; 3],
        radius: f32,
    },
    /// Corners of a triangle.
    Triangle([[f32; 3]; 3]),
    /// Corners of a polygon.
    Polygon(Vec<[f32; 3]>),
}

impl Primitive {
    /// Of a leaf; of a node, none.
    fn all(hierarchy: &Hierarchy, place: Place) -> Vec<Self> {
        match place {
            Place::Node(_) => vec![],
            Place::Spheres(block) => {
                let block = &hierarchy.spheres[block];
                let sphere = |lane: usize| {
                    let center = block.centers.map(|column| column[lane]);
                    Self { id: block.ids[lane], shape: Shape::Sphere { center, radius: block.radii[lane] } }
                };
                in_use(&block.ids).map(sphere).collect()
            }
            Place::Triangles(block) => {
                let block = &hierarchy.triangles[block];
                let triangle = |lane: usize| {
                    let vertices = block.vertices.map(|vertex| vertex.map(|column| column[lane]));
                    Self { id: block.ids[lane], shape: Shape::Triangle(vertices) }
                };
                in_use(&block.ids).map(triangle).collect()
            }
            Place::Polygons(first, count) => {
                let polygon = |index: usize| {
                    let face = &hierarchy.polygons[index];
                    let run = face.first_corner as usize..(face.first_corner + face.edges) as usize;
                    let corner = |corner| hierarchy.corners.each_ref().map(|column| column[corner]);
                    Self { id: face.id, shape: Shape::Polygon(run.map(corner).collect()) }
                };
                (first..first + count).map(polygon).collect()
            }
        }
    }

    fn truth(&self, line: [[f32; 3]; 2]) -> PairTruth {
        match &self.shape {
            Shape::Sphere { center, radius } => PairTruth::of_sphere(line, *center, *radius),
            Shape::Triangle(vertices) => PairTruth::of_triangle(line, *vertices),
            Shape::Polygon(corners) => PairTruth::of_polygon(line, corners),
        }
    }

    fn corners(&self) -> &[[f32; 3]] {
        match &self.shape {
            Shape::Sphere { .. } => &[],
            Shape::Triangle(vertices) => vertices,
            Shape::Polygon(corners) => corners,
        }
    }
}

fn in_use(ids: &[u32; BLOCK]) -> impl Iterator<Item = usize> {
    let used = ids.iter().take_while(|&&id| id != NOTHING).count();
    Range { start: 0, end: used }
}

/// Corners of triangles and polygons that lie on two sides of their leaf's box or on three, in the scale of the prepared scene.
fn corners_on_boxes(hierarchy: &Hierarchy) -> Vec<Vec3> {
    let mut found = Vec::new();
    for node in &hierarchy.nodes {
        for slot in 0..WIDTH {
            let Some(place) = Hierarchy::place(node.children[slot]) else { continue };
            let Bounds { low, high } = node.bounds(slot);
            for primitive in Primitive::all(hierarchy, place) {
                let corners = primitive.corners().iter().map(|corner| Vec3::from(*corner));
                let sides = |corner: &Vec3| (corner.cmpeq(low) | corner.cmpeq(high)).bitmask().count_ones();
                found.extend(corners.filter(|corner| sides(corner) >= 2));
            }
        }
    }
    found
}
