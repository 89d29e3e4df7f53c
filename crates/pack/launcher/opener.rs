//! The opener: the part of the launcher that stands in the file as it is.
//!
//! It checks the file, decodes the launcher's main part, and goes on there. It must be small, run
//! on any x86-64 processor, and do without a C library. (`main.rs` tells what the launcher does as
//! a whole.)
//!
//! A damaged file must end in a sentence and a code other than 0: the whole file is under a
//! checksum that is compared first, all decoders always end, and should damage in the few
//! instructions that compare it send them astray, the alarm clock ends the process.

#![no_std]
#![no_main]

#[path = "../src/codec/mod.rs"]
#[allow(dead_code, reason = "each part of the launcher decodes with a part of it")]
mod codec;
#[allow(dead_code, reason = "each part of the launcher uses a part of it")]
mod system;

use codec::checksum::crc32;
use codec::format::{CHECKSUM, HEADER, Header, LOADED_AT, MAIN_AT};
use codec::small;
use core::slice;
use system::*;

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
    /// What follows the opener: the header.
    static packed: Header;
}

/// Seconds after which an opener that is still busy must be astray.
const PATIENCE: usize = 5;

unsafe extern "C" fn start(stack: *const usize) -> ! {
    alarm(PATIENCE);
    // SAFETY: the packer has put a header there.
    let header = unsafe { &packed };
    // The two lengths must be believed before the checksum can be, so that of the whole file is
    // compared first.
    let main_at = (&raw const packed).addr() + HEADER;
    let checksum_at = main_at + header.main_coded as usize + header.payload as usize;
    let covered = checksum_at - LOADED_AT;
    if own_length().is_some_and(|length| length != covered + CHECKSUM) {
        die(&header.name, DAMAGED, 3);
    }
    // SAFETY: the file is in memory as a whole, and that long.
    let (file, coded, checksum) = unsafe {
        (
            slice::from_raw_parts(LOADED_AT as *const u8, covered),
            slice::from_raw_parts(main_at as *const u8, header.main_coded as usize),
            (checksum_at as *const u32).read_unaligned(),
        )
    };
    if crc32(file) != checksum {
        die(&header.name, DAMAGED, 3);
    }
    let length = header.main as usize;
    // SAFETY: nothing else lies at `MAIN_AT`; fresh memory is zero, as cells have to be. What is
    // decoded there is the main part, linked for that place, which begins with a function of that
    // signature.
    unsafe {
        let main = slice::from_raw_parts_mut(memory_at(MAIN_AT, length), length);
        small::decode(&mut *memory(size_of::<small::Cells>()).cast(), coded, main);
        make_executable(MAIN_AT, length);
        let start: extern "C" fn(*const usize, *const Header, *const u8) -> ! = core::mem::transmute(MAIN_AT);
        start(stack, header, main_at.wrapping_add(coded.len()) as *const u8)
    }
}
