//! One lane: plain f32 and f64.

use super::{Double, Lanes, Mask, RECORD, Record, SPREAD, Single};

impl Mask for bool {
    const NONE: Self = false;

    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}

macro_rules! one_lane {
    ($scalar:ty) => {
        impl Lanes for $scalar {
            type Scalar = $scalar;
            type Mask = bool;
            const WIDTH: usize = 1;

            #[inline(always)]
            fn splat(value: $scalar) -> Self {
                value
            }

            #[inline(always)]
            fn load(from: &[$scalar]) -> Self {
                from[0]
            }

            #[inline(always)]
            fn store(self, to: &mut [$scalar]) {
                to[0] = self;
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                <$scalar>::sqrt(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                <$scalar>::abs(self)
            }

            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }

            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }

            #[inline(always)]
            fn eq(self, other: Self) -> bool {
                self == other
            }

            #[inline(always)]
            fn select(mask: bool, then: Self, otherwise: Self) -> Self {
                if mask { then } else { otherwise }
            }

            #[inline(always)]
            fn first(count: usize) -> bool {
                count > 0
            }
        }
    };
}

one_lane!(f32);
one_lane!(f64);

impl Single for f32 {
    type Double = f64;
    type Block = f32;
    type Node = f32;
    type Ids = u32;

    #[inline(always)]
    fn splat_ids(id: u32) -> u32 {
        id
    }

    #[inline(always)]
    fn load_ids(from: &[u32]) -> u32 {
        from[0]
    }

    #[inline(always)]
    fn store_ids(ids: u32, to: &mut [u32]) {
        to[0] = ids;
    }

    #[inline(always)]
    fn select_ids(mask: bool, then: u32, otherwise: u32) -> u32 {
        if mask { then } else { otherwise }
    }

    #[inline(always)]
    fn ids_eq(a: u32, b: u32) -> bool {
        a == b
    }

    #[inline(always)]
    fn ids_odd(ids: u32) -> bool {
        ids & 1 == 1
    }

    #[inline(always)]
    fn ids_half(ids: u32) -> u32 {
        ids >> 1
    }

    #[inline(always)]
    fn pack_ids(ids: u32, _: u32, to: &mut [u32]) {
        to[0] = ids;
    }

    #[inline(always)]
    fn of_bits(bits: u32) -> bool {
        bits & 1 == 1
    }

    #[inline(always)]
    fn halves(_: bool) -> Option<[bool; 2]> {
        None
    }

    #[inline(always)]
    fn repeated(block: f32) -> f32 {
        block
    }

    #[inline(always)]
    fn spread(numbers: &[f32; SPREAD]) -> f32 {
        numbers[0]
    }

    #[inline(always)]
    fn spread_halves<'a>(half: impl Fn(usize) -> &'a [f32; RECORD / 2]) -> [f32; RECORD / 2] {
        *half(0)
    }

    #[inline(always)]
    fn bits_as_ids(self) -> u32 {
        self.to_bits()
    }

    #[inline(always)]
    fn store_records(numbers: [Self; RECORD], to: &mut [Record]) {
        to[0] = Record(numbers);
    }

    #[inline(always)]
    fn transposed<'a>(record: impl Fn(usize) -> &'a Record) -> [Self; RECORD] {
        record(0).0
    }
}

impl Double for f64 {
    #[inline(always)]
    fn widen(from: &[f32]) -> Self {
        Self::from(from[0])
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is meant")]
    fn round(self, to: &mut [f32]) {
        to[0] = self as f32;
    }

    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let bits = self.to_bits();
        let exponent = Self::from_bits((bits >> 52) | WHOLE.to_bits()) - (WHOLE + 1023.0);
        let mantissa = Self::from_bits((bits & MANTISSA) | 1.0_f64.to_bits());
        (exponent, mantissa)
    }

    #[inline(always)]
    fn times_power_of_two(self, n: Self) -> Self {
        self * Self::from_bits((n + (WHOLE + 1023.0)).to_bits() << 52)
    }
}

/// 2⁵²: in its binade the mantissa's bits are the whole number that was added.
pub(super) const WHOLE: f64 = 4_503_599_627_370_496.0;
/// The bits of an f64's mantissa.
pub(super) const MANTISSA: u64 = (1 << 52) - 1;
