//! Large allocations on huge pages (of 2 MiB where others are of 4 KiB), which Linux gives to who asks for them.
//!
//! A picture of 2048 × 2048 is 12,288 pages of 4 KiB otherwise, each of which is fetched from the system when it is first touched,
//! and a hierarchy's lines are looked up in tables that the processor has no room for.
#![expect(unsafe_code, reason = "an allocator is, and so is advice about memory")]

use std::alloc::{GlobalAlloc, Layout, System};

/// The system's allocator, which is asked for huge pages under what is large.
pub(crate) struct HugePages;

/// From here on a page of 2 MiB lies within, wherever the allocation begins.
const LARGE: usize = 4 << 20;

// SAFETY: all is done by `System`; advice changes no byte of what it returns.
unsafe impl GlobalAlloc for HugePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promises are those that `System` asks for.
        advised(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        advised(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        advised(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Asks for huge pages under an allocation that is large.
#[inline]
fn advised(memory: *mut u8, size: usize) -> *mut u8 {
    if size >= LARGE && !memory.is_null() {
        advise(memory, size);
    }
    memory
}

/// A system that has no such pages says so, which does no harm.
#[cold]
fn advise(memory: *mut u8, size: usize) {
    /// Some whole pages, of whatever size a system's small pages are.
    const PAGE: usize = 1 << 16;
    let before = memory.align_offset(PAGE);
    let length = (size - before) / PAGE * PAGE;
    // SAFETY: the range lies within one allocation, and this advice leaves its contents as they are.
    unsafe { libc::madvise(memory.wrapping_add(before).cast(), length, libc::MADV_HUGEPAGE) };
}
