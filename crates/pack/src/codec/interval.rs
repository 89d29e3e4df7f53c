//! Arithmetic coding: a sequence of bits and their probabilities as one long number.
//!
//! A range coder. What is left of the unit interval has a width of 24 to 32 bits, the range. Each bit divides
//! it by the predicted probability, and the code lies in the part of the bit that was coded: the decoder
//! keeps the distance from the part's lower end. When the range becomes narrow, a byte more is read.
//! The input past its end reads as zeros, so decoding never fails: damaged input only gives wrong
//! bits.
//!
//! Source: G. N. N. Martin, Range encoding (1979), as in Igor Pavlov's LZMA.

/// The range below which the next byte is read.
pub const NARROW: u32 = 1 << 24;

/// The width of the part for a one bit, whose probability in 16 bits is `one`.
pub fn part(range: u32, one: u32) -> u32 {
    ((u64::from(range) * u64::from(one)) >> 16) as u32
}

/// Reads bits back.
#[repr(C)]
pub struct Decoder<'a> {
    range: u32,
    code: u32,
    input: core::slice::Iter<'a, u8>,
}

impl<'a> Decoder<'a> {
    /// At the start of `input`. The range of 1 is widened three times before the first bit, which
    /// reads the first three bytes.
    pub fn new(input: &'a [u8]) -> Decoder<'a> {
        Decoder { range: 1, code: 0, input: input.iter() }
    }

    /// The next bit, which is a one with the probability `one`, in 16 bits.
    pub fn bit(&mut self, one: u32) -> u32 {
        self.widen();
        let part = part(self.range, one);
        if self.code < part {
            self.range = part;
            1
        } else {
            self.code -= part;
            self.range -= part;
            0
        }
    }

    fn widen(&mut self) {
        while self.range < NARROW {
            self.code = self.code << 8 | self.input.next().map_or(0, |&byte| u32::from(byte));
            self.range <<= 8;
        }
    }

    /// What lies behind this code, if that was ended in full.
    pub fn rest(&mut self) -> &'a [u8] {
        self.widen();
        self.input.as_slice()
    }
}
