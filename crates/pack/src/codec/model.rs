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

use super::lanes::{Eight, LANES, Reals, Words};
use super::logistic::Stretch;
use super::mixers::{Mixers, Place};
use super::slots::{Slots, Table};
use super::x86::{MIX, Walker, fact, mix};

/// The facts that each context sees; the last one of each has [`LAST`] added.
///
/// Found by a random search.
#[rustfmt::skip]
static SEEN: [u8; 102] = [
    32, 33, 35, LAST + 36,
    32, LAST + 56,
    32, LAST + 33,
    33, LAST + 34,
    0, 1, LAST + 48,
    LAST + 49,
    0, 1, 2, 17, LAST + 18,
    1, 9, LAST + 12,
    1, 48, LAST + 49,
    34, LAST + 35,
    9, 48, LAST + 49,
    LAST + 56,
    LAST + 33,
    4, LAST + 48,
    0, 4, LAST + 48,
    4, 5, 11, LAST + 32,
    0, 1, 8, 9, 10, LAST + 48,
    0, 1, 2, 9, 11, LAST + 49,
    1, 6, 9, 48, LAST + 49,
    5, 11, LAST + 48,
    LAST + 32,
    0, 8, 48, LAST + 49,
    1, 12, LAST + 48,
    2, 9, 11, 17, 19, LAST + 32,
    5, LAST + 57,
    20, 48, LAST + 49,
    0, 1, 9, 16, 17, 25, LAST + 48,
    5, 48, LAST + 49,
    1, 4, 7, LAST + 48,
    47, LAST + 56,
    9, 17, 48, LAST + 49,
    4, LAST + 51,
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
const GROUPS: usize = CONTEXTS / LANES;
/// Opinions, by eights: four of each context, and one that never changes.
const INPUTS: usize = 4 * CONTEXTS / 8 + 1;

/// The byte that followed the last five bytes the last time.
const EXPECTED: usize = fact::OTHERS;
/// The hash of the last five bytes.
const ORDER: usize = EXPECTED + 1;
/// The place in its group of four bytes, and of 32.
const PHASE: usize = ORDER + 1;
const PLACE: usize = PHASE + 1;

/// Learning rate of the mixers in the long run, and what is added to it at the start.
const RATE: f32 = 0.004;
const EARLY_RATE: f32 = 0.006;
/// A slot's probability stops adapting faster than `1 / SETTLED` after that many bits.
const SETTLED: i32 = 107;
/// Shares by which probabilities move, in 15 bits.
const MEANING_SHARE: i32 = 280;
const RUN_SHARE: i32 = 512;

/// What belongs to a register full of contexts.
#[repr(C)]
struct Group {
    /// The hash of what each sees, for this byte and for this half of it.
    hash: Words,
    half: Words,
    /// What it remembers of this bit.
    slot: Slots,
    /// What its history means, and that table's place.
    meaning: Words,
    meaning_at: Words,
    /// What it remembers of the byte that came last: that byte, behind a leading one, and how often in a row
    /// it came.
    run: Slots,
    /// Whether that byte agrees with the bits so far; how probable it is that it comes again, and that table's
    /// place.
    agrees: Words,
    holds: Words,
    holds_at: Words,
}

/// Logarithmic odds: four kinds of each context, and one that never changes.
#[repr(C)]
struct Opinions {
    of_contexts: [[Reals; GROUPS]; 4],
    always: Eight,
}

impl Opinions {
    #[inline(always)]
    fn eights(&self) -> &[Eight; INPUTS] {
        // SAFETY: that's what all are, one behind the other.
        unsafe { &*(&raw const *self).cast() }
    }
}

/// The model. Large; it is never made but by zeroing memory. The small parts come first, where
/// instructions of the launcher reach them with short operands.
#[repr(C)]
pub struct Model {
    walker: Walker,
    /// Bytes done.
    position: u32,
    /// The last byte, behind a leading one, and the last bit.
    byte: i32,
    bit: i32,
    opinions: Opinions,
    groups: [Group; GROUPS],
    /// By context: how often the byte that came last came again, by how often in a row it did before; and
    /// the probability of a one by history. One more than is read.
    holds: [u16; CONTEXTS * 32 + 1],
    meaning: [u16; CONTEXTS * 1024 + 1],
    /// How far a slot's probability moves, by the number of bits seen.
    shares: [u16; 257],
    stretch: Stretch,
    followed: [u8; 1 << 16],
    mixers: Mixers<INPUTS>,
    table: Table,
}

impl Model {
    /// Makes a model of zeroed memory ready for the first byte.
    pub fn start(&mut self) {
        self.stretch.fill();
        for (i, probability) in self.meaning.iter_mut().enumerate() {
            let (zeros, ones) = ((i >> 6 & 15) as u32 * 5 + 2, (i >> 2 & 15) as u32 * 5 + 2);
            *probability = ((ones << 16) / (zeros + ones)) as u16;
        }
        self.holds.fill(0xe000);
        for (seen, share) in self.shares.iter_mut().enumerate() {
            *share = (65536 / (seen * 2 + 3)) as u16;
        }
        self.mixers.start();
        self.opinions.always = Eight::all(0.28);
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
            facts[fact::BYTES] & 255 | (state as u32 & 7) << 8,
        ];
        let rate = RATE + EARLY_RATE / (1.0 + self.position as f32 * (1.0 / 4000.0));
        self.position += 1;

        // The bits of the byte so far, and of this half of it, behind a leading one.
        let mut byte = 1;
        let mut half = 1;
        for rest in (0..8u32).rev() {
            if rest & 3 == 3 {
                half = 1;
            }
            self.learn((rest + 1) & 7, byte);
            if rest == 7 {
                self.learn_runs();
            }
            for (i, group) in self.groups.iter_mut().enumerate() {
                let contexts = Words::ORDER + Words::all((i * LANES) as i32);
                let opinions = &mut self.opinions.of_contexts;
                // SAFETY: all places are: a context's number times the entries of each, and an entry; 12 bits
                // of a probability; a number seen.
                unsafe {
                    let slot = self.table.load(group.half, half);
                    let new = slot.seen.equals(Words::all(0));
                    let at = contexts * Words::all(1024) + (slot.history & Words::all(1023));
                    let meaning = Words::pairs(&self.meaning, at) & Words::all(0xffff);
                    let so_far = self.stretch.of_all(slot.probability).as_words().without(new);
                    let zeros = (slot.history & Words::all(15 << 6)).equals(Words::all(0));
                    let ones = (slot.history & Words::all(15 << 2)).equals(Words::all(0));
                    opinions[0][i] = so_far.as_reals();
                    opinions[1][i] = self.stretch.of_all(meaning).as_words().without(new).as_reals();
                    opinions[2][i] = (so_far & (zeros | ones)).as_reals();
                    group.slot = slot;
                    group.meaning = meaning;
                    group.meaning_at = at;
                    if rest == 7 {
                        group.run = self.table.load(group.half, 0);
                    }
                    let expected = group.run.probability;
                    group.agrees = (expected >> (rest + 1)).equals(Words::all(byte));
                    let at = contexts * Words::all(32) + (group.run.seen & Words::all(31));
                    group.holds = Words::pairs(&self.holds, at) & Words::all(0xffff);
                    group.holds_at = at;
                    let sign = ((expected >> rest) ^ Words::all(1)) << 31;
                    opinions[3][i] =
                        ((self.stretch.of_all(group.holds).as_words() ^ sign) & group.agrees).as_reals();
                }
            }
            let run = &self.groups[0].run;
            sets[1] = byte as u32;
            if run.probability.0[0] >> (rest + 1) == byte {
                sets[1] |= (run.seen.0[0] as u32).min(7) * 256;
            }

            let place = Place { sets, state, byte: byte as usize };
            let opinions = self.opinions.eights();
            let mixed = self.mixers.mix(&place, opinions);
            // SAFETY: the product is no less than 0 and less than 65536.
            let one = unsafe { (mixed.said * 65536.0).to_int_unchecked::<i32>() } as u32;
            let bit = coder(one.clamp(24, 65536 - 24)) as i32;

            self.mixers.learn(&place, bit as f32, &mixed, rate, opinions);
            self.bit = bit;
            sets[0] += 1;
            byte = byte << 1 | bit;
            half = half << 1 | bit;
        }

        self.byte = byte;
        self.followed[usize::from(self.walker.facts[ORDER] as u16)] = byte as u8;
        self.walker.step(byte as u8);
        byte as u8
    }

    /// Takes the last bit, behind which `rest` were left of its byte, into what the contexts remember, while
    /// what they will see in the next half of a byte is on its way from memory.
    #[inline(always)]
    fn learn(&mut self, rest: u32, byte: i32) {
        let bit = self.bit;
        let target = Words::all(-bit & 0xffff);
        for group in &mut self.groups {
            if rest & 3 == 0 {
                group.half = mix_all(group.hash, Words::all(byte));
                self.table.fetch(group.half);
            }
            let slot = &mut group.slot;
            let new = slot.seen.equals(Words::all(0));
            let meaning = toward(group.meaning, target, Words::all(MEANING_SHARE));
            let meaning = new.choose(group.meaning, meaning);
            // SAFETY: the numbers seen are less than 256.
            let share = unsafe { Words::pairs(&self.shares, slot.seen) } & Words::all(0xffff);
            slot.probability = toward(slot.probability, target, share);
            slot.seen = (slot.seen + Words::all(1)).min(Words::all(SETTLED));
            slot.history = next_history(slot.history, bit);
            self.table.store(slot);
            let bits = group.run.probability >> rest & Words::all(1);
            let held = bits.equals(Words::all(bit)) & Words::all(0xffff);
            let holds = toward(group.holds, held, Words::all(RUN_SHARE));
            let holds = group.agrees.choose(holds, group.holds);
            for lane in 0..LANES {
                // SAFETY: as where they were read.
                unsafe {
                    *self.meaning.get_unchecked_mut(group.meaning_at.0[lane] as usize) =
                        meaning.0[lane] as u16;
                    *self.holds.get_unchecked_mut(group.holds_at.0[lane] as usize) = holds.0[lane] as u16;
                }
            }
        }
    }

    /// Takes the last byte into what the contexts remember.
    #[inline(always)]
    fn learn_runs(&mut self) {
        for group in &mut self.groups {
            let run = &mut group.run;
            let again = run.probability.equals(Words::all(self.byte));
            run.probability = Words::all(self.byte);
            run.seen = ((run.seen & again) + Words::all(1)).min(Words::all(31));
            self.table.store(run);
        }
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
        for &entry in &SEEN {
            hash = mix(hash, walker.facts[usize::from(entry) & 63]);
            if entry >= LAST {
                self.groups[(i / LANES) & (GROUPS - 1)].hash.0[i & (LANES - 1)] = hash as i32;
                i += 1;
                hash = i as u32;
            }
        }
    }
}

/// [`mix`] of all lanes.
#[inline(always)]
fn mix_all(a: Words, b: Words) -> Words {
    let part = |i: usize| Words::all(MIX[i] as i32);
    let h = a * part(0) + b * part(1) + part(2);
    ((h ^ h >> 15) * part(3)) ^ h >> 13
}

/// Moves probabilities of 16 bits toward the target, 0 or 65535, by `share` / 32768 of the way.
#[inline(always)]
fn toward(old: Words, target: Words, share: Words) -> Words {
    old + ((target - old) * share).halved(15)
}

/// The history after one more bit: its count goes up, and a large count of the other falls to 3, since
/// what happened lately counts more.
#[inline(always)]
fn next_history(history: Words, bit: i32) -> Words {
    let up = if bit == 1 { 2 } else { 6 };
    let fifteen = Words::all(15);
    let (same, other) = (history >> up & fifteen, history >> (8 - up) & fifteen);
    (same + Words::all(1)).min(fifteen) << up
        | other.min(Words::all(3)) << (8 - up)
        | (history & Words::all(1)) << 1
        | Words::all(bit)
}
