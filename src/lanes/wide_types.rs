//! Lanes from the crate `wide`, which picks its instructions when it is compiled.

use super::pack::Packed;
use super::records::Records;
use super::scalar::{MANTISSA, WHOLE};
use super::{Double, Lanes, Mask, RECORD, Record, SPREAD, Single};
use wide::{f32x4, f32x8, f32x16, f64x2, f64x4, f64x8, i32x4, i32x8, i32x16, u64x2, u64x4, u64x8};

/// A lane's number in its place, for masks of the first lanes.
const COUNTING: [f32; 16] = [0., 1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 13., 14., 15.];

/// A lane's bit in a number.
const BITS: [u32; 16] = {
    let mut bits = [1; 16];
    let mut lane = 1;
    while lane < 16 {
        bits[lane] = bits[lane - 1] << 1;
        lane += 1;
    }
    bits
};

macro_rules! many_lanes {
    ($lanes:ty, $scalar:ty, $width:literal) => {
        impl Mask for $lanes {
            const NONE: Self = <$lanes>::ZERO;

            #[inline(always)]
            fn any(self) -> bool {
                <$lanes>::any(self)
            }

            #[inline(always)]
            fn bits(self) -> u32 {
                self.to_bitmask()
            }
        }

        impl Lanes for $lanes {
            type Scalar = $scalar;
            type Mask = Self;
            const WIDTH: usize = $width;

            #[inline(always)]
            fn splat(value: $scalar) -> Self {
                <$lanes>::splat(value)
            }

            #[inline(always)]
            fn load(from: &[$scalar]) -> Self {
                let mut array = [0.0; $width];
                array.copy_from_slice(&from[..$width]);
                <$lanes>::new(array)
            }

            #[inline(always)]
            fn store(self, to: &mut [$scalar]) {
                to[..$width].copy_from_slice(&self.to_array());
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                <$lanes>::sqrt(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                <$lanes>::abs(self)
            }

            #[inline(always)]
            fn lt(self, other: Self) -> Self {
                self.simd_lt(other)
            }

            #[inline(always)]
            fn le(self, other: Self) -> Self {
                self.simd_le(other)
            }

            #[inline(always)]
            fn eq(self, other: Self) -> Self {
                self.simd_eq(other)
            }

            #[inline(always)]
            fn select(mask: Self, then: Self, otherwise: Self) -> Self {
                mask.select(then, otherwise)
            }

            #[inline(always)]
            fn first(count: usize) -> Self {
                let mut lane = [0.0; $width];
                for (lane, number) in lane.iter_mut().zip(COUNTING) {
                    *lane = <$scalar>::from(number);
                }
                // Counts are small, and above the width they are all the same.
                #[allow(
                    clippy::cast_lossless,
                    clippy::cast_possible_truncation,
                    reason = "at most the width"
                )]
                let count = count.min($width) as u8 as $scalar;
                <$lanes>::new(lane).simd_lt(<$lanes>::splat(count))
            }

            // x86's own minimum has these very semantics; other processors' may not.
            #[cfg(target_arch = "x86_64")]
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                self.fast_min(other)
            }

            #[cfg(target_arch = "x86_64")]
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                self.fast_max(other)
            }
        }
    };
}

macro_rules! many_singles {
    ($lanes:ty, $width:literal, $ids:ty, $double:ty, $block:ty, $node:ty, $halves:expr) => {
        many_lanes!($lanes, f32, $width);

        impl Single for $lanes {
            type Double = $double;
            type Block = $block;
            type Node = $node;
            type Ids = $ids;

            #[inline(always)]
            fn splat_ids(id: u32) -> $ids {
                <$ids>::splat(id.cast_signed())
            }

            #[inline(always)]
            fn load_ids(from: &[u32]) -> $ids {
                let mut array = [0; $width];
                array.copy_from_slice(bytemuck::cast_slice(&from[..$width]));
                <$ids>::new(array)
            }

            #[inline(always)]
            fn store_ids(ids: $ids, to: &mut [u32]) {
                to[..$width].copy_from_slice(bytemuck::cast_slice(&ids.to_array()));
            }

            #[inline(always)]
            fn select_ids(mask: Self, then: $ids, otherwise: $ids) -> $ids {
                mask.select(then, otherwise)
            }

            #[inline(always)]
            fn ids_eq(a: $ids, b: $ids) -> Self {
                bytemuck::cast(a.simd_eq(b))
            }

            #[inline(always)]
            fn ids_odd(ids: $ids) -> Self {
                bytemuck::cast((ids & <$ids>::splat(1)).simd_eq(<$ids>::splat(1)))
            }

            #[inline(always)]
            fn ids_half(ids: $ids) -> $ids {
                (ids >> 1) & <$ids>::splat(i32::MAX)
            }

            #[inline(always)]
            fn pack_ids(ids: $ids, bits: u32, to: &mut [u32]) {
                Packed::pack(ids, bits, to);
            }

            #[inline(always)]
            fn of_bits(bits: u32) -> Self {
                let lanes = Self::load_ids(&BITS);
                bytemuck::cast((Self::splat_ids(bits) & lanes).simd_eq(lanes))
            }

            #[inline(always)]
            fn halves(mask: Self) -> Option<[$node; 2]> {
                const HALVES: fn($lanes) -> Option<[$node; 2]> = $halves;
                HALVES(mask)
            }

            #[inline(always)]
            fn repeated(block: f32x4) -> Self {
                bytemuck::cast([block; $width / 4])
            }

            #[inline(always)]
            fn spread(numbers: &[f32; SPREAD]) -> Self {
                <$lanes>::new(std::array::from_fn(|lane| numbers[lane / 4]))
            }

            #[inline(always)]
            fn spread_halves<'a>(half: impl Fn(usize) -> &'a [f32; RECORD / 2]) -> [Self; RECORD / 2] {
                let halves: [f32x4; $width / 4] = std::array::from_fn(|number| f32x4::new(*half(number)));
                let all: [f32; $width] = bytemuck::cast(halves);
                // Written out: a closure over lanes passes them through memory.
                [
                    <$lanes>::new(std::array::from_fn(|lane| all[lane / 4 * 4])),
                    <$lanes>::new(std::array::from_fn(|lane| all[lane / 4 * 4 + 1])),
                    <$lanes>::new(std::array::from_fn(|lane| all[lane / 4 * 4 + 2])),
                    <$lanes>::new(std::array::from_fn(|lane| all[lane / 4 * 4 + 3])),
                ]
            }

            #[inline(always)]
            fn bits_as_ids(self) -> $ids {
                bytemuck::cast(self)
            }

            #[inline(always)]
            fn transposed<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; RECORD] {
                Records::transposed(record)
            }

            #[inline(always)]
            fn store_records(numbers: [Self; RECORD], to: &mut [Record]) {
                Records::store(numbers, to);
            }
        }
    };
}

macro_rules! many_doubles {
    ($lanes:ty, $width:literal, $bits:ty) => {
        many_lanes!($lanes, f64, $width);

        impl Double for $lanes {
            #[inline(always)]
            fn widen(from: &[f32]) -> Self {
                let mut array = [0.0; $width];
                for (wide, narrow) in array.iter_mut().zip(&from[..$width]) {
                    *wide = f64::from(*narrow);
                }
                <$lanes>::new(array)
            }

            #[inline(always)]
            #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
            fn round(self, to: &mut [f32]) {
                for (narrow, wide) in to[..$width].iter_mut().zip(self.to_array()) {
                    *narrow = wide as f32;
                }
            }

            #[inline(always)]
            fn split_exponent(self) -> (Self, Self) {
                let bits: $bits = self.to_bits();
                let exponent = <$lanes>::from_bits((bits >> 52) | <$bits>::splat(WHOLE.to_bits()));
                let one = <$bits>::splat(1.0_f64.to_bits());
                let mantissa = <$lanes>::from_bits((bits & <$bits>::splat(MANTISSA)) | one);
                (exponent - <$lanes>::splat(WHOLE + 1023.0), mantissa)
            }

            #[inline(always)]
            fn times_power_of_two(self, n: Self) -> Self {
                self * <$lanes>::from_bits((n + <$lanes>::splat(WHOLE + 1023.0)).to_bits() << 52)
            }
        }
    };
}

many_singles!(f32x4, 4, i32x4, f64x2, f32x4, f32x4, |_| None);
many_singles!(f32x8, 8, i32x8, f64x4, f32x4, f32x8, |_| None);
many_singles!(f32x16, 16, i32x16, f64x8, f32x4, f32x8, |mask| Some(bytemuck::cast(mask)));
many_doubles!(f64x2, 2, u64x2);
many_doubles!(f64x4, 4, u64x4);
many_doubles!(f64x8, 8, u64x8);
