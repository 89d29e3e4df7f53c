//! The LZMA decoder: repetitions and adaptive bits, for the method `lzma`.
//!
//! A raw LZMA stream without header and end mark, with lc = 3, lp = 0, pb = 0; the length of the
//! output is known. Bytes before the output read as zeros, input past its end too, and copies
//! stop at the output's end, so damaged input gives wrong bytes but always ends.
//!
//! Source: Igor Pavlov, LZMA specification (of the LZMA SDK); names as there where they exist.

/// Number of adaptive bits. They lie in one array, each group at its place:
const BITS: usize = 0x2000;
/// Match or literal, by state; and the four questions about repeated distances, likewise.
const IS_MATCH: usize = 0x00;
const IS_REP: usize = 0x10;
const IS_REP_G0: usize = 0x20;
const IS_REP_G1: usize = 0x30;
const IS_REP_G2: usize = 0x40;
const IS_REP0_LONG: usize = 0x50;
/// The lowest four bits of far distances.
const ALIGN: usize = 0x60;
/// Lengths of matches, and of repeated ones: two choices, then trees of 8, 8 and 256 leaves.
const LENGTH: usize = 0x080;
const REP_LENGTH: usize = 0x200;
/// The magnitude of a distance, by length; and the low bits of near distances.
const SLOT: usize = 0x400;
const NEAR: usize = 0x500;
/// Literals, by the high bits of the byte before.
const LITERAL: usize = 0x800;

/// The range decoder and its adaptive bits.
pub struct Decoder<'a> {
    input: &'a [u8],
    range: u32,
    code: u32,
    bits: [u16; BITS],
}

impl Decoder<'_> {
    #[inline(never)]
    fn next(&mut self) {
        let (&byte, rest) = self.input.split_first().unwrap_or((&0, &[]));
        self.input = rest;
        self.code = self.code << 8 | u32::from(byte);
    }

    fn normalize(&mut self) {
        if self.range >> 24 == 0 {
            self.range <<= 8;
            self.next();
        }
    }

    /// An adaptive bit.
    #[inline(never)]
    fn bit(&mut self, index: usize) -> usize {
        let chance = &mut self.bits[index & (BITS - 1)];
        let bound = (self.range >> 11) * u32::from(*chance);
        let bit = self.code >= bound;
        if bit {
            self.code -= bound;
            self.range -= bound;
            *chance -= *chance >> 5;
        } else {
            self.range = bound;
            *chance += (2048 - *chance) >> 5;
        }
        self.normalize();
        usize::from(bit)
    }

    /// A bit that is as likely one as zero.
    fn even_bit(&mut self) -> usize {
        self.range >>= 1;
        let bit = self.code >= self.range;
        if bit {
            self.code -= self.range;
        }
        self.normalize();
        usize::from(bit)
    }

    /// A number of `depth` bits, highest first, each by the higher ones.
    #[inline(never)]
    fn tree(&mut self, group: usize, depth: u32) -> usize {
        let mut node = 1;
        for _ in 0..depth {
            node = node << 1 | self.bit(group + node);
        }
        node - (1 << depth)
    }

    /// A number of `depth` bits, lowest first.
    #[inline(never)]
    fn reverse_tree(&mut self, group: usize, depth: u32) -> usize {
        let (mut node, mut number) = (1, 0);
        for shift in 0..depth {
            let bit = self.bit(group + node);
            node = node << 1 | bit;
            number |= bit << shift;
        }
        number
    }

    #[inline(never)]
    fn length(&mut self, group: usize) -> usize {
        if self.bit(group) == 0 {
            2 + self.tree(group + 0x10, 3)
        } else if self.bit(group + 1) == 0 {
            10 + self.tree(group + 0x20, 3)
        } else {
            18 + self.tree(group + 0x40, 8)
        }
    }

    /// How far back a new match lies, less one.
    fn distance(&mut self, length: usize) -> usize {
        let slot = self.tree(SLOT + (length - 2).min(3) * 64, 6);
        if slot < 4 {
            return slot;
        }
        let low_bits = (slot >> 1) as u32 - 1;
        let base = (2 | slot & 1) << low_bits;
        if slot < 14 {
            return base + self.reverse_tree(NEAR + base - slot, low_bits);
        }
        let mut middle = 0;
        for _ in 4..low_bits {
            middle = middle << 1 | self.even_bit();
        }
        base + (middle << 4) + self.reverse_tree(ALIGN, 4)
    }

    /// A literal; after a match also by the byte at the match's distance, as long as they agree.
    fn literal(&mut self, before: usize, matched: Option<usize>) -> u8 {
        let group = LITERAL + 0x300 * (before >> 5);
        let mut node = 1;
        if let Some(matched) = matched {
            for shift in (0..8).rev() {
                let expected = matched >> shift & 1;
                let bit = self.bit(group + ((1 + expected) << 8) + node);
                node = node << 1 | bit;
                if bit != expected {
                    break;
                }
            }
        }
        while node < 256 {
            node = node << 1 | self.bit(group + node);
        }
        node as u8
    }
}

/// Decodes `input` until `output` is full.
pub fn decode(input: &[u8], output: &mut [u8]) {
    // The stream's first byte is always 0 and carries nothing; the packer leaves it out.
    let mut decoder = Decoder { input, range: !0, code: 0, bits: [1024; BITS] };
    for _ in 0..4 {
        decoder.next();
    }
    let mut state = 0;
    let mut distances = [0usize; 4];
    let mut at = 0;
    while at < output.len() {
        let back = |distance: usize| {
            let byte = at.checked_sub(distance + 1).and_then(|from| output.get(from));
            usize::from(byte.copied().unwrap_or(0))
        };
        if decoder.bit(IS_MATCH + state) == 0 {
            let byte = decoder.literal(back(0), (state >= 7).then(|| back(distances[0])));
            if let Some(place) = output.get_mut(at) {
                *place = byte;
            }
            at += 1;
            state = match state {
                0..4 => 0,
                4..10 => state - 3,
                _ => state - 6,
            };
            continue;
        }
        let after_match = usize::from(state >= 7) * 3;
        let [d0, d1, d2, d3] = distances;
        let mut length = 1;
        if decoder.bit(IS_REP + state) == 0 {
            length = decoder.length(LENGTH);
            state = 7 + after_match;
            distances = [decoder.distance(length), d0, d1, d2];
        } else {
            let mut long = true;
            if decoder.bit(IS_REP_G0 + state) == 0 {
                long = decoder.bit(IS_REP0_LONG + state) == 1;
            } else if decoder.bit(IS_REP_G1 + state) == 0 {
                distances = [d1, d0, d2, d3];
            } else if decoder.bit(IS_REP_G2 + state) == 0 {
                distances = [d2, d0, d1, d3];
            } else {
                distances = [d3, d0, d1, d2];
            }
            if long {
                length = decoder.length(REP_LENGTH);
            }
            state = match (long, after_match) {
                (true, 0) => 8,
                (false, 0) => 9,
                _ => 11,
            };
        }
        for _ in 0..length {
            let byte = at.checked_sub(distances[0] + 1).and_then(|from| output.get(from)).copied();
            if let Some(place) = output.get_mut(at) {
                *place = byte.unwrap_or(0);
            }
            at += 1;
        }
    }
}
