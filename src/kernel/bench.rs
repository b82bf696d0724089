//! The kernels on their own, for `benches/`: every ray of a packet against every primitive of a list, lanes across rays.
//!
//! Kernels and lanes are private, so a bench, which is another crate, can name neither. What it can name is this module, in
//! plain numbers and a [`Width`]. The loops stand here, so that kernels are inlined into them by the same crate and the same
//! flags as into the traversal. It is hidden from the documentation rather than behind a feature, which everyone would have to
//! ask for who runs `cargo bench`; the program never calls it, so it is not in the program.

use super::RaySpace;
use super::bounds::{self, PADDING, Slabs};
use super::polygon::{self, Outline};
use super::sphere::{self, Line};
use super::triangle;
use crate::lanes::{Job, Mask, Single, Vector, Width};
use std::hint::black_box;

/// As many rays as the traversal's packets have.
pub const RAYS: usize = 64;

/// A number for each ray.
pub type Column = [f32; RAYS];

/// Rays in columns, with what is derived from them: all that a packet keeps for the kernels.
#[repr(C, align(64))]
pub struct Rays {
    origin: [Column; 3],
    direction: [Column; 3],
    near_origin: [Column; 3],
    far_origin: [Column; 3],
    inverse: [Column; 3],
    shear: [Column; 2],
    t_per_z: Column,
    a: Column,
    inverse_a: Column,
}

/// Primitives of one kind.
#[derive(Clone, Debug)]
pub enum Shapes {
    /// Centre and radius.
    Spheres(Vec<([f32; 3], f32)>),
    /// Vertices.
    Triangles(Vec<[[f32; 3]; 3]>),
    /// Corners, and the normal of their plane.
    Polygons(Vec<(Vec<[f32; 3]>, [f32; 3])>),
    /// Low and high corner.
    Boxes(Vec<[[f32; 3]; 2]>),
}

impl Rays {
    /// Of rays, each an origin and a direction, that all have one order of axes and go one way: x and y of a direction are
    /// greater than 0, and z is the largest. `extent` is the largest coordinate of what they are to meet.
    #[must_use]
    pub fn new(rays: &[[[f32; 3]; 2]; RAYS], extent: f32) -> Self {
        let padding = |origin: [f32; 3]| (extent + origin.iter().fold(0.0, |a, b| b.abs().max(a))) * PADDING;
        let a = |direction: [f32; 3]| direction.iter().map(|component| component * component).sum::<f32>();
        Self {
            origin: [0, 1, 2].map(|axis| rays.map(|[o, _]| o[axis])),
            direction: [0, 1, 2].map(|axis| rays.map(|[_, d]| d[axis])),
            near_origin: [0, 1, 2].map(|axis| rays.map(|[o, _]| o[axis] + padding(o))),
            far_origin: [0, 1, 2].map(|axis| rays.map(|[o, _]| o[axis] - padding(o))),
            inverse: [0, 1, 2].map(|axis| rays.map(|[_, d]| 1.0 / d[axis])),
            shear: [0, 1].map(|axis| rays.map(|[_, d]| d[axis] * (1.0 / d[2]))),
            t_per_z: rays.map(|[_, d]| 1.0 / d[2]),
            a: rays.map(|[_, d]| a(d)),
            inverse_a: rays.map(|[_, d]| 1.0 / a(d)),
        }
    }

    #[inline(always)]
    fn line<F: Single>(&self, row: usize) -> Line<F> {
        Line {
            origin: vector(&self.origin, row),
            origin_low: None,
            direction: vector(&self.direction, row),
            a: F::load(&self.a[row..]),
            inverse_a: F::load(&self.inverse_a[row..]),
        }
    }

    #[inline(always)]
    fn space<F: Single>(&self, row: usize) -> RaySpace<F> {
        let [x, y, z] = &self.origin;
        RaySpace {
            origin: [F::load(&x[row..]), F::load(&y[row..]), F::load(&z[row..])],
            origin_low: None,
            shear: [F::load(&self.shear[0][row..]), F::load(&self.shear[1][row..])],
            t_per_z: F::load(&self.t_per_z[row..]),
        }
    }

    #[inline(always)]
    fn slabs<F: Single>(&self, row: usize) -> Slabs<F> {
        Slabs {
            near_origin: vector(&self.near_origin, row),
            far_origin: vector(&self.far_origin, row),
            inverse: vector(&self.inverse, row),
        }
    }
}

/// Tests every ray against every primitive. Lowers `nearest`, a t for each ray, where one is hit nearer, and returns how many
/// pairs hit; of boxes, where they are entered.
pub fn meet(width: Width, rays: &Rays, shapes: &Shapes, nearest: &mut Column) -> u64 {
    width.run(Meet { rays, shapes, nearest })
}

struct Meet<'a> {
    rays: &'a Rays,
    shapes: &'a Shapes,
    nearest: &'a mut Column,
}

impl Job for Meet<'_> {
    type Output = u64;

    fn run<F: Single>(self) -> u64 {
        let Self { rays, shapes, nearest } = self;
        match shapes {
            Shapes::Spheres(spheres) => meet_spheres::<F>(rays, spheres, nearest),
            Shapes::Triangles(triangles) => meet_triangles::<F>(rays, triangles, nearest),
            Shapes::Polygons(polygons) => meet_polygons::<F>(rays, polygons, nearest),
            Shapes::Boxes(boxes) => meet_boxes::<F>(rays, boxes, nearest),
        }
    }
}

fn meet_spheres<F: Single>(rays: &Rays, spheres: &[([f32; 3], f32)], nearest: &mut [f32]) -> u64 {
    let zero = F::splat(0.0);
    let mut pairs = 0;
    for &(center, radius) in spheres {
        let (center, radius) = (Vector::splat(center), F::splat(radius));
        for row in groups::<F>() {
            let meeting = sphere::meet(&rays.line::<F>(row), center, radius * radius, zero);
            if meeting.meets.any() {
                let (t, hit) = meeting.nearest(zero);
                pairs += keep(t, hit, &mut nearest[row..]);
            }
        }
    }
    pairs
}

fn meet_triangles<F: Single>(rays: &Rays, triangles: &[[[f32; 3]; 3]], nearest: &mut Column) -> u64 {
    let zero = F::splat(0.0);
    let mut pairs = 0;
    for &[a, b, c] in triangles {
        let vertices = [splat(a), splat(b), splat(c)];
        for row in groups::<F>() {
            let space = rays.space::<F>(row);
            let meeting = triangle::meet(&space, vertices);
            let inside = meeting.inside(zero);
            if inside.any() {
                let t = meeting.t(&space);
                pairs += keep(t, inside & t.gt(zero), &mut nearest[row..]);
            }
        }
    }
    pairs
}

fn meet_polygons<F: Single>(rays: &Rays, polygons: &[(Vec<[f32; 3]>, [f32; 3])], nearest: &mut [f32]) -> u64 {
    let zero = F::splat(0.0);
    let mut pairs = 0;
    for (corners, normal) in polygons {
        let (Some(&first), Some(&last)) = (corners.first(), corners.last()) else { continue };
        let plane = [Vector::splat(first), Vector::splat(*normal)];
        for row in groups::<F>() {
            let space = rays.space::<F>(row);
            let mut outline = Outline::<F>::new();
            let mut from = space.see(splat(last));
            for &corner in corners {
                let to = space.see(splat(corner));
                outline.add_edge(&from, &to, zero);
                from = to;
            }
            if outline.odd.any() {
                let line = rays.line::<F>(row);
                let corner_ts = [outline.least_z * space.t_per_z, outline.largest_z * space.t_per_z];
                let meeting = polygon::meet_plane(&line, plane, corner_ts, zero);
                let hit = outline.odd & meeting.meets & meeting.t.gt(zero);
                pairs += keep(meeting.t, hit, &mut nearest[row..]);
            }
        }
    }
    pairs
}

fn meet_boxes<F: Single>(rays: &Rays, boxes: &[[[f32; 3]; 2]], nearest: &mut Column) -> u64 {
    let (zero, infinity) = (F::splat(0.0), F::splat(f32::INFINITY));
    let mut pairs = 0;
    for &[low, high] in boxes {
        let (near, far) = (Vector::splat(low), Vector::splat(high));
        for row in groups::<F>() {
            let (enters, meets) = bounds::enter(&rays.slabs::<F>(row), near, far, zero, infinity);
            pairs += keep(enters, meets, &mut nearest[row..]);
        }
    }
    pairs
}

/// The first ray of each group of lanes. The compiler is not told that they follow each other, or it would work on several
/// groups of one lane at once, which it cannot in a packet: there a group is tested only if its rays meet a box.
fn groups<F: Single>() -> impl Iterator<Item = usize> {
    (0..RAYS).step_by(F::WIDTH).map(black_box)
}

/// Keeps what is nearer, and counts hits.
#[inline(always)]
fn keep<F: Single>(t: F, hit: F::Mask, nearest: &mut [f32]) -> u64 {
    let so_far = F::load(nearest);
    F::select(hit & t.lt(so_far), t, so_far).store(nearest);
    u64::from(hit.bits().count_ones())
}

#[inline(always)]
fn vector<F: Single>([x, y, z]: &[Column; 3], row: usize) -> Vector<F> {
    Vector::new(F::load(&x[row..]), F::load(&y[row..]), F::load(&z[row..]))
}

#[inline(always)]
fn splat<F: Single>([x, y, z]: [f32; 3]) -> [F; 3] {
    [F::splat(x), F::splat(y), F::splat(z)]
}
