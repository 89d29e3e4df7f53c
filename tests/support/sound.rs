//! What tests of the sound share.

use super::run;

/// Whether the program under test plays: the small build may not.
pub fn has_sound() -> bool {
    let help = run(std::path::Path::new("."), &["--help"]).stdout;
    String::from_utf8_lossy(&help).contains("--wav")
}

/// The samples of a WAV file as the program writes it; checks all of its header.
pub fn samples_of_wav(file: &[u8]) -> Vec<[i16; 2]> {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
    let half = |at: usize| u16::from_le_bytes(file[at..at + 2].try_into().unwrap());
    assert_eq!((&file[..4], &file[8..16], &file[36..40]), (&b"RIFF"[..], &b"WAVEfmt "[..], &b"data"[..]));
    assert_eq!((word(4) as usize, word(16), half(20), half(22)), (file.len() - 8, 16, 1, 2));
    assert_eq!((word(24), word(28), half(32), half(34)), (44_100, 176_400, 4, 16));
    assert_eq!(word(40) as usize, file.len() - 44);
    let frames = file[44..].chunks_exact(4);
    frames.map(|f| [i16::from_le_bytes([f[0], f[1]]), i16::from_le_bytes([f[2], f[3]])]).collect()
}
