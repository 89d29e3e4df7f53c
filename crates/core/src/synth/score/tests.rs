//! How a score is read: degrees, chords, ties, lengths, levels.

use super::*;
use crate::synth::instrument::{COLUMNS, LEVEL};

const INSTRUMENTS: [Instrument; 2] = {
    let mut numbers = [1.0; COLUMNS];
    numbers[PAN] = 0.75;
    numbers[LEVEL] = 0.5;
    let plain = Instrument::new(numbers);
    numbers[OFFBEAT] = 0.5;
    [plain, Instrument::new(numbers)]
};

static SCORE: Score = Score {
    instruments: &INSTRUMENTS,
    patterns: "k4-----7-----8---9--8--6-4-------\np0---------------\nd9...3...\nc0145\nb0-7.\nr0.b-\n",
};

const D_MINOR: Chord = Chord::new(0, b't', b'A');
const B_FLAT: Chord = Chord::new(-2, b'7', b'A');

const fn row(instrument: u8, pattern: u8, bar: u8, bars: u8) -> Row {
    Row { instrument, pattern, bar, bars, transpose: 0, level: [100, 50], cutoff: [10, 30], pan: Row::OWN }
}

fn section(harmony: &[Chord], rows: &[Row]) -> Section {
    let (harmony, rows) = (harmony.to_vec().leak(), rows.to_vec().leak());
    Section { gain: 100, reverb: 50, delay: 25, harmony, rows }
}

/// Start, pitch, length in sixteenths of all notes.
fn played(harmony: &[Chord], rows: &[Row]) -> Vec<(u32, i32, u32)> {
    let section = section(harmony, rows);
    let mut out = Vec::new();
    for step in 0..harmony.len() as u32 * STEPS {
        SCORE.notes(&section, step, |_, note| {
            out.push((step, note.pitch, (note.length * 2).div_ceil(11_025)))
        });
    }
    out
}

#[test]
fn the_motif_follows_the_scale() {
    let melody = played(&[D_MINOR, D_MINOR], &[row(0, 0, 0, 2)]);
    let (a, d, e, f, c) = (69, 74, 76, 77, 72);
    assert_eq!(melody, [(0, a, 6), (6, d, 6), (12, e, 4), (16, f, 3), (19, e, 3), (22, c, 2), (24, a, 8)]);
    let phrygian = [Chord::new(0, b't', b'P'), Chord::new(0, b't', b'P').key(3)];
    let transposed = played(&phrygian, &[row(0, 0, 0, 2).up(-7)]);
    // A D Eb in D Phrygian, then Ab Gb Eb C in F Phrygian, an octave lower.
    assert_eq!(transposed.iter().map(|n| n.1).collect::<Vec<_>>(), [57, 62, 63, 68, 66, 63, 60]);
}

#[test]
fn chords_are_broken_upwards_and_basses_folded() {
    let tones: Vec<i32> = played(&[B_FLAT], &[row(0, 3, 0, 1)]).iter().map(|n| n.1).take(4).collect();
    // B flat, D, B flat, D.
    assert_eq!(tones, [58, 62, 70, 74]);
    let bass = played(&[B_FLAT.over(0)], &[row(0, 4, 0, 1)]);
    assert_eq!(bass[..2], [(0, 38, 2), (2, 50, 1)]);
    let above_root = played(&[B_FLAT], &[row(0, 5, 0, 1)]);
    assert_eq!(above_root[..2], [(0, 58, 1), (2, 58 + 19, 2)]);
}

#[test]
fn held_chords_tie_the_tones_that_stay() {
    let chord = played(&[D_MINOR, D_MINOR, B_FLAT], &[row(0, 1, 0, 3)]);
    // D F A D: the lower D and F stay over B flat, A and D too, the root B flat is new.
    let starts = |step| chord.iter().filter(|n| n.0 == step).count();
    assert_eq!((starts(0), starts(16)), (4, 0));
    let held: u32 = chord.iter().map(|n| n.2).sum();
    assert_eq!(held, 4 * 3 * STEPS, "all four voices sound throughout: {chord:?}");
    assert!(chord.iter().all(|n| (50..73).contains(&n.1)));
}

#[test]
fn levels_and_cutoffs_go_straight_from_start_to_end() {
    let section = section(&[D_MINOR; 2], &[row(1, 2, 0, 2)]);
    let at = |step| {
        let mut found = None;
        SCORE.notes(&section, step, |who, n| {
            found = Some((who, [n.level, n.cutoff, n.pan, n.reverb, n.delay]))
        });
        found
    };
    assert_eq!(at(0), Some((1, [1.0, -1.0, -0.25, 0.5, 0.25])));
    let (_, [level, cutoff, ..]) = at(16).unwrap();
    assert!((level - 0.75).abs() < 1e-6 && cutoff.abs() < 1e-6);
    // A drum's digit is in ninths.
    let (_, [level, ..]) = at(20).unwrap();
    assert!((level - (1.0 - 0.5 * 20.0 / 32.0) / 3.0).abs() < 1e-6);
    assert!(at(1).is_none());
}

#[test]
fn offbeat_notes_are_softer_where_the_instrument_says_so() {
    let level = |section: &Section, step| {
        let mut level = 0.0;
        SCORE.notes(section, step, |_, note| level = note.level);
        level
    };
    let (straight, soft) = (section(&[D_MINOR], &[row(0, 3, 0, 1)]), section(&[D_MINOR], &[row(1, 3, 0, 1)]));
    assert_eq!(level(&soft, 4), level(&straight, 4));
    assert_eq!(level(&soft, 5), 0.5 * level(&straight, 5));
}
