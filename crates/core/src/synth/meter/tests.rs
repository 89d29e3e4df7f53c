//! The meters against signals whose values are known.

use super::*;

/// A sine in both channels.
fn sine(frequency: f32, amplitude: f32, seconds: usize) -> Vec<[f32; 2]> {
    let value = |i: usize| {
        let turns = (i as f64 * f64::from(frequency) / f64::from(RATE)).fract();
        [amplitude * sin_cos(turns as f32 * TAU).0; 2]
    };
    (0..seconds * RATE as usize).map(value).collect()
}

#[test]
fn a_sine_of_997_hz_at_minus_20_db_is_as_loud_as_the_standard_says() {
    // BS.1770: 0 dB full scale at 997 Hz in one channel is -3.01; two channels add 3.01.
    let measured = loudness(&sine(997.0, 0.1, 5));
    assert!((measured + 20.0).abs() < 0.05, "{measured}");
    // The weighting lifts high and drops low tones.
    assert!((loudness(&sine(10_000.0, 0.1, 5)) + 20.0 - 3.3).abs() < 0.3);
    assert!(loudness(&sine(30.0, 0.1, 5)) < -26.0);
}

#[test]
fn silence_does_not_lower_the_loudness() {
    let mut samples = sine(997.0, 0.1, 10);
    let alone = loudness(&samples);
    samples.resize(60 * RATE as usize, [0.0; 2]);
    assert!((loudness(&samples) - alone).abs() < 0.2);
}

#[test]
fn a_peak_between_samples_is_found() {
    // A quarter of the rate, an eighth of a turn off: all samples lie at 0.707 of the peak.
    let samples: Vec<_> = (0..4000).map(|i| [0.5 * sin_cos(TAU * (i as f32 / 4.0 + 0.125)).0; 2]).collect();
    let highest = samples.iter().fold(0.0f32, |a, s| a.max(s[0].abs()));
    assert!(highest < 0.36);
    let peak = true_peak(&samples);
    assert!((peak - 0.5).abs() < 0.01, "{peak}");
}

#[test]
fn a_tone_is_found_at_its_frequency_and_in_its_band() {
    let samples = sine(440.0, 0.25, 1);
    assert!((tone(&samples, 440.0) - 0.25).abs() < 1e-3);
    assert!(tone(&samples, 466.2) < 1e-3);
    let bands = bands(&samples, &[20.0, 250.0, 500.0, 1000.0]);
    assert!(bands[1] > 1e4 * bands[0] && bands[1] > 1e4 * bands[2], "{bands:?}");
    assert!((decibels(0.001) + 30.0).abs() < 1e-4);
}
