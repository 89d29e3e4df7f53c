//! Whether this processor can run the build, asked before anything else runs.
//!
//! On x86-64 the program is compiled for AVX2; without it the first such instruction would kill the
//! process without a word. Even Rust's own start code is compiled that way, so the question comes before
//! it, from the list of functions that the system calls ahead of `main`. An entry point that is not
//! called by the system's start code must call `require` itself. `is_x86_feature_detected!` would be
//! answered at compile time here, so the processor is asked directly.

#[cfg(all(target_os = "linux", target_arch = "x86_64", target_feature = "avx2"))]
mod check {
    use std::arch::x86_64::{__cpuid, __cpuid_count, _xgetbv};

    unsafe extern "C" {
        fn write(file: i32, bytes: *const u8, count: usize) -> isize;
        fn _exit(code: i32) -> !;
    }

    #[used]
    #[unsafe(link_section = ".init_array")]
    static BEFORE_MAIN: extern "C" fn() = require;

    /// Ends the program with a sentence if the processor cannot run it. Nothing here may need more than
    /// the basics, so it calls only the C library.
    pub extern "C" fn require() {
        if !suffices() {
            let line = b"luc: this build needs a processor with AVX2; most made since 2015 have it\n";
            // SAFETY: plain calls with a live buffer.
            unsafe {
                write(2, line.as_ptr(), line.len());
                _exit(2)
            }
        }
    }

    /// True if AVX2 is there and the system saves the wide registers.
    fn suffices() -> bool {
        const OSXSAVE: u32 = 1 << 27;
        const AVX2: u32 = 1 << 5;
        const XMM_AND_YMM: u64 = 6;
        #[target_feature(enable = "xsave")]
        fn saved_registers() -> u64 {
            // SAFETY: register 0 always exists where the instruction does.
            unsafe { _xgetbv(0) }
        }
        __cpuid(0).eax >= 7
            && __cpuid(1).ecx & OSXSAVE != 0
            && __cpuid_count(7, 0).ebx & AVX2 != 0
            // SAFETY: OSXSAVE says that the instruction exists.
            && unsafe { saved_registers() } & XMM_AND_YMM == XMM_AND_YMM
    }
}
