//! Any command line, arguments parted by zeros: an answer, or one short line without control characters.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;

#[allow(dead_code)]
#[path = "."]
mod player {
    #[path = "../../src/player/args.rs"]
    pub mod args;
    #[path = "../../src/player/text.rs"]
    pub mod text;
}

fuzz_target!(|data: &[u8]| {
    let args: Vec<&OsStr> = data.split(|&b| b == 0).map(OsStr::from_bytes).collect();
    if let Err(told) = player::args::parse(&args) {
        assert!(!told.is_empty() && told.len() < 400, "{}", String::from_utf8_lossy(&told));
        assert!(!told.iter().any(|&b| b < b' ' || b == 0x7f), "{told:?}");
    }
});
