//! Live sound as a card gets it: a card that is a file, compared with what `--wav` writes.
#![cfg(all(feature = "sound", target_os = "linux"))]
mod support;

use luc::show;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use support::run;
use support::sound::{has_sound, samples_of_wav};
use support::x11::Screen;
use tempfile::tempdir;

/// An ALSA configuration in `dir` whose card writes all it gets to a file, and that file.
fn card(dir: &Path) -> (PathBuf, PathBuf) {
    let (config, file) = (dir.join("card.conf"), dir.join("played.raw"));
    let slave = "slave { pcm { type null } }";
    let text = format!("pcm.default {{ type file {slave} file \"{}\" format \"raw\" }}\n", file.display());
    std::fs::write(&config, text).unwrap();
    (config, file)
}

/// What the card has got.
fn played(file: &Path) -> Vec<[i16; 2]> {
    let bytes = std::fs::read(file).unwrap_or_default();
    let frames = bytes.chunks_exact(4);
    frames.map(|f| [i16::from_le_bytes([f[0], f[1]]), i16::from_le_bytes([f[2], f[3]])]).collect()
}

/// What `--wav` writes of a part.
fn written(part: &str) -> Vec<[i16; 2]> {
    let output = run(Path::new("."), &["--scene", part, "--wav", "-"]);
    assert_eq!(output.status.code(), Some(0));
    samples_of_wav(&output.stdout)
}

/// Samples of the fade at the very start.
const FADE: usize = 441;

#[test]
fn the_card_gets_what_the_file_holds_after_a_fade_of_10_ms() {
    if !has_sound() {
        return;
    }
    let dir = tempdir().unwrap();
    let (config, file) = card(dir.path());
    let screen = Screen::new(640, 480);
    let mut player = screen.play_on(&config, &["--scene", "luc", "--quality", "draft", "--size", "160x90"]);
    let start = Instant::now();
    while played(&file).len() < 3 * 44_100 {
        assert!(start.elapsed() < Duration::from_secs(20), "three seconds of sound take too long");
        std::thread::sleep(Duration::from_millis(50));
    }
    player.tap_escape();
    player.ends("Esc");
    let (played, written) = (played(&file), written("luc"));
    let count = played.len().min(written.len());
    assert!(played[FADE..count] == written[FADE..count], "of {count} samples");
    for (i, (played, written)) in played.iter().zip(&written).take(FADE).enumerate() {
        for side in 0..2 {
            let expected = f32::from(written[side]) * i as f32 / FADE as f32;
            assert!((f32::from(played[side]) - expected).abs() <= 1.0, "sample {i}");
        }
    }
}

#[test]
fn playing_once_from_a_frame_plays_the_rest_and_no_more() {
    if !has_sound() {
        return;
    }
    let dir = tempdir().unwrap();
    let (config, file) = card(dir.path());
    let screen = Screen::new(640, 480);
    let args = ["--once", "--scene", "mirror", "--from", "1800", "--quality", "draft", "--size", "160x90"];
    let begun = Instant::now();
    let mut player = screen.play_on(&config, &args);
    player.ends_within("--once", Duration::from_secs(20));
    assert!(begun.elapsed() > Duration::from_secs(2), "it ended before its time");
    let (played, written) = (played(&file), written("mirror"));
    let rest = &written[1800 * show::SAMPLES as usize..];
    assert_eq!(played.len(), rest.len());
    // The tails of what was eight bars ago are missing: far below a step of 16 bits, but it may round.
    let apart = played[FADE..].as_flattened().iter().zip(rest[FADE..].as_flattened());
    assert!(apart.map(|(a, b)| a.abs_diff(*b)).max() <= Some(1));
}

#[test]
fn without_a_card_it_says_so_once_and_plays_silent() {
    if !has_sound() {
        return;
    }
    let dir = tempdir().unwrap();
    let config = dir.path().join("none.conf");
    std::fs::write(&config, "pcm.other { type null }\n").unwrap();
    let screen = Screen::new(640, 480);
    let args = ["--once", "--scene", "mirror", "--from", "1860", "--quality", "draft", "--size", "160x90"];
    let said = screen.play_on(&config, &args).last_words("--once", Duration::from_secs(20));
    assert_eq!(said, "luc: no sound: the sound card is absent or busy; playing silent\n");
    let (config, file) = card(dir.path());
    let said = screen
        .play_on(&config, &[&["--mute"], &args[..]].concat())
        .last_words("--mute", Duration::from_secs(20));
    assert_eq!(said, "");
    assert!(!file.exists(), "--mute leaves the card alone");
}
