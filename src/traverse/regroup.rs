//! Rays that packets leave, put in an order in which they help each other: those that go the same way from near each other
//! become neighbours.
//!
//! Rays mostly come in an order of their own, that of pixels, and keep near each other what starts near each other. Then they
//! are only parted by class, which takes a few ns a ray; to sort them by origin as well cost more than it gave, 2026-11. Only
//! where they come in no order at all, and many of them, are they sorted by origin first.

use super::stream::{AHEAD, CAPACITY, Class};
use super::{RUN, Rays};
use crate::lanes::{Lanes, Record, Single, prefetch};

/// Rays that are parted by class at a time: as many as stay in the cache, and enough for long lists. Of 8192, 16,384 and
/// 32,768 rays in an order the last were fastest on four scenes; 65,536 and 262,144 were slower when rays were also sorted in
/// each window; 2026-11.
pub(super) const WINDOW: usize = 512 * RUN;

/// Rays as they come, and the order in which they are to be traced.
#[derive(Default)]
pub(super) struct Incoming {
    /// Origin, where hits end to be of interest, direction, t beyond which they are wanted.
    pub(super) rays: Vec<Record>,
    /// What the origin's rounding left out, and the bits of the departure. Empty where no ray starts on a primitive.
    pub(super) departures: Vec<Record>,
    /// The caller's rows.
    pub(super) rows: Vec<u32>,
    /// Numbers of the rays' classes.
    classes: Vec<u8>,
    /// Places of a window, by class.
    parted: Vec<u32>,
    /// For sorting by origin: cells and places among the rays, and what is being sorted.
    cells: Vec<(u16, u32)>,
    moved: Vec<Record>,
}

/// Bits of a cell along each axis.
const CELL_BITS: u32 = 5;

/// Third axis and signs of directions.
const CLASSES: usize = 24;

impl Incoming {
    pub(super) fn clear(&mut self) {
        self.rays.clear();
        self.departures.clear();
        self.rows.clear();
        self.classes.clear();
    }

    pub(super) fn len(&self) -> usize {
        self.rays.len()
    }

    /// Takes in a run of [`RUN`] rows, `count` of which are rays, with where they end.
    pub(super) fn push_run<F: Single, const DEPARTING: bool>(
        &mut self,
        rays: &Rays<'_>,
        t: &[f32],
        (first, count): (usize, usize),
    ) {
        let zero = F::splat(0.0);
        let start = self.rays.len();
        self.rays.resize(start + RUN, Record::default());
        for row in (0..count).step_by(F::WIDTH) {
            let from = first + row;
            let ([x, y, z], [dx, dy, dz]) = (rays.origin, rays.direction);
            let record = [
                F::load(&x[from..]),
                F::load(&y[from..]),
                F::load(&z[from..]),
                F::load(&t[from..]),
                F::load(&dx[from..]),
                F::load(&dy[from..]),
                F::load(&dz[from..]),
                if rays.t_min.is_empty() { zero } else { F::load(&rays.t_min[from..]) },
            ];
            F::store_records(record, &mut self.rays[start + row..]);
        }
        self.rays.truncate(start + count);
        self.classes.extend(self.rays[start..].iter().map(class_number));
        if DEPARTING {
            self.departures.extend((first..first + count).map(|row| {
                let [x, y, z] = rays.origin_low.map(|column| column[row]);
                Record([x, y, z, f32::from_bits(rays.departure[row]), 0.0, 0.0, 0.0, 0.0])
            }));
        }
        self.rows.extend((first..first + count).map(word));
    }

    /// Asks for what is known of the first rays of some places.
    #[inline(always)]
    pub(super) fn prefetch<const DEPARTING: bool>(&self, places: &[u32], count: usize) {
        for &place in places.iter().take(count) {
            prefetch(self.rays.as_ptr().wrapping_add(place as usize).cast());
            if DEPARTING {
                prefetch(self.departures.as_ptr().wrapping_add(place as usize).cast());
            }
        }
    }

    /// Sorts all rays by the cells of their origins. They are moved, so that from then on what is read together lies together.
    pub(super) fn sort_by_origin(&mut self) {
        let (low, cells_per_length) = self.grid();
        self.cells.clear();
        let cells = self.rays.iter().map(|ray| cell(ray, low, cells_per_length));
        self.cells.extend(cells.zip(0..));
        radsort::sort_by_key(&mut self.cells, |cell| cell.0);
        let order = || self.cells.iter().map(|cell| cell.1 as usize);
        for records in [&mut self.rays, &mut self.departures] {
            if !records.is_empty() {
                let ahead = |place: usize| self.cells[(place + AHEAD).min(self.cells.len() - 1)].1;
                self.moved.clear();
                self.moved.extend(order().enumerate().map(|(at, place)| {
                    prefetch(records.as_ptr().wrapping_add(ahead(at) as usize).cast());
                    records[place]
                }));
                std::mem::swap(records, &mut self.moved);
            }
        }
        self.rows = order().map(|place| self.rows[place]).collect();
        self.classes = order().map(|place| self.classes[place]).collect();
    }

    /// The lowest origin along each axis, and cells for each unit of length.
    fn grid(&self) -> ([f32; 3], f32) {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for ray in &self.rays {
            for axis in 0..3 {
                low[axis] = Lanes::min(ray.0[axis], low[axis]);
                high[axis] = Lanes::max(ray.0[axis], high[axis]);
            }
        }
        let extent =
            (0..3).fold(f32::MIN_POSITIVE, |extent, axis| Lanes::max(high[axis] - low[axis], extent));
        (low, Lanes::min((1_u32 << CELL_BITS) as f32 / extent, f32::MAX))
    }

    /// Visits parts of no more than [`CAPACITY`] places of one class, window by window.
    pub(super) fn each_part(&mut self, mut visit: impl FnMut(&Self, &[u32], Class)) {
        let mut parted = std::mem::take(&mut self.parted);
        for first in (0..self.rays.len()).step_by(WINDOW) {
            let count = (self.rays.len() - first).min(WINDOW);
            let ends = part_by_class(&self.classes[first..first + count], first, &mut parted);
            let mut from = 0;
            for (class, end) in ends.into_iter().enumerate() {
                for part in parted[from..end].chunks(CAPACITY) {
                    visit(self, part, class_of(class));
                }
                from = end;
            }
        }
        self.parted = parted;
    }
}

/// Counts, then places; returns where each class ends. Of one class the order stays.
///
/// Neighbours are mostly of one class, and a count that was just stored is waited for. So the classes are gone through in
/// quarters, side by side.
fn part_by_class(classes: &[u8], first: usize, parted: &mut Vec<u32>) -> [usize; CLASSES] {
    const PARTS: usize = 4;
    let length = classes.len() / PARTS;
    let (sides, rest) = classes.split_at(PARTS * length);
    let class = |part: usize, index: usize| sides[part * length + index] as usize;
    // What is left over is of the last part.
    let mut next = [[0; CLASSES]; PARTS];
    for index in 0..length {
        for (part, next) in next.iter_mut().enumerate() {
            next[class(part, index)] += 1;
        }
    }
    for &class in rest {
        next[PARTS - 1][class as usize] += 1;
    }
    let (mut ends, mut before) = ([0; CLASSES], 0);
    for (class, end) in ends.iter_mut().enumerate() {
        for next in &mut next {
            let count = std::mem::replace(&mut next[class], before);
            before += count;
        }
        *end = before;
    }
    parted.resize(classes.len(), 0);
    let mut put = |next: &mut [usize; CLASSES], class: usize, place: usize| {
        parted[next[class]] = word(first + place);
        next[class] += 1;
    };
    for index in 0..length {
        for (part, next) in next.iter_mut().enumerate() {
            put(next, class(part, index), part * length + index);
        }
    }
    for (index, &class) in rest.iter().enumerate() {
        put(&mut next[PARTS - 1], class as usize, PARTS * length + index);
    }
    ends
}

/// Third axis and signs. Without a branch: of rays in no order it is anybody's guess.
#[inline(always)]
fn class_number(ray: &Record) -> u8 {
    let [.., dx, dy, dz, _] = ray.0;
    let direction = [dx, dy, dz];
    let signs = (0..3).fold(0, |signs, axis| signs | u8::from(direction[axis] < 0.0) << axis);
    let [x, y, z] = direction.map(f32::abs);
    let is_first = (x >= y) & (x >= z);
    let third = u8::from(!is_first) << u8::from(!is_first & (y < z));
    third << 3 | signs
}

fn class_of(number: usize) -> Class {
    Class { third: number >> 3, backwards: [0, 1, 2].map(|axis| number >> axis & 1 == 1) }
}

/// Along a Z-shaped curve.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cells are few, and counted from 0; what is not a number is in the first"
)]
fn cell(ray: &Record, low: [f32; 3], cells_per_length: f32) -> u16 {
    let last = (1 << CELL_BITS) - 1;
    let along =
        |axis: usize| spread_by_3((((ray.0[axis] - low[axis]) * cells_per_length) as u32).min(last)) << axis;
    (along(0) | along(1) | along(2)) as u16
}

/// Puts two zeros between bits, of which there are no more than 8. Morton, "A Computer Oriented Geodetic Data Base", 1966.
fn spread_by_3(word: u32) -> u32 {
    let word = (word | word << 8) & 0x0300_f00f;
    let word = (word | word << 4) & 0x030c_30c3;
    (word | word << 2) & 0x0924_9249
}

#[expect(clippy::cast_possible_truncation, reason = "rows are numbered in 32 bits")]
fn word(row: usize) -> u32 {
    row as u32
}

/// Whether rays that follow each other start near each other, by some runs of them.
pub(super) fn is_local(origin: [&[f32]; 3], count: usize) -> bool {
    const SAMPLED: usize = 32;
    /// Share of the whole that the runs of rays in an order cover at most.
    const NEAR: f32 = 0.25;
    let runs = count / RUN;
    if runs < SAMPLED {
        return true;
    }
    let extent_of = |rows: &mut dyn Iterator<Item = usize>| {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for row in rows {
            for axis in 0..3 {
                low[axis] = Lanes::min(origin[axis][row], low[axis]);
                high[axis] = Lanes::max(origin[axis][row], high[axis]);
            }
        }
        (0..3).fold(0.0, |extent, axis| Lanes::max(high[axis] - low[axis], extent))
    };
    let sampled = || (0..SAMPLED).map(|sample| sample * runs / SAMPLED * RUN);
    let of_runs: f32 = sampled().map(|first| extent_of(&mut (first..first + RUN))).sum();
    let of_all = extent_of(&mut sampled().flat_map(|first| first..first + RUN));
    of_runs <= NEAR * SAMPLED as f32 * of_all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::axes_along;
    use crate::random::random_unit;

    #[test]
    fn cells_follow_a_curve_of_bits() {
        let cell_of = |[x, y, z]: [f32; 3]| cell(&Record([x, y, z, 0.0, 1.0, 0.0, 0.0, 0.0]), [0.0; 3], 1.0);
        assert_eq!(cell_of([3.0, 0.0, 1.0]), 0b_001_101);
        assert_eq!(cell_of([1e30, 0.0, 0.0]), 0b001_001_001_001_001);
    }

    #[test]
    fn each_ray_is_in_one_part_of_its_class() {
        let mut incoming = Incoming::default();
        let count = WINDOW + 5000;
        #[expect(clippy::cast_possible_truncation, reason = "any number will do")]
        let number = |row: usize, column: usize| random_unit([word(row), word(column)]) as f32 - 0.5;
        incoming.rays.extend((0..count).map(|row| Record(std::array::from_fn(|column| number(row, column)))));
        incoming.classes.extend(incoming.rays.iter().map(class_number));
        incoming.rows.extend((0..count).map(word));
        for by_origin in [false, true] {
            if by_origin {
                incoming.sort_by_origin();
            }
            let mut seen = vec![0; count];
            incoming.each_part(|incoming, places, class| {
                assert!(!places.is_empty() && places.len() <= CAPACITY);
                for &place in places {
                    seen[place as usize] += 1;
                    let [.., x, y, z, _] = incoming.rays[place as usize].0;
                    assert_eq!(class.backwards, [x, y, z].map(|component| component < 0.0));
                    assert_eq!(class.third, axes_along([x, y, z])[2]);
                }
            });
            assert!(seen.iter().all(|&times| times == 1));
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
