//! The score: sections of bars with a harmony, and rows that play patterns over it; read sixteenth by
//! sixteenth into notes.
//!
//! A melody is written in degrees of the scale of its bar, 0 the tonic and 7 the octave, so it follows
//! the harmony by itself; broken chords are written in tones of the bar's chord. Everything is a small
//! whole number, because such tables pack well.

use super::instrument::{Instrument, OFFBEAT, PAN};
use super::voice::Note;
use super::{STEPS, sample_of};

/// A tune's tables that all its sections share.
#[derive(Debug)]
pub struct Score {
    /// Who plays. The strikes of the first one, the kick, press the others down.
    pub instruments: &'static [Instrument],
    /// Patterns, one a line: a letter for what the characters mean (see [`Row`]), then one character a
    /// sixteenth. A digit starts a note (letters go on after 9), `-` holds it, `.` is silence.
    pub patterns: &'static str,
}

/// A stretch of the tune.
#[derive(Debug)]
pub struct Section {
    /// Level of all its notes, hundredths; so are the next two.
    pub gain: u8,
    /// What goes to the reverb, as a multiple of the instruments' shares.
    pub reverb: u8,
    /// What goes to the delay, as a multiple of the instruments' shares.
    pub delay: u8,
    /// The chord of each bar; there are as many bars.
    pub harmony: &'static [Chord],
    /// What is played.
    pub rows: &'static [Row],
}

/// The harmony of a bar.
#[derive(Clone, Copy, Debug)]
pub struct Chord {
    /// The tonic, semitones above D.
    pub key: i8,
    /// The root, a degree.
    pub root: i8,
    /// Which of the kinds `t79s5x`: triad, seventh, ninth, fourths, no third, no fifth.
    pub kind: u8,
    /// Which of the scales `AHRP`: natural minor, harmonic minor, Dorian, Phrygian.
    pub scale: u8,
    /// The bass, a degree.
    pub bass: i8,
}

/// An instrument that plays a pattern over some bars.
///
/// The pattern's first character says what its digits are: `k` degrees, `r` degrees above the chord's
/// root, `c` tones of the chord, `b` the bass (7 an octave higher), `d` ninths of a drum's level,
/// `p` all tones of the chord, held while they stay (its digits stand at the starts of bars).
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Index of the instrument.
    pub instrument: u8,
    /// Index of the pattern; it begins with the row and repeats.
    pub pattern: u8,
    /// First bar, counted in the section.
    pub bar: u8,
    /// How many.
    pub bars: u8,
    /// Degrees up.
    pub transpose: i8,
    /// Level at its start and at its end, hundredths.
    pub level: [u8; 2],
    /// Shift of the cutoff at its start and at its end, tenths of an octave above -2.
    pub cutoff: [u8; 2],
    /// Place of the instrument, hundredths; [`Row::OWN`] is its own.
    pub pan: i8,
}

/// MIDI number of the tonic D.
const TONIC: i32 = 62;
/// Semitones of the scales.
const SCALES: [[u8; 7]; 4] =
    [[0, 2, 3, 5, 7, 8, 10], [0, 2, 3, 5, 7, 8, 11], [0, 2, 3, 5, 7, 9, 10], [0, 1, 3, 5, 7, 8, 10]];
/// Tones of the kinds of chords, degrees above the root: triad, seventh, ninth, fourths, without a
/// third, without a fifth.
const KINDS: [[u8; 4]; 6] =
    [[0, 2, 4, 7], [0, 2, 4, 6], [0, 2, 4, 8], [0, 3, 6, 7], [0, 4, 7, 8], [0, 2, 7, 9]];
/// The lowest note of the bass, and those of the four voices that hold chords.
const BASS: i32 = 28;
const HELD: [i32; 4] = [50, 50, 61, 61];
/// Places of the four.
const PLACES: [f32; 4] = [-0.5, 0.5, -0.2, 0.2];

impl Chord {
    /// In D, over its root; kind and scale by their letters.
    pub const fn new(root: i8, kind: u8, scale: u8) -> Self {
        Chord { key: 0, root, kind: place(kind, b"t79s5x"), scale: place(scale, b"AHRP"), bass: root }
    }

    /// Over another bass.
    pub const fn over(self, bass: i8) -> Self {
        Chord { bass, ..self }
    }

    /// In another key, semitones above D.
    pub const fn key(self, key: i8) -> Self {
        Chord { key, ..self }
    }

    /// MIDI number of a degree of its scale.
    fn degree(&self, degree: i32) -> i32 {
        let scale = &SCALES[usize::from(self.scale)];
        TONIC
            + i32::from(self.key)
            + i32::from(scale[degree.rem_euclid(7) as usize])
            + 12 * degree.div_euclid(7)
    }

    /// Degree of a tone of the chord; 4 is the first one an octave higher.
    fn tone(&self, tone: i32) -> i32 {
        let kind = &KINDS[usize::from(self.kind)];
        i32::from(self.root) + i32::from(kind[tone as usize % 4]) + 7 * (tone / 4)
    }

    /// What one of the four voices holds.
    fn held(&self, voice: usize) -> i32 {
        fold(self.degree(self.tone(voice as i32)), HELD[voice])
    }
}

/// Place of a letter.
const fn place(letter: u8, letters: &[u8]) -> u8 {
    let mut i = 0;
    while letters[i] != letter {
        i += 1;
    }
    i as u8
}

/// `pitch` moved by octaves into the one that begins at `low`.
fn fold(pitch: i32, low: i32) -> i32 {
    low + (pitch - low).rem_euclid(12)
}

impl Row {
    /// A pan that is the instrument's own.
    pub const OWN: i8 = i8::MIN;

    /// The row some degrees higher.
    pub const fn up(self, degrees: i8) -> Self {
        Row { transpose: degrees, ..self }
    }

    /// The row at another place, hundredths from left to right.
    pub const fn at(self, pan: i8) -> Self {
        Row { pan, ..self }
    }
}

/// `[a, b]` at a share of the way.
fn between([a, b]: [u8; 2], share: f32) -> f32 {
    f32::from(a) + (f32::from(b) - f32::from(a)) * share
}

impl Score {
    /// What a pattern's digits mean, and its characters.
    pub(super) const fn pattern(&self, index: u8) -> (u8, &'static [u8]) {
        let mut rest = self.patterns.as_bytes();
        let mut line = 0;
        loop {
            let mut end = 0;
            while rest[end] != b'\n' {
                end += 1;
            }
            let (this, after) = rest.split_at(end);
            if line == index {
                return (this[0], this.split_at(1).1);
            }
            rest = after.split_at(1).1;
            line += 1;
        }
    }

    /// Hands the notes that begin at a step of a section to `play`, with the instrument's index.
    #[inline(never)]
    pub fn notes(&self, section: &Section, step: u32, mut play: impl FnMut(u8, &Note)) {
        let bar = (step / STEPS) as usize;
        let chord = &section.harmony[bar];
        for (index, row) in section.rows.iter().enumerate() {
            let local = step.wrapping_sub(row.bar as u32 * STEPS);
            let all = row.bars as u32 * STEPS;
            if local >= all {
                continue;
            }
            let (mode, text) = self.pattern(row.pattern);
            let at = |local: u32| text[local as usize % text.len()];
            let c = at(local);
            // The marks `-` and `.` lie below the digits, letters above.
            if c < b'0' {
                continue;
            }
            let digit = i32::from(c) - if c > b'9' { 87 } else { 48 };
            let instrument = &self.instruments[usize::from(row.instrument)];
            let mut pan =
                if row.pan == Row::OWN { instrument.get(PAN) - 1.0 } else { 0.01 * f32::from(row.pan) };
            let mut share = local as f32 / all as f32;
            let mut voices = 1;
            if mode == b'p' {
                voices = HELD.len();
                share += 0.5 / f32::from(row.bars);
            }
            let mut level = 0.01 * between(row.level, share);
            if mode == b'd' {
                level *= digit as f32 / 9.0;
            }
            if !local.is_multiple_of(4) {
                level *= instrument.get(OFFBEAT);
            }
            let mut steps = 1;
            while local + steps < all && at(local + steps) == b'-' {
                steps += 1;
            }
            for (voice, place) in PLACES.into_iter().enumerate().take(voices) {
                let pitch = match mode {
                    b'd' => 0,
                    b'p' => chord.held(voice),
                    b'b' => fold(chord.degree(chord.bass.into()), BASS) + 12 * (digit / 7),
                    _ => {
                        let degree = match mode {
                            b'c' => chord.tone(digit),
                            b'r' => i32::from(chord.root) + digit,
                            _ => digit,
                        };
                        chord.degree(degree + i32::from(row.transpose))
                    }
                };
                if mode == b'p' {
                    pan = place;
                    let goes_on = |bar: usize| section.harmony[bar].held(voice) == pitch;
                    // Tied to the bar before.
                    if local > 0 && goes_on(bar - 1) {
                        continue;
                    }
                    let mut end = bar + 1;
                    while end < usize::from(row.bar + row.bars) && goes_on(end) {
                        end += 1;
                    }
                    steps = (end - bar) as u32 * STEPS;
                }
                let note = Note {
                    instrument,
                    pitch,
                    length: sample_of(steps),
                    level,
                    cutoff: 0.1 * between(row.cutoff, share) - 2.0,
                    pan,
                    reverb: 0.01 * f32::from(section.reverb),
                    delay: 0.01 * f32::from(section.delay),
                    seed: ((index * HELD.len() + voice) as u32)
                        .wrapping_mul(0x85eb_ca6b)
                        .wrapping_add(step.wrapping_mul(0xc2b2_ae35)),
                };
                play(row.instrument, &note);
            }
        }
    }
}

#[cfg(test)]
mod tests;
