//! An instrument: one row of numbers for the one voice that plays them all.

/// A row of the table of instruments: each number, 0 or from 2⁻¹² to below 2²⁰, as the five low bits of its
/// exponent and the three high bits of its fraction, so with an error of at most 6 %.
#[derive(Clone, Copy, Debug)]
pub struct Instrument([u8; COLUMNS]);

/// What the exponent of an f32 has besides the five bits, and what is below the three.
const EXPONENT: u32 = (127 - 12) << 23;
const FRACTION: u32 = 20;

/// Numbers of an instrument.
pub const COLUMNS: usize = 28;

/// 0 sine with frequency modulation, 1 saw, 2 pulse of 30 %.
pub const WAVE: usize = 0;
/// Copies of the oscillator, 1 to 8.
pub const COPIES: usize = 1;
/// Cents from the middle to the outermost copy.
pub const DETUNE: usize = 2;
/// Place of the outermost copy between the middle, 0, and a side, 1.
pub const SPREAD: usize = 3;
/// Semitones above the written note; for drums, which have none, the MIDI note itself.
pub const PITCH: usize = 4;
/// Frequency of the modulating sine, as a multiple of the note's.
pub const RATIO: usize = 5;
/// Depth of the modulation, radians.
pub const INDEX: usize = 6;
/// Seconds in which it falls to 1/e.
pub const INDEX_FALL: usize = 7;
/// How far the frequency begins too high, as a share of it.
pub const BEND: usize = 8;
/// Seconds in which that falls to 1/e.
pub const BEND_FALL: usize = 9;
/// Share of white noise.
pub const NOISE: usize = 10;
/// Seconds from silence to full level, linear.
pub const ATTACK: usize = 11;
/// Seconds in which the distance to the sustained level falls to 1/e.
pub const DECAY: usize = 12;
/// Sustained level.
pub const SUSTAIN: usize = 13;
/// Seconds in which the level falls to 1/e after the note.
pub const RELEASE: usize = 14;
/// What passes the filter: 0 low, 1 a band, 2 high.
pub const PASS: usize = 15;
/// Cutoff frequency, Hz.
pub const CUTOFF: usize = 16;
/// Quality of the filter.
pub const RESONANCE: usize = 17;
/// How far the cutoff is swept up, octaves.
pub const SWEEP: usize = 18;
/// Seconds of the way up, linear.
pub const SWEEP_RISE: usize = 19;
/// Seconds in which it falls to 1/e afterwards.
pub const SWEEP_FALL: usize = 20;
/// Depth of the vibrato, cents.
pub const VIBRATO: usize = 21;
/// Place between left, 0, and right, 2.
pub const PAN: usize = 22;
/// Level.
pub const LEVEL: usize = 23;
/// Share that is sent to the reverb.
pub const REVERB: usize = 24;
/// Share that is sent to the delay.
pub const DELAY: usize = 25;
/// How far a kick presses it down, 0 to 1.
pub const DUCK: usize = 26;
/// Level of notes that are not on a beat.
pub const OFFBEAT: usize = 27;

impl Instrument {
    /// From its numbers, in the order of the columns above.
    pub const fn new(numbers: [f32; COLUMNS]) -> Self {
        let mut bytes = [0; COLUMNS];
        let mut i = 0;
        while i < COLUMNS {
            if numbers[i] > 0.0 {
                let rounded = numbers[i].to_bits() + (1 << (FRACTION - 1)) - EXPONENT;
                assert!(rounded >> FRACTION < 256, "a number outside the table's range");
                bytes[i] = (rounded >> FRACTION) as u8;
            }
            i += 1;
        }
        Instrument(bytes)
    }

    /// The number of a column.
    pub fn get(&self, column: usize) -> f32 {
        let byte = u32::from(self.0[column]);
        if byte == 0 { 0.0 } else { f32::from_bits((byte << FRACTION) + EXPONENT) }
    }
}
