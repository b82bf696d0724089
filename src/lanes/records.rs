//! Records into lanes and back: a record for each lane becomes lanes for each of its numbers.
//!
//! Numbers that are needed together for a few rays out of many lie together in memory: one load and a part of a
//! transposition take the place of eight loads from eight columns.

use super::{Lanes, RECORD, Record, Single};
use wide::{f32x4, f32x8, f32x16};

/// See [`super::Single::transposed`] and [`super::Single::store_records`].
pub(super) trait Records: Sized {
    fn transposed<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; RECORD];
    fn store(numbers: [Self; RECORD], to: &mut [Record]);
}

impl Records for f32x4 {
    #[inline(always)]
    fn transposed<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; RECORD] {
        let [k, l, m, n] = [record(0), record(1), record(2), record(3)];
        let half = |from: usize| {
            Self::transpose([
                Self::load(&k[from..]),
                Self::load(&l[from..]),
                Self::load(&m[from..]),
                Self::load(&n[from..]),
            ])
        };
        let ([a, b, c, d], [e, f, g, h]) = (half(0), half(4));
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn store(numbers: [Self; RECORD], to: &mut [Record]) {
        let [a, b, c, d, e, f, g, h] = numbers;
        let (low, high) = (Self::transpose([a, b, c, d]), Self::transpose([e, f, g, h]));
        for lane in 0..Self::WIDTH {
            low[lane].store(&mut to[lane]);
            high[lane].store(&mut to[lane][4..]);
        }
    }
}

impl Records for f32x8 {
    #[inline(always)]
    fn transposed<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; RECORD] {
        Self::transpose([
            Self::new(*record(0)),
            Self::new(*record(1)),
            Self::new(*record(2)),
            Self::new(*record(3)),
            Self::new(*record(4)),
            Self::new(*record(5)),
            Self::new(*record(6)),
            Self::new(*record(7)),
        ])
    }

    #[inline(always)]
    fn store(numbers: [Self; RECORD], to: &mut [Record]) {
        let records = Self::transpose(numbers);
        for lane in 0..Self::WIDTH {
            to[lane] = records[lane].to_array();
        }
    }
}

impl Records for f32x16 {
    #[inline(always)]
    fn transposed<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; RECORD] {
        let low = <f32x8 as Records>::transposed(&record);
        let high = <f32x8 as Records>::transposed(|lane| record(lane + 8));
        let mut numbers = [Self::splat(0.0); RECORD];
        for number in 0..RECORD {
            numbers[number] = bytemuck::cast([low[number], high[number]]);
        }
        numbers
    }

    #[inline(always)]
    fn store(numbers: [Self; RECORD], to: &mut [Record]) {
        let mut halves = [[f32x8::splat(0.0); RECORD]; 2];
        for number in 0..RECORD {
            let [low, high]: [f32x8; 2] = bytemuck::cast(numbers[number]);
            (halves[0][number], halves[1][number]) = (low, high);
        }
        Records::store(halves[0], to);
        Records::store(halves[1], &mut to[8..]);
    }
}

/// The least of the lanes of each: the same in any order, unlike a sum. All at once, and by halves, since a chain of sixteen
/// is slow.
#[inline(always)]
pub(crate) fn least_of_each<F: Single>(lanes: [F; RECORD]) -> Record {
    let mut records = [[0.0; RECORD]; 16];
    F::store_records(lanes, &mut records);
    for half in [8, 4, 2, 1] {
        if half < F::WIDTH {
            let (low, high) = records.split_at_mut(half);
            for (low, high) in low.as_flattened_mut().iter_mut().zip(high.as_flattened()) {
                *low = Lanes::min(*high, *low);
            }
        }
    }
    records[0]
}

#[cfg(test)]
mod tests {
    use crate::lanes::{Job, RECORD, Record, Single, Width};

    struct ThereAndBack;

    impl Job for ThereAndBack {
        type Output = ();

        fn run<F: Single>(self) {
            // Bits of any kind: some are no numbers.
            let mut bits = (0xFFFF_FE00..).map(f32::from_bits);
            let records: Vec<Record> =
                (0..32).map(|_| std::array::from_fn(|_| bits.next().unwrap_or(0.0))).collect();
            let row = |lane: usize| (lane * 7 + 3) % 32;
            let numbers = F::transposed(|lane| &records[row(lane)]);
            for (number, lanes) in numbers.into_iter().enumerate() {
                let mut words = [0; 16];
                F::store_ids(lanes.bits_as_ids(), &mut words);
                for (lane, word) in words[..F::WIDTH].iter().enumerate() {
                    assert_eq!(*word, records[row(lane)][number].to_bits(), "number {number}, lane {lane}");
                }
            }
            let mut back = vec![[0.0; RECORD]; 17];
            F::store_records(numbers, &mut back);
            for (lane, back) in back.iter().enumerate() {
                let expected = if lane < F::WIDTH { records[row(lane)] } else { [0.0; RECORD] };
                assert_eq!(back.map(f32::to_bits), expected.map(f32::to_bits), "lane {lane} of {}", F::WIDTH);
            }
        }
    }

    #[test]
    fn records_become_lanes_and_lanes_records() {
        for width in Width::ALL {
            width.run(ThereAndBack);
        }
    }
}
