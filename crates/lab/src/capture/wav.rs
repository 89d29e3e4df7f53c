//! The sound of captured frames as a WAV file: 16 bits, two channels.

use luc::show;
use luc_core::synth::stream::Stream;
use luc_core::synth::{RATE, pcm};
use std::fs::write;
use std::ops::Range;
use std::path::Path;

/// Samples of a frame, a whole number.
const PER_FRAME: u32 = RATE / show::FPS as u32;
/// Bytes of a sample of both channels.
const BYTES: u32 = 4;

/// Writes the sound of `frames` of the show.
pub fn save(path: &Path, frames: &Range<u64>) -> Result<(), String> {
    let fault = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let size = (frames.end - frames.start) * u64::from(PER_FRAME * BYTES);
    let size = u32::try_from(size + 36).map_err(|_| fault(&"a WAV file holds no more than 4 GiB"))? - 36;
    // From the beginning, as the player's own file is: what still rings there rings here too.
    let first = (frames.start % show::FRAMES) as usize * PER_FRAME as usize;
    let mut samples = vec![[0.0; 2]; first + (size / BYTES) as usize];
    Stream::new(show::tune(0..show::PARTS.len()), 0).render(&mut samples);
    let mut bytes = Vec::new();
    for word in [*b"RIFF", (36 + size).to_le_bytes(), *b"WAVE", *b"fmt ", 16_u32.to_le_bytes()] {
        bytes.extend(word);
    }
    for word in [1 | 2 << 16, RATE, RATE * BYTES, BYTES | 16 << 16, u32::from_le_bytes(*b"data"), size] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(samples[first..].as_flattened().iter().flat_map(|&v| pcm(v).to_le_bytes()));
    write(path, bytes).map_err(|e| fault(&e))
}

#[cfg(test)]
mod tests {
    use super::*;

    const _: () = assert!(PER_FRAME as u64 * show::FPS == RATE as u64);

    #[test]
    fn the_sound_of_later_frames_is_a_piece_of_the_whole() {
        let folder = tempfile::tempdir().unwrap();
        let sound = |name: &str, frames: Range<u64>| {
            let path = folder.path().join(name);
            save(&path, &frames).unwrap();
            std::fs::read(&path).unwrap()
        };
        let (whole, piece) = (sound("a.wav", 0..90), sound("b.wav", 60..90));
        let each = (PER_FRAME * BYTES) as usize;
        assert_eq!((whole.len(), piece.len()), (44 + 90 * each, 44 + 30 * each));
        assert!(piece.starts_with(b"RIFF") && &piece[8..16] == b"WAVEfmt ");
        assert!(piece[44..] == whole[44 + 60 * each..], "other samples");
        assert!(whole[44..].iter().any(|&b| b != 0), "silence");
    }
}
