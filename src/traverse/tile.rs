//! A few rays beside the primitives of a block: each lane is a pair of the two.
//!
//! Where few rays meet a leaf, rays in lanes leave most lanes empty, once for each primitive. Of sixteen lanes four rays fill all
//! with a block's four primitives at once. One ray alone is the least of tiles.

use super::candidate::{self, Candidate, Start};
use super::exact::Spot;
use super::{Counts, NOTHING};
use crate::kernel::RaySpace;
use crate::kernel::sphere::Line;
use crate::lanes::{Lanes, Mask, Single, Vector};
use crate::prepare::{BLOCK, Hierarchy, count_there};

/// Rays one after the other, each of which is spread over as many lanes as a block has, and what they have found so far.
pub(super) trait TileRays {
    /// Order of axes in ray space, the same for all.
    fn axes(&self) -> [usize; 3];
    /// Of the rays from a place on, with what else tests of triangles ask.
    fn space<L: Single, const DEPARTING: bool>(&self, place: usize) -> (RaySpace<L>, Origin<L>);
    /// Takes a hit of the ray in a place in if it is nearer, or if any will do.
    fn offer<const ANY: bool>(&mut self, hierarchy: &Hierarchy, place: usize, found: (f32, f32, Spot));
    /// The same of a primitive for which f32 cannot tell.
    fn offer_exact<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        place: usize,
        spot: Spot,
    );
}

/// The same for spheres too, which ask for more.
pub(super) trait TileLines: TileRays {
    /// Of the rays from a place on.
    fn line<L: Single, const DEPARTING: bool>(&self, place: usize) -> (Line<L>, Origin<L>);
}

/// Where and how rays start.
pub(super) struct Origin<L> {
    /// How far a surface may seem to be from where it is.
    pub(super) padding: L,
    /// Hits are wanted beyond this t; not read where rays start on primitives.
    pub(super) t_min: L,
    /// The bits of the departure; not read where none starts on one.
    pub(super) departure: L,
}

impl<L: Single> Origin<L> {
    /// As primitives of these ids see it.
    #[inline(always)]
    pub(super) fn on<const DEPARTING: bool>(&self, ids: L::Ids) -> Start<L> {
        if !DEPARTING {
            return Start { own: L::Mask::NONE, inward: L::Mask::NONE, t_min: self.t_min };
        }
        let departure = self.departure.bits_as_ids();
        let own = L::ids_eq(L::ids_half(departure), ids);
        Start { own, inward: L::ids_odd(departure), t_min: L::splat(0.0) }
    }
}

/// Tests the triangles of a block against so many rays.
#[inline(always)]
pub(super) fn triangles<L: Single, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    index: usize,
    (rays, count): (&mut impl TileRays, usize),
    counts: &mut Counts,
) {
    let block = &hierarchy.triangles[index];
    let [a, b, c] = &block.vertices;
    let [x, y, z] = rays.axes();
    for side in Side::each::<L>(&block.ids) {
        // Written out: a closure over arrays of lanes is not inlined and passes them through memory, which took a third of the
        // time, 2026-11.
        let vertices = [
            [side.repeated(&a[x]), side.repeated(&a[y]), side.repeated(&a[z])],
            [side.repeated(&b[x]), side.repeated(&b[y]), side.repeated(&b[z])],
            [side.repeated(&c[x]), side.repeated(&c[y]), side.repeated(&c[z])],
        ];
        for place in (0..count).step_by(rays_of::<L>()) {
            let (mask, used) = mask_of::<L>(count - place);
            let (space, origin) = rays.space::<L, DEPARTING>(place);
            let start = origin.on::<DEPARTING>(side.ids::<L>());
            let sizes = || [side.repeated(&block.size), side.repeated(&block.error_area)];
            counts.triangles.add(L::WIDTH, used * side.there);
            if let Some(candidate) =
                candidate::triangle::<L, DEPARTING>(&space, origin.padding, vertices, sizes, (mask, start))
            {
                let spot = |lane| Spot::triangle(index, lane);
                side.offer::<L, DEPARTING, ANY>(hierarchy, (rays, place), (&candidate, mask), spot);
            }
        }
    }
}

/// The same of spheres.
#[inline(always)]
pub(super) fn spheres<L: Single, const DEPARTING: bool, const ANY: bool>(
    hierarchy: &Hierarchy,
    index: usize,
    (rays, count): (&mut impl TileLines, usize),
    counts: &mut Counts,
) {
    let block = &hierarchy.spheres[index];
    let [x, y, z] = &block.centers;
    for side in Side::each::<L>(&block.ids) {
        let center = Vector::new(side.repeated(x), side.repeated(y), side.repeated(z));
        let radius = side.repeated(&block.radii);
        for place in (0..count).step_by(rays_of::<L>()) {
            let (mask, used) = mask_of::<L>(count - place);
            let (line, origin) = rays.line::<L, DEPARTING>(place);
            let start = origin.on::<DEPARTING>(side.ids::<L>());
            counts.spheres.add(L::WIDTH, used * side.there);
            if let Some(candidate) =
                candidate::sphere::<L, DEPARTING>(&line, origin.padding, center, radius, (mask, start))
            {
                let spot = |lane| Spot::sphere(index, lane);
                side.offer::<L, DEPARTING, ANY>(hierarchy, (rays, place), (&candidate, mask), spot);
            }
        }
    }
}

/// How often the kernel runs for so many rays.
#[inline(always)]
pub(super) fn runs<L: Single>(rays: usize) -> usize {
    rays.div_ceil(rays_of::<L>()) * (BLOCK / L::Block::WIDTH)
}

/// How many rays go into these lanes.
const fn rays_of<L: Single>() -> usize {
    L::WIDTH / L::Block::WIDTH
}

/// The lanes of some rays or, if they are more than go into lanes, all; and how many rays that is.
#[inline(always)]
fn mask_of<L: Single>(count: usize) -> (L::Mask, usize) {
    let used = count.min(rays_of::<L>());
    (L::first(used * L::Block::WIDTH), used)
}

/// The primitives of a block that lanes take at once: all, unless lanes are fewer.
struct Side<'a> {
    ids: &'a [u32; BLOCK],
    first: usize,
    there: usize,
}

impl<'a> Side<'a> {
    #[inline(always)]
    fn each<L: Single>(ids: &'a [u32; BLOCK]) -> impl Iterator<Item = Self> {
        let side =
            move |first: usize| Self { ids, first, there: count_there(&ids[first..][..L::Block::WIDTH]) };
        (0..BLOCK).step_by(L::Block::WIDTH).map(side)
    }

    #[inline(always)]
    fn repeated<L: Single>(&self, column: &[f32; BLOCK]) -> L {
        L::repeated(L::Block::load(&column[self.first..]))
    }

    #[inline(always)]
    fn ids<L: Single>(&self) -> L::Ids {
        self.repeated::<L>(bytemuck::cast_ref(self.ids)).bits_as_ids()
    }

    /// Offers what pairs of a mask hit to the rays from a place on.
    #[inline(always)]
    fn offer<L: Single, const DEPARTING: bool, const ANY: bool>(
        &self,
        hierarchy: &Hierarchy,
        (rays, place): (&mut impl TileRays, usize),
        (candidate, mask): (&Candidate<L>, L::Mask),
        spot: impl Fn(usize) -> Spot,
    ) {
        let Candidate { t, error, hit, unclear } = *candidate;
        let pair = |bit: usize| (place + bit / L::Block::WIDTH, self.first + bit % L::Block::WIDTH);
        let is_asked = |lane: usize| {
            let id = self.ids[lane];
            id != NOTHING && (!ANY || hierarchy.casts_shadow(id))
        };
        let mut unclear = (unclear & mask).bits();
        while unclear != 0 {
            let (place, lane) = pair(unclear.trailing_zeros() as usize);
            unclear &= unclear - 1;
            if is_asked(lane) {
                rays.offer_exact::<DEPARTING, ANY>(hierarchy, place, spot(lane));
            }
        }
        let mut bits = (hit & mask).bits();
        if bits == 0 {
            return;
        }
        let (mut ts, mut errors) = ([0.0; 16], [0.0; 16]);
        t.store(&mut ts);
        error.store(&mut errors);
        while bits != 0 {
            let bit = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let (place, lane) = pair(bit);
            if is_asked(lane) {
                rays.offer::<ANY>(hierarchy, place, (ts[bit], errors[bit], spot(lane)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Job, Width};
    use crate::prepare::{Place, Prepared};
    use crate::scene::{Geometry, Material, MaterialId, Scene};
    use glam::Vec3;

    /// Any number of rays along the z axis, all the same: those beyond the last that is asked for would meet as much.
    struct Alike {
        found: Vec<(usize, Spot)>,
    }

    impl TileRays for Alike {
        fn axes(&self) -> [usize; 3] {
            [0, 1, 2]
        }

        fn space<L: Single, const DEPARTING: bool>(&self, _: usize) -> (RaySpace<L>, Origin<L>) {
            let [zero, one] = [0.0, 1.0].map(L::splat);
            let space =
                RaySpace { origin: [zero, zero, -one], origin_low: None, shear: [zero, zero], t_per_z: one };
            (space, Origin { padding: zero, t_min: zero, departure: zero })
        }

        fn offer<const ANY: bool>(&mut self, _: &Hierarchy, place: usize, (_, _, spot): (f32, f32, Spot)) {
            self.found.push((place, spot));
        }

        fn offer_exact<const DEPARTING: bool, const ANY: bool>(
            &mut self,
            _: &Hierarchy,
            place: usize,
            spot: Spot,
        ) {
            self.found.push((place, spot));
        }
    }

    struct Pairs<'a>(&'a Hierarchy, usize);

    impl Job for Pairs<'_> {
        type Output = (Vec<(usize, Spot)>, Counts);

        fn run<F: Single>(self) -> Self::Output {
            let Self(hierarchy, count) = self;
            let (mut rays, mut counts) = (Alike { found: Vec::new() }, Counts::default());
            let Some(Place::Triangles(index)) =
                hierarchy.nodes[0].children.into_iter().find_map(Hierarchy::place)
            else {
                unreachable!("one leaf of triangles")
            };
            triangles::<F, false, false>(hierarchy, index, (&mut rays, count), &mut counts);
            (rays.found, counts)
        }
    }

    #[test]
    fn each_ray_meets_each_primitive_once_and_nobody_else_does() {
        let mut geometry = Geometry::default();
        for z in [1.0, 2.0, 3.0] {
            let corners = [Vec3::new(-1.0, -1.0, z), Vec3::new(1.0, -1.0, z), Vec3::new(0.0, 1.0, z)];
            let first = geometry.add_vertices(corners).unwrap();
            geometry.add_triangle([first, first + 1, first + 2], None, MaterialId(0)).unwrap();
        }
        let scene = Scene::unlit(geometry, vec![Material::grey()]);
        let prepared = Prepared::new(&scene).unwrap();
        for width in Width::ALL {
            for count in 1..=9 {
                let (mut found, counts) = width.run(Pairs(&prepared.hierarchy, count));
                found.sort_by_key(|&(place, spot)| (place, spot.0));
                let places: Vec<usize> = found.iter().map(|&(place, _)| place).collect();
                let expected: Vec<usize> = (0..count).flat_map(|place| [place; 3]).collect();
                assert_eq!(places, expected, "{count} rays, {width:?}");
                assert_eq!(counts.triangles.used, 3 * count as u64);
            }
        }
    }
}
