//! The monotonic clock, in whole nanoseconds, and waiting.
//!
//! On Unix by the C library's functions: the standard library's instants and durations, each of two numbers,
//! would cost the packed file 200 bytes.

/// Nanoseconds in a second.
pub const SECOND: u64 = 1_000_000_000;
/// Nanoseconds in a millisecond.
pub const MILLISECOND: u64 = 1_000_000;

/// Nanoseconds since a moment that stays the same while the program runs.
#[cfg(unix)]
pub fn now() -> u64 {
    // SAFETY: two numbers, for which zero is a valid value.
    let mut time: libc::timespec = unsafe { std::mem::zeroed() };
    // SAFETY: there is room for the answer.
    unsafe { libc::clock_gettime(libc::CLOCK_MONOTONIC, &mut time) };
    time.tv_sec as u64 * SECOND + time.tv_nsec as u64
}

/// Waits for so many nanoseconds or a little longer; less than a second.
#[cfg(unix)]
pub fn sleep(nanoseconds: u64) {
    // SAFETY: it takes any number below a million.
    unsafe { libc::usleep((nanoseconds / 1000 + 1) as u32) };
}

#[cfg(not(unix))]
pub fn now() -> u64 {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed().as_nanos() as u64
}

#[cfg(not(unix))]
pub fn sleep(nanoseconds: u64) {
    std::thread::sleep(std::time::Duration::from_nanos(nanoseconds));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waiting_takes_at_least_as_long_as_asked() {
        for nanoseconds in [0, 1, 999, 1000, MILLISECOND, 3 * MILLISECOND + 1] {
            let before = now();
            sleep(nanoseconds);
            assert!(now() - before >= nanoseconds, "{nanoseconds}");
        }
    }
}
