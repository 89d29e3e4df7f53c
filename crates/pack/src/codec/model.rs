//! The context-mixing model: how likely the next bit of a program is a one.
//!
//! Each of [`CONTEXTS`] looks at something else: the last bytes, or the parts of the current and
//! the last instructions that the [`Walker`] knows. Under the hash of what it sees and of the
//! bits of the byte so far it keeps a [`Slot`], which gives two opinions: how often the bit was a
//! one there, and, by a table that learns, what the pattern of ones and zeros there usually meant.
//! A match model follows the longest repetition. Three mixers, each with a set of weights chosen
//! by another selector, add the opinions up; their mean is corrected by two tables that learn how
//! far such a prediction is to be trusted after this byte.
//!
//! All memory is part of [`Model`], which starts as zeros.
//!
//! Source: Matt Mahoney's paq8 and lpaq1 for the architecture; Fabian Giesen's kkrunchy and Rune
//! Stubbe's and Aske Christensen's Crinkler for contexts that follow instructions.

use super::logistic::{LIMIT, Stretch, Vector, squash};
use super::x86::{Part, Walker, mix};

/// Number of contexts.
pub const CONTEXTS: usize = 22;
/// Opinions, in fours: two for each context, the match model's, and a constant.
const FOURS: usize = (CONTEXTS * 2 + 2).div_ceil(4);
const MATCH: usize = CONTEXTS * 2;
const BIAS: usize = CONTEXTS * 2 + 1;
/// Mixers.
const MIXERS: usize = 3;
/// Sets of weights of each mixer.
const SETS: usize = 2048;
/// Rows of sixteen slots for each context, as a power of two.
const ROW_BITS: u32 = 14;
/// Entries of the match model's table, as a power of two.
const MATCH_BITS: u32 = 16;

/// Weight of each opinion at the start.
const FIRST_WEIGHT: f32 = 0.07;
/// Learning rate of the mixers in the long run, and what is added to it at the start.
const RATE: f32 = 0.0035;
const EARLY_RATE: f32 = 0.028;
/// A slot's probability stops adapting faster than `1 / SETTLED` after that many bits.
const SETTLED: u8 = 60;

/// What a context remembers of one bit position.
#[derive(Clone, Copy)]
struct Slot {
    /// Probability of a one, 16 bits.
    probability: u16,
    /// Tells contexts that share the slot apart, most of the time.
    check: u8,
    /// Bits seen, up to [`SETTLED`].
    seen: u8,
    /// Counts of zeros (bits 5..8) and ones (2..5), each up to 7, and the last two bits.
    history: u8,
}

/// Finer probabilities from coarse ones: 33 steps over the stretched range, interpolated.
type Correction = [u16; 33];

/// The model. Large; it is never made but by zeroing memory.
pub struct Model {
    slots: [[[Slot; 16]; 1 << ROW_BITS]; CONTEXTS],
    /// Meaning of histories, by context: probability of a one.
    meaning: [[u16; 256]; CONTEXTS],
    weights: [[Vector<FOURS>; SETS]; MIXERS],
    by_partial: [Correction; 256],
    by_byte: [Correction; 1 << 16],
    stretch: Stretch,
    /// Position after the last occurrence of a hashed run of bytes.
    last_seen: [u32; 1 << MATCH_BITS],
    /// How often a match of a length held: probability.
    match_holds: [u16; 32],

    walker: Walker,
    /// The bits of the byte so far, behind a leading one.
    partial: u32,
    /// Bytes done.
    position: usize,
    /// The last byte.
    last: u32,
    /// The contexts' hashes for this byte.
    hashes: [u32; CONTEXTS],
    /// Their rows for this half of the byte.
    rows: [u32; CONTEXTS],
    /// Their slots' checks for this half of the byte.
    checks: [u8; CONTEXTS],
    /// Places within the rows for this bit.
    places: [u32; CONTEXTS],
    opinions: Vector<FOURS>,
    /// Sets of weights, by mixer: the parts that stand for a whole byte, and those in use.
    selectors: [usize; MIXERS],
    sets: [usize; MIXERS],
    /// What each mixer said.
    mixed: [f32; MIXERS],
    /// Where the corrections came from: index and step.
    corrected: [(usize, usize); 2],
    /// Where the match goes on, and how long it has been; 0 without one.
    match_at: usize,
    match_length: usize,
    /// The byte that the match expects, behind a leading one; 0 without one or once it failed.
    expected: u32,
}

impl Model {
    /// Makes a model of zeroed memory ready for the first bit.
    pub fn start(&mut self) {
        self.stretch.fill();
        for table in &mut self.meaning {
            for (history, probability) in table.iter_mut().enumerate() {
                let (zeros, ones) = ((history >> 5) as f32, (history >> 2 & 7) as f32);
                *probability = ((ones + 0.4) / (zeros + ones + 0.8) * 65535.0) as u16;
            }
        }
        self.match_holds = [0xe000; 32];
        for sets in &mut self.weights {
            for set in sets {
                for four in set.numbers_mut() {
                    *four = [FIRST_WEIGHT; 4];
                }
            }
        }
        for (step, first) in self.by_partial[0].iter_mut().enumerate() {
            *first = (squash((step as f32 - 16.0) * 0.5) * 65535.0) as u16;
        }
        let first = self.by_partial[0];
        for correction in self.by_partial.iter_mut().chain(&mut self.by_byte) {
            *correction = first;
        }
        self.end_byte(&[]);
    }

    /// Probability of a one, in 16 bits, never quite 0 or 1.
    pub fn predict(&mut self) -> u32 {
        let partial = self.partial;
        let bits = 31 - partial.leading_zeros();
        if bits & 3 == 0 {
            self.find_rows();
        }
        // The bits of this half of the byte, behind a leading one.
        let half = if bits < 4 { partial } else { partial & ((1 << (bits - 4)) - 1) | 1 << (bits - 4) };
        let stretch = &self.stretch;
        let opinions = self.opinions.numbers_mut();
        for i in 0..CONTEXTS {
            let place = (self.checks[i] as u32 >> 3 ^ half) & 15;
            self.places[i] = place;
            let slot = &mut self.slots[i][self.rows[i] as usize & ((1 << ROW_BITS) - 1)][place as usize & 15];
            let check = self.checks[i] | 1;
            if slot.check != check {
                *slot = Slot { probability: 1 << 15, check, seen: 0, history: 0 };
            }
            let (mut counted, mut meant) = (0.0, 0.0);
            if slot.seen != 0 {
                counted = stretch.of(slot.probability);
                meant = stretch.of(self.meaning[i][usize::from(slot.history)]);
            }
            opinions[i / 2][i % 2 * 2] = counted;
            opinions[i / 2][i % 2 * 2 + 1] = meant;
        }
        opinions[BIAS / 4][BIAS % 4] = 0.4;
        let mut matched = 0.0;
        if self.expected != 0 {
            let rest = 8 - bits;
            if self.expected >> rest == partial {
                matched = stretch.of(self.match_holds[self.match_length.min(31) & 31]);
                if self.expected >> (rest - 1) & 1 == 0 {
                    matched = -matched;
                }
            } else {
                self.expected = 0;
                self.match_length = 0;
            }
        }
        opinions[MATCH / 4][MATCH % 4] = matched;

        let agreed = (self.match_length.min(15) as u32 + 1).ilog2() as usize;
        self.sets =
            [self.selectors[0] * 8 + bits as usize, partial as usize | agreed << 8, self.selectors[2]];
        let mut sum = 0.0;
        for mixer in 0..MIXERS {
            let weights = &self.weights[mixer][self.sets[mixer] & (SETS - 1)];
            let dot = weights.dot(&self.opinions);
            self.mixed[mixer] = squash(dot);
            sum += dot;
        }
        let mean = sum * (1.0 / MIXERS as f32);

        let position = (mean.clamp(-7.99, 7.99) + 8.0) * 2.0;
        let step = position as usize & 31;
        let part = position - step as f32;
        let nearer = step + usize::from(part > 0.5);
        let after = (self.last << 8 | partial) as usize & 0xffff;
        self.corrected = [(partial as usize & 255, nearer), (after, nearer)];
        let mut corrected = 0.0;
        for correction in [&self.by_partial[partial as usize & 255], &self.by_byte[after]] {
            corrected += f32::from(correction[step]) * (1.0 - part) + f32::from(correction[step + 1]) * part;
        }
        let probability = squash(mean) * 32768.0 + corrected * 0.25;
        (probability as u32).clamp(24, 65536 - 24)
    }

    /// Learns the bit that came.
    pub fn learn(&mut self, bit: u32) {
        let rate = RATE + EARLY_RATE / (1.0 + self.position as f32 * (1.0 / 4000.0));
        for mixer in 0..MIXERS {
            let error = bit as f32 - self.mixed[mixer];
            let weights = &mut self.weights[mixer][self.sets[mixer] & (SETS - 1)];
            weights.add_scaled(error * rate, &self.opinions);
        }
        for i in 0..CONTEXTS {
            let row = &mut self.slots[i][self.rows[i] as usize & ((1 << ROW_BITS) - 1)];
            let slot = &mut row[self.places[i] as usize & 15];
            if slot.seen > 0 {
                toward(&mut self.meaning[i][usize::from(slot.history)], bit, 50);
            }
            let target = if bit == 1 { 65535 } else { 0 };
            let probability = i32::from(slot.probability);
            slot.probability =
                (probability + (target - probability) * 2 / (i32::from(slot.seen) * 2 + 3)) as u16;
            slot.seen += u8::from(slot.seen < SETTLED);
            slot.history = next_history(slot.history, bit);
        }
        if self.expected != 0 {
            let rest = self.partial.leading_zeros() - 23;
            let held = u32::from(self.expected >> (rest - 1) & 1 == bit);
            toward(&mut self.match_holds[self.match_length.min(31) & 31], held, 32);
        }
        let [(partial, nearer), (after, _)] = self.corrected;
        toward(&mut self.by_partial[partial & 255][nearer.min(32)], bit, 40);
        toward(&mut self.by_byte[after & 0xffff][nearer.min(32)], bit, 40);
        self.partial = self.partial << 1 | bit;
    }

    /// Goes on to the next byte; `bytes` is all up to now.
    pub fn end_byte(&mut self, bytes: &[u8]) {
        let back =
            |n: usize| u32::from(bytes.len().checked_sub(n).and_then(|i| bytes.get(i)).copied().unwrap_or(0));
        self.position = bytes.len();
        self.partial = 1;
        if let Some(&last) = bytes.last() {
            self.last = u32::from(last);
            self.walker.step(last);
        }
        let c1 = self.last;
        let c4 = back(4);
        let last4 = c1 | back(2) << 8 | back(3) << 16 | c4 << 24;
        let before4 = back(5) | back(6) << 8 | back(7) << 16 | back(8) << 24;
        let walker = &self.walker;
        let state = walker.part as u32 | u32::from(walker.left) << 4 | u32::from(walker.map) << 8;
        let current = mix(walker.prefix ^ walker.opcode << 16, walker.modrm | state << 20);
        let field = walker.field;
        let [p0, p1, p2, p3] = walker.previous;
        let one = mix(current, p0);
        let two = mix(one, p1);
        let column = self.position as u32 & 3;
        let seen = [
            0,
            c1,
            last4 & 0xffff,
            last4 & 0xff_ffff,
            last4,
            mix(last4, before4 & 0xff),
            mix(last4, before4 & 0xffff),
            mix(last4, before4),
            current,
            one,
            two,
            mix(two, p2),
            mix(current, c1),
            mix(current, last4 & 0xffff),
            mix(state, walker.opcode ^ field << 10),
            last4 & 0xff00,
            last4 & 0xff_ff00,
            last4 & 0xff00_ff00,
            mix(c4, column),
            mix(c4 << 8 | back(8), column),
            mix(mix(current, field), p0),
            mix(mix(mix(p0, p1), p2), mix(p3, current ^ field)),
        ];
        for (i, (hash, seen)) in self.hashes.iter_mut().zip(seen).enumerate() {
            *hash = mix(seen, i as u32 + 1);
        }
        let left = usize::from(walker.left.min(7));
        self.selectors = [walker.part as usize | left << 3, 0, walker.opcode as usize & 1023];
        self.follow_match(bytes, mix(last4, before4 & 0xff));
    }

    /// Keeps to the run that matches what came last, or looks for one.
    fn follow_match(&mut self, bytes: &[u8], hash: u32) {
        let here = bytes.len();
        let held = self.match_length > 0 && bytes.get(self.match_at) == bytes.last();
        if held {
            self.match_at += 1;
            self.match_length += 1;
        } else {
            self.match_length = 0;
        }
        let entry = &mut self.last_seen[(hash >> (32 - MATCH_BITS)) as usize & ((1 << MATCH_BITS) - 1)];
        if self.match_length == 0 {
            self.match_at = *entry as usize;
            let old = bytes.get(..self.match_at).unwrap_or(&[]);
            let equal = old.iter().rev().zip(bytes.iter().rev()).take(32).take_while(|(a, b)| a == b);
            self.match_length = equal.count();
        }
        *entry = here as u32;
        let expected = bytes.get(self.match_at).map_or(0, |&byte| u32::from(byte) | 256);
        self.expected = if self.match_length > 0 { expected } else { 0 };
    }

    /// Finds the contexts' rows for the next four bits.
    fn find_rows(&mut self) {
        for i in 0..CONTEXTS {
            let hash = mix(self.hashes[i], self.partial);
            self.rows[i] = hash >> (32 - ROW_BITS);
            self.checks[i] = hash as u8;
        }
    }
}

/// Moves a probability of 16 bits toward the bit by one part in `divisor`.
fn toward(probability: &mut u16, bit: u32, divisor: i32) {
    let target = if bit == 1 { 65535 } else { 0 };
    let old = i32::from(*probability);
    *probability = (old + (target - old) / divisor) as u16;
}

/// The history after one more bit: its count goes up, and a large count of the other goes down,
/// since what happened lately counts more.
fn next_history(history: u8, bit: u32) -> u8 {
    let (zeros, ones) = (history >> 5, history >> 2 & 7);
    let (same, other) = if bit == 1 { (ones, zeros) } else { (zeros, ones) };
    let same = if same < 7 { same + 1 } else { same };
    let other = if other > 2 { other / 2 + 1 } else { other };
    let (zeros, ones) = if bit == 1 { (other, same) } else { (same, other) };
    zeros << 5 | ones << 2 | history << 1 & 2 | bit as u8
}

// Not used by the arithmetic, but a wrong order of magnitude here would be a wrong model.
const _: () = assert!(LIMIT > 8.0 && Part::Opcode as u8 == 0);
