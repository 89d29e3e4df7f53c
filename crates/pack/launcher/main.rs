//! The launcher's main part, which unpacks the program and starts it.
//!
//! The launcher is the code in front of a packed program. It works without a C library and on any
//! x86-64 processor, since it runs before anything is known of either. Its first part, the opener,
//! has decoded this one. This one checks the processor, decodes the program into memory, checks
//! that too, and executes it from a nameless file in memory with the original arguments and
//! environment. Where the system forbids that (`vm.memfd_noexec`), a private file in
//! `$XDG_RUNTIME_DIR` or `/tmp` serves, which loses its name before the program starts.

#![no_std]
#![no_main]

#[path = "../src/codec/mod.rs"]
#[allow(dead_code, reason = "each part of the launcher decodes with a part of it")]
mod codec;
mod system;

use codec::format::*;
use codec::interval::Decoder;
use core::slice;
use system::*;

// Functions of the opener.
unsafe extern "C" {
    safe fn luc_bit(decoder: &mut Decoder, one: u32) -> u32;
    safe fn luc_die(sentence: Sentence, code: usize) -> !;
    fn luc_checksum(bytes: *const u8, length: usize) -> u32;
    /// What follows the main part.
    static behind: Header;
}

/// Seconds that decoding may take, which is a second of work, on a machine as busy as can be.
const PATIENCE: usize = 60;

#[unsafe(link_section = ".text._start")]
#[unsafe(no_mangle)]
unsafe extern "C" fn _start(stack: *const usize, decoder: &mut Decoder<'static>) -> ! {
    // SAFETY: the packer has put a header there, and the opener has checked it.
    let header = unsafe { &behind };
    if (cfg!(target_feature = "avx2") || header.flags & NEEDS_AVX2 != 0) && !has_avx2() {
        luc_die(sentence(b": needs a processor with AVX2, and this one has none\n\0"), 2);
    }
    call!(ALARM, PATIENCE);
    // SAFETY: the opener has mapped memory there, all zeros behind the header.
    let (program, checksum) = unsafe {
        let known = (&raw const behind).addr() + size_of::<Header>() - MAIN_AT;
        let memory = slice::from_raw_parts_mut(MAIN_AT as *mut u8, known + header.length as usize);
        decode(decoder, memory, known);
        let program = slice::from_raw_parts_mut((MAIN_AT + known) as *mut u8, header.length as usize);
        #[cfg(not(luc_method = "raw"))]
        if let Some(code) = program.get_mut(header.code_start as usize..header.code_end as usize) {
            let address = header.base.wrapping_add(header.code_start);
            let walker = &mut *(WALKER_AT as *mut codec::x86::Walker);
            codec::filter::filter_with(walker, code, address, codec::filter::Direction::Unpack);
        }
        (&*program, luc_checksum(program.as_ptr(), program.len()))
    };
    if checksum != header.checksum {
        luc_die(DAMAGED, 3);
    }
    call!(ALARM, 0);
    run(program, stack);
    luc_die(sentence(b": can neither start from memory nor write to /tmp\n\0"), 4)
}

/// Decodes the program into `memory`, where the first `known` bytes are the launcher's main part.
fn decode(decoder: &mut Decoder<'static>, memory: &mut [u8], known: usize) {
    #[cfg(luc_method = "cm")]
    {
        use codec::model::Model;
        call!(MADVISE, MODEL_AT, size_of::<Model>(), HUGE_PAGES);
        // SAFETY: the opener has mapped memory there, all zeros, which is a valid model.
        let model = unsafe { &mut *(MODEL_AT as *mut Model) };
        codec::cm::decode(model, memory, known, |one| luc_bit(decoder, one));
    }
    #[cfg(not(luc_method = "cm"))]
    if let Some(program) = memory.get_mut(known..) {
        let input = decoder.rest();
        #[cfg(luc_method = "lzma")]
        codec::lzma::decode(input, program);
        #[cfg(luc_method = "raw")]
        for (to, from) in program.iter_mut().zip(input) {
            *to = *from;
        }
    }
}

/// Whether the processor has AVX2 and the system saves the wide registers.
fn has_avx2() -> bool {
    use core::arch::x86_64::__cpuid_count;
    const OSXSAVE_AND_AVX: u32 = 3 << 27;
    const AVX2: u32 = 1 << 5;
    // Whatever has AVX knows the question 7.
    __cpuid_count(1, 0).ecx & OSXSAVE_AND_AVX == OSXSAVE_AND_AVX
        && wide_registers_saved()
        && __cpuid_count(7, 0).ebx & AVX2 != 0
}

/// Whether the system has switched on the registers of AVX; only after `cpuid` tells OSXSAVE.
fn wide_registers_saved() -> bool {
    let enabled: u32;
    // SAFETY: reads register 0, which exists with OSXSAVE.
    unsafe { core::arch::asm!("xgetbv", in("ecx") 0, out("eax") enabled, out("edx") _) };
    enabled & 0b110 == 0b110
}

/// Starts the program from a file in memory or else from a private file; only returns if neither
/// is possible. `stack` is what the system left there: the argument count, the arguments, a null,
/// the environment, a null.
fn run(program: &[u8], stack: *const usize) {
    let path = |text: &'static core::ffi::CStr| text.as_ptr().addr();
    // SAFETY: as told above; a text of the environment may be compared up to its first difference,
    // so at the latest at its zero.
    let (arguments, environment, directory) = unsafe {
        let arguments = stack.add(1);
        let environment = arguments.add(*stack + 1);
        let mut directory = 0;
        let mut variable = environment;
        while *variable != 0 {
            let text = *variable as *const u8;
            let wanted = b"XDG_RUNTIME_DIR=";
            if wanted.iter().enumerate().all(|(i, byte)| *text.add(i) == *byte) {
                directory = text.addr() + wanted.len();
            }
            variable = variable.add(1);
        }
        (arguments.addr(), environment.addr(), directory)
    };
    let write = |file: isize| call!(WRITE, file, program.as_ptr(), program.len()) == program.len() as isize;
    let execute = |file: isize| call!(EXECVEAT, file, path(c""), arguments, environment, AT_EMPTY_PATH);
    let file = call!(MEMFD_CREATE, path(c"luc"), MFD_CLOEXEC);
    if write(file) {
        execute(file);
    }
    // Sixteen letters that no one else has, and a zero.
    // SAFETY: has no memory operands.
    let time = unsafe { core::arch::x86_64::_rdtsc() };
    let name = [time & LOW_BITS | LETTERS, time >> 4 & LOW_BITS | LETTERS, 0];
    const LOW_BITS: u64 = 0x0f0f_0f0f_0f0f_0f0f;
    const LETTERS: u64 = 0x6060_6060_6060_6060;
    let name = (&raw const name).addr();
    for directory in [directory, path(c"/tmp")] {
        // The file is new, nobody else may touch it, and it is closed for writing, as the system
        // demands, and nameless before the program starts.
        let directory = call!(OPENAT, 0, directory, O_DIRECTORY | O_CLOEXEC);
        let file = call!(OPENAT, directory, name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0o700);
        let complete = write(file);
        call!(CLOSE, file);
        let file = call!(OPENAT, directory, name, O_CLOEXEC);
        call!(UNLINKAT, directory, name, 0);
        if complete {
            execute(file);
        }
    }
}
