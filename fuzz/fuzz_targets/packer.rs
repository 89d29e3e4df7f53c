//! Any file as the program to pack: packed, or an error that is a sentence.
#![no_main]

use libfuzzer_sys::fuzz_target;
use luc_pack::{Method, pack_elf};

fuzz_target!(|data: &[u8]| {
    // A proper beginning now and then, so that more than the first check is reached.
    let mut file = data.to_vec();
    if let [first, ..] = data
        && first & 1 == 1
    {
        let head = [0x7f, b'E', b'L', b'F', 2, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 62, 0, 1, 0, 0, 0];
        for (to, from) in file.iter_mut().zip(head) {
            *to = from;
        }
    }
    match pack_elf(&file, Method::Raw) {
        Ok(packed) => assert!(packed.file.len() > packed.payload),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
