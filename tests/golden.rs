//! Golden frames: the exact pixels of frames over the whole show, kept as PNG files, and the fingerprints
//! of others in other presets and sizes.
//!
//! A frame that has changed fails with how much, and leaves a picture
//! `target/golden/NAME.png`: expected, actual, and their difference times eight. If the change is
//! wanted, `LUC_BLESS=1 cargo test --test golden` rewrites `tests/golden/`; look at the pictures
//! before committing them.
//!
//! The files are the same for every build. To compare others than the default one:
//!
//! - optimised: `cargo test --release --test golden --test determinism`
//! - SSE2 only, no AVX2: `RUSTFLAGS= cargo test --target-dir target/sse2 --test golden --test determinism`
//! - any other executable: `LUC_BIN=target/pack/luc cargo test --test determinism`
mod support;

use luc::show;
use luc_core::math::fingerprint::Fingerprint;
use luc_core::output::png;
use support::golden::{self, FINGERPRINTS, FRAMES, SIZE, VALUE_SIZE, VALUES};
use support::picture::Picture;

/// Whether to rewrite the files instead of comparing with them.
fn bless() -> bool {
    std::env::var_os("LUC_BLESS").is_some_and(|v| v == "1")
}

const PRESET: &str = "high";

fn write(path: &std::path::Path, bytes: &[u8]) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, bytes).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}

/// What is wrong with a frame, and how to look into it.
fn check(part: &str, frame: u64) -> Result<(), String> {
    let actual = golden::render(part, frame, PRESET, SIZE);
    let path = golden::path(part, frame);
    if bless() {
        write(&path, &png(actual.width, actual.height, &actual.pixels));
    }
    let expected = Picture::read_png(&path)?;
    let Some(what) = expected.compare(&actual) else { return Ok(()) };
    let name = golden::name(part, frame);
    let mut message = format!("{name}: {what}\n");
    if expected.pixels.len() == actual.pixels.len() {
        let side_by_side = expected.difference(&actual);
        let file = format!("target/golden/{name}.png");
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        write(&root.join(&file), &png(side_by_side.width, side_by_side.height, &side_by_side.pixels));
        message += &format!("  expected | actual | difference x 8: {file}\n");
    }
    Err(message + "  replay: " + &golden::replay(part, frame, PRESET, SIZE))
}

#[test]
fn every_golden_frame_has_exactly_its_pixels() {
    let wrong: Vec<String> = FRAMES.iter().filter_map(|&(part, frame)| check(part, frame).err()).collect();
    assert!(
        wrong.is_empty(),
        "{} of {} golden frames have changed; if that is wanted: LUC_BLESS=1 cargo test --test golden\n{}",
        wrong.len(),
        FRAMES.len(),
        wrong.join("\n"),
    );
}

/// Holds frames against the table in `file`.
fn have_their_fingerprints(file: &str, frames: &[golden::Frame]) {
    let path = golden::directory().join(file);
    let print = |&(part, n, preset, size): &golden::Frame| {
        Fingerprint::of_pixels(&golden::render(part, n, preset, size).pixels)
    };
    let lines: Vec<String> = frames.iter().map(|frame| golden::line(*frame, print(frame))).collect();
    if bless() {
        write(&path, lines.concat().as_bytes());
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let wrong: Vec<String> = lines
        .iter()
        .zip(frames)
        .filter(|(line, _)| !kept.contains(line.as_str()))
        .map(|(line, &(part, n, preset, size))| line.clone() + "  " + &golden::replay(part, n, preset, size))
        .collect();
    assert!(wrong.is_empty(), "not in {}:\n{}", path.display(), wrong.join("\n"));
    assert_eq!(kept.lines().count(), lines.len(), "{} holds other frames too", path.display());
}

#[test]
fn frames_of_other_presets_and_sizes_have_their_fingerprints() {
    have_their_fingerprints("fingerprints.txt", &FINGERPRINTS);
}

/// The table that `tests/matrix.sh` holds other builds against: some frames of every part.
#[test]
fn frames_of_all_parts_have_their_one_value() {
    have_their_fingerprints("values.txt", &VALUES.map(|(part, n)| (part, n, PRESET, VALUE_SIZE)));
    for part in show::PARTS {
        assert!(VALUES.iter().any(|(name, _)| *name == part.name), "no frame of {} among them", part.name);
    }
}

#[test]
fn a_difference_is_told_in_numbers_and_in_a_picture() {
    let black = Picture { width: 3, height: 2, pixels: vec![0; 6] };
    let mut other = black.clone();
    assert_eq!(black.compare(&other), None);
    other.pixels[4] = 0x0001_2003;
    let what = black.compare(&other).unwrap();
    assert!(what.starts_with("1 of 6 pixels differ, "), "{what}");
    assert!(what.ends_with("the first at (1, 1) is 012003 instead of 000000"), "{what}");
    let side_by_side = black.difference(&other);
    assert_eq!((side_by_side.width, side_by_side.height), (9, 2));
    assert_eq!(side_by_side.pixels[9..], [0, 0, 0, 0, 0x0001_2003, 0, 0, 0x0008_ff18, 0]);
    // FNV-1a of nothing and of the bytes "foobar", from its authors' test vectors.
    assert_eq!(Fingerprint::of_pixels(&[]), 0xcbf2_9ce4_8422_2325);
    assert_eq!(Fingerprint::of_pixels(&[0x0066_6f6f, 0x0062_6172]), 0x8594_4171_f739_67e8);
}
