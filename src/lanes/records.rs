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
                Self::load(&k.0[from..]),
                Self::load(&l.0[from..]),
                Self::load(&m.0[from..]),
                Self::load(&n.0[from..]),
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
            low[lane].store(&mut to[lane].0);
            high[lane].store(&mut to[lane].0[4..]);
        }
    }
}

impl Records for f32x8 {
    #[inline(always)]
    fn transposed<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; RECORD] {
        Self::transpose([
            Self::new(record(0).0),
            Self::new(record(1).0),
            Self::new(record(2).0),
            Self::new(record(3).0),
            Self::new(record(4).0),
            Self::new(record(5).0),
            Self::new(record(6).0),
            Self::new(record(7).0),
        ])
    }

    #[inline(always)]
    fn store(numbers: [Self; RECORD], to: &mut [Record]) {
        let records = Self::transpose(numbers);
        for lane in 0..Self::WIDTH {
            to[lane] = Record(records[lane].to_array());
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
pub(crate) fn least_of_each<F: Single>(lanes: [F; RECORD]) -> [f32; RECORD] {
    let mut records = [Record::default(); 16];
    F::store_records(lanes, &mut records);
    for half in [8, 4, 2, 1] {
        if half < F::WIDTH {
            let (low, high) = records.split_at_mut(half);
            let (low, high): (&mut [f32], &[f32]) =
                (bytemuck::cast_slice_mut(low), bytemuck::cast_slice(high));
            for (low, high) in low.iter_mut().zip(high) {
                *low = Lanes::min(*high, *low);
            }
        }
    }
    records[0].0
}

#[cfg(test)]
mod tests {
    use crate::lanes::{Job, Lanes, Record, SPREAD, Single, Width};

    struct ThereAndBack;

    impl Job for ThereAndBack {
        type Output = ();

        fn run<F: Single>(self) {
            // Bits of any kind: some are no numbers.
            let mut bits = (0xFFFF_FE00..).map(f32::from_bits);
            let records: Vec<Record> =
                (0..32).map(|_| Record(std::array::from_fn(|_| bits.next().unwrap_or(0.0)))).collect();
            let row = |lane: usize| (lane * 7 + 3) % 32;
            let numbers = F::transposed(|lane| &records[row(lane)]);
            for (number, lanes) in numbers.into_iter().enumerate() {
                let mut words = [0; 16];
                F::store_ids(lanes.bits_as_ids(), &mut words);
                for (lane, word) in words[..F::WIDTH].iter().enumerate() {
                    assert_eq!(*word, records[row(lane)].0[number].to_bits(), "number {number}, lane {lane}");
                }
            }
            let mut back = vec![Record::default(); 17];
            F::store_records(numbers, &mut back);
            for (lane, back) in back.iter().enumerate() {
                let expected = if lane < F::WIDTH { records[row(lane)] } else { Record::default() };
                assert_eq!(
                    back.0.map(f32::to_bits),
                    expected.0.map(f32::to_bits),
                    "lane {lane} of {}",
                    F::WIDTH
                );
            }
        }
    }

    struct Spreads;

    impl Job for Spreads {
        type Output = ();

        fn run<F: Single>(self) {
            // Bits of any kind, as above.
            let mut bits = (0x7F7F_FFF0..).map(f32::from_bits);
            let records: Vec<Record> =
                (0..4).map(|_| Record(std::array::from_fn(|_| bits.next().unwrap_or(0.0)))).collect();
            let words = |lanes: F| {
                let mut words = [0; 16];
                F::store_ids(lanes.bits_as_ids(), &mut words);
                words
            };
            let numbers: [f32; SPREAD] = std::array::from_fn(|number| records[number].0[0]);
            let (spread, repeated) =
                (words(F::spread(&numbers)), words(F::repeated(F::Block::load(&numbers))));
            for half in 0..2 {
                let halves = F::spread_halves(|row| &records[row].halves()[half]);
                for (number, lanes) in halves.into_iter().enumerate() {
                    for (lane, word) in words(lanes)[..F::WIDTH].iter().enumerate() {
                        let record = &records[lane / F::Block::WIDTH];
                        assert_eq!(
                            *word,
                            record.0[half * 4 + number].to_bits(),
                            "{number} of {half}, lane {lane}"
                        );
                    }
                }
            }
            for lane in 0..F::WIDTH {
                assert_eq!(spread[lane], numbers[lane / F::Block::WIDTH].to_bits(), "lane {lane}");
                assert_eq!(repeated[lane], numbers[lane % F::Block::WIDTH].to_bits(), "lane {lane}");
            }
        }
    }

    #[test]
    fn numbers_fill_as_many_lanes_as_a_block_has() {
        for width in Width::ALL {
            width.run(Spreads);
        }
    }

    #[test]
    fn records_become_lanes_and_lanes_records() {
        for width in Width::ALL {
            width.run(ThereAndBack);
        }
    }
}
