//! Which frame belongs on the screen after a given time: pure arithmetic, no clock of its own.
//!
//! Content follows time, never the other way round: a slow machine skips frames, and the show stays as
//! long as it is. All arithmetic is in whole nanoseconds and frames, so nothing drifts.

use luc::show::FPS;
use std::time::Duration;

const SECOND: u64 = 1_000_000_000;

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
    /// The frame of the show to be seen after `elapsed`, or none when playing once is over.
    pub fn frame(&self, elapsed: Duration) -> Option<u64> {
        let local = self.from % self.length + ticks(elapsed);
        (!self.once || local < self.length).then_some(self.first + local % self.length)
    }
}

/// Whole frames in `elapsed`.
fn ticks(elapsed: Duration) -> u64 {
    elapsed.as_secs() * FPS + u64::from(elapsed.subsec_nanos()) * FPS / SECOND
}

/// Time left after `elapsed` until the next frame begins; at least a nanosecond.
pub fn until_next(elapsed: Duration) -> Duration {
    let now = u64::from(elapsed.subsec_nanos());
    let next = now * FPS / SECOND + 1;
    Duration::from_nanos((next * SECOND).div_ceil(FPS) - now)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAY: u64 = 86_400;

    fn clock(from: u64, once: bool) -> Clock {
        Clock { first: 1000, length: 600, from, once }
    }

    #[test]
    fn sixty_frames_pass_in_each_second_without_drift() {
        let c = clock(0, false);
        assert_eq!(c.frame(Duration::ZERO), Some(1000));
        assert_eq!(c.frame(Duration::from_nanos(16_666_666)), Some(1000));
        assert_eq!(c.frame(Duration::from_nanos(16_666_667)), Some(1001));
        for days in [1, 365, 36_500] {
            assert_eq!(c.frame(Duration::from_secs(days * DAY) - Duration::from_nanos(1)), Some(1599));
            assert_eq!(c.frame(Duration::from_secs(days * DAY)), Some(1000), "after {days} days");
        }
    }

    #[test]
    fn looping_starts_over_and_once_ends() {
        assert_eq!(clock(0, false).frame(Duration::from_secs(10)), Some(1000));
        assert_eq!(clock(0, true).frame(Duration::from_millis(9_999)), Some(1599));
        assert_eq!(clock(0, true).frame(Duration::from_secs(10)), None);
        assert_eq!(clock(0, true).frame(Duration::from_secs(DAY)), None);
    }

    #[test]
    fn playing_starts_at_the_asked_frame_modulo_the_length() {
        assert_eq!(clock(599, false).frame(Duration::ZERO), Some(1599));
        assert_eq!(clock(599, false).frame(Duration::from_millis(17)), Some(1000));
        assert_eq!(clock(599, true).frame(Duration::from_millis(17)), None);
        assert_eq!(clock(u64::MAX, false).frame(Duration::ZERO), Some(1000 + u64::MAX % 600));
    }

    #[test]
    fn waiting_ends_exactly_when_the_next_frame_begins() {
        for nanos in (0..3 * SECOND).step_by(1_234_567) {
            let now = Duration::from_nanos(nanos);
            let then = now + until_next(now);
            assert_eq!(ticks(then), ticks(now) + 1, "from {nanos} ns");
            assert_eq!(ticks(then - Duration::from_nanos(1)), ticks(now), "from {nanos} ns");
        }
    }
}
