//! When an instrument strikes: what pictures need to move with the sound, and nothing of the sound itself.
//!
//! [`strikes`] reads the score at compile time and leaves three bytes a bar, so that nobody copies a time by
//! hand, and an executable without sound moves as one with it.

use super::STEPS;
use super::score::{Score, Section};
use crate::math::number;
use crate::math::scalar::exp;

/// Frames of a picture in two sixteenths, at 60 a second.
const FRAMES: u64 = 15;

/// The strikes of an instrument in a bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strikes {
    /// One bit a sixteenth, the lowest first.
    pub steps: u16,
    /// Level of the first of them, hundredths.
    pub level: u8,
}

/// The strikes of an instrument in a section of `BARS` bars. For constants.
pub const fn strikes<const BARS: usize>(score: &Score, section: &Section, instrument: u8) -> [Strikes; BARS] {
    assert!(section.harmony.len() == BARS, "a section has another number of bars");
    let mut bars = [Strikes { steps: 0, level: 0 }; BARS];
    let mut i = 0;
    while i < section.rows.len() {
        let row = &section.rows[i];
        i += 1;
        if row.instrument != instrument {
            continue;
        }
        let (mode, text) = score.pattern(row.pattern);
        let steps = row.bars as u32 * STEPS;
        let mut local = 0;
        while local < steps {
            let c = text[local as usize % text.len()];
            if c >= b'0' {
                let bar = &mut bars[(row.bar as u32 + local / STEPS) as usize];
                if bar.steps == 0 {
                    let [from, to] = [row.level[0] as u32, row.level[1] as u32];
                    let level = (from * (steps - local) + to * local) / steps;
                    bar.level = if mode == b'd' { level * (c - b'0') as u32 / 9 } else { level } as u8;
                }
                bar.steps |= 1 << (local % STEPS);
            }
            local += 1;
        }
    }
    bars
}

/// Seconds since the last strike up to a frame of the section, and its level; none before the first one.
pub fn last(bars: &[Strikes], frame: u64) -> Option<(f32, f32)> {
    let mut step = (2 * frame + 1) / FRAMES;
    loop {
        let bar = bars.get((step / u64::from(STEPS)) as usize);
        if let Some(bar) = bar.filter(|bar| bar.steps >> (step % u64::from(STEPS)) & 1 == 1) {
            let since = frame - step * FRAMES / 2;
            return Some((number(since as usize) / 60.0, 0.01 * f32::from(bar.level)));
        }
        step = step.checked_sub(1)?;
    }
}

/// Level of the last strike, falling by 1/e in 1/`rate` seconds; 0 before the first one.
pub fn pulse(bars: &[Strikes], frame: u64, rate: f32) -> f32 {
    last(bars, frame).map_or(0.0, |(since, level)| level * exp(-rate * since))
}

/// The frame of the `n`-th strike from the first of `bar` on. For constants.
pub const fn frame_of(bars: &[Strikes], bar: usize, n: u32) -> u64 {
    let mut step = bar as u32 * STEPS;
    let mut left = n;
    loop {
        if bars[(step / STEPS) as usize].steps >> (step % STEPS) & 1 == 1 {
            if left == 0 {
                return step as u64 * FRAMES / 2;
            }
            left -= 1;
        }
        step += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::score::{Chord, Row};

    const fn row(instrument: u8, pattern: u8, bar: u8, bars: u8) -> Row {
        Row { instrument, pattern, bar, bars, transpose: 0, level: [100, 50], cutoff: [20; 2], pan: Row::OWN }
    }

    static SCORE: Score = Score { instruments: &[], patterns: "d9...9...\nk0-----4-----7---\n" };
    static SECTION: Section = Section {
        gain: 100,
        reverb: 100,
        delay: 100,
        harmony: &[Chord::new(0, b't', b'A'); 4],
        rows: &[row(0, 0, 1, 2), row(1, 1, 0, 4), row(0, 1, 3, 1)],
    };
    const DRUM: [Strikes; 4] = strikes(&SCORE, &SECTION, 0);
    const MELODY: [Strikes; 4] = strikes(&SCORE, &SECTION, 1);

    #[test]
    fn strikes_lie_where_patterns_have_digits() {
        let steps = |bars: [Strikes; 4]| bars.map(|bar| bar.steps);
        assert_eq!(steps(DRUM), [0, 0x1111, 0x1111, 0x1041]);
        assert_eq!(steps(MELODY), [0x1041; 4]);
        assert_eq!(DRUM.map(|bar| bar.level), [0, 100, 75, 100]);
    }

    #[test]
    fn time_since_a_strike_starts_on_its_frame() {
        assert_eq!(last(&DRUM, 0), None);
        assert_eq!(last(&DRUM, 119), None);
        assert_eq!(last(&DRUM, 120), Some((0.0, 1.0)));
        assert_eq!(last(&DRUM, 149), Some((29.0 / 60.0, 1.0)));
        assert_eq!(last(&DRUM, 150), Some((0.0, 1.0)));
        // Sixteenth 6 begins at frame 45, 12 at 90; after the section the last one fades on.
        assert_eq!(
            [44, 45, 89, 90].map(|frame| last(&MELODY, frame).unwrap().0 * 60.0),
            [44.0, 0.0, 44.0, 0.0]
        );
        assert_eq!(last(&DRUM, 600), Some((150.0 / 60.0, 1.0)));
        assert_eq!(pulse(&DRUM, 100, 8.0), 0.0);
        assert!((pulse(&DRUM, 126, 8.0) - 0.449_329).abs() < 1e-5);
        assert_eq!([(0, 0), (0, 1), (2, 2)].map(|(bar, n)| frame_of(&MELODY, bar, n)), [0, 45, 330]);
    }
}
