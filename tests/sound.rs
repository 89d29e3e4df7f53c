//! The soundtrack: levels, spectrum and bits of the tune, and `--wav` as a user meets it.
#![cfg(feature = "sound")]
mod support;

use luc::show;
use luc::show::score::{self, SCORE, SECTIONS};
use luc_core::math::fingerprint::Fingerprint;
use luc_core::synth::score::Section;
use luc_core::synth::stream::{Stream, Tune};
use luc_core::synth::{BAR, RATE, meter, pcm};
use std::sync::OnceLock;
use support::sound::{has_sound, samples_of_wav};
use support::{command, names, run};
use tempfile::tempdir;

type Samples = Vec<[f32; 2]>;

/// One round of some sections.
fn round(sections: &'static [&'static Section]) -> Samples {
    let tune = Tune { score: &SCORE, sections };
    let mut samples = vec![[0.0; 2]; tune.samples() as usize];
    Stream::new(tune, 0).render(&mut samples);
    samples
}

/// The whole tune, 92 bars, rendered once.
fn whole() -> &'static Samples {
    static WHOLE: OnceLock<Samples> = OnceLock::new();
    WHOLE.get_or_init(|| round(&SECTIONS))
}

/// The tune of the parts that there are, rendered once.
fn shown() -> &'static Samples {
    static SHOWN: OnceLock<Samples> = OnceLock::new();
    SHOWN.get_or_init(|| round(show::tune(0..show::PARTS.len()).sections))
}

/// The samples from a sixteenth of the whole tune on.
fn from_sixteenth(step: u32, seconds: f32) -> &'static [[f32; 2]] {
    let first = luc_core::synth::sample_of(step) as usize;
    &whole()[first..first + (seconds * RATE as f32) as usize]
}

/// Fingerprint of the samples as 16 bits, which is what is heard and written.
fn fingerprint(samples: &[[f32; 2]]) -> u64 {
    Fingerprint::of(samples.as_flattened().iter().flat_map(|&v| pcm(v).to_le_bytes()))
}

fn decibels(amplitude: f32) -> f64 {
    2.0 * meter::decibels(amplitude.into())
}

#[test]
fn the_tune_has_exactly_its_bits() {
    // Kept numbers: any build, on any machine, must give them.
    assert_eq!(fingerprint(whole()), 0x29e9_8172_88a5_e461, "the whole tune: {:#x}", fingerprint(whole()));
}

#[test]
fn parts_are_as_long_as_their_sections() {
    let bars: usize = SECTIONS.iter().map(|section| section.harmony.len()).sum();
    assert_eq!((bars, whole().len()), (92, 92 * BAR as usize));
    let frames: u64 = show::PARTS.iter().map(|part| part.frames).sum();
    assert_eq!(shown().len() as u64, frames * show::SAMPLES);
    // Each plays a section of its own, in the tune's order.
    let place = |part: &show::Part| SECTIONS.iter().position(|section| std::ptr::eq(*section, part.section));
    let places = show::PARTS.iter().map(place);
    assert!(places.is_sorted_by(|a, b| a < b) && place(&show::PARTS[0]) == Some(0));
}

#[test]
fn levels_are_those_that_were_asked_for() {
    let loudness = meter::loudness(whole());
    assert!((loudness + 14.5).abs() < 0.7, "{loudness} LUFS");
    for (name, samples) in [("whole", whole()), ("shown", shown())] {
        let peak = decibels(meter::true_peak(samples));
        assert!(peak < -1.0, "{name}: true peak {peak} dB");
        assert!(samples.as_flattened().iter().all(|v| v.abs() <= 1.0), "{name}: a sample outside [-1, 1]");
        for side in 0..2 {
            let mean = samples.iter().map(|s| f64::from(s[side])).sum::<f64>() / samples.len() as f64;
            assert!(mean.abs() < 1e-4, "{name}: mean {mean:e}");
        }
    }
}

#[test]
fn the_arc_over_the_parts_is_that_of_the_composition() {
    let arc = [-20.0, -15.9, -13.2, -13.7, -10.5, -17.3, -14.8, -18.3, -20.1];
    let mut first = 0;
    for (section, expected) in SECTIONS.iter().zip(arc) {
        let samples = section.harmony.len() * BAR as usize;
        let loudness = meter::loudness(&whole()[first..first + samples]);
        assert!((loudness - expected).abs() < 0.6, "from sample {first}: {loudness} LUFS, not {expected}");
        first += samples;
    }
}

#[test]
fn the_loop_closes_without_a_click() {
    for (name, samples) in [("whole", whole()), ("shown", shown())] {
        let near: Vec<[f32; 2]> =
            samples[samples.len() - 2000..].iter().chain(&samples[..2000]).copied().collect();
        for side in 0..2 {
            let bend: Vec<f32> =
                near.windows(3).map(|w| (w[0][side] - 2.0 * w[1][side] + w[2][side]).abs()).collect();
            let seam = bend[1998].max(bend[1999]);
            let mut sorted = bend.clone();
            sorted.sort_by(f32::total_cmp);
            assert!(seam <= sorted[sorted.len() * 99 / 100], "{name}: {seam} at the seam");
        }
    }
    // Beginning shortly before the end runs into the same first second.
    let tune = show::tune(0..show::PARTS.len());
    let mut stream = Stream::new(tune, tune.samples() - RATE);
    let mut over = vec![[0.0; 2]; 2 * RATE as usize];
    stream.render(&mut over);
    let start = &shown()[..RATE as usize];
    let apart = over[RATE as usize..].as_flattened().iter().zip(start.as_flattened());
    let apart = apart.fold(0.0f32, |worst, (a, b)| worst.max((a - b).abs()));
    assert!(apart < 1e-5, "{apart:e}");
}

#[test]
fn beginning_at_a_frame_is_that_frame_of_the_whole() {
    let frames = show::FRAMES;
    for frame in [1, 480, 800, 2700, 4567, 6001, frames - 30] {
        let first = (frame * show::SAMPLES) as usize;
        let mut stream = Stream::new(show::tune(0..show::PARTS.len()), first as u32);
        let mut later = vec![[0.0; 2]; 20 * show::SAMPLES as usize];
        stream.render(&mut later);
        let apart = later.as_flattened().iter().zip(shown()[first..].as_flattened());
        let apart = apart.fold(0.0f32, |worst, (a, b)| worst.max((a - b).abs()));
        assert!(apart < 1e-5, "from frame {frame}: {:.0} dB", decibels(apart));
    }
}

/// Frequency of a MIDI note.
fn hertz(note: i32) -> f32 {
    440.0 * luc_core::math::scalar::exp2((note - 69) as f32 / 12.0)
}

#[test]
fn the_notes_of_the_score_are_in_the_spectrum() {
    // Sixteenth, note: the three letters A D E of the bell, the bass of Mirror's first bars D and
    // C, the sub of Blobs' drop F, the last three notes of the tune.
    for (step, note) in
        [(32, 81), (38, 86), (44, 88), (96, 38), (112, 36), (802, 29), (1456, 81), (1462, 86), (1468, 88)]
    {
        let samples = from_sixteenth(step, 0.35);
        let level = meter::tone(samples, hertz(note));
        for neighbour in [note - 1, note + 1] {
            // Low notes lie closer than a window of 0.35 s can tell apart.
            if note < 60 {
                continue;
            }
            let beside = meter::tone(samples, hertz(neighbour));
            assert!(level > 3.0 * beside, "sixteenth {step}: {level} at {note}, {beside} at {neighbour}");
        }
        assert!(level > 0.003, "sixteenth {step}: {level} at {note}");
    }
    // And not before: the bell has not yet played D and E.
    for (step, note) in [(32, 86), (32, 88)] {
        let (early, then) =
            (from_sixteenth(step, 0.3), from_sixteenth(if note == 86 { 38 } else { 44 }, 0.3));
        let (early, then) = (meter::tone(early, hertz(note)), meter::tone(then, hertz(note)));
        assert!(then > 5.0 * early, "{note}: {early} before, {then} when it is played");
    }
}

#[test]
fn what_rests_is_silent() {
    // Swarm has neither drums nor bass in its ninth bar: 20 to 60 Hz are left to reverb and pads.
    let low = |bar: u32| meter::bands(from_sixteenth(bar * 16, 2.0), &[20.0, 60.0])[0];
    assert!(low(80) < 0.03 * low(78) && low(80) < 0.03 * low(81), "{} {} {}", low(78), low(80), low(81));
    // Facets holds its breath: no kick in the last bar, all of them in the next.
    assert!(low(49) < 0.1 * low(50));
    // Without rows nothing at all.
    static EMPTY: Section = Section { rows: &[], ..score::LUC };
    assert!(round([&EMPTY].to_vec().leak()).as_flattened().iter().all(|&v| pcm(v) == 0));
}

#[test]
fn the_executable_writes_what_the_library_plays() {
    if !has_sound() {
        return;
    }
    let dir = tempdir().unwrap();
    let output = run(dir.path(), &["--wav", "a.wav"]);
    assert_eq!((output.status.code(), &*output.stderr, &*output.stdout), (Some(0), &b""[..], &b""[..]));
    let file = std::fs::read(dir.path().join("a.wav")).unwrap();
    let sections: Vec<_> = show::PARTS.iter().map(|part| part.section).collect();
    let played: Vec<[i16; 2]> = round(sections.leak()).iter().map(|s| s.map(pcm)).collect();
    assert!(samples_of_wav(&file) == played, "the whole loop");
    assert_eq!(names(dir.path()), ["a.wav"]);

    let output = run(dir.path(), &["--scene", "luc", "--wav", "-"]);
    assert_eq!((output.status.code(), &*output.stderr), (Some(0), &b""[..]));
    let played: Vec<[i16; 2]> = round([&score::LUC].to_vec().leak()).iter().map(|s| s.map(pcm)).collect();
    assert!(samples_of_wav(&output.stdout) == played, "one part");
}

/// One line on standard error that contains `part`, and code 2.
fn refused(args: &[&str], output: &std::process::Output, part: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), said.lines().count()), (Some(2), 1), "{args:?}: {said}");
    assert!(said.starts_with("luc: ") && said.contains(part), "{args:?}: {said}");
    assert!(output.stdout.is_empty(), "{args:?}");
}

#[test]
fn bad_arguments_are_answered_with_what_would_be_right() {
    let dir = tempdir().unwrap();
    if !has_sound() {
        for args in [&["--wav", "a.wav"][..], &["--mute"]] {
            refused(args, &run(dir.path(), args), "is not an option");
        }
        return;
    }
    let name = "a name ending in .wav, or - for standard output";
    let nothing = "does nothing for --wav; leave one of them out";
    for (args, part) in [
        (&["--wav"][..], name),
        (&["--wav", "a.mp3"], name),
        (&["--wav", "a"], name),
        (&["--wav", "a.wav", "--frame", "1"], nothing),
        (&["--wav", "a.wav", "--size", "2x2"], nothing),
        (&["--wav", "a.wav", "--once"], nothing),
        (&["--mute", "--wav", "a.wav"], nothing),
        (&["--from", "3", "--wav", "a.wav"], nothing),
        (&["-o", "a.png", "--wav", "a.wav"], nothing),
        (&["--mute", "--frame", "1"], "--mute is for playing"),
        (&["--wav", "none/a.wav"], "'none/a.wav': no such directory; choose another place"),
        (&["--wav", "/proc/a.wav"], "choose another place"),
    ] {
        refused(args, &run(dir.path(), args), part);
        assert!(names(dir.path()).is_empty(), "{args:?} left {:?}", names(dir.path()));
    }
    std::fs::create_dir(dir.path().join("d.wav")).unwrap();
    refused(&["d.wav"], &run(dir.path(), &["--wav", "d.wav"]), "it is a directory");
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let args = ["--scene", "luc", "--wav", "-"];
    let output = command(dir.path()).args(args).stdout(full).output().unwrap();
    refused(&args, &output, "cannot write standard output: no space left");
}
