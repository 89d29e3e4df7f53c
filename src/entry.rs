//! How the program starts, in both builds.
//!
//! The whole program is compiled for AVX2, so the processor is asked first, by `cpuid` (does it
//! have AVX2?) and `xgetbv` (does the system save the wide registers?), by code that needs neither.
//! The standard macro `is_x86_feature_detected!` is no help: in a build that assumes AVX2 it is the
//! constant `true`.
//!
//! In the ordinary build the question is an initializer, which the C library calls before `main`:
//! even Rust's own start code, once inlined into `main`, has AVX instructions in it.
//!
//! The size build (`cfg(luc_size)`, made by `cargo pack`) has neither glibc's start code nor
//! Rust's, which cost 1 to 2 kB: the system jumps to `_start`, which calls
//! [`player::run`](crate::player::run) with the arguments, and leaves by C's `exit`. Rust's standard library
//! is not told of the arguments, which nobody asks it for, and nothing flushes its standard output: the
//! player writes without its buffer.

#![cfg(all(target_arch = "x86_64", unix))]

use core::arch::x86_64::{__cpuid_count, _xgetbv};

/// What a processor without AVX2 is told. The launcher of the packed file says the same.
const NEEDS_AVX2: &str = "luc: needs a processor with AVX2, and this one has none\n";

unsafe extern "C" {
    fn write(file: i32, bytes: *const u8, length: usize) -> isize;
    safe fn exit(code: i32) -> !;
}

#[cfg(not(luc_size))]
#[used]
#[cfg_attr(target_vendor = "apple", unsafe(link_section = "__DATA,__mod_init_func"))]
#[cfg_attr(not(target_vendor = "apple"), unsafe(link_section = ".init_array"))]
static BEFORE_MAIN: extern "C" fn() = require_avx2;

/// Ends the program with a sentence, exit code 2, if the processor or the system lacks AVX2.
///
/// It calls C itself and is never inlined, so that no AVX instruction can slip in.
#[inline(never)]
extern "C" fn require_avx2() {
    /// The part of the wide-register check that may run only where `xgetbv` exists.
    #[target_feature(enable = "xsave")]
    fn wide_registers_saved() -> bool {
        // SAFETY: the caller has seen OSXSAVE, so `xgetbv` exists and register 0 may be read.
        unsafe { _xgetbv(0) & 0b110 == 0b110 }
    }

    const OSXSAVE: u32 = 1 << 27;
    const AVX2: u32 = 1 << 5;
    let avx2 = __cpuid_count(0, 0).eax >= 7
        && __cpuid_count(1, 0).ecx & OSXSAVE != 0
        // SAFETY: OSXSAVE says that the system has switched on the `xsave` family.
        && unsafe { wide_registers_saved() }
        && __cpuid_count(7, 0).ebx & AVX2 != 0;
    if !avx2 {
        // SAFETY: the pointer and the length are those of one string.
        unsafe {
            write(2, NEEDS_AVX2.as_ptr(), NEEDS_AVX2.len());
            exit(2)
        }
    }
}

#[cfg(luc_size)]
mod size {
    //! Start of the size build: Linux on x86-64.

    use super::{exit, require_avx2};
    use crate::player;
    use std::alloc::{GlobalAlloc, Layout};
    use std::ffi::{CStr, OsStr};
    use std::os::unix::ffi::OsStrExt;

    // The system leaves the argument count at the stack pointer, and the arguments above it. The
    // stack is aligned to 16 here, and a call must find it so.
    core::arch::global_asm!(
        ".globl _start",
        "_start:",
        "xor ebp, ebp",
        "mov rdi, rsp",
        "call {start}",
        start = sym start,
    );

    unsafe extern "C" {
        fn aligned_alloc(alignment: usize, size: usize) -> *mut u8;
        fn free(memory: *mut u8);
        fn signal(number: i32, action: usize) -> usize;
    }

    /// The C library's memory, by one function for any alignment: the standard library's own way there
    /// takes four.
    struct Memory;

    // SAFETY: `aligned_alloc` gives memory of that size and alignment, and `free` takes all that it gave.
    unsafe impl GlobalAlloc for Memory {
        unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
            // SAFETY: an alignment is a power of two.
            unsafe { aligned_alloc(layout.align(), layout.size()) }
        }

        unsafe fn dealloc(&self, memory: *mut u8, _: Layout) {
            // SAFETY: the caller has it from `alloc`.
            unsafe { free(memory) }
        }
    }

    #[global_allocator]
    static MEMORY: Memory = Memory;

    /// A write to a closed pipe is an error to report, as Rust's own start code has it.
    const SIGPIPE: i32 = 13;
    const SIG_IGN: usize = 1;

    unsafe extern "C" fn start(stack: *const usize) -> ! {
        require_avx2();
        // SAFETY: the stack holds the count, that many arguments, a null, the environment, a null.
        unsafe {
            let count = *stack;
            let arguments = stack.add(1).cast::<*const i8>();
            signal(SIGPIPE, SIG_IGN);
            let text = |i: usize| OsStr::from_bytes(CStr::from_ptr(*arguments.add(i)).to_bytes());
            exit(player::run(&(1..count).map(text).collect::<Vec<_>>()))
        }
    }
}
