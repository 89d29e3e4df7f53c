//! The context-mixing model: how likely the next bit of a program is a one.
//!
//! Each of [`CONTEXTS`] looks at something else: the last bytes, or the parts of the current and
//! the last instructions that the [`Walker`] knows. Under the hash of what it sees and of the
//! bits of the byte so far it keeps a slot, which gives two opinions: how often the bit was a
//! one there, and, by a table that learns, what the pattern of ones and zeros there usually meant.
//! A match model follows the longest repetition. Four mixers, each with a set of weights chosen
//! by another selector, add the opinions up; their mean is corrected by two tables that learn how
//! far such a prediction is to be trusted after this byte.
//!
//! All memory is part of [`Model`], which starts as zeros.
//!
//! Source: Matt Mahoney's paq8 and lpaq1 for the architecture; Fabian Giesen's kkrunchy and Rune
//! Stubbe's and Aske Christensen's Crinkler for contexts that follow instructions.

use super::logistic::{Stretch, Vector, squash};
use super::x86::{Part, Walker, mix};

/// Number of contexts.
pub const CONTEXTS: usize = 24;
/// Opinions, in fours: two for each context, then the match model's and a constant.
const FOURS: usize = CONTEXTS / 2 + 1;
/// Mixers.
const MIXERS: usize = 4;
/// Sets of weights of each mixer.
const SETS: usize = 2048;
/// Rows of sixteen slots for each context, as a power of two.
const ROW_BITS: u32 = 14;
/// Entries of the match model's table, as a power of two.
const MATCH_BITS: u32 = 16;

/// Weight of each opinion at the start.
const FIRST_WEIGHT: f32 = 0.05;
/// Learning rate of the mixers in the long run, and what is added to it at the start.
const RATE: f32 = 0.0035;
const EARLY_RATE: f32 = 0.02;
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

/// The model. Large; it is never made but by zeroing memory. The small parts come first, where
/// instructions of the launcher reach them with short operands.
#[repr(C)]
pub struct Model {
    walker: Walker,
    /// The bits of the byte so far, behind a leading one.
    partial: u32,
    /// The last eight bytes, the last one lowest.
    last8: u64,
    /// Bytes done.
    position: usize,
    /// Where the match goes on, and how long it has been; 0 without one.
    match_at: usize,
    match_length: usize,
    /// The byte that the match expects, behind a leading one; 0 without one or once it failed.
    expected: u32,
    /// What chooses the mixers' sets of weights as far as it stands for a whole byte: the part of
    /// the instruction, nothing, the opcode, and the byte before the last.
    selectors: [u32; MIXERS],
    /// The sets in use.
    sets: [u32; MIXERS],
    /// What each mixer said.
    mixed: [f32; MIXERS],
    /// Where the corrections came from: by the byte before, and the step.
    after: usize,
    nearer: usize,
    opinions: Vector<FOURS>,
    found: [Found; CONTEXTS],
    /// How often a match of a length held: probability.
    match_holds: [u16; 32],
    /// Meaning of histories, by context: probability of a one.
    meaning: [[u16; 256]; CONTEXTS],
    by_partial: [Correction; 256],
    stretch: Stretch,
    weights: [[Vector<FOURS>; SETS]; MIXERS],
    by_byte: [Correction; 1 << 16],
    /// Position after the last occurrence of a hashed run of bytes.
    last_seen: [u32; 1 << MATCH_BITS],
    slots: [[[Slot; 16]; 1 << ROW_BITS]; CONTEXTS],
}

/// Where a context keeps what it knows.
#[derive(Clone, Copy)]
struct Found {
    /// Its hash for this byte.
    hash: u32,
    /// Its row for this half of the byte.
    row: u32,
    /// The slot in the row for this bit.
    place: u8,
    /// What that slot's check is if it is this context's.
    check: u8,
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
        self.partial = 1;
        self.look_around();
    }

    /// Probability of a one, in 16 bits, never quite 0 or 1.
    pub fn predict(&mut self) -> u32 {
        let partial = self.partial;
        let bits = 31 - partial.leading_zeros();
        // The bits of this half of the byte, behind a leading one.
        let half = if bits < 4 { partial } else { partial & 15 >> (8 - bits) | 1 << (bits & 3) };
        let stretch = &self.stretch;
        let opinions = self.opinions.numbers_mut().as_flattened_mut();
        let contexts = self.found.iter_mut().zip(&mut self.slots).zip(&self.meaning);
        for (((found, rows), meaning), opinion) in contexts.zip(opinions.as_chunks_mut::<2>().0) {
            if bits & 3 == 0 {
                let hash = mix(found.hash, partial);
                found.row = hash >> (32 - ROW_BITS);
                found.check = hash as u8 | 1;
            }
            found.place = (found.check >> 4 ^ half as u8) & 15;
            let slot = &mut rows[found.row as usize & ((1 << ROW_BITS) - 1)][usize::from(found.place) & 15];
            if slot.check != found.check {
                *slot = Slot { probability: 1 << 15, check: found.check, seen: 0, history: 0 };
            }
            *opinion = [0.0; 2];
            if slot.seen != 0 {
                *opinion = [stretch.of(slot.probability), stretch.of(meaning[usize::from(slot.history)])];
            }
        }
        let mut matched = 0.0;
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
        self.opinions.numbers_mut()[CONTEXTS / 2] = [matched, 0.4, 0.0, 0.0];

        let agreed = (self.match_length.min(15) as u32 + 1).ilog2();
        let [state, _, opcode, before] = self.selectors;
        self.sets = [state * 8 + bits, partial | agreed << 8, opcode, before];
        let mut sum = 0.0;
        for ((mixed, set), weights) in self.mixed.iter_mut().zip(self.sets).zip(&self.weights) {
            let dot = weights[set as usize & (SETS - 1)].dot(&self.opinions);
            *mixed = squash(dot);
            sum += dot;
        }
        let mean = sum * (1.0 / MIXERS as f32);

        let position = (mean.clamp(-7.99, 7.99) + 8.0) * 2.0;
        let step = position as usize & 31;
        let part = position - step as f32;
        self.nearer = step + usize::from(part > 0.5);
        self.after = (self.last8 << 8) as usize & 0xff00 | partial as usize & 0xff;
        let mut corrected = 0.0;
        for correction in [&self.by_partial[self.after & 0xff], &self.by_byte[self.after & 0xffff]] {
            corrected += f32::from(correction[step]) * (1.0 - part) + f32::from(correction[step + 1]) * part;
        }
        let probability = squash(mean) * 32768.0 + corrected * 0.25;
        (probability as u32).clamp(24, 65536 - 24)
    }

    /// Learns the bit that came.
    pub fn learn(&mut self, bit: u32) {
        let rate = RATE + EARLY_RATE / (1.0 + self.position as f32 * (1.0 / 4000.0));
        for ((mixed, set), weights) in self.mixed.iter().zip(self.sets).zip(&mut self.weights) {
            let error = bit as f32 - mixed;
            weights[set as usize & (SETS - 1)].add_scaled(error * rate, &self.opinions);
        }
        for ((found, rows), meaning) in self.found.iter().zip(&mut self.slots).zip(&mut self.meaning) {
            let slot = &mut rows[found.row as usize & ((1 << ROW_BITS) - 1)][usize::from(found.place) & 15];
            if slot.seen > 0 {
                toward(&mut meaning[usize::from(slot.history)], bit, 50, 1);
            }
            toward(&mut slot.probability, bit, i32::from(slot.seen) * 2 + 3, 2);
            slot.seen += u8::from(slot.seen < SETTLED);
            slot.history = next_history(slot.history, bit);
        }
        let rest = self.partial.leading_zeros() - 24;
        if self.expected != 0 {
            let held = u32::from(self.expected >> rest & 1 == bit);
            toward(&mut self.match_holds[self.match_length.min(31) & 31], held, 32, 1);
        }
        let nearer = self.nearer.min(32);
        toward(&mut self.by_partial[self.after & 0xff][nearer], bit, 40, 1);
        toward(&mut self.by_byte[self.after & 0xffff][nearer], bit, 40, 1);
        self.partial = self.partial << 1 | bit;
    }

    /// Goes on to the next byte; `bytes` is all up to now.
    pub fn end_byte(&mut self, bytes: &[u8]) {
        let byte = self.partial as u8;
        self.partial = 1;
        self.position = bytes.len();
        self.last8 = self.last8 << 8 | u64::from(byte);
        self.walker.step(byte);
        self.look_around();
        self.follow_match(bytes);
    }

    /// What the contexts see before the next byte.
    fn look_around(&mut self) {
        let last4 = self.last8 as u32;
        let before4 = (self.last8 >> 32) as u32;
        let (c1, c4) = (last4 & 0xff, last4 >> 24);
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
            mix(c4 << 8 | before4 >> 24, column),
            mix(one, field),
            mix(walker.modrm & 0xc7, state),
            mix(mix(walker.modrm & 0xc7, field), state),
            mix(mix(mix(p0, p1), p2), mix(p3, current ^ field)),
        ];
        for (i, (found, seen)) in self.found.iter_mut().zip(seen).enumerate() {
            found.hash = mix(seen, i as u32 + 1);
        }
        let left = u32::from(walker.left.min(7));
        self.selectors = [walker.part as u32 | left << 3, 0, walker.opcode & 1023, last4 >> 8 & 0xff];
    }

    /// Keeps to the run that matches what came last, or looks for one.
    fn follow_match(&mut self, bytes: &[u8]) {
        let hash = mix(self.last8 as u32, (self.last8 >> 32) as u32 & 0xff);
        let entry = &mut self.last_seen[(hash >> (32 - MATCH_BITS)) as usize & ((1 << MATCH_BITS) - 1)];
        if self.match_length > 0 {
            self.match_at += 1;
            self.match_length += 1;
        } else {
            self.match_at = *entry as usize;
            let old = bytes.get(..self.match_at).unwrap_or(&[]);
            let equal = old.iter().rev().zip(bytes.iter().rev()).take(32).take_while(|(a, b)| a == b);
            self.match_length = equal.count();
        }
        *entry = bytes.len() as u32;
        self.expected = 0;
        if self.match_length > 0 {
            self.expected = bytes.get(self.match_at).map_or(0, |&byte| u32::from(byte) | 256);
        }
    }
}

/// Moves a probability of 16 bits toward the bit by `part / divisor` of the way.
fn toward(probability: &mut u16, bit: u32, divisor: i32, part: i32) {
    let target = if bit == 1 { 65535 } else { 0 };
    let old = i32::from(*probability);
    *probability = (old + (target - old) * part / divisor) as u16;
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

// A model of zeros starts with an instruction's first byte, and opinions come in fours.
const _: () = assert!(Part::Opcode as u8 == 0 && CONTEXTS.is_multiple_of(2));
