//! The table in which contexts keep what they remember.
//!
//! A slot is three halves of a word: a probability; a history; and a check in the low byte, which tells contexts
//! that share the slot apart, most of the time, with the number seen above it. The fifteen slots for the bits of
//! half a byte and one for the byte that came last lie in one row of 96 bytes, so that a context waits for memory
//! but once in half a byte.

use super::lanes::{LANES, Words};

/// Slots of all contexts together, as a power of two.
const BITS: u32 = 25;

/// All slots; zeros at the start. One half more than is read.
#[repr(C)]
pub struct Table([u16; (3 << BITS) + 1]);

/// What contexts remember of one bit position, or of the byte that came last.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Slots {
    /// Where they are.
    at: Words,
    check: Words,
    /// Probability of a one, 16 bits; or the byte.
    pub probability: Words,
    /// Counts of zeros (bits 6..10) and ones (2..6), and the last two bits.
    pub history: Words,
    /// Bits seen, less than 256; or how often in a row that byte came.
    pub seen: Words,
}

impl Table {
    /// Those of the contexts with these hashes for this part of half a byte, emptied if they were others'.
    #[inline(always)]
    pub fn load(&self, hash: Words, part: i32) -> Slots {
        let slot = (hash >> 7) ^ Words::all(part & 15);
        let at = slot + slot + slot;
        let check = hash & Words::all(255) | Words::all(1);
        // SAFETY: 25 bits of the hash are the number of a slot.
        let (low, high) = unsafe { (Words::pairs(&self.0, at), Words::pairs(&self.0, at + Words::all(2))) };
        let same = (high & Words::all(255)).equals(check);
        Slots {
            at,
            check,
            probability: same.choose(low & Words::all(0xffff), Words::all(1 << 15)),
            history: low >> 16 & same,
            seen: high >> 8 & Words::all(255) & same,
        }
    }

    /// Keeps them where they were.
    #[inline(always)]
    pub fn store(&mut self, slots: &Slots) {
        let high = slots.seen << 8 | slots.check;
        let low = slots.history << 16 | slots.probability;
        for lane in 0..LANES {
            // SAFETY: as where they were loaded.
            unsafe {
                let slot = self.0.as_mut_ptr().add(slots.at.0[lane] as usize);
                slot.cast::<i32>().write_unaligned(low.0[lane].to_le());
                *slot.add(2) = high.0[lane] as u16;
            }
        }
    }

    /// Tells the processor that these rows will be read soon, so that it needn't wait for one after the other.
    #[inline(always)]
    pub fn fetch(&self, hash: Words) {
        #[cfg(target_arch = "x86_64")]
        {
            use core::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            let row = hash >> 7 & Words::all(!15);
            for row in (row + row + row).0 {
                let row = self.0.as_ptr().wrapping_add(row as usize);
                // SAFETY: reads nothing; all x86-64 processors have the instruction.
                unsafe {
                    _mm_prefetch::<_MM_HINT_T0>(row.cast());
                    _mm_prefetch::<_MM_HINT_T0>(row.wrapping_add(47).cast());
                }
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = hash;
    }
}
