//! What is in a leaf against rays in lanes: those of a packet that lie side by side, or those of a stream that a list names.

use super::candidate::{self, Candidate, Start, View};
use super::edges;
use super::exact::Spot;
use super::sight::Sight;
use super::{Counts, NOTHING};
use crate::kernel::polygon::Outline;
use crate::kernel::sphere::Line;
use crate::kernel::{RaySpace, Seen, unclear_area};
use crate::lanes::{Mask, Single, Vector};
use crate::prepare::{BLOCK, Hierarchy, Place};

/// A ray in each lane, and what it has found so far.
pub(super) trait RayLanes<F: Single> {
    /// Order of axes in ray space, the same for all.
    fn axes(&self) -> [usize; 3];
    fn space<const DEPARTING: bool>(&self) -> RaySpace<F>;
    /// How far a surface may seem to be from where it is.
    fn padding(&self) -> F;
    /// Not asked of rays that start on primitives.
    fn t_min(&self) -> F;
    /// Asked of rays that start on primitives alone.
    fn departure(&self) -> F::Ids;
    /// Takes hits in where they are nearer than what was found so far or, if ANY, before the end. See `exact` for those lanes
    /// in which f32 cannot tell. What stands in lanes that are not of `mask` is nothing.
    fn offer<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        candidate: &Candidate<F>,
        mask: F::Mask,
        at: (Spot, u32),
    );
}

/// The same for spheres and polygons too, which ask for more.
pub(super) trait RayLines<F: Single>: RayLanes<F> {
    /// Whether the rays go nearly the same way from nearly the same place.
    const ARE_ALIKE: bool;

    fn line<const DEPARTING: bool>(&self) -> Line<F>;
}

/// Where rays start.
struct Starts<F: Single> {
    /// For those that start on primitives, on which, and which go inside.
    departures: Option<(F::Ids, F::Mask)>,
    t_min: F,
}

impl<F: Single> Starts<F> {
    #[inline(always)]
    fn of<const DEPARTING: bool>(rays: &impl RayLanes<F>) -> Self {
        if !DEPARTING {
            return Self { departures: None, t_min: rays.t_min() };
        }
        let departure = rays.departure();
        let departures = Some((F::ids_half(departure), F::ids_odd(departure)));
        Self { departures, t_min: F::splat(0.0) }
    }

    /// As a primitive sees it.
    #[inline(always)]
    fn on(&self, id: u32) -> Start<F> {
        let none = F::Mask::NONE;
        let (own, inward) =
            self.departures.map_or((none, none), |(ids, inward)| (F::ids_eq(ids, F::splat_ids(id)), inward));
        Start { own, inward, t_min: self.t_min }
    }
}

/// Tests what is in a leaf against the lanes of a mask, `used` of them. Of triangles those whose bits are set in `in_sight`.
#[inline(always)]
pub(super) fn visit<F: Single, R: RayLines<F>, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    (leaf, in_sight): (Place, u32),
    rays: &mut R,
    (mask, used): (F::Mask, usize),
    counts: &mut Counts,
) {
    match leaf {
        Place::Node(_) => {}
        Place::Triangles(index) => {
            triangles::<F, R, DEPARTING, ANY>(hierarchy, (index, in_sight), rays, (mask, used), counts);
        }
        Place::Spheres(index) => {
            spheres::<F, R, DEPARTING, ANY>(hierarchy, index, rays, (mask, used), counts);
        }
        Place::Polygons(first, count) => {
            for index in first..first + count {
                polygon::<F, R, DEPARTING, ANY>(hierarchy, index, rays, (mask, used), counts);
            }
        }
    }
}

/// The primitives of a block that a query asks about, with their lanes; those that are there come first.
#[inline(always)]
fn asked<const ANY: bool>(hierarchy: &Hierarchy, ids: &[u32; BLOCK]) -> impl Iterator<Item = (usize, u32)> {
    let there = ids.iter().copied().enumerate().take_while(|&(_, id)| id != NOTHING);
    there.filter(move |&(_, id)| !ANY || hierarchy.casts_shadow(id))
}

/// Tests triangles of a block, those whose bits are set in `in_sight`.
#[inline(always)]
fn triangles<F: Single, R: RayLanes<F>, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    (index, in_sight): (usize, u32),
    rays: &mut R,
    (mask, used): (F::Mask, usize),
    counts: &mut Counts,
) {
    let block = &hierarchy.triangles[index];
    let (space, padding, starts) = (rays.space::<DEPARTING>(), rays.padding(), Starts::of::<DEPARTING>(rays));
    let [x, y, z] = rays.axes();
    let mut tested = 0;
    for (lane, id) in asked::<ANY>(hierarchy, &block.ids).filter(|(lane, _)| in_sight >> lane & 1 == 1) {
        let [a, b, c] = &block.vertices;
        let corner =
            |of: &[[f32; BLOCK]; 3]| [F::splat(of[x][lane]), F::splat(of[y][lane]), F::splat(of[z][lane])];
        let vertices = [corner(a), corner(b), corner(c)];
        let sizes = || [F::splat(block.size[lane]), F::splat(block.error_area[lane])];
        let start = starts.on(id);
        tested += 1;
        if let Some(candidate) =
            candidate::triangle::<F, DEPARTING>(&space, padding, vertices, sizes, (mask, start))
        {
            rays.offer::<DEPARTING, ANY>(hierarchy, &candidate, mask, (Spot::triangle(index, lane), id));
        }
    }
    counts.triangles.add_runs(tested, F::WIDTH, used);
}

#[inline(always)]
fn spheres<F: Single, R: RayLines<F>, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    index: usize,
    rays: &mut R,
    (mask, used): (F::Mask, usize),
    counts: &mut Counts,
) {
    let block = &hierarchy.spheres[index];
    let (line, padding, starts) = (rays.line::<DEPARTING>(), rays.padding(), Starts::of::<DEPARTING>(rays));
    let mut tested = 0;
    for (lane, id) in asked::<ANY>(hierarchy, &block.ids) {
        let center = Vector::splat(block.centers.map(|column| column[lane]));
        let start = starts.on(id);
        let radius = F::splat(block.radii[lane]);
        tested += 1;
        if let Some(candidate) =
            candidate::sphere::<F, DEPARTING>(&line, padding, center, radius, (mask, start))
        {
            rays.offer::<DEPARTING, ANY>(hierarchy, &candidate, mask, (Spot::sphere(index, lane), id));
        }
    }
    counts.spheres.add_runs(tested, F::WIDTH, used);
}

#[inline(always)]
fn polygon<F: Single, R: RayLines<F>, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    index: usize,
    rays: &mut R,
    (mask, used): (F::Mask, usize),
    counts: &mut Counts,
) {
    let face = &hierarchy.polygons[index];
    if ANY && !hierarchy.casts_shadow(face.id) {
        return;
    }
    let zero = F::splat(0.0);
    let space = rays.space::<DEPARTING>();
    let first = face.first_corner as usize;
    let [x, y, z] = rays.axes().map(|axis| &hierarchy.corners[axis][..]);
    let corner = |index: usize| space.see([F::splat(x[index]), F::splat(y[index]), F::splat(z[index])]);
    let mut outline = Outline::<F>::new();
    let mut from = corner(first);
    let doubt = if DEPARTING {
        unclear_area(&from, [F::splat(face.size), F::splat(face.longest_edge)])
    } else {
        zero
    };
    let mut add_edge = |from: &Seen<F>, to: &Seen<F>| {
        if DEPARTING {
            outline.add_edge_with_doubt(from, to, (doubt, mask), zero);
        } else {
            outline.add_edge(from, to, zero);
        }
        counts.polygons.add(F::WIDTH, used);
    };
    // A ray in line with an edge that lies apart is in doubt for no reason, and then f64 gives its t: to leave out that edge
    // leaves its hit as it is, but perhaps not t.
    let may_leave_out = ANY || !DEPARTING;
    if R::ARE_ALIKE && may_leave_out && F::WIDTH > 2 && face.edges >= edges::MANY {
        let sight = Sight::of(&space, mask);
        let size = DEPARTING.then_some(face.size);
        let columns = [&y[first..], &z[first..]];
        let depths = edges::each_near::<F>(&sight, columns, face.edges as usize, size, |edge| {
            add_edge(&corner(first + edge), &corner(first + edge + 1));
        });
        let depth = |z: f32| space.see([zero, zero, F::splat(z)]).z;
        [outline.least_z, outline.largest_z] = depths.map(depth);
    } else {
        for index in first + 1..=first + face.edges as usize {
            let to = corner(index);
            add_edge(&from, &to);
            from = to;
        }
    }
    if !DEPARTING {
        let (before, beyond) = outline.sides_of(rays.t_min(), space.t_per_z);
        outline.unclear = before & beyond;
    }
    if !((outline.odd | outline.unclear) & mask).any() {
        return;
    }
    let view = View { space, line: rays.line::<DEPARTING>(), padding: rays.padding() };
    let plane = [Vector::splat(face.point), Vector::splat(face.normal)];
    let start = Starts::of::<DEPARTING>(rays).on(face.id);
    let candidate = candidate::polygon::<F, DEPARTING>(&view, plane, &outline, F::splat(face.slack), start);
    rays.offer::<DEPARTING, ANY>(hierarchy, &candidate, mask, (Spot::polygon(index), face.id));
}
