//! Arithmetic coding: a sequence of bits and their probabilities as one long number.
//!
//! A carryless range coder: `low..=high` is what is left of the 32-bit unit interval. Each bit
//! divides it by the predicted probability, the code lies in the part of the bit that was coded,
//! and as soon as the top bytes of both ends agree they are shifted out. The input past its end
//! reads as zeros, so decoding never fails: damaged input only gives wrong bits.
//!
//! Source: the coder of Matt Mahoney's lpaq1.

/// The interval, for coder and decoder.
#[repr(C)]
pub struct Interval {
    /// The lower end.
    pub low: u32,
    /// The upper end, which belongs to it.
    pub high: u32,
}

impl Interval {
    /// Everything.
    pub const WHOLE: Interval = Interval { low: 0, high: u32::MAX };

    /// The last number of the part for a one bit, whose probability in 16 bits is `one`.
    pub fn split(&self, one: u32) -> u32 {
        let range = u64::from(self.high - self.low);
        self.low + ((range * u64::from(one)) >> 16) as u32
    }

    /// Keeps the part of `bit`.
    pub fn narrow(&mut self, split: u32, bit: u32) {
        if bit == 1 { self.high = split } else { self.low = split + 1 }
    }

    /// Shifts out the top byte if both ends agree on it.
    pub fn settled(&mut self) -> bool {
        let settled = (self.low ^ self.high) >> 24 == 0;
        if settled {
            self.low <<= 8;
            self.high = self.high << 8 | 255;
        }
        settled
    }
}

/// Reads bits back.
#[repr(C)]
pub struct Decoder<'a> {
    interval: Interval,
    code: u32,
    input: &'a [u8],
}

impl<'a> Decoder<'a> {
    /// At the start of `input`. The interval of one number is settled four times before the first bit,
    /// which reads the first four bytes.
    pub fn new(input: &'a [u8]) -> Decoder<'a> {
        Decoder { interval: Interval { low: 0, high: 0 }, code: 0, input }
    }

    /// The next bit, which is a one with the probability `one`, in 16 bits.
    pub fn bit(&mut self, one: u32) -> u32 {
        self.settle();
        let split = self.interval.split(one);
        let bit = u32::from(self.code <= split);
        self.interval.narrow(split, bit);
        bit
    }

    fn settle(&mut self) {
        while self.interval.settled() {
            let (&byte, rest) = self.input.split_first().unwrap_or((&0, &[]));
            self.input = rest;
            self.code = self.code << 8 | u32::from(byte);
        }
    }

    /// What lies behind this code, if that was ended in full.
    pub fn rest(&mut self) -> &'a [u8] {
        self.settle();
        self.input
    }
}
