//! All decoders and the filter on any input: they must end, and must not panic.
#![no_main]

use luc_pack::codec::{cm, filter, interval::Decoder, lzma, small};
use luc_pack::encode;

/// Bytes to decode.
const LENGTH: usize = 2000;

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    let mut output = vec![0; LENGTH];
    lzma::decode(input, &mut output);
    let mut decoder = Decoder::new(input);
    small::decode(&mut encode::new_cells(), &mut output, |one| decoder.bit(one));
    let mut decoder = Decoder::new(input);
    cm::decode(&mut encode::new_model(), &mut output, 100, |one| decoder.bit(one));
    filter::filter(&mut output, 0x40_0000, filter::Direction::Unpack);
    let mut unfiltered = input.to_vec();
    filter::filter(&mut unfiltered, 0x40_0000, filter::Direction::Unpack);
});
