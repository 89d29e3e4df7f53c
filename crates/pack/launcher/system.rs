//! What both parts of the launcher ask of Linux, and what compilers expect to find.
//!
//! There is no panic in here: the handler below names a function that doesn't exist, so that the
//! link fails if one creeps in.
#![allow(dead_code, reason = "each part of the launcher uses a part of it")]

// Numbers of system calls on x86-64.
pub const WRITE: usize = 1;
pub const CLOSE: usize = 3;
pub const MMAP: usize = 9;
pub const RT_SIGACTION: usize = 13;
pub const RT_SIGPROCMASK: usize = 14;
pub const MADVISE: usize = 28;
pub const ALARM: usize = 37;
pub const EXIT_GROUP: usize = 231;
pub const OPENAT: usize = 257;
pub const UNLINKAT: usize = 263;
pub const MEMFD_CREATE: usize = 319;
pub const EXECVEAT: usize = 322;

pub const O_WRONLY: usize = 0o1;
pub const O_CREAT: usize = 0o100;
pub const O_EXCL: usize = 0o200;
pub const O_DIRECTORY: usize = 0o200000;
pub const O_CLOEXEC: usize = 0o2000000;
pub const MFD_CLOEXEC: usize = 1;
pub const AT_EMPTY_PATH: usize = 0x1000;
/// Memory in large pages, which are found faster, if the system has some.
pub const HUGE_PAGES: usize = 14;

pub const READ_WRITE_EXECUTE: usize = 7;
/// Not in the way of what is there already; and the system needn't have all of it at hand.
pub const PRIVATE_ANONYMOUS_FIXED: usize = 0x10_4022;
pub const NO_FILE: usize = usize::MAX;
/// Bytes of a set of signals, and something that can't be done with one.
pub const SIGNALS: usize = 8;
/// The signals of instructions that lead nowhere are among these, all of which end a process anyway.
pub const SIGILL: usize = 4;
pub const SIGSEGV: usize = 11;
pub const SA_RESTORER: usize = 0x400_0000;
pub const SENSELESS: usize = 99;

/// A pointer that leads nowhere.
pub const EFAULT: isize = -14;

/// A text that ends with a zero.
pub type Sentence = &'static [u8; 1];

/// The sentence for a damaged file.
pub const DAMAGED: Sentence = sentence(b": damaged file\n\0");

/// The text, without its length.
pub const fn sentence(text: &'static [u8]) -> Sentence {
    // SAFETY: texts have at least one byte.
    unsafe { &*text.as_ptr().cast() }
}

/// A system call with up to six arguments; results from -4095 to -1 are errors. In line, so that
/// only registers that matter are set.
#[macro_export]
macro_rules! call {
    ($number:expr, $a:expr $(, $b:expr $(, $c:expr $(, $d:expr $(, $e:expr $(, $f:expr)?)?)?)?)?) => {{
        let result: isize;
        // SAFETY: as safe as what the system does with these arguments, which are as Linux calls
        // for. By its calling convention rcx and r11 are lost.
        #[allow(unused_unsafe, reason = "some are in unsafe blocks")]
        unsafe {
            core::arch::asm!("syscall", inlateout("rax") $number => result, in("rdi") $a
                $(, in("rsi") $b $(, in("rdx") $c $(, in("r10") $d $(, in("r8") $e $(, in("r9") $f)?)?)?)?)?,
                lateout("rcx") _, lateout("r11") _);
        }
        result
    }};
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
    unsafe {
        core::arch::asm!("rep movsb", inout("rdi") to => _, inout("rsi") from => _, inout("rcx") length => _)
    };
    to
}

/// What the compiler calls to fill memory.
///
/// # Safety
/// As C's `memset`.
#[unsafe(no_mangle)]
unsafe extern "C" fn memset(to: *mut u8, value: i32, length: usize) -> *mut u8 {
    // SAFETY: the caller's.
    unsafe {
        core::arch::asm!("rep stosb", inout("rdi") to => _, in("al") value as u8, inout("rcx") length => _)
    };
    to
}
