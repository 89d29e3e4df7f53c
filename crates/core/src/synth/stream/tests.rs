//! Laws of the stream, on a small score that is sparse: long gaps are where subnormal numbers would grow.

use super::*;
use crate::synth::instrument::*;
use crate::synth::pcm;
use crate::synth::score::{Chord, Row};

const INSTRUMENTS: [Instrument; 3] = {
    let mut kick = [0.0; COLUMNS];
    kick[COPIES] = 1.0;
    kick[PITCH] = 32.0;
    kick[RATIO] = 3.0;
    kick[INDEX] = 2.5;
    kick[INDEX_FALL] = 0.006;
    kick[BEND] = 7.5;
    kick[BEND_FALL] = 0.024;
    kick[ATTACK] = 0.001;
    kick[DECAY] = 0.16;
    kick[RELEASE] = 0.16;
    kick[PAN] = 1.0;
    kick[CUTOFF] = 6000.0;
    kick[RESONANCE] = 0.7;
    kick[SWEEP_FALL] = 0.1;
    kick[LEVEL] = 0.5;
    kick[REVERB] = 0.5;
    kick[DELAY] = 0.5;
    kick[OFFBEAT] = 1.0;
    let mut noise = kick;
    noise[COPIES] = 2.0;
    noise[SPREAD] = 1.0;
    noise[NOISE] = 1.0;
    noise[PASS] = 2.0;
    let mut saws = kick;
    saws[WAVE] = 2.0;
    saws[COPIES] = 7.0;
    saws[DETUNE] = 9.0;
    saws[PITCH] = 0.0;
    saws[SUSTAIN] = 0.5;
    saws[SWEEP] = 2.0;
    saws[SWEEP_RISE] = 0.1;
    saws[VIBRATO] = 9.0;
    saws[DUCK] = 0.5;
    [Instrument::new(kick), Instrument::new(noise), Instrument::new(saws)]
};

static SCORE: Score =
    Score { instruments: &INSTRUMENTS, patterns: "d9...............\np0---------------\nk0...4-----7---9\n" };

const CHORD: Chord = Chord::new(0, b't', b'A');
const fn row(instrument: u8, pattern: u8, bar: u8, bars: u8) -> Row {
    Row { instrument, pattern, bar, bars, transpose: 0, level: [100, 80], cutoff: [20, 25], pan: Row::OWN }
}

static BUSY: Section = Section {
    gain: 90,
    reverb: 100,
    delay: 100,
    harmony: &[CHORD, CHORD, Chord::new(-2, b'7', b'A')],
    rows: &[row(0, 0, 0, 3), row(1, 0, 0, 3), row(2, 2, 0, 3), row(2, 1, 0, 2)],
};
static SPARSE: Section = Section {
    gain: 90,
    reverb: 100,
    delay: 100,
    harmony: &[CHORD; 24],
    rows: &[row(0, 0, 0, 1), row(1, 0, 0, 1), row(2, 2, 0, 1)],
};
static EMPTY: Section = Section { gain: 90, reverb: 100, delay: 100, harmony: &[CHORD; 2], rows: &[] };

fn stream(sections: &[&'static Section], sample: u32) -> Stream {
    Stream::new(Tune { score: &SCORE, sections: sections.to_vec().leak() }, sample)
}

fn take(stream: &mut Stream, samples: usize) -> Vec<[f32; 2]> {
    let mut out = vec![[0.0; 2]; samples];
    stream.render(&mut out);
    out
}

fn bits(samples: &[[f32; 2]]) -> Vec<u32> {
    samples.as_flattened().iter().map(|v| v.to_bits()).collect()
}

#[test]
fn blocks_of_any_size_give_the_same_bits() {
    let start = stream(&[&BUSY], 0);
    let whole = take(&mut start.clone(), 3 * BAR as usize);
    for size in [1, 7, 31, 64, 65, 735, 5513, 44_100] {
        let mut stream = start.clone();
        let mut parts = Vec::new();
        while parts.len() < whole.len() {
            parts.extend(take(&mut stream, size.min(whole.len() - parts.len())));
        }
        assert!(bits(&parts) == bits(&whole), "blocks of {size}");
    }
}

#[test]
fn every_round_has_the_same_bits() {
    for sections in [&[&BUSY][..], &[&BUSY, &SPARSE], &[&EMPTY]] {
        let mut stream = stream(sections, 0);
        let round = stream.tune.samples() as usize;
        let first = bits(&take(&mut stream, round));
        for n in 2..4 {
            assert!(bits(&take(&mut stream, round)) == first, "round {n} of {} sections", sections.len());
        }
    }
}

#[test]
fn beginning_anywhere_is_beginning_earlier() {
    let mut whole = stream(&[&BUSY, &SPARSE], 0);
    let all = take(&mut whole, BAR as usize * 6);
    for sample in [1, 64, 5512, 5513, 100_000, 300_007] {
        let later = take(&mut stream(&[&BUSY, &SPARSE], sample), 44_100);
        let expected = &all[sample as usize..][..44_100];
        let apart = later.as_flattened().iter().zip(expected.as_flattened());
        let apart = apart.fold(0.0f32, |worst, (a, b)| worst.max((a - b).abs()));
        assert!(apart < 1e-5, "from sample {sample}: {apart:e} off");
    }
}

#[test]
fn nothing_is_silence_and_notes_end_in_silence() {
    let empty = take(&mut stream(&[&EMPTY], 0), 2 * BAR as usize);
    assert!(empty.as_flattened().iter().all(|&v| pcm(v) == 0 && v.abs() < 1e-12));
    let sparse = take(&mut stream(&[&SPARSE], 0), 24 * BAR as usize);
    assert!(sparse[..BAR as usize].as_flattened().iter().any(|&v| pcm(v).abs() > 1000));
    let last = &sparse[23 * BAR as usize..];
    assert!(last.as_flattened().iter().all(|&v| pcm(v) == 0), "the last of 24 bars, 44 s after the notes");
}

#[test]
fn no_number_of_the_state_is_subnormal() {
    for sections in [&[&SPARSE][..], &[&EMPTY, &BUSY]] {
        let mut stream = stream(sections, 0);
        for second in 0..48 {
            take(&mut stream, 44_100);
            let state = &stream.state;
            let numbers = state.packets.iter().flat_map(Packet::numbers).chain(state.effects.numbers());
            let bad: Vec<_> =
                numbers.enumerate().filter(|(_, v)| v.is_subnormal() || !v.is_finite()).collect();
            assert!(bad.is_empty(), "after {second} s: {bad:?}");
        }
    }
}

#[test]
fn a_kick_presses_down_at_once_and_lets_go_without_a_step() {
    let mut duck = Duck::default();
    assert_eq!(duck.next(), 0.0);
    let mut before = 0.0;
    for sample in 0..30_000 {
        if sample == 100 || sample == 8000 {
            duck.press(0.8);
        }
        let value = duck.next();
        assert!((0.0..=1.0).contains(&value));
        assert!((value - before).abs() < 0.02, "a step at sample {sample}");
        before = value;
    }
    assert_eq!(before, 0.0);
    duck.press(0.5);
    let highest = (0..200).map(|_| duck.next()).fold(0.0, f32::max);
    assert!((highest - 0.55).abs() < 1e-3, "{highest}");
}

#[test]
fn sixteenths_begin_where_sequencers_put_them() {
    assert_eq!([0, 1, 2, 3, 16, 1472].map(sample_of), [0, 5512, 11_025, 16_537, BAR, 92 * BAR]);
    assert_eq!([0.0, 1.0, -1.0, 0.5 / 32_767.0].map(pcm), [0, 32_767, -32_767, 1]);
}
