//! Rays in no order, as a file may have them. They are sorted by where they start before threads share them: the more there are of
//! them, the more likely some go the same way from near each other, and a walker that has half of them is slower by 3 to 15 %.
//!
//! Each thread takes a share, rays that follow each other. It walks those that are alike in packets, if there are any, and sorts the
//! others by the cells of their origins. A part is what all shares have in some cells; a walker traces it. What it finds goes back to
//! the shares, and from each to its own rows.

use super::coherence::common_order;
use super::regroup::{Incoming, WINDOW};
use super::{Counts, Ends, NOTHING, RUN, Rays, Walkers};
use crate::lanes::{Lanes, Record, Single};
use crate::prepare::Hierarchy;
use rayon::prelude::*;
use std::ops::{Add, Range};

/// Memory for rays in no order, used again for others.
#[derive(Default)]
pub(crate) struct Shuffled {
    shares: Vec<Share>,
    parts: Vec<Part>,
}

/// Rays that follow each other.
#[derive(Default)]
struct Share {
    /// Those that walk in no packet.
    incoming: Incoming,
    /// Cells of origins, in order, and where their rays were before they were put into this order.
    order: Vec<(u16, u32)>,
}

/// Rays of some cells.
#[derive(Default)]
struct Part {
    /// Of each share, a range of its order.
    of_shares: Vec<Range<usize>>,
    /// Where rays end, share after share.
    t: Vec<f32>,
    id: Vec<u32>,
}

/// How origins are told apart.
#[derive(Clone, Copy)]
struct Grid {
    low: [f32; 3],
    cells_per_length: f32,
}

/// Lowest and highest coordinates.
type Bounds = [[f32; 3]; 2];

/// Bits of a cell along each axis.
const CELL_BITS: u32 = 5;
const CELLS: u32 = 1 << (3 * CELL_BITS);

impl Shuffled {
    /// Finds the closest hit of each ray or, if ANY, whether anything that casts a shadow is in its way. `t` is where hits end to
    /// be of interest; of the ends nothing is read.
    pub(crate) fn trace<F: Single, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        (rays, t): (&Rays<'_>, &[f32]),
        ends: &mut Ends<'_>,
        walkers: &Walkers,
    ) -> Counts {
        if hierarchy.nodes.is_empty() {
            ends.t.copy_from_slice(t);
            ends.id.fill(NOTHING);
            return Counts::default();
        }
        if rays.departure.is_empty() {
            self.walk::<F, false, ANY>(hierarchy, (rays, t), ends, walkers)
        } else {
            self.walk::<F, true, ANY>(hierarchy, (rays, t), ends, walkers)
        }
    }

    fn walk<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        (rays, t): (&Rays<'_>, &[f32]),
        ends: &mut Ends<'_>,
        walkers: &Walkers,
    ) -> Counts {
        let threads = rayon::current_num_threads();
        let rows = rays.count.div_ceil(threads).next_multiple_of(RUN);
        let in_packets = self.take_in::<F, DEPARTING, ANY>(hierarchy, (rays, t), (ends, rows), walkers);
        self.sort();
        // Of parts a third as large some threads were done sooner, and walks slower by more: 0.96 of the speed, 2026-11.
        let count = self.shares.iter().map(|share| share.order.len()).sum::<usize>();
        self.cut(count, threads * count.div_ceil(threads * WINDOW));
        let in_streams = self.trace_parts::<F, DEPARTING, ANY>(hierarchy, walkers);
        Self::of_shares::<ANY>(ends, rows)
            .enumerate()
            .for_each(|(number, mut ends)| self.give_back::<ANY>(number, &mut ends));
        in_packets + in_streams
    }

    /// Each share takes its rows, so many. Where some rays are alike, these walk at once.
    fn take_in<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        (rays, t): (&Rays<'_>, &[f32]),
        (ends, rows): (&mut Ends<'_>, usize),
        walkers: &Walkers,
    ) -> Counts {
        let some_are_alike = are_some_alike(rays);
        self.shares.resize_with(rays.count.div_ceil(rows), Share::default);
        let own = Self::of_shares::<ANY>(ends, rows).zip(t.par_chunks(rows)).zip(&mut self.shares);
        let counts = own.enumerate().map(|(number, ((mut ends, t), share))| {
            let rays = rays.rows(number * rows..number * rows + t.len());
            let mut counts = Counts::default();
            share.incoming.clear();
            if some_are_alike {
                ends.t.copy_from_slice(t);
                ends.id.fill(NOTHING);
                let aside = &mut share.incoming;
                walkers.lend(|walker| {
                    walker.packets::<F, DEPARTING, ANY>(hierarchy, &rays, &mut ends, aside, &mut counts);
                });
            } else {
                share.incoming.push_all::<F, DEPARTING>(&rays, t);
                ends.t[rays.count..].copy_from_slice(&t[rays.count..]);
            }
            counts
        });
        counts.reduce(Counts::default, Counts::add)
    }

    fn trace_parts<F: Single, const DEPARTING: bool, const ANY: bool>(
        &mut self,
        hierarchy: &Hierarchy,
        walkers: &Walkers,
    ) -> Counts {
        let shares = &self.shares;
        let counts = self.parts.par_iter_mut().with_max_len(1).map(|Part { of_shares, t, id }| {
            let count = of_shares.iter().map(Range::len).sum();
            t.resize(count, 0.0);
            id.resize(if ANY { 0 } else { count }, NOTHING);
            let mut counts = Counts::default();
            walkers.lend(|walker| {
                let take_in = |incoming: &mut Incoming| merge::<DEPARTING>(shares, of_shares, incoming);
                walker.streams::<F, DEPARTING, ANY>(hierarchy, take_in, &mut Ends { t, id }, &mut counts);
            });
            counts
        });
        counts.reduce(Counts::default, Counts::add)
    }

    /// Each share's own ends.
    fn of_shares<'a, const ANY: bool>(ends: &'a mut Ends<'_>, rows: usize) -> rayon::vec::IntoIter<Ends<'a>> {
        let ts = ends.t.chunks_mut(rows);
        let ends: Vec<Ends<'a>> = if ANY {
            ts.map(|t| Ends { t, id: &mut [] }).collect()
        } else {
            ts.zip(ends.id.chunks_mut(rows)).map(|(t, id)| Ends { t, id }).collect()
        };
        ends.into_par_iter()
    }

    /// Puts each share's rays into the order of cells.
    fn sort(&mut self) {
        let bounds = self.shares.par_iter().map(|share| bounds_of(&share.incoming.rays));
        let grid = Grid::new(bounds.reduce(|| NO_BOUNDS, union));
        self.shares.par_iter_mut().for_each(|Share { incoming, order }| {
            order.clear();
            order.extend(incoming.rays.iter().map(|ray| grid.cell(ray)).zip(0..));
            radsort::sort_by_key(order, |cell| cell.0);
            incoming.reorder(order);
        });
    }

    /// Makes parts of as many rays each, give or take one.
    fn cut(&mut self, count: usize, parts: usize) {
        self.parts.resize_with(parts, Part::default);
        let mut from = vec![0; self.shares.len()];
        for number in 0..parts {
            let to = self.first_of_each_share(count * (number + 1) / parts);
            self.parts[number].of_shares = from.iter().zip(&to).map(|(&from, &to)| from..to).collect();
            from = to;
        }
    }

    /// How many of each share are among so many first of all, in the order of cells and, in a cell, of shares.
    fn first_of_each_share(&self, count: usize) -> Vec<usize> {
        let before = |share: &Share, cell: u32| share.order.partition_point(|of| u32::from(of.0) < cell);
        let all_before = |cell: u32| -> usize { self.shares.iter().map(|share| before(share, cell)).sum() };
        // The cell in which the last of them is.
        let (mut cell, mut beyond) = (0, CELLS);
        while beyond - cell > 1 {
            let middle = (cell + beyond) / 2;
            *(if all_before(middle) <= count { &mut cell } else { &mut beyond }) = middle;
        }
        let mut rest = count - all_before(cell);
        let of_share = |share: &Share| {
            let (from, to) = (before(share, cell), before(share, cell + 1));
            let taken = rest.min(to - from);
            rest -= taken;
            from + taken
        };
        self.shares.iter().map(of_share).collect()
    }

    /// Writes what parts found to the rows of a share.
    fn give_back<const ANY: bool>(&self, number: usize, ends: &mut Ends<'_>) {
        let rows = &self.shares[number].incoming.rows;
        for part in &self.parts {
            for (at, &row) in (first_of(&part.of_shares, number)..).zip(&rows[part.of_shares[number].clone()])
            {
                ends.t[row as usize] = part.t[at];
                if !ANY {
                    ends.id[row as usize] = part.id[at];
                }
            }
        }
    }
}

/// Where the rays of a share begin in a part.
fn first_of(of_shares: &[Range<usize>], number: usize) -> usize {
    of_shares[..number].iter().map(Range::len).sum()
}

/// Takes rays of some cells from all shares, cell by cell. Their rows count share after share.
fn merge<const DEPARTING: bool>(shares: &[Share], of_shares: &[Range<usize>], incoming: &mut Incoming) {
    let mut rest = of_shares.to_vec();
    let cell_of = |share: &Share, at: usize| share.order[at].0;
    loop {
        let next = shares.iter().zip(&rest).filter(|(_, rest)| !rest.is_empty());
        let Some(cell) = next.map(|(share, rest)| cell_of(share, rest.start)).min() else { return };
        for (number, share) in shares.iter().enumerate() {
            let Range { start, end } = rest[number];
            let in_cell = (start..end).take_while(|&at| cell_of(share, at) == cell).count();
            let row = first_of(of_shares, number) + start - of_shares[number].start;
            incoming.take_over::<DEPARTING>(&share.incoming, start..start + in_cell, row);
            rest[number].start += in_cell;
        }
    }
}

const NO_BOUNDS: Bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];

fn union([low, high]: Bounds, [other_low, other_high]: Bounds) -> Bounds {
    let axes = [0, 1, 2];
    [
        axes.map(|axis| Lanes::min(other_low[axis], low[axis])),
        axes.map(|axis| Lanes::max(other_high[axis], high[axis])),
    ]
}

/// Of origins; what is not a number is passed over.
fn bounds_of(rays: &[Record]) -> Bounds {
    rays.iter().fold(NO_BOUNDS, |bounds, Record([x, y, z, ..])| union(bounds, [[*x, *y, *z]; 2]))
}

/// Along the axis in which they reach farthest.
fn extent([low, high]: Bounds) -> f32 {
    (0..3).fold(0.0, |extent, axis| Lanes::max(high[axis] - low[axis], extent))
}

impl Grid {
    fn new([low, high]: Bounds) -> Self {
        let extent = Lanes::max(extent([low, high]), f32::MIN_POSITIVE);
        Self { low, cells_per_length: Lanes::min((1_u32 << CELL_BITS) as f32 / extent, f32::MAX) }
    }

    /// Along a Z-shaped curve.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "cells are few, and counted from 0; what is not a number is in the first"
    )]
    fn cell(&self, ray: &Record) -> u16 {
        let last = (1 << CELL_BITS) - 1;
        let along = |axis: usize| {
            let cell = ((ray.0[axis] - self.low[axis]) * self.cells_per_length) as u32;
            spread_by_3(cell.min(last)) << axis
        };
        (along(0) | along(1) | along(2)) as u16
    }
}

/// Puts two zeros between bits, of which there are no more than 8. Morton, "A Computer Oriented Geodetic Data Base", 1966.
fn spread_by_3(word: u32) -> u32 {
    let word = (word | word << 8) & 0x0300_f00f;
    let word = (word | word << 4) & 0x030c_30c3;
    (word | word << 2) & 0x0924_9249
}

/// Runs that are looked at.
const SAMPLED: usize = 32;

/// Some runs of rays, evenly spread.
fn sampled_runs(count: usize) -> impl Iterator<Item = Range<usize>> {
    let runs = count / RUN;
    (0..SAMPLED.min(runs)).map(move |sample| {
        let first = sample * runs / SAMPLED.min(runs) * RUN;
        first..first + RUN
    })
}

/// Whether rays that follow each other start near each other, by some runs of them.
pub(crate) fn is_local(origin: [&[f32]; 3], count: usize) -> bool {
    /// Share of the whole that the runs of rays in an order cover at most.
    const NEAR: f32 = 0.25;
    if count / RUN < SAMPLED {
        return true;
    }
    let extent_of = |rows: &mut dyn Iterator<Item = usize>| {
        let bounds = rows.map(|row| [origin.map(|column| column[row]); 2]).fold(NO_BOUNDS, union);
        extent(bounds)
    };
    let of_runs: f32 = sampled_runs(count).map(|mut run| extent_of(&mut run)).sum();
    let of_all = extent_of(&mut sampled_runs(count).flatten());
    of_runs <= NEAR * SAMPLED as f32 * of_all
}

/// Whether some runs of rays may walk in packets, by those that are looked at.
fn are_some_alike(rays: &Rays<'_>) -> bool {
    sampled_runs(rays.count)
        .any(|run| common_order::<f32>(rays.direction.map(|column| &column[run.clone()])).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_follow_a_curve_of_bits() {
        let grid = Grid { low: [0.0; 3], cells_per_length: 1.0 };
        let cell_of = |[x, y, z]: [f32; 3]| grid.cell(&Record([x, y, z, 0.0, 1.0, 0.0, 0.0, 0.0]));
        assert_eq!(cell_of([3.0, 0.0, 1.0]), 0b_001_101);
        assert_eq!(cell_of([1e30, 0.0, 0.0]), 0b001_001_001_001_001);
    }

    /// Cells of shares, and how they are cut.
    #[test]
    fn parts_are_alike_and_each_ray_is_in_one() {
        let share =
            |cells: &[u16]| Share { order: cells.iter().copied().zip(0..).collect(), ..Share::default() };
        let last = u16::try_from(CELLS - 1).unwrap();
        let shares: [&[u16]; 3] = [&[0, 5, 5, 5, 5, last], &[5, 5, 7, 7], &[last, last, last]];
        let count: usize = shares.iter().map(|share| share.len()).sum();
        for parts in 1..=count + 2 {
            let mut shuffled = Shuffled { shares: shares.map(share).into(), parts: Vec::new() };
            shuffled.cut(count, parts);
            let mut cells = Vec::new();
            for part in &shuffled.parts {
                let of_part: usize = part.of_shares.iter().map(Range::len).sum();
                assert!(
                    (count / parts..=count.div_ceil(parts)).contains(&of_part),
                    "{of_part} of {count} in {parts}"
                );
                let of_shares = part.of_shares.iter().zip(shares);
                let mut of_part: Vec<u16> =
                    of_shares.flat_map(|(range, cells)| &cells[range.clone()]).copied().collect();
                of_part.sort_unstable();
                cells.extend(of_part);
            }
            assert!(cells.len() == count && cells.is_sorted(), "{cells:?} in {parts}");
            for (number, share) in shares.iter().enumerate() {
                let ranges = shuffled.parts.iter().flat_map(|part| part.of_shares[number].clone());
                assert!(ranges.eq(0..share.len()), "share {number} in {parts}");
            }
        }
    }

    #[test]
    fn rays_in_an_order_are_told_from_shuffled_ones() {
        let count = 100 * RUN;
        let ordered: Vec<f32> = (0..count).map(|row| row as f32).collect();
        let shuffled: Vec<f32> = (0..count).map(|row| (row * 7919 % count) as f32).collect();
        let none = vec![0.0; count];
        assert!(is_local([&ordered, &none, &none], count));
        assert!(is_local([&none, &none, &none], count), "from one point");
        assert!(!is_local([&none, &none, &shuffled], count));
    }
}
