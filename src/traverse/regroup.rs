//! Rays that packets leave, put in an order in which they help each other: those that go the same way from near each other
//! become neighbours.
//!
//! Rays mostly come in an order of their own, that of pixels, and keep near each other what starts near each other. Then they
//! are only parted by class, which takes a few ns a ray; to sort them by origin as well cost more than it gave, 2026-11. Rays that
//! come in no order are sorted by origin before: see `shuffled`.

use super::stream::{AHEAD, CAPACITY, Class};
use super::{RUN, Rays};
use crate::lanes::{Record, Single, prefetch};
use std::ops::Range;

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
    /// For reordering.
    moved: Vec<Record>,
}

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

    /// Takes in all rows.
    pub(super) fn push_all<F: Single, const DEPARTING: bool>(&mut self, rays: &Rays<'_>, t: &[f32]) {
        for run in rays.runs() {
            self.push_run::<F, DEPARTING>(rays, t, run);
        }
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

    /// Puts rays into an order of their places, so that from then on what is read together lies together.
    pub(super) fn reorder(&mut self, order: &[(u16, u32)]) {
        let place = |at: usize| order[at].1 as usize;
        for records in [&mut self.rays, &mut self.departures] {
            if !records.is_empty() {
                self.moved.clear();
                self.moved.extend((0..order.len()).map(|at| {
                    let ahead = place((at + AHEAD).min(order.len() - 1));
                    prefetch(records.as_ptr().wrapping_add(ahead).cast());
                    records[place(at)]
                }));
                std::mem::swap(records, &mut self.moved);
            }
        }
        self.rows = (0..order.len()).map(|at| self.rows[place(at)]).collect();
        self.classes = (0..order.len()).map(|at| self.classes[place(at)]).collect();
    }

    /// Takes over a range of another's rays; they get rows from `row` on.
    pub(super) fn take_over<const DEPARTING: bool>(&mut self, from: &Self, range: Range<usize>, row: usize) {
        self.rows.extend((row..row + range.len()).map(word));
        self.classes.extend_from_slice(&from.classes[range.clone()]);
        self.rays.extend_from_slice(&from.rays[range.clone()]);
        if DEPARTING {
            self.departures.extend_from_slice(&from.departures[range]);
        }
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

#[expect(clippy::cast_possible_truncation, reason = "rows are numbered in 32 bits")]
pub(super) fn word(row: usize) -> u32 {
    row as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::axes_along;
    use crate::random::random_unit;

    #[test]
    fn each_ray_is_in_one_part_of_its_class() {
        let mut incoming = Incoming::default();
        let count = WINDOW + 5000;
        #[expect(clippy::cast_possible_truncation, reason = "any number will do")]
        let number = |row: usize, column: usize| random_unit([word(row), word(column)]) as f32 - 0.5;
        incoming.rays.extend((0..count).map(|row| Record(std::array::from_fn(|column| number(row, column)))));
        incoming.classes.extend(incoming.rays.iter().map(class_number));
        incoming.rows.extend((0..count).map(word));
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
