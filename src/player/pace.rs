//! What time it is in the show: by the sound card where there is one, by the monotonic clock elsewhere.
//!
//! Between two looks at the card time goes on by the monotonic clock: the sound tells when its first sample
//! was heard, or would have been, if all had been played at the pace of now. Small corrections
//! come in slowly, because cards tell their position in steps.

use super::time::{SECOND, now};
use luc_core::synth::RATE;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

/// Corrections beyond this come at once: the card stood still.
const STEP: i64 = 40_000_000; // nanoseconds
/// The others by this share.
const SHARE: i64 = 16;
const UNKNOWN: u64 = 1 << 63;

/// The show's time, shared by those who tell it and those who ask.
pub struct Pace {
    /// When the show's time was 0, by [`now`].
    origin: AtomicU64,
    /// Nobody will tell.
    silent: AtomicBool,
}

impl Pace {
    /// Time has not begun, and nobody tells it.
    pub fn new() -> Self {
        Pace { origin: AtomicU64::new(UNKNOWN), silent: AtomicBool::new(true) }
    }

    /// Whether nobody tells the time from now on.
    pub fn set_silent(&self, silent: bool) {
        self.silent.store(silent, Relaxed);
    }

    /// Nanoseconds since the show began; none until the card has begun. Without sound it begins with the first
    /// question.
    pub fn elapsed(&self) -> Option<u64> {
        let now = now();
        if self.silent.load(Relaxed) {
            let _ = self.origin.compare_exchange(UNKNOWN, now, Relaxed, Relaxed);
        }
        let origin = self.origin.load(Relaxed);
        let passed = now.wrapping_sub(origin) as i64;
        (origin != UNKNOWN).then_some(passed.max(0) as u64)
    }

    /// Takes in that `heard` samples have been heard by now.
    pub fn hear(&self, heard: u64) {
        let origin = self.origin.load(Relaxed);
        self.origin.store(follow(origin, now(), heard), Relaxed);
    }
}

/// The new origin after `heard` samples at `now`.
fn follow(origin: u64, now: u64, heard: u64) -> u64 {
    let rate = u64::from(RATE);
    let measured = now.wrapping_sub(heard / rate * SECOND + heard % rate * SECOND / rate);
    let off = measured.wrapping_sub(origin) as i64;
    if origin == UNKNOWN || heard == 0 || off.abs() > STEP {
        measured
    } else {
        origin.wrapping_add_signed(off / SHARE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: i64 = 1_000_000_000 / 60;

    #[test]
    fn silence_begins_with_the_first_question_and_sound_with_the_card() {
        let pace = Pace::new();
        pace.set_silent(false);
        assert_eq!(pace.elapsed(), None);
        pace.hear(0);
        assert!(pace.elapsed().unwrap() < SECOND);
        let pace = Pace::new();
        assert!(pace.elapsed().unwrap() < SECOND / 10);
    }

    #[test]
    fn the_picture_stays_within_a_frame_of_a_card_that_drifts_and_tells_in_steps() {
        // A card 0.05 % too fast that moves on by 1024 samples at a time, asked every 23 ms for an hour.
        let mut origin = UNKNOWN;
        for tick in 0..3600 * 43 {
            let now = SECOND + tick * 23_219_954;
            let exact = (now - SECOND) as f64 * 1.0005;
            let heard = (exact / SECOND as f64 * f64::from(RATE) / 1024.0) as u64 * 1024;
            origin = follow(origin, now, heard);
            // On average a card is half a step ahead of what it tells.
            let told = now.wrapping_sub(origin) as i64 + 11_600_000;
            assert!(
                (told - exact as i64).abs() < FRAME,
                "after {} s: {} ns off",
                tick / 43,
                told - exact as i64
            );
        }
    }

    #[test]
    fn a_card_that_stood_still_is_followed_at_once() {
        let origin = follow(UNKNOWN, 5 * SECOND, u64::from(RATE));
        assert_eq!(origin, 4 * SECOND);
        assert_eq!(follow(origin, 8 * SECOND, 2 * u64::from(RATE)), 6 * SECOND);
        // A correction of 1 ms comes in slowly.
        let slow = follow(origin, 6 * SECOND + 1_000_000, 2 * u64::from(RATE));
        assert_eq!(slow, 4 * SECOND + 1_000_000 / SHARE as u64);
    }
}
