//! The arithmetic decoder that turns the model's predictions back into bytes.
//!
//! A carryless range coder: `low..=high` is what is left of the 32-bit unit interval. Each bit
//! divides it by the predicted probability, the code lies in the part of the bit that was coded,
//! and as soon as the top bytes of both ends agree they are shifted out. The input past its end
//! reads as zeros, and the output has a fixed length, so damaged input gives wrong bytes but
//! always ends.
//!
//! Source: the coder of Matt Mahoney's lpaq1.

use super::model::Model;

/// The interval, for packer and unpacker.
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

/// Decodes `input` until `output` is full. `model` is new, that is all zero.
pub fn decode(model: &mut Model, input: &[u8], output: &mut [u8]) {
    let mut rest = input.iter();
    let mut next = || u32::from(rest.next().copied().unwrap_or(0));
    let mut interval = Interval::WHOLE;
    let mut code = 0;
    for _ in 0..4 {
        code = code << 8 | next();
    }
    model.start();
    for position in 0..output.len() {
        let mut byte = 1;
        while byte < 256 {
            let split = interval.split(model.predict());
            let bit = u32::from(code <= split);
            interval.narrow(split, bit);
            while interval.settled() {
                code = code << 8 | next();
            }
            model.learn(bit);
            byte = byte << 1 | bit;
        }
        if let Some(place) = output.get_mut(position) {
            *place = byte as u8;
        }
        model.end_byte(output.get(..position + 1).unwrap_or(&[]));
    }
}
