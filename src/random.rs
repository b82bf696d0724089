//! Random numbers that depend on nothing but the words they are made from, so that no order of work can change them.

/// A multiple of 2⁻²⁴ in [0, 1) that depends on the words alone.
pub(crate) fn random_unit<const N: usize>(words: [u32; N]) -> f64 {
    let hash = words.iter().fold(0, |hash, word| lowbias32((hash ^ word).wrapping_add(0x9E37_79B9)));
    f64::from(hash >> 8) / f64::from(1 << 24)
}

/// Source: Wellons, "Prospecting for Hash Functions", 2018, the function he names lowbias32.
fn lowbias32(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked out step by step with 32-bit arithmetic outside this program.
    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!((lowbias32(0), lowbias32(1)), (0, 0x688990c0));
    }
}
