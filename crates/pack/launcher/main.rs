//! The launcher's main part, which unpacks the program and starts it.
//!
//! The launcher is the code in front of a packed program. It works without a C library and on any
//! x86-64 processor, since it runs before anything is known of either. Its first part, the opener,
//! has checked the file and decoded this one. This one checks the processor, decodes the program
//! into memory, checks that too, and executes it from a nameless file in memory with the original
//! arguments and environment. Where the system forbids that (`vm.memfd_noexec`), a private file in
//! `$XDG_RUNTIME_DIR` or `/tmp` serves, which loses its name before the program starts.

#![no_std]
#![no_main]

#[path = "../src/codec/mod.rs"]
#[allow(dead_code, reason = "each part of the launcher decodes with a part of it")]
mod codec;
#[allow(dead_code, reason = "each part of the launcher uses a part of it")]
mod system;

use codec::checksum::crc32;
use codec::format::{Header, NEEDS_AVX2};
use core::slice;
use system::*;

// The opener jumps to the first byte.
core::arch::global_asm!(
    ".section .text._start, \"ax\"",
    ".globl _start",
    "_start:",
    "jmp {start}",
    start = sym start,
);

/// Seconds that decoding may take, which is a second of work, on a machine as busy as can be.
const PATIENCE: usize = 60;

unsafe extern "C" fn start(stack: *const usize, header: &Header, payload: *const u8) -> ! {
    let name = &header.name;
    // SAFETY: the opener says that the payload begins there, and has checked its length.
    let payload = unsafe { slice::from_raw_parts(payload, header.payload as usize) };
    if header.flags & NEEDS_AVX2 != 0 && !has_avx2() {
        die(name, b": needs a processor with AVX2, and this one has none\n", 2);
    }

    alarm(PATIENCE);
    // SAFETY: fresh memory of that many bytes.
    let program =
        unsafe { slice::from_raw_parts_mut(memory(header.output as usize), header.output as usize) };
    unpack(header, payload, program);
    if crc32(program) != header.output_crc {
        die(name, DAMAGED, 3);
    }
    alarm(0);
    // SAFETY: what the system left on the stack, as told above.
    let (arguments, environment) = unsafe {
        let arguments = stack.add(1);
        (arguments, arguments.add(*stack + 1))
    };
    run_from_memory(program, arguments, environment);
    run_from_file(program, arguments, environment);
    die(name, b": can neither start from memory nor write to /tmp\n", 4)
}

/// Decodes the payload and undoes the filter.
fn unpack(header: &Header, payload: &[u8], program: &mut [u8]) {
    #[cfg(luc_method = "raw")]
    for (to, from) in program.iter_mut().zip(payload) {
        *to = *from;
    }
    #[cfg(luc_method = "lzma")]
    codec::lzma::decode(payload, program);
    #[cfg(luc_method = "cm")]
    {
        // SAFETY: fresh memory is zero, which is a valid model.
        let model = unsafe { &mut *memory(size_of::<codec::model::Model>()).cast() };
        codec::cm::decode(model, payload, program);
    }
    #[cfg(not(luc_method = "raw"))]
    if let Some(code) = program.get_mut(header.code_start as usize..header.code_end as usize) {
        let address = header.base.wrapping_add(header.code_start);
        codec::filter::filter(code, address, codec::filter::Direction::Unpack);
    }
    #[cfg(luc_method = "raw")]
    let _ = header;
}

/// Whether the processor has AVX2 and the system saves the wide registers.
fn has_avx2() -> bool {
    use core::arch::x86_64::__cpuid_count;
    const OSXSAVE: u32 = 1 << 27;
    const AVX2: u32 = 1 << 5;
    __cpuid_count(0, 0).eax >= 7
        && __cpuid_count(1, 0).ecx & OSXSAVE != 0
        && wide_registers_saved()
        && __cpuid_count(7, 0).ebx & AVX2 != 0
}
