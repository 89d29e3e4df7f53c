//! Which frame belongs on the screen after a given time: pure arithmetic, no clock of its own.
//!
//! Content follows time, never the other way round: a slow machine skips frames, and the show stays as
//! long as it is. All arithmetic is in whole nanoseconds and frames, so nothing drifts.

use super::time::SECOND;
use luc::show::FPS;

/// A stretch of the show and how it is played.
pub struct Clock {
    /// The stretch's first frame in the show.
    pub first: u64,
    /// The stretch's length in frames.
    pub length: u64,
    /// The frame to start at, counted from `first`; taken modulo the length.
    pub from: u64,
    /// End after the last frame instead of starting over.
    pub once: bool,
}

impl Clock {
    /// The frame of the show to be seen after `elapsed` nanoseconds, or none when playing once is over.
    pub fn frame(&self, elapsed: u64) -> Option<u64> {
        let local = self.from % self.length + ticks(elapsed);
        (!self.once || local < self.length).then_some(self.first + local % self.length)
    }
}

/// Whole frames in `elapsed` nanoseconds.
fn ticks(elapsed: u64) -> u64 {
    elapsed / SECOND * FPS + elapsed % SECOND * FPS / SECOND
}

/// Nanoseconds left after `elapsed` until the next frame begins; at least one.
pub fn until_next(elapsed: u64) -> u64 {
    let now = elapsed % SECOND;
    let next = now * FPS / SECOND + 1;
    (next * SECOND).div_ceil(FPS) - now
}

#[cfg(test)]
mod tests {
    use super::super::time::MILLISECOND;
    use super::*;

    const DAY: u64 = 86_400 * SECOND;

    fn clock(from: u64, once: bool) -> Clock {
        Clock { first: 1000, length: 600, from, once }
    }

    #[test]
    fn sixty_frames_pass_in_each_second_without_drift() {
        let c = clock(0, false);
        assert_eq!(c.frame(0), Some(1000));
        assert_eq!(c.frame(16_666_666), Some(1000));
        assert_eq!(c.frame(16_666_667), Some(1001));
        for days in [1, 365, 36_500] {
            assert_eq!(c.frame(days * DAY - 1), Some(1599));
            assert_eq!(c.frame(days * DAY), Some(1000), "after {days} days");
        }
    }

    #[test]
    fn looping_starts_over_and_once_ends() {
        assert_eq!(clock(0, false).frame(10 * SECOND), Some(1000));
        assert_eq!(clock(0, true).frame(9_999 * MILLISECOND), Some(1599));
        assert_eq!(clock(0, true).frame(10 * SECOND), None);
        assert_eq!(clock(0, true).frame(DAY), None);
    }

    #[test]
    fn playing_starts_at_the_asked_frame_modulo_the_length() {
        assert_eq!(clock(599, false).frame(0), Some(1599));
        assert_eq!(clock(599, false).frame(17 * MILLISECOND), Some(1000));
        assert_eq!(clock(599, true).frame(17 * MILLISECOND), None);
        assert_eq!(clock(u64::MAX, false).frame(0), Some(1000 + u64::MAX % 600));
    }

    #[test]
    fn waiting_ends_exactly_when_the_next_frame_begins() {
        for nanos in (0..3 * SECOND).step_by(1_234_567) {
            let then = nanos + until_next(nanos);
            assert_eq!(ticks(then), ticks(nanos) + 1, "from {nanos} ns");
            assert_eq!(ticks(then - 1), ticks(nanos), "from {nanos} ns");
        }
    }
}
