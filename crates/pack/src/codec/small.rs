//! The small coder, which packs the launcher itself.
//!
//! The launcher proper is several kilobytes of machine code, so only its first part, the opener,
//! stands in the file as it is, and decodes the rest. Its coder must be small before all else:
//! 300 bytes of code that save 3,000. Each of eight sets of bits of the last three bytes is a
//! context; under the hash of what it sees and of the bits so far it keeps one weight, and the
//! sum of the eight weights, squashed, is the probability. After each bit the weights move along
//! the error, the less the more often they were seen. There is neither mixer nor counter: it is
//! logistic regression, with a context's presence as its features.

use super::logistic::squash;

/// Number of contexts.
const CONTEXTS: usize = 8;
/// Which bits each sees of the byte so far (the lowest eight) and the three bytes before it.
static SEEN: [u32; CONTEXTS] =
    [0x0000_00ff, 0x0000_f0ff, 0x0000_ffff, 0x00f0_ffff, 0x00ff_00ff, 0x00ff_f0ff, 0xff00_ffff, 0xfff0_00ff];
/// Weights of each context, as a power of two.
const CELL_BITS: u32 = 17;

/// One weight.
#[derive(Clone, Copy, Default)]
#[repr(C)]
pub struct Cell {
    weight: f32,
    /// How often it was used, times 0.08.
    seen: f32,
}

/// The memory of the coder; zeros at the start.
pub type Cells = [Cell; CONTEXTS << CELL_BITS];

/// The next byte, after the bytes `last`, the last one lowest. `coder` is told for each bit how likely
/// it is a one, in 16 bits, and tells which it is.
pub fn byte(cells: &mut Cells, last: u32, mut coder: impl FnMut(u32) -> u32) -> u8 {
    let mut byte = 1;
    while byte < 256 {
        const UNKNOWN: u32 = 2;
        let mut bit = UNKNOWN;
        // The first time round nothing moves, the second time all weights along the error.
        let (mut error, mut step) = (0.0, 0.0);
        loop {
            let mut sum = 0.0;
            for (context, mask) in SEEN.iter().enumerate() {
                let hash = ((last << 8 | byte) & mask).wrapping_mul(0x9e37_79b1) >> (32 - CELL_BITS);
                let cell = &mut cells[context << CELL_BITS | hash as usize];
                cell.weight += error / (2.0 + cell.seen);
                cell.seen += step;
                sum += cell.weight;
            }
            if bit != UNKNOWN {
                break;
            }
            let probability = squash(sum);
            // SAFETY: the product is no less than 0 and less than 65536.
            bit = coder(unsafe { (probability * 65536.0).to_int_unchecked::<i32>() } as u32);
            error = bit as f32 - probability;
            step = 0.08;
        }
        byte = byte << 1 | bit;
    }
    byte as u8
}

/// Decodes until `output` is full, with `cells` of zeros.
pub fn decode(cells: &mut Cells, output: &mut [u8], mut coder: impl FnMut(u32) -> u32) {
    let mut last = 0;
    for place in output {
        *place = byte(cells, last, &mut coder);
        last = last << 8 | u32::from(*place);
    }
}
