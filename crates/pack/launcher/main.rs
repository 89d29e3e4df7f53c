//! The launcher: the code in front of a packed program, which unpacks and starts it.
//!
//! Without a C library and for any x86-64 processor, since it runs before anything is known of
//! either. It checks the file and the processor, decodes the program into memory, checks that
//! too, and executes it from a nameless file in memory with the original arguments and
//! environment. Where the system forbids that (`vm.memfd_noexec`), a private file in
//! `$XDG_RUNTIME_DIR` or `/tmp` serves, which loses its name before the program starts.
//!
//! A damaged file must end in a sentence and a code other than 0: the whole file is under a
//! checksum that is compared first, the decoders always end, and should damage in the few
//! instructions that compare it send them astray, the alarm clock ends the process.
//!
//! There is no panic in here: the handler below names a function that doesn't exist, so that the
//! link fails if one creeps in.

#![no_std]
#![no_main]

#[path = "../src/codec/mod.rs"]
#[allow(dead_code)]
mod codec;
mod system;

use codec::checksum::crc32;
use codec::format::{CHECKSUM, HEADER, Header, LOADED_AT, NEEDS_AVX2};
use core::slice;
use system::*;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    unsafe extern "C" {
        fn the_launcher_must_not_panic() -> !;
    }
    // SAFETY: never linked.
    unsafe { the_launcher_must_not_panic() }
}

// The system leaves the argument count at the stack pointer, the arguments and the environment
// above it; a call must find the stack aligned to 16, which it is at the start.
core::arch::global_asm!(
    ".section .text._start, \"ax\"",
    ".globl _start",
    "_start:",
    "mov rdi, rsp",
    "call {start}",
    start = sym start,
);

unsafe extern "C" {
    /// What follows the launcher: the header.
    static packed: Header;
}

const DAMAGED: &[u8] = b": damaged file\n";
/// Seconds after which a launcher that hasn't even looked at its file must be astray.
const PATIENCE: usize = 5;

unsafe extern "C" fn start(stack: *const usize) -> ! {
    alarm(PATIENCE);
    // SAFETY: the packer has put a header there.
    let header = unsafe { &packed };
    let name = header.name.split(|byte| *byte == 0).next().unwrap_or(&[]);
    // The payload's length must be believed before the checksum can be, so that of the whole file
    // is compared first.
    let payload_at = (&raw const packed).addr() + HEADER;
    let checksum_at = payload_at + header.payload as usize;
    let covered = checksum_at - LOADED_AT;
    if own_length().is_some_and(|length| length != covered + CHECKSUM) {
        die(name, DAMAGED, 3);
    }
    // SAFETY: the file is in memory as a whole, and that long.
    let (file, payload, checksum) = unsafe {
        (
            slice::from_raw_parts(LOADED_AT as *const u8, covered),
            slice::from_raw_parts(payload_at as *const u8, header.payload as usize),
            (checksum_at as *const u32).read_unaligned(),
        )
    };
    if crc32(file) != checksum {
        die(name, DAMAGED, 3);
    }
    if header.flags & NEEDS_AVX2 != 0 && !has_avx2() {
        die(name, b" needs a CPU with AVX2, and this one has none\n", 2);
    }

    // Decoding may take longer: on no machine of use a second for 16 kB.
    alarm(PATIENCE + (header.output as usize >> 14));
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

/// Says `name` and `sentence` on the standard error output and ends.
#[inline(never)]
fn die(name: &[u8], sentence: &[u8], code: usize) -> ! {
    write_all(2, name);
    write_all(2, sentence);
    exit(code)
}
