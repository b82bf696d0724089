//! The one table from numbers of lanes to types.

use super::Single;
use serde::Serialize;
use wide::{f32x4, f32x8, f32x16};

/// How many f32 lanes the kernels work on at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Width {
    /// Plain f32.
    One,
    /// As SSE and NEON have them.
    Four,
    /// As AVX has them.
    Eight,
    /// As AVX-512 has them.
    Sixteen,
}

/// Work that is written once for lanes of every width.
pub(crate) trait Job {
    /// What it ends in.
    type Output;
    /// Does it with lanes of one width.
    fn run<F: Single>(self) -> Self::Output;
}

impl Width {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::One, Self::Four, Self::Eight, Self::Sixteen];

    /// The widest that pays in this build.
    pub const BEST: Self = if cfg!(target_feature = "avx512f") {
        Self::Sixteen
    } else if cfg!(target_feature = "avx") {
        Self::Eight
    } else {
        Self::Four
    };

    /// The number.
    #[must_use]
    pub fn lanes(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    /// Does a job with lanes of this width.
    pub(crate) fn run<J: Job>(self, job: J) -> J::Output {
        match self {
            Self::One => job.run::<f32>(),
            Self::Four => job.run::<f32x4>(),
            Self::Eight => job.run::<f32x8>(),
            Self::Sixteen => job.run::<f32x16>(),
        }
    }
}
