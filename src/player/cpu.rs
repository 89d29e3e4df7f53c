//! Whether this processor can run the build, asked before anything else runs.
//!
//! On x86-64 the program is compiled for AVX2; without it the first such instruction would kill the
//! process without a word. `is_x86_feature_detected!` would be answered at compile time here, so the
//! processor is asked directly.

use std::io::Write;

/// Tells the user and gives the exit code, by means of nothing that this build compiles itself.
#[cold]
pub fn refuse() -> i32 {
    let line = b"luc: this build needs a processor with AVX2; most made since 2015 have it\n";
    let _ = std::io::stderr().write_all(line);
    super::REFUSED
}

/// True if every instruction the build uses is there and the system saves the wide registers.
#[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
#[inline(never)]
pub fn suffices() -> bool {
    use std::arch::x86_64::{__cpuid, __cpuid_count, _xgetbv};
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

/// Nothing beyond the architecture's basics is used.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
pub fn suffices() -> bool {
    true
}
