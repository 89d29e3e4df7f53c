//! What the launcher asks of Linux, by bare system calls, and what compilers expect to find.
//!
//! There is no panic in here: the handler below names a function that doesn't exist, so that the
//! link fails if one creeps in.

use core::arch::asm;
use core::ptr::null;

// Numbers of system calls on x86-64.
const OPEN: usize = 2;
const WRITE: usize = 1;
const CLOSE: usize = 3;
const LSEEK: usize = 8;
const MMAP: usize = 9;
const MPROTECT: usize = 10;
const MADVISE: usize = 28;
const ALARM: usize = 37;
const UNLINK: usize = 87;
const EXIT_GROUP: usize = 231;
const MEMFD_CREATE: usize = 319;
const EXECVEAT: usize = 322;

const O_WRONLY: usize = 0o1;
const O_CREAT: usize = 0o100;
const O_EXCL: usize = 0o200;
const O_CLOEXEC: usize = 0o2000000;
const MFD_CLOEXEC: usize = 1;
/// Linux 6.3 and later: this memory is meant to be executed.
const MFD_EXEC: usize = 0x10;
const AT_EMPTY_PATH: usize = 0x1000;

/// A system call; results from -4095 to -1 are errors.
///
/// # Safety
/// As safe as what the system does with these arguments.
#[inline(never)]
unsafe fn call(number: usize, a: usize, b: usize, c: usize, d: usize, e: usize) -> isize {
    let result;
    // SAFETY: the calling convention of Linux: six arguments, rcx and r11 are lost. The sixth
    // matters to `mmap` alone, which gets no file and so no offset.
    unsafe {
        asm!("syscall", inlateout("rax") number => result, in("rdi") a, in("rsi") b, in("rdx") c,
            in("r10") d, in("r8") e, in("r9") 0usize, lateout("rcx") _, lateout("r11") _);
    }
    result
}

/// Ends the process by a signal in so many seconds; 0 calls that off.
pub fn alarm(seconds: usize) {
    // SAFETY: touches no memory.
    unsafe { call(ALARM, seconds, 0, 0, 0, 0) };
}

/// Ends the process.
pub fn exit(code: usize) -> ! {
    loop {
        // SAFETY: touches no memory.
        unsafe { call(EXIT_GROUP, code, 0, 0, 0, 0) };
    }
}

/// Writes all of `bytes`; whether that worked.
pub fn write_all(file: usize, mut bytes: &[u8]) -> bool {
    while !bytes.is_empty() {
        // SAFETY: the system only reads `bytes`.
        let written = unsafe { call(WRITE, file, bytes.as_ptr().addr(), bytes.len(), 0, 0) };
        if written <= 0 {
            return false;
        }
        bytes = bytes.get(written as usize..).unwrap_or(&[]);
    }
    true
}

/// Says the program's name, without the zeros behind it, and the sentence, and ends the process.
#[inline(never)]
pub fn die(name: &[u8], sentence: &[u8], code: usize) -> ! {
    for byte in name {
        if *byte != 0 {
            write_all(2, core::slice::from_ref(byte));
        }
    }
    write_all(2, sentence);
    exit(code)
}

/// The sentence for a damaged file.
pub const DAMAGED: &[u8] = b": damaged file\n";

/// Fresh memory, all zeros; ends the process if there is none.
pub fn memory(length: usize) -> *mut u8 {
    memory_at(0, length)
}

/// Fresh memory, all zeros, near `address` if that isn't 0; at it, if the place is free.
#[inline(never)]
pub fn memory_at(address: usize, length: usize) -> *mut u8 {
    const READ_WRITE: usize = 3;
    const PRIVATE_ANONYMOUS: usize = 0x22;
    const NO_FILE: usize = usize::MAX;
    const HUGE_PAGES: usize = 14;
    // At least a byte, since the system refuses to map nothing.
    // SAFETY: the system never takes a place that is in use.
    let found = unsafe { call(MMAP, address, length + 1, READ_WRITE, PRIVATE_ANONYMOUS, NO_FILE) };
    if found < 0 {
        die(b"", b"not enough memory\n", 4);
    }
    // In large pages, which are found faster, if the system has some.
    // SAFETY: changes nothing that the program can see.
    unsafe { call(MADVISE, found as usize, length, HUGE_PAGES, 0, 0) };
    found as *mut u8
}

/// Lets the processor execute what is in memory, and nobody change it any more.
///
/// # Safety
/// Nothing else may lie in these pages.
pub unsafe fn make_executable(address: usize, length: usize) {
    const READ_EXECUTE: usize = 5;
    // SAFETY: the caller's.
    unsafe { call(MPROTECT, address, length, READ_EXECUTE, 0, 0) };
}

/// The length of the file that this launcher begins, if the system tells. The file stays open
/// until the program starts.
pub fn own_length() -> Option<usize> {
    const END: usize = 2;
    // SAFETY: the path ends with a zero; no memory is written.
    let length = unsafe {
        let file = call(OPEN, c"/proc/self/exe".as_ptr().addr(), O_CLOEXEC, 0, 0, 0);
        call(LSEEK, file as usize, 0, END, 0, 0)
    };
    usize::try_from(length).ok()
}

/// Whether the system has switched on the registers of AVX; only after `cpuid` tells OSXSAVE.
pub fn wide_registers_saved() -> bool {
    let enabled: u32;
    // SAFETY: reads register 0, which exists with OSXSAVE.
    unsafe { asm!("xgetbv", in("ecx") 0, out("eax") enabled, out("edx") _) };
    enabled & 0b110 == 0b110
}

/// Starts the program that is in `file`; only returns if that is impossible.
fn execute(file: usize, arguments: *const usize, environment: *const usize) {
    // SAFETY: the lists are those of this process.
    unsafe { call(EXECVEAT, file, c"".as_ptr().addr(), arguments.addr(), environment.addr(), AT_EMPTY_PATH) };
}

/// Starts the program from a file in memory; only returns if that is impossible.
pub fn run_from_memory(program: &[u8], arguments: *const usize, environment: *const usize) {
    for flags in [MFD_CLOEXEC | MFD_EXEC, MFD_CLOEXEC] {
        // SAFETY: the name ends with a zero.
        let file = unsafe { call(MEMFD_CREATE, c"luc".as_ptr().addr(), flags, 0, 0, 0) };
        if file >= 0 && write_all(file as usize, program) {
            execute(file as usize, arguments, environment);
        }
    }
}

/// Starts the program from a private file; only returns if that is impossible.
pub fn run_from_file(program: &[u8], arguments: *const usize, environment: *const usize) {
    const LONGEST: usize = 256;
    let mut directory: *const u8 = null();
    let mut variable = environment;
    // SAFETY: the environment is a list of pointers to strings that end with zeros, and ends with
    // a null pointer; comparing stops at the first difference, so at the latest at the zero.
    unsafe {
        while *variable != 0 {
            let text = *variable as *const u8;
            let wanted = b"XDG_RUNTIME_DIR=";
            if wanted.iter().enumerate().all(|(i, byte)| *text.add(i) == *byte) {
                directory = text.add(wanted.len());
            }
            variable = variable.add(1);
        }
    }
    // SAFETY: has no memory operands.
    let number = unsafe { core::arch::x86_64::_rdtsc() };
    for directory in [directory, c"/tmp".as_ptr().cast()] {
        if directory.is_null() {
            continue;
        }
        let mut path = [0u8; LONGEST];
        let mut end = 0;
        // The directory, a slash and a number that no one else has: together shorter than `path`,
        // whose last byte stays 0.
        while end < LONGEST - 32 {
            // SAFETY: the directory is a string that ends with a zero, behind which nothing is read.
            path[end] = unsafe { *directory.add(end) };
            if path[end] == 0 {
                break;
            }
            end += 1;
        }
        for (i, place) in path[end..].iter_mut().take(18).enumerate() {
            *place = match i {
                0 => b'/',
                1 => b'.',
                _ => b'a' + (number >> (4 * (i - 2)) & 15) as u8,
            };
        }
        let path = path.as_ptr().addr();
        // SAFETY: the path ends with a zero. The file is new, nobody else may touch it, and it is
        // closed for writing, as the system demands, and nameless before the program starts.
        unsafe {
            let file = call(OPEN, path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0o700, 0, 0);
            if file < 0 {
                continue;
            }
            let complete = write_all(file as usize, program);
            call(CLOSE, file as usize, 0, 0, 0, 0);
            let file = call(OPEN, path, O_CLOEXEC, 0, 0, 0);
            call(UNLINK, path, 0, 0, 0, 0);
            if complete && file >= 0 {
                execute(file as usize, arguments, environment);
            }
        }
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    unsafe extern "C" {
        fn the_launcher_must_not_panic() -> !;
    }
    // SAFETY: never linked.
    unsafe { the_launcher_must_not_panic() }
}

/// What the compiler calls to copy memory.
///
/// # Safety
/// As C's `memcpy`.
#[unsafe(no_mangle)]
unsafe extern "C" fn memcpy(to: *mut u8, from: *const u8, length: usize) -> *mut u8 {
    // SAFETY: the caller's.
    unsafe { asm!("rep movsb", inout("rdi") to => _, inout("rsi") from => _, inout("rcx") length => _) };
    to
}

/// What the compiler calls to fill memory.
///
/// # Safety
/// As C's `memset`.
#[unsafe(no_mangle)]
unsafe extern "C" fn memset(to: *mut u8, value: i32, length: usize) -> *mut u8 {
    // SAFETY: the caller's.
    unsafe { asm!("rep stosb", inout("rdi") to => _, in("al") value as u8, inout("rcx") length => _) };
    to
}
