//! The opener: the part of the launcher that stands in the file as it is.
//!
//! It decodes the launcher's main part, checks it, and goes on there. It must be small, run on any
//! x86-64 processor, and do without a C library. (`main.rs` tells what the launcher does as a
//! whole.) The main part calls its functions too.
//!
//! A damaged file must end in a sentence and a code other than 0: what is decoded is under a
//! checksum each time, all decoders always end, and should damage in these few instructions send
//! them astray, a signal says the same or the alarm clock ends the process.

#![no_std]
#![no_main]

#[path = "../src/codec/mod.rs"]
#[allow(dead_code, reason = "each part of the launcher decodes with a part of it")]
mod codec;
mod system;

use codec::format::*;
use codec::interval::Decoder;
use codec::small;
use core::slice;
use system::*;

// The system leaves the argument count at the stack pointer, the arguments and the environment
// above it. A function expects the stack as a call leaves it; `start` follows.
core::arch::global_asm!(
    ".section .text._start, \"ax\"",
    ".globl _start",
    "_start:",
    "mov rdi, rsp",
    "push rax"
);

unsafe extern "C" {
    /// What follows the opener: the code.
    static behind: u8;
}

/// Seconds after which an opener that is still busy must be astray.
const PATIENCE: usize = 5;

/// What the system is told to do on a signal.
#[repr(C)]
struct Action {
    handler: extern "C" fn() -> !,
    flags: usize,
    restorer: usize,
    blocked: usize,
}

/// Where instructions that make no sense end.
extern "C" fn astray() -> ! {
    luc_die(DAMAGED, 3)
}

/// A word of the file's headers.
fn word(at: usize) -> usize {
    // SAFETY: the file is loaded there.
    unsafe { *((LOADED_AT + at) as *const u32) as usize }
}

#[unsafe(link_section = ".text.start")]
#[unsafe(no_mangle)]
unsafe extern "C" fn start(stack: *const usize) -> ! {
    call!(ALARM, PATIENCE);
    // Nothing returns from there, so there is nothing to restore; but the system insists on the flag.
    let action = Action { handler: astray, flags: SA_RESTORER, restorer: 0, blocked: 0 };
    for signal in SIGILL..=SIGSEGV {
        call!(RT_SIGACTION, signal, &raw const action, 0, SIGNALS);
    }
    if call!(MMAP, MAIN_AT, MEMORY, READ_WRITE_EXECUTE, PRIVATE_ANONYMOUS_FIXED, NO_FILE, 0) < 0 {
        luc_die(sentence(b": no memory\n\0"), 4);
    }
    let end = LOADED_AT + word(FILE_LENGTH_AT);
    // If the file is shorter than that, its last bytes aren't in memory: then this senseless call
    // complains about where its argument is.
    if call!(RT_SIGPROCMASK, SENSELESS, end - SIGNALS, 0, SIGNALS) == EFAULT {
        luc_die(DAMAGED, 3);
    }
    // SAFETY: the packer has put the code there, and the main part at its beginning, linked for
    // `MAIN_AT`. It begins with a function of that signature.
    unsafe {
        let code = (&raw const behind).addr();
        let mut decoder = Decoder::new(slice::from_raw_parts(code as *const u8, end - code));
        let main = slice::from_raw_parts_mut(MAIN_AT as *mut u8, word(MAIN_LENGTH_AT));
        small::decode(&mut *(CELLS_AT as *mut small::Cells), main, |one| luc_bit(&mut decoder, one));
        if luc_checksum(main.as_ptr(), main.len()) as usize != word(MAIN_CHECKSUM_AT) {
            luc_die(DAMAGED, 3);
        }
        let start: extern "C" fn(*const usize, &mut Decoder) -> ! = core::mem::transmute(MAIN_AT);
        start(stack, &mut decoder)
    }
}

/// The next bit, which is a one with the probability `one`, in 16 bits.
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn luc_bit(decoder: &mut Decoder, one: u32) -> u32 {
    decoder.bit(one)
}

/// The checksum of so many bytes.
///
/// # Safety
/// They must be there.
#[unsafe(no_mangle)]
#[inline(never)]
unsafe extern "C" fn luc_checksum(bytes: *const u8, length: usize) -> u32 {
    // SAFETY: the caller's.
    codec::checksum::checksum(unsafe { slice::from_raw_parts(bytes, length) })
}

/// Says the program's name and the sentence, which ends with a zero, and ends the process.
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn luc_die(sentence: Sentence, code: usize) -> ! {
    say(LOADED_AT + NAME_AT);
    say(sentence.as_ptr().addr());
    loop {
        call!(EXIT_GROUP, code);
    }
}

/// Writes a text that ends with a zero.
#[inline(never)]
fn say(text: usize) {
    let mut length = 0;
    // SAFETY: up to the zero.
    while unsafe { *((text + length) as *const u8) } != 0 {
        length += 1;
    }
    call!(WRITE, 2, text, length);
}
