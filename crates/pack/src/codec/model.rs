//! The context-mixing model: how likely the next bit of a program is a one.
//!
//! Each context of a list sees other facts: the last bytes, and the parts of the current and the
//! last instructions that the [`Walker`] knows. Under the hash of what it sees and of the bits of
//! the byte so far it keeps a slot, which gives three opinions: how often the bit was a one there; by a
//! table that learns, what such a sequence of ones and zeros usually meant; and the first once more if
//! the bit was always the same. A fourth comes from the byte that followed last time, and how often
//! in a row. Mixers, each with a set of weights chosen by another selector, add the opinions up,
//! and a last one adds the mixers.
//!
//! All memory is part of [`Model`], which starts as zeros.
//!
//! Source: Matt Mahoney's paq8 and lpaq1 for the architecture; Fabian Giesen's kkrunchy and Rune
//! Stubbe's and Aske Christensen's Crinkler for contexts that follow instructions.

use super::logistic::{Four, Stretch, dot, move_along, squash};
use super::x86::{Walker, fact, mix};

/// The facts that each context sees; the last one of each has [`LAST`] added.
///
/// Found by a random search.
#[rustfmt::skip]
static SEEN: [u8; 103] = [
    5, 32, 33, 35, LAST + 36,
    32, LAST + 56,
    32, LAST + 33,
    33, LAST + 34,
    0, 1, LAST + 48,
    LAST + 49,
    0, 1, 2, 17, LAST + 18,
    1, 9, 36, 37, LAST + 48,
    1, 48, LAST + 49,
    34, LAST + 35,
    9, 48, LAST + 49,
    21, LAST + 56,
    39, LAST + 58,
    4, LAST + 48,
    0, 4, LAST + 48,
    16, LAST + 32,
    0, 1, 8, 9, 10, LAST + 48,
    0, 1, 2, 9, LAST + 11,
    1, 6, 25, 38, 43, 48, LAST + 49,
    48, LAST + 58,
    32, LAST + 50,
    0, 1, 8, 48, LAST + 49,
    1, 12, LAST + 48,
    9, 11, 17, 19, LAST + 32,
    LAST + 4,
    6, 48, LAST + 49,
    0, 1, 9, 16, 17, 25, LAST + 48,
    5, 48, LAST + 49,
    1, 7, LAST + 48,
    32, LAST + 48,
    9, 17, LAST + 48,
    2, LAST + 51,
];
/// Marks the last fact of a context.
const LAST: u8 = 0x80;
/// Number of contexts, a power of two.
const CONTEXTS: usize = {
    let (mut count, mut i) = (0, 0);
    while i < SEEN.len() {
        count += (SEEN[i] >= LAST) as usize;
        i += 1;
    }
    assert!(count.is_power_of_two());
    count
};

/// The byte that followed the last five bytes the last time.
const EXPECTED: usize = fact::OTHERS;
/// The hash of the last five bytes.
const ORDER: usize = EXPECTED + 1;
/// The place in its group of four bytes, and of 32.
const PHASE: usize = ORDER + 1;
const PLACE: usize = PHASE + 1;

/// Mixers.
const MIXERS: usize = 5;
/// Sets of weights of each mixer.
const SETS: usize = 2048;
/// Slots of all contexts together, as a power of two.
const SLOT_BITS: u32 = 25;

/// Weight of each opinion at the start.
const FIRST_WEIGHT: f32 = 0.03;
/// Learning rate of the mixers in the long run, and what is added to it at the start.
const RATE: f32 = 0.004;
const EARLY_RATE: f32 = 0.006;
/// That of the mixer of mixers.
const TRUST_RATE: f32 = 0.0008;
/// A slot's probability stops adapting faster than `1 / SETTLED` after that many bits.
const SETTLED: u8 = 107;
/// Shares by which probabilities move, in 15 bits.
const MEANING_SHARE: i32 = 280;
const RUN_SHARE: i32 = 512;

/// What a context remembers of one bit position, or of the byte that came last.
#[derive(Clone, Copy)]
struct Slot {
    /// Probability of a one, 16 bits; or the byte.
    probability: u16,
    /// Counts of zeros (bits 6..10) and ones (2..6), and the last two bits.
    history: u16,
    /// Tells contexts that share the slot apart, most of the time.
    check: u8,
    /// Bits seen, up to [`SETTLED`]; or how often in a row that byte came.
    seen: u8,
}

/// What belongs to one context.
#[repr(C)]
struct Context {
    /// The hash of what it sees, for this byte and for this half of it.
    hash: u32,
    half: u32,
    /// The slot of the byte that came last.
    run: u32,
    /// That byte, behind a leading one, and how often in a row it came.
    expected: u32,
    times: u32,
    /// How often it came again: probability.
    holds: [u16; 32],
    /// Meaning of histories: probability of a one.
    meaning: [u16; 1024],
}

/// The model. Large; it is never made but by zeroing memory. The small parts come first, where
/// instructions of the launcher reach them with short operands.
#[repr(C)]
pub struct Model {
    walker: Walker,
    /// Bytes done.
    position: u32,
    opinions: [Four; CONTEXTS + 1],
    contexts: [Context; CONTEXTS],
    /// How far the mixers' own weights are from equal ones, by the part of the instruction, and by it and the
    /// bits of the byte so far.
    trust: [[f32; MIXERS]; 64],
    trust_so_far: [[f32; MIXERS]; 64 << 8],
    /// How far a slot's probability moves, by the number of bits seen.
    shares: [u16; 256],
    stretch: Stretch,
    followed: [u8; 1 << 16],
    weights: [[[Four; CONTEXTS + 1]; SETS]; MIXERS],
    slots: [Slot; 1 << SLOT_BITS],
}

impl Model {
    /// Makes a model of zeroed memory ready for the first byte.
    pub fn start(&mut self) {
        self.stretch.fill();
        for context in &mut self.contexts {
            for (history, probability) in context.meaning.iter_mut().enumerate() {
                let (zeros, ones) = ((history >> 6) as u32 * 5 + 2, (history >> 2 & 15) as u32 * 5 + 2);
                *probability = ((ones << 16) / (zeros + ones)) as u16;
            }
            context.holds = [0xe000; 32];
        }
        for (seen, share) in self.shares.iter_mut().enumerate() {
            *share = (65536 / (seen * 2 + 3)) as u16;
        }
        for four in self.weights.as_flattened_mut().as_flattened_mut() {
            *four = Four::all(FIRST_WEIGHT);
        }
        if let Some(last) = self.opinions.last_mut() {
            *last = Four::all(0.4);
        }
    }

    /// The next byte. `coder` is told for each bit how likely it is a one, in 16 bits, never quite
    /// 0 or 1, and tells which it is.
    pub fn byte(&mut self, mut coder: impl FnMut(u32) -> u32) -> u8 {
        self.look_around();
        let facts = &self.walker.facts;
        let state = self.walker.part as usize | usize::from(self.walker.left.min(7)) << 3;
        let follower = facts[fact::OPCODE + fact::RECORD] & 1023 | u32::from(state == 0) << 10;
        let mut sets = [
            state as u32 * 8,
            0,
            facts[fact::OPCODE] & 1023,
            facts[fact::BYTES + 2] & 255 | (state as u32 & 7) << 8,
            follower,
        ];
        let rate = RATE + EARLY_RATE / (1.0 + self.position as f32 * (1.0 / 4000.0));
        self.position += 1;
        let trust = &mut self.trust[state & 63];

        // The bits of the byte so far, and of this half of it, behind a leading one.
        let mut byte = 1;
        let mut half = 1;
        for rest in (0..8u32).rev() {
            if rest & 3 == 3 {
                half = 1;
                for context in &mut self.contexts {
                    context.half = mix(context.hash, byte);
                    fetch(&self.slots, place(context.half, 0));
                }
            }
            for (context, opinions) in self.contexts.iter_mut().zip(&mut self.opinions) {
                let slot = claim(&mut self.slots, context.half, half);
                let mut four = [0.0; 4];
                if slot.seen != 0 {
                    let so_far = self.stretch.of(slot.probability);
                    four[0] = so_far;
                    four[1] = self.stretch.of(context.meaning[usize::from(slot.history) & 1023]);
                    if slot.history & 15 << 6 == 0 || slot.history & 15 << 2 == 0 {
                        four[2] = so_far;
                    }
                }
                if rest == 7 {
                    context.run = context.half;
                    let run = claim(&mut self.slots, context.run, 0);
                    context.times = u32::from(run.seen);
                    context.expected = u32::from(run.probability);
                }
                if context.expected >> (rest + 1) == byte {
                    let holds = self.stretch.of(context.holds[context.times as usize & 31]);
                    four[3] = if context.expected >> rest & 1 != 0 { holds } else { -holds };
                }
                *opinions = Four::of(four);
            }
            let first = &self.contexts[0];
            sets[1] = byte;
            if first.expected >> (rest + 1) == byte {
                sets[1] |= first.times.min(7) * 256;
            }

            let so_far = &mut self.trust_so_far[(state & 63) << 8 | byte as usize & 255];
            let mut mixed = [0.0; MIXERS];
            let mut mean = 0.0;
            for i in 0..MIXERS {
                mixed[i] = dot(&self.weights[i][sets[i] as usize & (SETS - 1)], &self.opinions);
                mean += mixed[i] * (trust[i] + so_far[i] + 1.0 / MIXERS as f32);
            }
            let said = squash(mean);
            // SAFETY: the product is no less than 0 and less than 65536.
            let one = unsafe { (said * 65536.0).to_int_unchecked::<i32>() } as u32;
            let bit = coder(one.clamp(24, 65536 - 24));

            let error = (bit as f32 - said) * TRUST_RATE;
            for i in 0..MIXERS {
                trust[i] += error * mixed[i];
                so_far[i] += error * mixed[i];
                let error = bit as f32 - squash(mixed[i]);
                // A mixer that is nearly right has little to learn, and time is short.
                if error.abs() > 0.02 {
                    move_along(
                        &mut self.weights[i][sets[i] as usize & (SETS - 1)],
                        error * rate,
                        &self.opinions,
                    );
                }
            }
            for context in &mut self.contexts {
                let slot = &mut self.slots[place(context.half, half)];
                if slot.seen != 0 {
                    toward(&mut context.meaning[usize::from(slot.history) & 1023], bit, MEANING_SHARE);
                }
                toward(&mut slot.probability, bit, i32::from(self.shares[usize::from(slot.seen)]));
                slot.seen += u8::from(slot.seen < SETTLED);
                slot.history = next_history(slot.history, bit);
                if context.expected >> (rest + 1) == byte {
                    let held = u32::from(context.expected >> rest & 1 == bit);
                    toward(&mut context.holds[context.times as usize & 31], held, RUN_SHARE);
                }
            }
            sets[0] += 1;
            byte = byte << 1 | bit;
            half = half << 1 | bit;
        }

        for context in &mut self.contexts {
            let run = &mut self.slots[place(context.run, 0)];
            if byte != context.expected {
                run.probability = byte as u16;
                run.seen = 0;
            }
            run.seen += u8::from(run.seen < 31);
        }
        self.followed[usize::from(self.walker.facts[ORDER] as u16)] = byte as u8;
        self.walker.step(byte as u8);
        byte as u8
    }

    /// What the contexts see before the next byte.
    fn look_around(&mut self) {
        let walker = &mut self.walker;
        walker.facts[fact::STATE] = walker.state();
        walker.facts[PHASE] = self.position & 3;
        walker.facts[PLACE] = self.position & 31;
        walker.facts[ORDER] = 0;
        for i in fact::BYTES..fact::BYTES + 5 {
            walker.facts[ORDER] = mix(walker.facts[ORDER], walker.facts[i]);
        }
        walker.facts[EXPECTED] = u32::from(self.followed[usize::from(walker.facts[ORDER] as u16)]);
        walker.recall();
        let mut i = 0;
        let mut hash = 0;
        for entry in SEEN {
            hash = mix(hash, walker.facts[usize::from(entry) & 63]);
            if entry >= LAST {
                self.contexts[i & (CONTEXTS - 1)].hash = hash;
                i += 1;
                hash = i as u32;
            }
        }
    }
}

/// Where a context's slot for this part of the byte is.
fn place(hash: u32, part: u32) -> usize {
    (hash >> 7 ^ part & 15) as usize
}

/// That slot, emptied if it was another context's.
fn claim(slots: &mut [Slot; 1 << SLOT_BITS], hash: u32, part: u32) -> &mut Slot {
    let slot = &mut slots[place(hash, part)];
    let check = hash as u8 | 1;
    if slot.check != check {
        *slot = Slot { probability: 1 << 15, history: 0, check, seen: 0 };
    }
    slot
}

/// Tells the processor that a row of slots will be read soon, so that it needn't wait for one after
/// the other.
fn fetch(slots: &[Slot; 1 << SLOT_BITS], at: usize) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: reads nothing; all x86-64 processors have the instruction.
    unsafe {
        use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let row = &raw const slots[at & !15];
        _mm_prefetch::<_MM_HINT_T0>(row.cast());
        _mm_prefetch::<_MM_HINT_T0>(row.wrapping_add(15).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (slots, at);
}

/// Moves a probability of 16 bits toward the bit, by `share` / 32768 of the way.
fn toward(probability: &mut u16, bit: u32, share: i32) {
    let old = i32::from(*probability);
    let target = -(bit as i32) & 0xffff;
    *probability = (old + (((target - old) * share) >> 15)) as u16;
}

/// The history after one more bit: its count goes up, and a large count of the other falls to 3, since
/// what happened lately counts more.
fn next_history(history: u16, bit: u32) -> u16 {
    let up = if bit == 1 { 2 } else { 6 };
    let (same, other) = (history >> up & 15, history >> (8 - up) & 15);
    (same + 1).min(15) << up | other.min(3) << (8 - up) | history << 1 & 2 | bit as u16
}
