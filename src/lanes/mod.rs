//! The only room that knows the processor's instruction sets.

#[cfg(target_arch = "x86_64")]
pub(crate) mod cpu;
mod isa;

pub use isa::Isa;

/// Says why this machine cannot run this build, if it cannot. This is known of x86-64 alone.
#[inline(never)]
pub(crate) fn check_machine() -> Result<(), impl std::fmt::Display> {
    #[cfg(target_arch = "x86_64")]
    return cpu::check();
    #[cfg(not(target_arch = "x86_64"))]
    Ok::<(), std::convert::Infallible>(())
}
