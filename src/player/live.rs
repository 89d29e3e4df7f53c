//! Live quality: the best level that holds 60 frames a second, found from measured render times.
//!
//! Levels are presets, and pictures of fewer pixels under them. Going down is quick, because lost frames are
//! seen; going up is slow and needs room to spare, because the next level costs more. An ascent that fails
//! doubles the wait before the next one, so a machine between two levels settles instead of flickering
//! between them.

/// The longest a frame may take: a sixtieth of a second less what presenting needs.
const BUDGET: u32 = 15_000; // microseconds
/// A level about twice as dear still fits if the frame takes less than this.
const ROOMY: u32 = BUDGET / 2;
/// Going down takes this many late frames more than timely ones; very late frames count up to thrice.
const LATE_LIMIT: u32 = 6;
/// Going up takes this many frames in a row with room; a second.
const PATIENCE: u32 = 60;
/// The longest wait between two ascents, frames; half a minute.
const MOST_PATIENCE: u32 = 32 * PATIENCE;

/// The controller; starts at a middle level.
pub struct Live {
    level: usize,
    top: usize,
    late: u32,
    roomy: u32,
    patience: u32,
    /// Frames since the last ascent, while it may still prove a mistake.
    trial: Option<u32>,
}

impl Live {
    /// Starts at `level` and never passes `top`.
    pub fn new(level: usize, top: usize) -> Self {
        Live { level, top, late: 0, roomy: 0, patience: PATIENCE, trial: None }
    }

    /// The level to render at.
    pub fn level(&self) -> usize {
        self.level
    }

    /// Takes in how many nanoseconds the last frame took to render.
    pub fn measured(&mut self, time: u64) {
        let time = (time / 1000).min(u32::MAX.into()) as u32;
        self.late =
            if time > BUDGET { self.late + (time / BUDGET).min(3) } else { self.late.saturating_sub(1) };
        self.roomy = if time < ROOMY { self.roomy + 1 } else { 0 };
        self.trial = self.trial.map(|frames| frames + 1);
        if self.late >= LATE_LIMIT && self.level > 0 {
            if self.trial.is_some() {
                self.patience = (2 * self.patience).min(MOST_PATIENCE);
            }
            self.turn(self.level - 1);
            self.trial = None;
        } else if self.roomy >= self.patience && self.level < self.top {
            self.turn(self.level + 1);
            self.trial = Some(0);
        } else if self.trial > Some(3 * PATIENCE) {
            // The ascent held: the next may come as soon as the first.
            self.trial = None;
            self.patience = PATIENCE;
        }
        self.late = self.late.min(LATE_LIMIT);
    }

    fn turn(&mut self, level: usize) {
        self.level = level;
        self.late = 0;
        self.roomy = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::super::time::MILLISECOND;
    use super::*;

    const TOP: usize = 4;

    /// Plays `frames` on a machine where level i takes `costs[i]` ms; returns the level after each.
    fn play(live: &mut Live, frames: usize, costs: [u64; TOP + 1]) -> Vec<usize> {
        (0..frames)
            .map(|_| {
                live.measured(costs[live.level()] * MILLISECOND);
                live.level()
            })
            .collect()
    }

    fn changes(levels: &[usize]) -> usize {
        levels.windows(2).filter(|w| w[0] != w[1]).count()
    }

    #[test]
    fn a_fast_machine_climbs_to_the_top_and_never_beyond() {
        let mut live = Live::new(2, TOP);
        let levels = play(&mut live, 600, [1, 1, 2, 3, 4]);
        assert_eq!(levels.last(), Some(&TOP));
        assert_eq!(changes(&levels), 2);
    }

    #[test]
    fn a_slow_machine_reaches_draft_within_a_dozen_frames_and_stays() {
        let mut live = Live::new(2, TOP);
        let levels = play(&mut live, 600, [40, 60, 100, 200, 400]);
        assert_eq!(levels[11], 0);
        assert_eq!(changes(&levels[11..]), 0);
    }

    #[test]
    fn one_late_frame_among_timely_ones_changes_nothing() {
        let mut live = Live::new(2, TOP);
        for i in 0..3000 {
            live.measured(MILLISECOND * if i % 20 == 0 { 500 } else { 10 });
            assert_eq!(live.level(), 2, "frame {i}");
        }
    }

    #[test]
    fn late_every_other_frame_is_not_held() {
        let mut live = Live::new(2, TOP);
        for i in 0..60 {
            live.measured(MILLISECOND * if i % 2 == 0 { 31 } else { 14 });
        }
        assert!(live.level() < 2);
    }

    #[test]
    fn between_two_presets_it_settles_on_the_one_that_holds() {
        // "high" leaves room, "ultra" is far too dear.
        let mut live = Live::new(2, TOP);
        play(&mut live, 3600, [1, 2, 4, 6, 40]);
        let minute = play(&mut live, 3600, [1, 2, 4, 6, 40]);
        let above = minute.iter().filter(|&&l| l > 3).count();
        assert!(above < 36, "{above} of 3600 frames at a level that cannot hold");
        assert!(changes(&minute) <= 8, "{} changes in a minute", changes(&minute));
    }

    #[test]
    fn a_lighter_scene_is_used_after_failed_ascents() {
        let mut live = Live::new(2, TOP);
        play(&mut live, 7200, [1, 2, 6, 40, 80]);
        let levels = play(&mut live, 3600, [1, 1, 2, 3, 4]);
        assert_eq!(levels.last(), Some(&TOP), "back at the top within a minute");
    }

    #[test]
    fn absurd_times_do_not_overflow() {
        let mut live = Live::new(0, 0);
        for _ in 0..100_000 {
            live.measured(u64::MAX);
            live.measured(0);
        }
        assert_eq!(live.level(), 0);
    }
}
