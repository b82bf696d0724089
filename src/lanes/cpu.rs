//! Whether this machine can run the instructions that the compiler used.
//!
//! A build uses what the processor has that it was made for. On a lesser one it would end in the middle of a picture by
//! an illegal instruction, so it asks before it starts, and refuses with a word on what to do.
//! [`is_x86_feature_detected!`] cannot tell: it is constant true for all that the build assumes. So CPUID is read here,
//! and XCR0 for the registers that the operating system has to save before programs may use them.
//!
//! This code too is compiled with the instructions that it asks about, and nothing can promise that it uses none of
//! them. So it stays small and plain: it runs before all else, keeps no list, allocates nothing, shifts nothing, copies
//! nothing that would fit a wide register, and the compiler cannot mix it with what comes next.
//!
//! Leaves, registers and bits: Intel SDM volume 2A, CPUID, and volume 1, 13.2 and 13.3 (XCR0), 14.3 and 15.2
//! (detection of AVX and AVX-512); AMD APM volume 3, appendix E.
#![expect(unsafe_code, reason = "XGETBV is an unsafe intrinsic, and in older compilers so is CPUID")]

use core::arch::x86_64::{__cpuid_count, _xgetbv};
use std::fmt;
use std::hint::black_box;

/// XCR0: the system saves XMM and YMM.
const AVX: u64 = 0b110;
/// XCR0: and the mask registers, ZMM and the upper sixteen of these. macOS enables them when they are first used.
const AVX512: u64 = if cfg!(target_os = "macos") { AVX } else { 0b1110_0110 };

/// One bit of CPUID.
struct Feature {
    /// As the compiler calls it.
    name: &'static str,
    is_used: bool,
    mask: u32,
    /// Bits of XCR0 that have to be 1.
    state: u64,
}

/// One register of a leaf of CPUID, and what there is to know in it.
struct Word {
    leaf: u32,
    subleaf: u32,
    register: Register,
    features: &'static [Feature],
}

enum Register {
    Eax,
    Ebx,
    Ecx,
    Edx,
}

macro_rules! feature {
    ($name:tt, $bit:literal, $state:expr) => {
        Feature { name: $name, is_used: cfg!(target_feature = $name), mask: 1 << $bit, state: $state }
    };
}

/// All that the compiler knows by name and may use by itself, or that libraries use where the build has it. Left out
/// are the baseline of x86-64, and what is used only where the source asks for it, which this program does not: the
/// XSAVE family, for one, is often hidden in virtual machines, which would be refused for nothing. What stable compilers
/// do not name (APX, AVX10.2, XOP) cannot be asked about; they are found out where something that came with them is
/// missing too.
const WORDS: [Word; 7] = [
    Word {
        leaf: 1,
        subleaf: 0,
        register: Register::Ecx,
        features: &[
            feature!("sse3", 0, 0),
            feature!("pclmulqdq", 1, 0),
            feature!("ssse3", 9, 0),
            feature!("fma", 12, AVX),
            feature!("cmpxchg16b", 13, 0),
            feature!("sse4.1", 19, 0),
            feature!("sse4.2", 20, 0),
            feature!("movbe", 22, 0),
            feature!("popcnt", 23, 0),
            feature!("aes", 25, 0),
            feature!("avx", 28, AVX),
            feature!("f16c", 29, AVX),
        ],
    },
    Word {
        leaf: 7,
        subleaf: 0,
        register: Register::Ebx,
        features: &[
            feature!("bmi1", 3, 0),
            feature!("avx2", 5, AVX),
            feature!("bmi2", 8, 0),
            feature!("avx512f", 16, AVX512),
            feature!("avx512dq", 17, AVX512),
            feature!("adx", 19, 0),
            feature!("avx512ifma", 21, AVX512),
            feature!("avx512cd", 28, AVX512),
            feature!("sha", 29, 0),
            feature!("avx512bw", 30, AVX512),
            feature!("avx512vl", 31, AVX512),
        ],
    },
    Word {
        leaf: 7,
        subleaf: 0,
        register: Register::Ecx,
        features: &[
            feature!("avx512vbmi", 1, AVX512),
            feature!("avx512vbmi2", 6, AVX512),
            feature!("gfni", 8, 0),
            feature!("vaes", 9, AVX),
            feature!("vpclmulqdq", 10, AVX),
            feature!("avx512vnni", 11, AVX512),
            feature!("avx512bitalg", 12, AVX512),
            feature!("avx512vpopcntdq", 14, AVX512),
        ],
    },
    Word {
        leaf: 7,
        subleaf: 0,
        register: Register::Edx,
        features: &[feature!("avx512vp2intersect", 8, AVX512), feature!("avx512fp16", 23, AVX512)],
    },
    Word {
        leaf: 7,
        subleaf: 1,
        register: Register::Eax,
        features: &[
            feature!("sha512", 0, AVX),
            feature!("sm3", 1, AVX),
            feature!("sm4", 2, AVX),
            feature!("avxvnni", 4, AVX),
            feature!("avx512bf16", 5, AVX512),
            feature!("avxifma", 23, AVX),
        ],
    },
    Word {
        leaf: 7,
        subleaf: 1,
        register: Register::Edx,
        features: &[
            feature!("avxvnniint8", 4, AVX),
            feature!("avxneconvert", 5, AVX),
            feature!("avxvnniint16", 10, AVX),
        ],
    },
    Word {
        leaf: 0x8000_0001,
        subleaf: 0,
        register: Register::Ecx,
        features: &[feature!("lzcnt", 5, 0), feature!("sse4a", 6, 0), feature!("tbm", 21, 0)],
    },
];

/// What to ask, and who answers: this machine, or one that a test makes up.
struct Check {
    words: &'static [Word],
    read: fn(&Word) -> u32,
    xcr0: fn() -> u64,
}

static THIS_MACHINE: Check = Check { words: &WORDS, read: read_word, xcr0: read_xcr0 };

/// Why this machine cannot run this build, as the user reads it.
pub(crate) struct Refusal(&'static Check);

/// Whether this machine has all that this build uses.
#[inline(never)]
pub(crate) fn check() -> Result<(), Refusal> {
    THIS_MACHINE.run()
}

/// Who keeps a feature from being used.
#[derive(Clone, Copy, PartialEq)]
enum Culprit {
    Processor,
    System,
}

impl Check {
    fn run(&'static self) -> Result<(), Refusal> {
        let mut is_fit = true;
        self.each_missing(&mut |_, _| is_fit = false);
        if is_fit { Ok(()) } else { Err(Refusal(self)) }
    }

    fn each_missing(&self, found: &mut dyn FnMut(Culprit, &'static str)) {
        let xcr0 = (self.xcr0)();
        for word in self.words {
            let bits = (self.read)(word);
            for feature in word.features.iter().filter(|feature| feature.is_used) {
                // The boxes keep the compiler from ANDN, which is BMI1, and from several features at once.
                if black_box(bits & feature.mask) == 0 {
                    found(Culprit::Processor, feature.name);
                } else if black_box(xcr0 & feature.state) != feature.state {
                    found(Culprit::System, feature.name);
                }
            }
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("this program was built for another machine than this:")?;
        for (culprit, says) in [
            (Culprit::Processor, "\nthe processor does not have"),
            (Culprit::System, "\nthe operating system does not enable"),
        ] {
            let mut start = says;
            let mut written = Ok(());
            self.0.each_missing(&mut |by, name| {
                if by == culprit && written.is_ok() {
                    written = formatter.write_str(start).and_then(|()| formatter.write_str(" "));
                    written = written.and_then(|()| formatter.write_str(name));
                    start = ",";
                }
            });
            written?;
        }
        formatter.write_str(
            "\nbuild it here: cargo build --release\n\
             or for every x86-64 machine: RUSTFLAGS=-Ctarget-cpu=x86-64 cargo build --release",
        )
    }
}

/// A word of CPUID, 0 where the processor does not have it.
fn read_word(word: &Word) -> u32 {
    // A leaf beyond the last is answered with another's content, and so is, by some Sandy Bridges, a sub-leaf of leaf 7
    // (https://reviews.llvm.org/D156963).
    if cpuid(word.leaf & 0x8000_0000, 0, &Register::Eax) < word.leaf {
        return 0;
    }
    if word.subleaf > 0 && cpuid(word.leaf, 0, &Register::Eax) < word.subleaf {
        return 0;
    }
    cpuid(word.leaf, word.subleaf, &word.register)
}

fn cpuid(leaf: u32, subleaf: u32, register: &Register) -> u32 {
    #[allow(unused_unsafe, reason = "newer compilers know that it is safe")]
    // SAFETY: every x86-64 processor has CPUID.
    let answer = unsafe { __cpuid_count(leaf, subleaf) };
    match register {
        Register::Eax => answer.eax,
        Register::Ebx => answer.ebx,
        Register::Ecx => answer.ecx,
        Register::Edx => answer.edx,
    }
}

/// The registers that the operating system saves, 0 where it does not say.
fn read_xcr0() -> u64 {
    const OSXSAVE: u32 = 1 << 27;
    if cpuid(1, 0, &Register::Ecx) & OSXSAVE == 0 {
        return 0;
    }
    // SAFETY: OSXSAVE says that the processor has XGETBV and that the system lets programs use it.
    unsafe { _xgetbv(0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    /// Whether the processor and the system together have it, used or not.
    fn is_present(word: &Word, feature: &Feature) -> bool {
        read_word(word) & feature.mask != 0 && read_xcr0() & feature.state == feature.state
    }

    #[test]
    fn a_name_and_a_bit_stand_in_the_table_once() {
        let (mut names, mut bits) = (HashSet::new(), HashSet::new());
        for word in &WORDS {
            for feature in word.features {
                assert!(names.insert(feature.name), "{} twice", feature.name);
                assert_eq!(feature.mask.count_ones(), 1);
                let register = match word.register {
                    Register::Eax => 'a',
                    Register::Ebx => 'b',
                    Register::Ecx => 'c',
                    Register::Edx => 'd',
                };
                assert!(
                    bits.insert((word.leaf, word.subleaf, register, feature.mask)),
                    "{}: its bit is taken",
                    feature.name
                );
            }
        }
    }

    /// Of what the build assumes the standard library only repeats that; of all else it asks the machine.
    #[test]
    fn the_table_agrees_with_the_standard_library() {
        macro_rules! said {
            ($($name:tt),*) => { [$(($name, is_x86_feature_detected!($name))),*] };
        }
        #[rustfmt::skip]
        let said = said!(
            "sse3", "pclmulqdq", "ssse3", "fma", "cmpxchg16b", "sse4.1", "sse4.2", "movbe", "popcnt", "aes", "avx", "f16c",
            "bmi1", "avx2", "bmi2", "avx512f", "avx512dq", "adx", "avx512ifma", "avx512cd", "sha", "avx512bw", "avx512vl",
            "avx512vbmi", "avx512vbmi2", "gfni", "vaes", "vpclmulqdq", "avx512vnni", "avx512bitalg", "avx512vpopcntdq",
            "avx512vp2intersect", "avx512fp16", "sha512", "sm3", "sm4", "avxvnni", "avx512bf16", "avxifma",
            "avxvnniint8", "avxneconvert", "avxvnniint16", "lzcnt", "sse4a", "tbm"
        );
        let features = WORDS.iter().flat_map(|word| word.features.iter().map(move |feature| (word, feature)));
        let read: Vec<_> =
            features.map(|(word, feature)| (feature.name, is_present(word, feature))).collect();
        assert_eq!(read, said);
    }

    #[test]
    fn this_machine_runs_what_runs_on_it() {
        assert!(check().is_ok());
    }

    #[test]
    fn leaves_beyond_the_last_are_empty() {
        for (leaf, subleaf) in [(0x7fff_ffff, 0), (0xffff_ffff, 0), (7, 0xffff)] {
            for register in [Register::Eax, Register::Ebx, Register::Ecx, Register::Edx] {
                assert_eq!(
                    read_word(&Word { leaf, subleaf, register, features: &[] }),
                    0,
                    "{leaf:x} {subleaf:x}"
                );
            }
        }
    }

    const fn feature(name: &'static str, is_used: bool, mask: u32, state: u64) -> Feature {
        Feature { name, is_used, mask, state }
    }

    /// A build that uses all but `unused`, with a made-up bit for each.
    const MADE_UP: [Word; 2] = [
        Word {
            leaf: 1,
            subleaf: 0,
            register: Register::Ecx,
            features: &[
                feature("sse3", true, 1, 0),
                feature("avx", true, 2, AVX),
                feature("unused", false, 4, 0),
            ],
        },
        Word {
            leaf: 7,
            subleaf: 0,
            register: Register::Ebx,
            features: &[feature("avx2", true, 1, AVX), feature("avx512f", true, 2, AVX512)],
        },
    ];

    #[track_caller]
    fn assert_says(check: &'static Check, expected: &str) {
        let said = check.run().map_or_else(|refusal| refusal.to_string(), |()| String::new());
        let advice = "\nbuild it here: cargo build --release\n\
                      or for every x86-64 machine: RUSTFLAGS=-Ctarget-cpu=x86-64 cargo build --release";
        let reasons = said.strip_prefix("this program was built for another machine than this:\n");
        assert_eq!(reasons.and_then(|said| said.strip_suffix(advice)).unwrap_or(&said), expected);
    }

    #[test]
    fn a_refusal_says_what_is_missing_and_whose_fault_it_is() {
        static ALL: Check = Check { words: &MADE_UP, read: |_| 3, xcr0: || 0b1110_0111 };
        assert_says(&ALL, "");
        static NOTHING: Check = Check { words: &MADE_UP, read: |_| 0, xcr0: || 0 };
        assert_says(&NOTHING, "the processor does not have sse3, avx, avx2, avx512f");
        static AVX_ONLY: Check =
            Check { words: &MADE_UP, read: |word| if word.leaf == 1 { 2 } else { 1 }, xcr0: || 0b111 };
        assert_says(&AVX_ONLY, "the processor does not have sse3, avx512f");
        static NO_STATE: Check = Check { words: &MADE_UP, read: |_| 3, xcr0: || 0 };
        assert_says(&NO_STATE, "the operating system does not enable avx, avx2, avx512f");
        static BOTH: Check =
            Check { words: &MADE_UP, read: |word| if word.leaf == 1 { 2 } else { 3 }, xcr0: || 0b10 };
        assert_says(
            &BOTH,
            "the processor does not have sse3\nthe operating system does not enable avx, avx2, avx512f",
        );
    }

    #[cfg(not(target_os = "macos"))]
    #[test]
    fn avx_512_needs_more_registers_than_avx() {
        static YMM_ONLY: Check = Check { words: &MADE_UP, read: |_| 3, xcr0: || 0b111 };
        assert_says(&YMM_ONLY, "the operating system does not enable avx512f");
        static NO_UPPER_ZMM: Check = Check { words: &MADE_UP, read: |_| 3, xcr0: || 0b0110_0111 };
        assert_says(&NO_UPPER_ZMM, "the operating system does not enable avx512f");
    }
}
