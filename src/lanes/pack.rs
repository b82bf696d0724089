//! Lanes put side by side that were chosen by a mask, for lists and queues.

use super::compress::{compressed_8, compressed_16};
use bytemuck::Pod;
use wide::{i32x4, i32x8, i32x16, u32x8};

/// Which of eight numbers side by side are wanted, one after the other. It is found once and serves any number of columns.
#[derive(Clone, Copy)]
pub(crate) struct Packing {
    bits: u32,
}

impl Packing {
    /// Numbers at once.
    pub(crate) const MOST: usize = 8;

    /// Bit i is number i.
    #[inline(always)]
    pub(crate) fn new(bits: u32) -> Self {
        Self { bits: bits & 255 }
    }

    /// How many are wanted.
    #[inline(always)]
    pub(crate) fn count(self) -> usize {
        self.bits.count_ones() as usize
    }

    /// Puts those of the first eight that are wanted where `to` begins, and anything behind them where there is room. `from`
    /// may end behind the last that is wanted, and `to` where these are full.
    #[inline(always)]
    pub(crate) fn pack<T: Pod>(self, from: &[T], to: &mut [T]) {
        const { assert!(size_of::<T>() == 4) };
        match (from.first_chunk::<8>(), to.first_chunk_mut::<8>()) {
            (Some(from), Some(to)) if cfg!(target_feature = "avx2") => {
                *to = bytemuck::cast(compressed_8(bytemuck::cast(*from), self.bits));
            }
            _ => self.pack_each(from, to),
        }
    }

    #[inline(always)]
    fn pack_each<T: Pod>(self, from: &[T], to: &mut [T]) {
        let mut bits = self.bits;
        for to in &mut to[..self.count()] {
            *to = from[bits.trailing_zeros() as usize];
            bits &= bits - 1;
        }
    }
}

/// Which of eight numbers side by side are wanted, in an order that is not theirs. It is found once and serves any number of
/// columns.
#[derive(Clone, Copy)]
pub(crate) struct Arrangement {
    /// Those wanted, one after the other; then anything.
    numbers: u32x8,
    count: usize,
}

impl Arrangement {
    /// `order` names `used` of them in 3 bits each, the first lowest. Those whose bits are set in `bits` are wanted, the last
    /// first.
    #[inline(always)]
    pub(crate) fn reversed(order: u32, used: usize, bits: u32) -> Self {
        let places = (u32x8::splat(order) >> u32x8::new([21, 18, 15, 12, 9, 6, 3, 0])) & u32x8::splat(7);
        let is_wanted = (u32x8::splat(bits) >> places) << u32x8::splat(31);
        let wanted = is_wanted.to_bitmask() & (255 << (8 - used)) & 255;
        let numbers = bytemuck::cast(compressed_8(bytemuck::cast(places), wanted));
        Self { numbers, count: wanted.count_ones() as usize }
    }

    /// How many are wanted.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Puts those that are wanted where `to` begins, and anything behind them.
    #[inline(always)]
    pub(crate) fn arrange<T: Pod>(&self, from: &[T; 8], to: &mut [T; 8]) {
        const { assert!(size_of::<T>() == 4) };
        let from: u32x8 = bytemuck::cast(*from);
        *to = bytemuck::cast(from.shuffle(self.numbers));
    }
}

/// See [`super::Single::pack_ids`].
pub(super) trait Packed {
    fn pack(self, bits: u32, to: &mut [u32]);
}

impl Packed for i32x8 {
    #[inline(always)]
    fn pack(self, bits: u32, to: &mut [u32]) {
        // Through `Packing`, which asks where slices end, streams of diffuse rays took 1.06 times as long, 2026-11-23.
        if cfg!(target_feature = "avx2") {
            to[..8].copy_from_slice(bytemuck::cast_slice(&compressed_8(self, bits).to_array()));
        } else {
            pack_each(bytemuck::cast_ref::<_, [u32; 8]>(&self.to_array()), bits, to);
        }
    }
}

impl Packed for i32x4 {
    #[inline(always)]
    fn pack(self, bits: u32, to: &mut [u32]) {
        pack_each(bytemuck::cast_ref::<_, [u32; 4]>(&self.to_array()), bits, to);
    }
}

impl Packed for i32x16 {
    #[inline(always)]
    fn pack(self, bits: u32, to: &mut [u32]) {
        to[..16].copy_from_slice(bytemuck::cast_slice(&compressed_16(self, bits).to_array()));
    }
}

/// Without a branch: what is not chosen is written over.
#[inline(always)]
fn pack_each(ids: &[u32], bits: u32, to: &mut [u32]) {
    let mut count = 0;
    for (lane, &id) in ids.iter().enumerate() {
        to[count] = id;
        count += (bits >> lane & 1) as usize;
    }
}

#[cfg(test)]
mod tests {
    use super::{Arrangement, Packing};
    use crate::lanes::{Job, Single, Width};

    struct Packs;

    impl Job for Packs {
        type Output = ();

        fn run<F: Single>(self) {
            let ids: Vec<u32> = (1000..1016).collect();
            for bits in 0..1_u32 << F::WIDTH {
                // Up to the last lane's place there is room, and beyond it nothing is written.
                let mut to = [7; 17];
                F::pack_ids(F::load_ids(&ids), bits, &mut to[..F::WIDTH]);
                let chosen: Vec<u32> =
                    (0..F::WIDTH).filter(|lane| bits >> lane & 1 == 1).map(|lane| ids[lane]).collect();
                assert_eq!(to[..chosen.len()], chosen, "{bits:b} of {}", F::WIDTH);
                assert!(to[F::WIDTH..].iter().all(|&id| id == 7));
            }
        }
    }

    #[test]
    fn lanes_of_any_mask_come_one_after_the_other() {
        for width in Width::ALL {
            width.run(Packs);
        }
    }

    #[test]
    fn numbers_of_any_choice_come_one_after_the_other_wherever_columns_end() {
        let from: Vec<f32> = (0_u8..8).map(|number| f32::from(number) + 0.5).collect();
        for bits in 0..256_u32 {
            let packing = Packing::new(bits);
            let chosen: Vec<f32> =
                (0..8).filter(|lane| bits >> lane & 1 == 1).map(|lane| from[lane]).collect();
            let (count, last) = (chosen.len(), 32 - bits.leading_zeros() as usize);
            assert_eq!(packing.count(), count);
            for (from, room) in
                [(&from[..], 9), (&from[..], count), (&from[..last], 8), (&from[..last], count)]
            {
                let mut to = vec![7.0; room];
                packing.pack(from, &mut to);
                assert_eq!(to[..count], chosen, "{bits:b} into {room}");
                assert!(to.get(8).is_none_or(|&beyond| beyond == 7.0));
            }
        }
    }

    #[test]
    fn numbers_of_any_choice_come_in_the_reverse_of_any_order() {
        let from = [10, 11, 12, 13, 14, 15, 16, 17_u32];
        for order in [&[0, 1, 2, 3, 4, 5, 6, 7][..], &[6, 2, 7, 0, 5, 1, 4, 3], &[2, 0, 1], &[0], &[]] {
            let list = order.iter().rev().fold(0, |list, number| list << 3 | number);
            // What lies above the order is none of it.
            for list in [list, list | u32::try_from(order.len()).unwrap() << 28] {
                for bits in (0..256_u32).filter(|bits| bits >> order.len() == 0 || order.len() == 8) {
                    let arrangement = Arrangement::reversed(list, order.len(), bits);
                    let mut to = [0; 8];
                    arrangement.arrange(&from, &mut to);
                    let chosen = order.iter().rev().filter(|&&number| bits >> number & 1 == 1);
                    let expected: Vec<u32> = chosen.map(|&number| from[number as usize]).collect();
                    assert_eq!(to[..arrangement.count()], expected, "{bits:b} of {order:?}");
                }
            }
        }
    }
}
