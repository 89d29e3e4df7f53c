//! The packers' encoding halves.

use crate::codec::interval::Interval;
use crate::codec::model::Model;
use crate::codec::small;

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
/// memory before. What each byte cost, bits.
#[allow(clippy::disallowed_methods, reason = "costs are for reports, whose last digit doesn't matter")]
pub fn cm(encoder: &mut Encoder, lesson: &[u8], bytes: &[u8]) -> Vec<f32> {
    let mut model = new_model();
    model.start();
    for &byte in lesson {
        let mut bits = bits(byte);
        model.byte(|_| bits.next().unwrap_or(0));
    }
    let mut costs = vec![0.0; bytes.len()];
    for (&byte, cost) in bytes.iter().zip(&mut costs) {
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
pub struct Encoder {
    interval: Interval,
    packed: Vec<u8>,
}

impl Encoder {
    /// With nothing coded yet.
    pub fn new() -> Encoder {
        Encoder { interval: Interval::WHOLE, packed: Vec::new() }
    }

    /// A bit that is a one with the probability `one`, in 16 bits.
    pub fn bit(&mut self, bit: u32, one: u32) {
        self.interval.narrow(self.interval.split(one), bit);
        let mut top = (self.interval.high >> 24) as u8;
        while self.interval.settled() {
            self.packed.push(top);
            top = (self.interval.high >> 24) as u8;
        }
    }

    /// Bytes so far.
    pub fn length(&self) -> usize {
        self.packed.len()
    }

    /// The code, ended by the fewest bytes that lie in the interval when zeros follow.
    pub fn finish(mut self) -> Vec<u8> {
        let Interval { low, high } = self.interval;
        let kept = |count: u32| if count == 0 { 0 } else { high & !0 << (32 - 8 * count) };
        let count = (0..4).find(|&count| kept(count) >= low).unwrap_or(4);
        self.packed.extend(&high.to_be_bytes()[..count as usize]);
        self.packed
    }

    /// The code, ended in full so that other data may follow.
    pub fn finish_in_full(mut self) -> Vec<u8> {
        self.packed.extend(&self.interval.high.to_be_bytes());
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
