//! What the launcher decodes, damaged in any way: each decoder ends, and what was encoded comes back.
#![no_main]

use libfuzzer_sys::fuzz_target;
use luc_pack::codec::{cm, filter, interval::Decoder, lzma, small};
use luc_pack::encode;

fuzz_target!(|data: &[u8]| {
    let [kind, size, rest @ ..] = data else { return };
    let mut output = vec![0; usize::from(*size) * 4];
    match kind % 5 {
        0 => lzma::decode(rest, &mut output),
        1 => {
            let mut decoder = Decoder::new(rest);
            small::decode(&mut encode::new_cells(), &mut output, |one| decoder.bit(one));
        }
        2 => {
            // Each byte touches a thousand pages of a new model, which takes most of the time; the first half is known.
            let mut decoder = Decoder::new(rest);
            output.truncate(16);
            let known = output.len() / 2;
            cm::decode(&mut encode::new_model(), &mut output, known, |one| decoder.bit(one));
        }
        3 => {
            let coded = encode::lzma(rest);
            let mut back = vec![0; rest.len()];
            lzma::decode(&coded, &mut back);
            assert_eq!(back, rest);
        }
        _ => {
            let mut code = rest.to_vec();
            let address = 0x0040_0000 + u32::from(*size);
            filter::filter(&mut code, address, filter::Direction::Pack);
            filter::filter(&mut code, address, filter::Direction::Unpack);
            assert_eq!(code, rest);
        }
    }
});
