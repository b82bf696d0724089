//! Vector lanes: width as a type. The only place that names `wide`, an instruction set or a width.
//!
//! `Single` stands for some f32 side by side, `Double` for f64; one lane is a plain `f32` or `f64`, and the same
//! source runs at every width. Lanes have the operations whose bits are equal at every width and in every build, and no
//! others: + − × ÷ √, comparisons, selection and bits. There is no fused multiply-add, no estimate of a reciprocal and no
//! sum across lanes.

#[cfg(target_arch = "x86_64")]
mod compress;
pub(crate) mod cpu;
mod isa;
mod pack;
mod prefetch;
mod records;
mod scalar;
#[cfg(test)]
mod tests;
mod vector;
mod wide_types;
mod widths;

pub use isa::Isa;
pub(crate) use pack::{Arrangement, Packing};
pub(crate) use prefetch::prefetch;
pub(crate) use records::least_of_each;
pub(crate) use vector::Vector;
/// Eight lanes by name, for what is as wide whatever the width that rays go in.
pub(crate) use wide::f32x8 as EightSingles;
pub(crate) use widths::Job;
pub use widths::Width;

use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// Numbers side by side, worked on at once.
pub(crate) trait Lanes:
    Copy
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// f32 or f64.
    type Scalar: Copy;
    /// A truth for each lane.
    type Mask: Mask;
    /// How many lanes there are.
    const WIDTH: usize;

    fn splat(value: Self::Scalar) -> Self;
    /// The first [`Self::WIDTH`] of a slice that has at least as many.
    fn load(from: &[Self::Scalar]) -> Self;
    /// Into the first [`Self::WIDTH`] of a slice that has at least as many.
    fn store(self, to: &mut [Self::Scalar]);
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn lt(self, other: Self) -> Self::Mask;
    fn le(self, other: Self) -> Self::Mask;
    fn eq(self, other: Self) -> Self::Mask;
    fn select(mask: Self::Mask, then: Self, otherwise: Self) -> Self;
    /// Lanes 0 to `count` − 1; all of them where `count` is at least the width.
    fn first(count: usize) -> Self::Mask;

    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }

    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }

    /// `if self < other { self } else { other }`: `other` where one is not a number.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// `if self > other { self } else { other }`: `other` where one is not a number.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.gt(other), self, other)
    }
}

/// A truth for each lane.
pub(crate) trait Mask:
    Copy + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
    /// No lane.
    const NONE: Self;

    /// True where one is and the other is not.
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self ^ other
    }

    fn any(self) -> bool;
    /// Bit i is lane i.
    fn bits(self) -> u32;
}

/// f32 lanes: what rays and primitives are tested in.
pub(crate) trait Single: Lanes<Scalar = f32> {
    /// f64 lanes that fill as many bits.
    type Double: Double;
    /// These lanes, or as many as a block of primitives holds if these are more.
    type Block: Single;
    /// These lanes, or as many as a node has children if these are more.
    type Node: Single;
    /// A primitive's id for each lane.
    type Ids: Copy;

    fn splat_ids(id: u32) -> Self::Ids;
    fn load_ids(from: &[u32]) -> Self::Ids;
    fn store_ids(ids: Self::Ids, to: &mut [u32]);
    fn select_ids(mask: Self::Mask, then: Self::Ids, otherwise: Self::Ids) -> Self::Ids;
    fn ids_eq(a: Self::Ids, b: Self::Ids) -> Self::Mask;
    /// Lanes whose id has its lowest bit set.
    fn ids_odd(ids: Self::Ids) -> Self::Mask;
    /// All ids without their lowest bit, halved.
    fn ids_half(ids: Self::Ids) -> Self::Ids;
    /// Stores the ids of the lanes whose bits are set, one after the other from the start, and anything behind them, of a
    /// slice that has room for all.
    fn pack_ids(ids: Self::Ids, bits: u32, to: &mut [u32]);
    /// The mask of the lanes whose bits are set.
    fn of_bits(bits: u32) -> Self::Mask;
    /// A mask's halves, of lanes that are half as many: what they choose may be less work in such. None where a node's are no
    /// fewer than these.
    fn halves(mask: Self::Mask) -> Option<[<Self::Node as Lanes>::Mask; 2]>;
    /// A block's lanes again and again, as often as they go into these.
    fn repeated(block: Self::Block) -> Self;
    /// The reverse: each number in as many lanes as a block has, the first in the first of them. Of the numbers beyond the last
    /// that fits nothing is read.
    fn spread(numbers: &[f32; SPREAD]) -> Self;
    /// Likewise of halves of records: lanes for each of their numbers.
    fn spread_halves<'a>(half: impl Fn(usize) -> &'a [f32; RECORD / 2]) -> [Self; RECORD / 2];
    /// The bits of each lane, which held an id or what else has 32 bits.
    fn bits_as_ids(self) -> Self::Ids;
    /// Turns a record for each lane into lanes for each of its numbers.
    fn transposed<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; RECORD];
    /// The reverse: into the first [`Lanes::WIDTH`] records of a slice that has at least as many.
    fn store_records(numbers: [Self; RECORD], to: &mut [Record]);
}

/// Most numbers that are spread over lanes at once.
pub(crate) const SPREAD: usize = 4;
/// Numbers of a [`Record`].
pub(crate) const RECORD: usize = 8;
/// Numbers that lie side by side, and never across two lines of memory: half of them would where they lie as an allocator happens
/// to put them.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Record(pub(crate) [f32; RECORD]);

impl Record {
    /// Its first numbers and its last.
    #[inline(always)]
    pub(crate) fn halves(&self) -> &[[f32; RECORD / 2]; 2] {
        bytemuck::cast_ref(&self.0)
    }
}

/// f64 lanes: what follows a hit is computed in them, and rounded to f32 where it enters a queue.
pub(crate) trait Double: Lanes<Scalar = f64> {
    /// The first [`Lanes::WIDTH`] of a slice, widened.
    fn widen(from: &[f32]) -> Self;
    /// Into the first [`Lanes::WIDTH`] of a slice, each rounded to the nearest f32.
    fn round(self, to: &mut [f32]);
    /// The exponent e and mantissa m of m·2^e with 1 ≤ m < 2, for positive normal numbers.
    fn split_exponent(self) -> (Self, Self);
    /// self · 2^n for whole numbers n from −1022 to 1023.
    fn times_power_of_two(self, n: Self) -> Self;
}

/// Says why this machine cannot run this build, if it cannot. This is known of x86-64 alone.
#[inline(never)]
pub(crate) fn check_machine() -> Result<(), impl std::fmt::Display> {
    #[cfg(target_arch = "x86_64")]
    return cpu::check();
    #[cfg(not(target_arch = "x86_64"))]
    Ok::<(), std::convert::Infallible>(())
}
