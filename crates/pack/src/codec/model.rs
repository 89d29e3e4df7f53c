//! The context-mixing model: how likely the next bit of a program is a one.
//!
//! Each of [`CONTEXTS`] sees other facts of a list: the last bytes, and the parts of the current and
//! the last instructions that the [`Walker`] knows. Under the hash of what it sees and of the
//! bits of the byte so far it keeps a slot, which gives three opinions: how often the bit was a
//! one there; by a table that learns, what the pattern of ones and zeros there usually meant; and the
//! first once more if the bit was always the same. A match model follows the longest repetition. Four
//! mixers, each with a set of weights chosen by another selector, add the opinions up, and a fifth adds
//! them; its sum is corrected by two tables that learn how far such a prediction is to be trusted after
//! this byte.
//!
//! Which facts the contexts see (`SEEN`) was found by a random search that flipped, copied, added and dropped
//! and kept what made the intro and gzip smaller. Programs that it didn't know (bc, mawk, grotty) became 2.8 to 3.7 %
//! smaller by it and the mixer of mixers, gzip 3.4 %, the intro 5.7 %.
//!
//! All memory is part of [`Model`], which starts as zeros.
//!
//! Source: Matt Mahoney's paq8 and lpaq1 for the architecture; Fabian Giesen's kkrunchy and Rune
//! Stubbe's and Aske Christensen's Crinkler for contexts that follow instructions.

use super::logistic::{Stretch, Vector, squash};
use super::x86::{Part, Walker, mix};

/// The facts that each context sees: bit i stands for fact i in [`Model::look_around`].
const SEEN: [u32; CONTEXTS] = [
    0x00000001, 0x00000003, 0x0000003b, 0x004003c0, 0x000573c0, 0x100dc3c0, 0x00083150, 0x00001140,
    0x00000006, 0x00002140, 0x01000008, 0x05000008, 0x00000840, 0x00021840, 0x5804c380, 0x00092bc0,
    0x000223c0, 0x0000e3c0, 0x000010c0, 0x00000002, 0x000813c0, 0x00101040, 0x00022041, 0x200033c8,
    0x00201040, 0x0800e3c0, 0x00010040, 0x02001140, 0x00000005, 0x01001240, 0x40021860,
];
/// Number of contexts.
pub const CONTEXTS: usize = 31;
/// Opinions, in fours: three for each context, then the match model's and a constant.
const FOURS: usize = (3 * CONTEXTS + 2).div_ceil(4);
/// Mixers.
const MIXERS: usize = 4;
/// Sets of weights of each mixer.
const SETS: usize = 2048;
/// Rows of sixteen slots for each context, as a power of two.
const ROW_BITS: u32 = 15;
/// Entries of the match model's table, as a power of two.
const MATCH_BITS: u32 = 16;

/// Weight of each opinion at the start.
const FIRST_WEIGHT: f32 = 0.03;
/// Learning rate of the mixers in the long run, and what is added to it at the start.
const RATE: f32 = 0.0044;
const EARLY_RATE: f32 = 0.012;
/// That of the mixer of mixers.
const TRUST_RATE: f32 = 0.002;
/// A slot's probability stops adapting faster than `1 / SETTLED` after that many bits.
const SETTLED: u8 = 107;

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
    /// the instruction, nothing, the opcode, and the last byte.
    selectors: [u32; MIXERS],
    /// The sets in use.
    sets: [u32; MIXERS],
    /// What each mixer said.
    mixed: [f32; MIXERS],
    /// The same, squashed.
    squashed: [f32; MIXERS],
    /// What the mixer of mixers said, squashed.
    said: f32,
    /// Where the corrections came from: by the byte before, and the step.
    after: usize,
    nearer: usize,
    opinions: Vector<FOURS>,
    found: [Found; CONTEXTS],
    /// The modes of operands that opcodes had last, and the opcodes that came after.
    last_modrm: [u32; 1024],
    last_follower: [u32; 1024],
    /// Weights of the mixers themselves, by the part of the instruction.
    trust: [[f32; MIXERS]; 64],
    /// How often a match of a length held: probability.
    match_holds: [u16; 32],
    /// How far a slot's probability moves, by the number of bits seen.
    shares: [u16; 256],
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
        for (seen, share) in self.shares.iter_mut().enumerate() {
            *share = (65536 / (seen * 2 + 3)) as u16;
        }
        self.trust = [[1.0 / MIXERS as f32; MIXERS]; 64];
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
        if bits & 3 == 0 {
            for (found, rows) in self.found.iter_mut().zip(&self.slots) {
                let hash = mix(found.hash, partial);
                found.row = hash >> (32 - ROW_BITS);
                found.check = hash as u8 | 1;
                fetch(&rows[found.row as usize & ((1 << ROW_BITS) - 1)]);
            }
        }
        let stretch = &self.stretch;
        let opinions = self.opinions.numbers_mut().as_flattened_mut();
        let contexts = self.found.iter_mut().zip(&mut self.slots).zip(&self.meaning);
        for (((found, rows), meaning), opinion) in contexts.zip(opinions.as_chunks_mut::<3>().0) {
            found.place = (found.check >> 4 ^ half as u8) & 15;
            let slot = &mut rows[found.row as usize & ((1 << ROW_BITS) - 1)][usize::from(found.place) & 15];
            if slot.check != found.check {
                *slot = Slot { probability: 1 << 15, check: found.check, seen: 0, history: 0 };
            }
            *opinion = [0.0; 3];
            if slot.seen != 0 {
                let so_far = stretch.of(slot.probability);
                let both = slot.history & 0xe0 != 0 && slot.history & 0x1c != 0;
                *opinion =
                    [so_far, stretch.of(meaning[usize::from(slot.history)]), if both { 0.0 } else { so_far }];
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
        let last = &mut self.opinions.numbers_mut().as_flattened_mut()[3 * CONTEXTS..][..2];
        last.copy_from_slice(&[matched, 0.4]);

        let agreed = (self.match_length.min(15) as u32 + 1).ilog2();
        let [state, _, opcode, last] = self.selectors;
        self.sets = [state * 8 + bits, partial | agreed << 8, opcode, last];
        let mut mean = 0.0;
        let trust = &self.trust[state as usize & 63];
        for (i, (set, weights)) in self.sets.iter().zip(&self.weights).enumerate() {
            let dot = weights[*set as usize & (SETS - 1)].dot(&self.opinions);
            self.mixed[i] = dot;
            self.squashed[i] = squash(dot);
            mean += dot * trust[i];
        }
        self.said = squash(mean);

        let position = (mean.clamp(-7.99, 7.99) + 8.0) * 2.0;
        let step = position as usize & 31;
        let part = position - step as f32;
        self.nearer = step + usize::from(part > 0.5);
        self.after = (self.last8 << 8) as usize & 0xff00 | partial as usize & 0xff;
        let mut corrected = 0.0;
        for correction in [&self.by_partial[self.after & 0xff], &self.by_byte[self.after & 0xffff]] {
            corrected += f32::from(correction[step]) * (1.0 - part) + f32::from(correction[step + 1]) * part;
        }
        let probability = self.said * 65536.0 * 0.45 + corrected * (0.55 * 0.5);
        (probability as u32).clamp(24, 65536 - 24)
    }

    /// Learns the bit that came.
    pub fn learn(&mut self, bit: u32) {
        let rate = RATE + EARLY_RATE / (1.0 + self.position as f32 * (1.0 / 4000.0));
        let error = (bit as f32 - self.said) * TRUST_RATE;
        for (trust, mixed) in self.trust[self.selectors[0] as usize & 63].iter_mut().zip(self.mixed) {
            *trust += error * mixed;
        }
        for ((mixed, set), weights) in self.squashed.iter().zip(self.sets).zip(&mut self.weights) {
            let error = bit as f32 - mixed;
            weights[set as usize & (SETS - 1)].add_scaled(error * rate, &self.opinions);
        }
        for ((found, rows), meaning) in self.found.iter().zip(&mut self.slots).zip(&mut self.meaning) {
            let slot = &mut rows[found.row as usize & ((1 << ROW_BITS) - 1)][usize::from(found.place) & 15];
            if slot.seen > 0 {
                toward(&mut meaning[usize::from(slot.history)], bit, 410);
            }
            toward(&mut slot.probability, bit, i32::from(self.shares[usize::from(slot.seen)]));
            slot.seen += u8::from(slot.seen < SETTLED);
            slot.history = next_history(slot.history, bit);
        }
        let rest = self.partial.leading_zeros() - 24;
        if self.expected != 0 {
            let held = u32::from(self.expected >> rest & 1 == bit);
            toward(&mut self.match_holds[self.match_length.min(31) & 31], held, 1024);
        }
        let nearer = self.nearer.min(32);
        toward(&mut self.by_partial[self.after & 0xff][nearer], bit, 910);
        toward(&mut self.by_byte[self.after & 0xffff][nearer], bit, 910);
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

    /// What the contexts see before the next byte: the facts, of which each sees those in its mask.
    fn look_around(&mut self) {
        let (last4, before4) = (self.last8 as u32, (self.last8 >> 32) as u32);
        let walker = &self.walker;
        let past = &walker.past;
        let [opcode1, opcode2, opcode3, opcode4] = past.opcodes;
        let [modrm1, modrm2, modrm3] = past.modrms;
        if walker.part == Part::Opcode {
            self.last_modrm[opcode1 as usize & 1023] = modrm1;
            self.last_follower[opcode2 as usize & 1023] = opcode1;
        }
        let state = walker.part as u32 | u32::from(walker.left) << 4 | u32::from(walker.map) << 8;
        let facts = [
            // 0: the last bytes.
            last4 & 0xff,
            last4 & 0xff00,
            last4 & 0xff_0000,
            last4 & 0xff00_0000,
            before4 & 0xffff,
            before4 >> 16,
            // 6: this instruction so far.
            state,
            walker.prefix,
            walker.opcode,
            walker.modrm,
            walker.modrm & REGISTER,
            walker.modrm & !REGISTER & 0xff,
            walker.field,
            // 13: the instructions before.
            opcode1,
            opcode2,
            opcode3,
            modrm1,
            modrm1 & REGISTER,
            modrm2,
            past.prefixes[0],
            past.offset,
            past.displacement,
            // 22: what came with such an opcode, or behind it, the last time.
            self.last_modrm[walker.opcode as usize & 1023],
            self.last_follower[opcode1 as usize & 1023],
            // 24: more of the above.
            self.position as u32 & 3,
            past.immediate,
            before4 >> 24,
            opcode4,
            modrm3,
            past.prefixes[1],
            walker.displacement,
            modrm2 & REGISTER,
        ];
        for (i, (found, mask)) in self.found.iter_mut().zip(SEEN).enumerate() {
            found.hash = i as u32;
            let mut rest = mask;
            while rest != 0 {
                found.hash = mix(found.hash, facts[rest.trailing_zeros() as usize & 31]);
                rest &= rest - 1;
            }
        }
        let left = u32::from(walker.left.min(7));
        self.selectors = [walker.part as u32 | left << 3, 0, walker.opcode & 1023, last4 & 0xff];
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

/// The field of a ModRM byte that names a register.
const REGISTER: u32 = 0x38;

/// Tells the processor that a row will be read soon, so that it needn't wait for one after the other.
fn fetch(row: &[Slot; 16]) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: reads nothing; all x86-64 processors have the instruction.
    unsafe {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>((&raw const row[0]).cast());
        _mm_prefetch::<_MM_HINT_T0>((&raw const row[15]).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = row;
}

/// Moves a probability of 16 bits toward the bit, by `share` / 32768 of the way.
fn toward(probability: &mut u16, bit: u32, share: i32) {
    let old = i32::from(*probability);
    let target = -(bit as i32) & 0xffff;
    *probability = (old + (((target - old) * share) >> 15)) as u16;
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

// A model of zeros starts with an instruction's first byte.
const _: () = assert!(Part::Opcode as u8 == 0);
