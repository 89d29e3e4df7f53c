//! The soundtrack as a file: one round of the loop, the same bytes on every machine.

use super::args::Options;
use luc::show;
use luc_core::synth::stream::Stream;
use luc_core::synth::{RATE, pcm};

/// Bytes of a sample of both channels.
const FRAME: u32 = 4;
/// Samples rendered at once.
const BLOCK: usize = 1024;

/// Renders what the options say as a file.
pub fn bytes(options: &Options) -> Vec<u8> {
    let tune = show::tune(options.scene.map_or(0..show::PARTS.len(), |part| part..part + 1));
    let samples = tune.samples();
    let mut bytes = header(samples).to_vec();
    let mut stream = Stream::new(tune, 0);
    let mut left = samples as usize;
    while left > 0 {
        let mut block = [[0.0; 2]; BLOCK];
        let block = &mut block[..left.min(BLOCK)];
        stream.render(block);
        for value in block.as_flattened() {
            bytes.extend_from_slice(&pcm(*value).to_le_bytes());
        }
        left -= block.len();
    }
    bytes
}

/// The 44 bytes before `samples` samples of 16 bits, two channels (RIFF, "Multimedia Programming
/// Interface and Data Specifications 1.0", Microsoft & IBM 1991).
fn header(samples: u32) -> [u8; 44] {
    let size = samples * FRAME;
    let words = [
        u32::from_le_bytes(*b"RIFF"),
        36 + size,
        u32::from_le_bytes(*b"WAVE"),
        u32::from_le_bytes(*b"fmt "),
        16,
        // Whole numbers; two channels.
        1 | 2 << 16,
        RATE,
        RATE * FRAME,
        // Bytes of a sample of both channels; bits of one.
        FRAME | 16 << 16,
        u32::from_le_bytes(*b"data"),
        size,
    ];
    let mut bytes = [0; 44];
    for (place, word) in bytes.chunks_mut(4).zip(words) {
        place.copy_from_slice(&word.to_le_bytes());
    }
    bytes
}
