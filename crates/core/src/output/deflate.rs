//! A zlib stream in the fewest instructions: one deflate block with the fixed codes, greedy matches; or,
//! in fewer still, stored blocks.
//!
//! The match finder remembers only the last place where four bytes were seen. That finds the runs and
//! the short repeats that a row predictor leaves in a rendered picture. The format is RFC 1950 and 1951.

/// The shortest match that always costs less than its four literals.
const SHORTEST: usize = 4;
/// One less than the format's longest, whose length has a code of its own that this spares.
const LONGEST: usize = 257;
const WINDOW: usize = 32768;
const HASH_BITS: u32 = 15;

/// Collects codes of up to 15 bits, lowest bit first.
struct Bits {
    out: Vec<u8>,
    pending: u32,
    count: u32,
}

impl Bits {
    fn put(&mut self, value: u32, bits: u32) {
        self.pending |= value << self.count;
        self.count += bits;
        while self.count >= 8 {
            self.out.push(self.pending as u8);
            self.pending >>= 8;
            self.count -= 8;
        }
    }

    /// Codes go in from their highest bit, numbers from their lowest.
    fn code(&mut self, code: u32, bits: u32) {
        self.put(code.reverse_bits() >> (32 - bits), bits);
    }

    fn symbol(&mut self, s: u32) {
        match s {
            0..=143 => self.code(0x30 + s, 8),
            144..=255 => self.code(0x190 + s - 144, 9),
            256..=279 => self.code(s - 256, 7),
            _ => self.code(0xc0 + s - 280, 8),
        }
    }

    fn copy(&mut self, length: u32, distance: u32) {
        let l = length - 3;
        let extra = (l | 7).ilog2() - 2;
        self.symbol(257 + 4 * extra + (l >> extra));
        self.put(l & ((1 << extra) - 1), extra);
        let d = distance - 1;
        let extra = (d | 3).ilog2() - 1;
        self.code(2 * extra + (d >> extra), 5);
        self.put(d & ((1 << extra) - 1), extra);
    }
}

fn hash(four: &[u8]) -> usize {
    let word = u32::from_le_bytes([four[0], four[1], four[2], four[3]]);
    (word.wrapping_mul(0x9e37_79b1) >> (32 - HASH_BITS)) as usize
}

/// Two running sums over the bytes, modulo the largest prime under 65,536.
fn adler32(data: &[u8]) -> u32 {
    let (mut a, mut b) = (1u32, 0u32);
    // 5552 bytes are the most that cannot overflow 32 bits before the modulo.
    for chunk in data.chunks(5552) {
        for &byte in chunk {
            a += u32::from(byte);
            b += a;
        }
        a %= 65521;
        b %= 65521;
    }
    b << 16 | a
}

/// `data` as a zlib stream, with codes or stored as it is.
pub fn zlib(data: &[u8], coded: bool) -> Vec<u8> {
    let mut out = vec![0x78, 0x01];
    if coded {
        out = code(data, out);
    } else {
        let mut rest = data.len();
        for block in data.chunks(0xffff) {
            rest -= block.len();
            let length = block.len() as u32;
            out.push((rest == 0) as u8); // whether it is the last block
            out.extend_from_slice(&(length | !length << 16).to_le_bytes());
            out.extend_from_slice(block);
        }
    }
    out.extend_from_slice(&adler32(data).to_be_bytes());
    out
}

/// One block with the fixed codes behind what is in `out`.
fn code(data: &[u8], out: Vec<u8>) -> Vec<u8> {
    let mut bits = Bits { out, pending: 0, count: 0 };
    bits.put(0b011, 3); // the last block, fixed codes
    let mut last = vec![0u32; 1 << HASH_BITS];
    let mut at = 0;
    while at < data.len() {
        let rest = &data[at..];
        let mut length = 0;
        let mut distance = 0;
        if rest.len() >= SHORTEST {
            // Places are stored one up, so that 0 means none.
            let seen = std::mem::replace(&mut last[hash(rest)], at as u32 + 1) as usize;
            distance = at + 1 - seen;
            if seen > 0 && distance <= WINDOW {
                let earlier = &data[seen - 1..];
                length = rest.iter().zip(earlier).take(LONGEST).take_while(|(a, b)| a == b).count();
            }
        }
        if length >= SHORTEST {
            bits.copy(length as u32, distance as u32);
            at += length;
        } else {
            bits.symbol(rest[0].into());
            at += 1;
        }
    }
    bits.symbol(256);
    bits.put(0, 7); // fill the last byte
    bits.out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adler32_matches_the_published_value() {
        assert_eq!(adler32(b"Wikipedia"), 0x11e6_0398);
        assert_eq!(adler32(&[255; 20_000]), 0x9f51_d664, "sums of long inputs stay in range");
    }

    #[test]
    fn runs_compress_and_noise_grows_little() {
        let run = zlib(&vec![7; 100_000], true);
        assert!(run.len() < 1_300, "a run of 100,000 bytes became {}", run.len());
        let mut state = 1u32;
        let noise: Vec<u8> = (0..100_000)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as u8
            })
            .collect();
        let packed = zlib(&noise, true).len();
        assert!(packed < 108_000, "100,000 bytes of noise became {packed}");
    }
}
