//! Those shadow rays of a packet that meet a leaf of triangles, moved side by side to be tested in tiles.
//!
//! Of the rays of a group a few meet a leaf, and each triangle in it would be tested with all others in lanes of no use: shadow
//! rays of the bunny left 6 of 14 empty. To move what the test needs of a ray is a handful of operations a group, once for all
//! triangles of the leaf: shadow rays of the bunny and of a terrain of 130,000 were 1.07 times as fast, and in tiles instead of
//! sixteen to a triangle another 1.05 and 1.08, 2026-11.

use super::super::Counts;
use super::super::exact::Spot;
use super::super::tile::{self, Origin, TileRays};
use super::{Column, PACKET, Packet};
use crate::kernel::RaySpace;
use crate::lanes::{SPREAD, Single};
use crate::prepare::Hierarchy;

/// Lanes may be stored, and loaded, so far beyond the last ray.
const BEYOND: usize = 16;
const ROOM: usize = PACKET + BEYOND;

/// What the test of triangles needs of the rays, in their order of axes. Beyond the last ray there is anything.
#[repr(C, align(64))]
pub(super) struct Picked {
    /// Where they are in the packet.
    rows: [u32; ROOM],
    origin: [[f32; ROOM]; 3],
    /// Not read where no ray starts on a primitive, no more than `departure`.
    origin_low: [[f32; ROOM]; 3],
    departure: [u32; ROOM],
    shear: [[f32; ROOM]; 2],
    t_per_z: [f32; ROOM],
    padding: [f32; ROOM],
    /// Not read where rays start on primitives.
    t_min: [f32; ROOM],
}

/// Rows of a packet, a bit each.
pub(super) type Rows = u64;
const _: () = assert!(PACKET == Rows::BITS as usize);

/// Places of all rows.
const COUNTING: [u32; PACKET] = {
    let mut rows = [0; PACKET];
    let mut row = 1;
    while row < PACKET {
        rows[row] = rows[row - 1] + 1;
        row += 1;
    }
    rows
};

impl Picked {
    pub(super) const NONE: Self = Self {
        rows: [0; ROOM],
        origin: [[0.0; ROOM]; 3],
        origin_low: [[0.0; ROOM]; 3],
        departure: [0; ROOM],
        shear: [[0.0; ROOM]; 2],
        t_per_z: [0.0; ROOM],
        padding: [0.0; ROOM],
        t_min: [0.0; ROOM],
    };
}

/// Whether so many triangles are tested against some rows in fewer runs of the kernel in tiles than in groups.
#[inline(always)]
pub(super) fn pays<F: Single>(rows: Rows, triangles: usize) -> bool {
    let groups = (0..PACKET).step_by(F::WIDTH).filter(|&row| of_group::<F>(rows, row) != 0).count();
    tile::runs::<F>(rows.count_ones() as usize) < groups * triangles
}

/// The rows of a group that are among some.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a group has no more than 16 rows")]
pub(super) fn of_group<F: Single>(rows: Rows, first: usize) -> u32 {
    (rows >> first) as u32 & ((1 << F::WIDTH) - 1)
}

impl Packet {
    /// Tests the triangles of a leaf against the shadow rays of some rows.
    #[inline(always)]
    pub(super) fn visit_picked<F: Single, const DEPARTING: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        index: usize,
        rows: Rows,
        counts: &mut Counts,
    ) {
        self.pick::<F, DEPARTING>(rows);
        let count = rows.count_ones() as usize;
        tile::triangles::<F, DEPARTING, true>(hierarchy, index, (&mut PickedRays(self), count), counts);
    }

    /// Moves what the tests need of the rays of some rows side by side.
    #[inline(always)]
    fn pick<F: Single, const DEPARTING: bool>(&mut self, rows: Rows) {
        let picked = &mut self.picked;
        let mut count = 0;
        for row in (0..PACKET).step_by(F::WIDTH) {
            let bits = of_group::<F>(rows, row);
            if bits == 0 {
                continue;
            }
            let words = |from: &[u32; PACKET], to: &mut [u32; ROOM]| {
                F::pack_ids(F::load_ids(&from[row..]), bits, &mut to[count..]);
            };
            let numbers = |from: &Column, to: &mut [f32; ROOM]| {
                words(bytemuck::cast_ref(from), bytemuck::cast_mut(to));
            };
            words(&COUNTING, &mut picked.rows);
            for (axis, to) in self.axes.into_iter().zip(&mut picked.origin) {
                numbers(&self.origin[axis], to);
            }
            numbers(&self.shear[0], &mut picked.shear[0]);
            numbers(&self.shear[1], &mut picked.shear[1]);
            numbers(&self.t_per_z, &mut picked.t_per_z);
            numbers(&self.padding, &mut picked.padding);
            if DEPARTING {
                for (axis, to) in self.axes.into_iter().zip(&mut picked.origin_low) {
                    numbers(&self.origin_low[axis], to);
                }
                words(&self.departure, &mut picked.departure);
            } else {
                numbers(&self.t_min, &mut picked.t_min);
            }
            count += bits.count_ones() as usize;
        }
    }
}

/// Picked rays, and the packet that they are of.
struct PickedRays<'a>(&'a mut Packet);

impl PickedRays<'_> {
    fn row(&self, place: usize) -> usize {
        self.0.picked.rows[place] as usize % PACKET
    }
}

#[inline(always)]
fn spread<L: Single>(column: &[f32; ROOM], place: usize) -> L {
    const { assert!(SPREAD <= BEYOND) };
    column[place..].first_chunk().map_or(L::splat(0.0), L::spread)
}

#[inline(always)]
fn spread_three<L: Single>([x, y, z]: &[[f32; ROOM]; 3], place: usize) -> [L; 3] {
    [spread(x, place), spread(y, place), spread(z, place)]
}

impl TileRays for PickedRays<'_> {
    #[inline(always)]
    fn axes(&self) -> [usize; 3] {
        self.0.axes
    }

    #[inline(always)]
    fn space<L: Single, const DEPARTING: bool>(&self, place: usize) -> (RaySpace<L>, Origin<L>) {
        let picked = &self.0.picked;
        let space = RaySpace {
            origin: spread_three(&picked.origin, place),
            origin_low: DEPARTING.then(|| spread_three(&picked.origin_low, place)),
            shear: [spread(&picked.shear[0], place), spread(&picked.shear[1], place)],
            t_per_z: spread(&picked.t_per_z, place),
        };
        let origin = Origin {
            padding: spread(&picked.padding, place),
            t_min: spread(&picked.t_min, place),
            departure: spread(bytemuck::cast_ref(&picked.departure), place),
        };
        (space, origin)
    }

    #[inline(always)]
    fn offer<const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        place: usize,
        (t, error, spot): (f32, f32, Spot),
    ) {
        let row = self.row(place);
        self.0.offer_one::<ANY>(hierarchy, row, (t, error), (spot, 0));
    }

    #[inline(always)]
    fn offer_exact<const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        place: usize,
        spot: Spot,
    ) {
        let row = self.row(place);
        self.0.offer_exact::<DEPARTING, ANY>(hierarchy, row, spot);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Job, Width};

    struct Picks(Rows);

    impl Job for Picks {
        type Output = ();

        fn run<F: Single>(self) {
            let mut packet = Packet::new();
            packet.axes = [2, 0, 1];
            // A number for each column and row.
            let column = |number: f32| -> Column { COUNTING.map(|row| number * 100.0 + row as f32) };
            packet.origin = [0.0, 1.0, 2.0].map(column);
            packet.origin_low = [3.0, 4.0, 5.0].map(column);
            packet.shear = [6.0, 7.0].map(column);
            (packet.t_per_z, packet.padding, packet.t_min) = (column(8.0), column(9.0), column(10.0));
            packet.departure = COUNTING.map(|row| 1000 + row);
            packet.pick::<F, true>(self.0);
            packet.pick::<F, false>(self.0);
            let rows = COUNTING.into_iter().filter(|row| self.0 >> row & 1 == 1);
            let Picked { rows: places, origin, origin_low, departure, shear, t_per_z, padding, t_min } =
                &packet.picked;
            for (place, row) in rows.enumerate() {
                assert_eq!((places[place], departure[place]), (row, 1000 + row));
                let numbers =
                    [&origin[1], &origin[2], &origin[0], &origin_low[1], &origin_low[2], &origin_low[0]];
                let others = [&shear[0], &shear[1], t_per_z, padding, t_min];
                for (number, column) in numbers.into_iter().chain(others).enumerate() {
                    assert_eq!(column[place], number as f32 * 100.0 + row as f32, "column {number}");
                }
            }
        }
    }

    #[test]
    fn picked_rays_are_those_of_the_rows_in_their_order() {
        for rows in [0, 1, 1 << 63, !0, 0x0123_4567_89ab_cdef, 0xffff_0000_ffff_0000, 0x8000_0001_0000_8001] {
            for width in Width::ALL {
                width.run(Picks(rows));
            }
        }
    }

    #[test]
    fn rays_are_moved_where_that_makes_fewer_runs() {
        use wide::{f32x4, f32x16};
        assert!(!pays::<f32x16>(0, 4) && pays::<f32x16>(1, 4) && !pays::<f32x16>(1, 1));
        // Sixteen rays are four tiles, or a group for each triangle.
        assert!(!pays::<f32x16>(0xffff, 4) && !pays::<f32x16>(!0, 4) && pays::<f32x16>(0x0fff, 4));
        assert!(pays::<f32x16>(0x00ff_00ff_00ff_00ff, 3) && !pays::<f32x16>(0x00ff_00ff_00ff_00ff, 2));
        assert!(pays::<f32x4>(0x7, 4) && !pays::<f32x4>(0xf, 4) && !pays::<f32x4>(0x7, 3));
        assert!(!pays::<f32>(0x0123_4567_89ab_cdef, 4), "one lane is always in use");
    }
}
