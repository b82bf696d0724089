//! The instruction sets that make a difference to the lanes.

use serde::Serialize;
use std::fmt;

/// Instruction sets that a build can be for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Isa {
    /// x86-64 as every such processor has it.
    Sse2,
    /// With AVX2.
    Avx2,
    /// With AVX-512 F.
    Avx512,
    /// 64-bit ARM.
    Neon,
    /// None that the lanes know.
    Scalar,
}

impl Isa {
    /// The one that this program was built for.
    pub const BUILT_FOR: Self = if cfg!(target_feature = "avx512f") {
        Self::Avx512
    } else if cfg!(target_feature = "avx2") {
        Self::Avx2
    } else if cfg!(target_feature = "sse2") {
        Self::Sse2
    } else if cfg!(target_feature = "neon") {
        Self::Neon
    } else {
        Self::Scalar
    };

    /// The best one that this machine can run.
    pub fn of_this_machine() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            // The standard library takes for granted what the build does, which is so where the build runs.
            if is_x86_feature_detected!("avx512f") {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::BUILT_FOR
    }

    /// The name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sse2 => "sse2",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
            Self::Neon => "neon",
            Self::Scalar => "scalar",
        }
    }
}

impl fmt::Display for Isa {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_one_in_all_places() {
        for isa in [Isa::Sse2, Isa::Avx2, Isa::Avx512, Isa::Neon, Isa::Scalar] {
            assert_eq!(serde_json::to_value(isa).unwrap(), isa.name());
            assert_eq!(isa.to_string(), isa.name());
        }
    }

    #[test]
    fn a_machine_has_what_the_build_that_it_runs_is_for() {
        let better = match Isa::BUILT_FOR {
            Isa::Sse2 => vec![Isa::Avx2, Isa::Avx512],
            Isa::Avx2 => vec![Isa::Avx512],
            Isa::Avx512 | Isa::Neon | Isa::Scalar => vec![],
        };
        let machine = Isa::of_this_machine();
        assert!(machine == Isa::BUILT_FOR || better.contains(&machine), "{machine}");
    }
}
