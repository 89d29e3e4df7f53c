//! The packers' encoding halves.

use crate::codec::interval::{NARROW, part};
use crate::codec::model::Model;
use crate::codec::small;

/// Told now and then how many bytes of how many are packed.
pub type Progress = fn(usize, usize);

/// Bytes between two reports of progress.
const STEP: usize = 4096;

/// Memory of zeros as a model.
pub fn new_model() -> Box<Model> {
    let layout = std::alloc::Layout::new::<Model>();
    // SAFETY: the layout is not empty, and a model is numbers (and one enum whose first variant
    // is 0), for all of which zero is a valid value.
    unsafe {
        let memory = std::alloc::alloc_zeroed(layout).cast::<Model>();
        if memory.is_null() {
            std::alloc::handle_alloc_error(layout);
        }
        Box::from_raw(memory)
    }
}

/// Context mixing: what [`crate::codec::cm::decode`] decodes, into `encoder`, with `lesson` in
/// memory before. What each byte cost, bits. `progress` is told now and then how far it is.
#[allow(clippy::disallowed_methods, reason = "costs are for reports, whose last digit doesn't matter")]
pub fn cm(encoder: &mut Encoder, lesson: &[u8], bytes: &[u8], progress: Progress) -> Vec<f32> {
    let mut model = new_model();
    model.start();
    for &byte in lesson {
        let mut bits = bits(byte);
        model.byte(|_| bits.next().unwrap_or(0));
    }
    let mut costs = vec![0.0; bytes.len()];
    for (position, (&byte, cost)) in bytes.iter().zip(&mut costs).enumerate() {
        if position % STEP == 0 {
            progress(position, bytes.len());
        }
        let mut bits = bits(byte);
        model.byte(|one| {
            let bit = bits.next().unwrap_or(0);
            encoder.bit(bit, one);
            let probability = if bit == 1 { one } else { 65536 - one };
            *cost -= (probability as f32 / 65536.0).log2();
            bit
        });
    }
    costs
}

/// The small coder: what [`small::decode`] decodes, into `encoder`.
pub fn small(encoder: &mut Encoder, bytes: &[u8]) {
    let mut cells = new_cells();
    let mut bits = bytes.iter().flat_map(|&byte| bits(byte));
    let mut output = vec![0; bytes.len()];
    small::decode(&mut cells, &mut output, |one| {
        let bit = bits.next().unwrap_or(0);
        encoder.bit(bit, one);
        bit
    });
}

/// Memory for the small coder.
pub fn new_cells() -> Box<small::Cells> {
    let cells = vec![small::Cell::default(); size_of::<small::Cells>() / size_of::<small::Cell>()];
    cells.into_boxed_slice().try_into().unwrap_or_else(|_| unreachable!("the length is right"))
}

/// The bits of a byte, highest first.
fn bits(byte: u8) -> impl Iterator<Item = u32> {
    (0..8).rev().map(move |shift| u32::from(byte) >> shift & 1)
}

/// Writes bits for [`crate::codec::interval::Decoder`].
///
/// The lower end of the interval has bytes that are written already, a byte of its own, and 24 bits
/// more. What is added to it may carry into what is written.
pub struct Encoder {
    low: u64,
    range: u32,
    packed: Vec<u8>,
}

impl Encoder {
    /// With nothing coded yet.
    pub fn new() -> Encoder {
        Encoder { low: 0, range: NARROW, packed: Vec::new() }
    }

    /// A bit that is a one with the probability `one`, in 16 bits.
    pub fn bit(&mut self, bit: u32, one: u32) {
        let part = part(self.range, one);
        if bit == 1 {
            self.range = part;
        } else {
            self.add(part);
            self.range -= part;
        }
        while self.range < NARROW {
            self.range <<= 8;
            self.shift();
        }
    }

    /// Moves the lower end up.
    fn add(&mut self, amount: u32) {
        self.low += u64::from(amount);
        if self.low >> 32 != 0 {
            self.low &= 0xffff_ffff;
            // The interval never ends above 1, so some byte takes the carry.
            for byte in self.packed.iter_mut().rev() {
                *byte = byte.wrapping_add(1);
                if *byte != 0 {
                    break;
                }
            }
        }
    }

    /// Writes the byte.
    fn shift(&mut self) {
        self.packed.push((self.low >> 24) as u8);
        self.low = self.low << 8 & 0xffff_ffff;
    }

    /// Bytes so far.
    pub fn length(&self) -> usize {
        self.packed.len()
    }

    /// The code, ended by the fewest bytes that lie in the interval when zeros follow.
    pub fn finish(mut self) -> Vec<u8> {
        // The number with the most zeros at its end that is no less than the lower end.
        let end = self.low + u64::from(self.range);
        let up = |zeros: u32| (self.low + (1 << zeros) - 1) >> zeros << zeros;
        let number = (0..=32).rev().map(up).find(|&number| number < end).unwrap_or(self.low);
        self.add((number - self.low) as u32);
        let mut packed = self.finish_in_full();
        while packed.last() == Some(&0) {
            packed.pop();
        }
        packed
    }

    /// The code, ended in full so that other data may follow.
    pub fn finish_in_full(mut self) -> Vec<u8> {
        for _ in 0..4 {
            self.shift();
        }
        // The first byte is always 0 and carries nothing; the decoder starts behind it.
        self.packed.remove(0);
        self.packed
    }
}

impl Default for Encoder {
    fn default() -> Encoder {
        Encoder::new()
    }
}

/// LZMA: what [`crate::codec::lzma::decode`] decodes.
pub fn lzma(bytes: &[u8]) -> Vec<u8> {
    use lzma_rust2::{EncodeMode, LzmaOptions, LzmaWriter, MfType};
    use std::io::Write;

    let options = LzmaOptions {
        dict_size: (bytes.len() as u32).next_power_of_two().max(1 << 16),
        lc: 3,
        lp: 0,
        pb: 0,
        mode: EncodeMode::Normal,
        nice_len: LzmaOptions::NICE_LEN_MAX,
        mf: MfType::Bt4,
        depth_limit: 1000,
        preset_dict: None,
    };
    let in_memory = "writing to memory doesn't fail";
    let mut writer = LzmaWriter::new_no_header(Vec::new(), &options, false).expect("the options are valid");
    writer.write_all(bytes).expect(in_memory);
    let mut packed = writer.finish().expect(in_memory);
    // The first byte is always 0; the last ones may be zeros, and read as zeros when missing.
    packed.remove(0);
    while packed.last() == Some(&0) {
        packed.pop();
    }
    packed
}
