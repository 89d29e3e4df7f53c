//! The small coder, which packs the launcher itself.
//!
//! The launcher proper is several kilobytes of machine code, so only its first part, the opener,
//! stands in the file as it is, and decodes the rest. Its coder must be small before all else:
//! 300 bytes of code that save 3,000. Each of the eight subsets of the last three bytes is a
//! context; under the hash of what it sees and of the bits so far it keeps one weight, and the
//! sum of the eight weights, squashed, is the probability. After each bit the weights move along
//! the error, the less the more often they were seen. There is neither mixer nor counter: it is
//! logistic regression, with a context's presence as its features.

use super::interval::Decoder;
use super::logistic::squash;

/// Number of contexts: the subsets of three bytes.
const CONTEXTS: usize = 8;
/// Weights, all contexts together, as a power of two.
const CELL_BITS: u32 = 20;

/// One weight.
#[derive(Clone, Copy, Default)]
pub struct Cell {
    weight: f32,
    /// How often it was used.
    seen: f32,
}

/// The memory of the coder; zeros at the start.
pub type Cells = [Cell; 1 << CELL_BITS];

/// The model.
pub struct Model<'a> {
    cells: &'a mut Cells,
    /// The last bytes, the last one lowest.
    last: u32,
    /// The bits of the byte so far, behind a leading one.
    partial: u32,
    places: [usize; CONTEXTS],
    probability: f32,
}

impl Model<'_> {
    /// A model at the start, in memory of zeros.
    pub fn new(cells: &mut Cells) -> Model<'_> {
        Model { cells, last: 0, partial: 1, places: [0; CONTEXTS], probability: 0.0 }
    }

    /// Probability of a one, in 16 bits.
    pub fn predict(&mut self) -> u32 {
        let mut sum = 0.0;
        for (subset, place) in self.places.iter_mut().enumerate() {
            let mut hash = self.partial << 8 | (subset as u32) << 17;
            for byte in 0..3 {
                if subset >> byte & 1 == 1 {
                    hash = (hash ^ self.last >> (8 * byte) & 0xff).wrapping_mul(0x9e37_79b1);
                    hash ^= hash >> 15;
                }
            }
            *place = (hash.wrapping_mul(0x2c1b_3c6d) >> (32 - CELL_BITS)) as usize;
            sum += self.cells[*place & ((1 << CELL_BITS) - 1)].weight;
        }
        self.probability = squash(sum);
        // SAFETY: the probability is less than 1, and no less than 0.
        unsafe { (self.probability * 65536.0).to_int_unchecked::<i32>() as u32 }
    }

    /// Learns the bit that came. Returns the byte that it completes, if it does.
    pub fn learn(&mut self, bit: u32) -> Option<u8> {
        let error = bit as f32 - self.probability;
        for &place in &self.places {
            let cell = &mut self.cells[place & ((1 << CELL_BITS) - 1)];
            cell.weight += error * 0.5 / (1.0 + cell.seen * 0.04);
            cell.seen += 1.0;
        }
        self.partial = self.partial << 1 | bit;
        let byte = self.partial as u8;
        if self.partial < 256 {
            return None;
        }
        self.last = self.last << 8 | u32::from(byte);
        self.partial = 1;
        Some(byte)
    }
}

/// Decodes `input` until `output` is full, with `cells` of zeros.
pub fn decode(cells: &mut Cells, input: &[u8], output: &mut [u8]) {
    let mut model = Model::new(cells);
    let mut decoder = Decoder::new(input);
    for place in output {
        loop {
            let bit = decoder.bit(model.predict());
            if let Some(byte) = model.learn(bit) {
                *place = byte;
                break;
            }
        }
    }
}
