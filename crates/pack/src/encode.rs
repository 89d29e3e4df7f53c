//! The packers' encoding halves.

use crate::codec::cm::Interval;
use crate::codec::model::Model;

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

/// Context mixing: what [`crate::codec::cm::decode`] decodes.
pub fn cm(bytes: &[u8]) -> Vec<u8> {
    let mut model = new_model();
    let mut interval = Interval::WHOLE;
    let mut packed = Vec::new();
    model.start();
    for (position, &byte) in bytes.iter().enumerate() {
        for shift in (0..8).rev() {
            let bit = u32::from(byte) >> shift & 1;
            let split = interval.split(model.predict());
            interval.narrow(split, bit);
            let mut top = (interval.high >> 24) as u8;
            while interval.settled() {
                packed.push(top);
                top = (interval.high >> 24) as u8;
            }
            model.learn(bit);
        }
        model.end_byte(&bytes[..position + 1]);
    }
    // Any number in the interval will do, and missing bytes read as zeros.
    packed.extend(interval.high.to_be_bytes());
    let end = shortest_end(&interval, &packed);
    packed.truncate(end);
    packed
}

/// How many of `packed`, whose last four bytes are the interval's upper end, must be kept for
/// the rest, read as zeros, to lie in the interval.
fn shortest_end(interval: &Interval, packed: &[u8]) -> usize {
    let body = packed.len() - 4;
    let keeps = |n: usize| {
        let kept = if n == 0 { 0 } else { interval.high & !0u32 << (32 - 8 * n) };
        kept >= interval.low
    };
    body + (0..=4).find(|&n| keeps(n)).unwrap_or(4)
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
