//! Meters: what a listener can't read off the samples, in numbers. For tests and the lab only.
//!
//! Loudness by ITU-R BS.1770-4 (two filters, gated blocks of 0.4 s), peaks between samples by
//! four-fold interpolation, the strength of one frequency, and of octaves.

use super::RATE;
use crate::math::scalar::{log2, sin_cos};
use core::f32::consts::{PI, TAU};

/// A second-order filter: b0 b1 b2 a1 a2, and its state.
struct Biquad([f64; 5], [f64; 2]);

impl Biquad {
    /// The two filters of BS.1770 at 44,100 samples a second, by the bilinear transform of its prototypes.
    fn weighting() -> [Biquad; 2] {
        [
            Biquad(
                [
                    1.5308412300503478,
                    -2.650979995154729,
                    1.1690790799215869,
                    -1.6636551132560204,
                    0.7125954280732254,
                ],
                [0.0; 2],
            ),
            Biquad([1.0, -2.0, 1.0, -1.9891696736297957, 0.9891990357870394], [0.0; 2]),
        ]
    }

    fn next(&mut self, x: f64) -> f64 {
        let [b0, b1, b2, a1, a2] = self.0;
        let y = b0 * x + self.1[0];
        self.1 = [b1 * x - a1 * y + self.1[1], b2 * x - a2 * y];
        y
    }
}

/// `power` in decibels.
pub fn decibels(power: f64) -> f64 {
    // 10 lg 2
    f64::from(log2(power as f32)) * 3.010_299_956_639_812
}

/// Integrated loudness of stereo, LUFS; gated at -70 and at 10 below the mean.
pub fn loudness(samples: &[[f32; 2]]) -> f64 {
    const TENTH: usize = RATE as usize / 10;
    let mut filters = [Biquad::weighting(), Biquad::weighting()];
    let mut tenths = Vec::new();
    for chunk in samples.chunks_exact(TENTH) {
        let mut power = 0.0;
        for sample in chunk {
            for (x, filters) in sample.iter().zip(&mut filters) {
                let y = filters.iter_mut().fold(f64::from(*x), |x, filter| filter.next(x));
                power += y * y;
            }
        }
        tenths.push(power / TENTH as f64);
    }
    let blocks: Vec<f64> = tenths.windows(4).map(|w| w.iter().sum::<f64>() / 4.0).collect();
    let lufs = |power: f64| decibels(power) - 0.691;
    let mean = |gate: f64| {
        let loud: Vec<f64> = blocks.iter().copied().filter(|&p| p > 0.0 && lufs(p) > gate).collect();
        lufs(loud.iter().sum::<f64>() / loud.len() as f64)
    };
    mean(mean(-70.0) - 10.0)
}

/// The greatest magnitude of a channel, with three values interpolated between each two samples
/// (windowed sinc of 32 taps).
pub fn true_peak(samples: &[[f32; 2]]) -> f32 {
    const HALF: i32 = 16;
    let kernel: Vec<[f32; 2 * HALF as usize]> = (1..4)
        .map(|phase| {
            core::array::from_fn(|tap| {
                let x = (tap as i32 - HALF + 1) as f32 - phase as f32 / 4.0;
                let window = 0.5 + 0.5 * sin_cos(PI * x / HALF as f32).1;
                window * sin_cos(PI * x).0 / (PI * x)
            })
        })
        .collect();
    let mut peak = 0.0f32;
    for side in 0..2 {
        for (i, sample) in samples.iter().enumerate() {
            peak = peak.max(sample[side].abs());
            // Where all neighbours are far below the peak, nothing between them can reach it.
            let Some(near) =
                (i + 1).checked_sub(HALF as usize).and_then(|i| samples.get(i..i + 2 * HALF as usize))
            else {
                continue;
            };
            if sample[side].abs().max(near[HALF as usize][side].abs()) < 0.6 * peak {
                continue;
            }
            for kernel in &kernel {
                let value: f32 = near.iter().zip(kernel).map(|(sample, tap)| sample[side] * tap).sum();
                peak = peak.max(value.abs());
            }
        }
    }
    peak
}

/// Amplitude of the sine of a frequency (Hz) in both channels together, seen through a Hann window.
pub fn tone(samples: &[[f32; 2]], frequency: f32) -> f32 {
    let mut sum = [0.0f64; 2];
    for (i, [left, right]) in samples.iter().enumerate() {
        let turns = i as f64 * f64::from(frequency) / f64::from(RATE);
        let (sin, cos) = sin_cos((turns - turns.floor()) as f32 * TAU);
        let window = 1.0 - sin_cos(TAU * (i as f32 + 0.5) / samples.len() as f32).1;
        let value = f64::from(0.5 * (left + right) * window);
        sum = [sum[0] + value * f64::from(sin), sum[1] + value * f64::from(cos)];
    }
    let amplitude = (sum[0] * sum[0] + sum[1] * sum[1]).sqrt() * 2.0 / samples.len() as f64;
    amplitude as f32
}

/// Samples of a spectrum.
const WINDOW: usize = 8192;

/// Mean power in bands between frequencies (Hz), both channels together.
pub fn bands(samples: &[[f32; 2]], edges: &[f32]) -> Vec<f64> {
    let mut powers = vec![0.0; edges.len().saturating_sub(1)];
    for chunk in samples.chunks_exact(WINDOW) {
        // Left as real, right as imaginary part: |X(f)|² + |X(-f)|² is the power of both.
        let windowed = chunk.iter().enumerate().map(|(i, &[left, right])| {
            let window = 1.0 - sin_cos(TAU * (i as f32 + 0.5) / WINDOW as f32).1;
            [f64::from(left * window), f64::from(right * window)]
        });
        let spectrum = transform(windowed.collect());
        for k in 1..WINDOW / 2 {
            let frequency = k as f32 * RATE as f32 / WINDOW as f32;
            let after = edges.iter().take_while(|&&edge| edge <= frequency).count();
            if after > 0 && after < edges.len() {
                let power = |[re, im]: [f64; 2]| re * re + im * im;
                powers[after - 1] += power(spectrum[k]) + power(spectrum[WINDOW - k]);
            }
        }
    }
    let scale = (WINDOW * WINDOW) as f64 * (samples.len() / WINDOW).max(1) as f64;
    powers.iter().map(|power| power / scale).collect()
}

/// Fourier transform of 2ⁿ complex numbers (Cooley & Tukey 1965).
fn transform(values: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let n = values.len();
    if n == 1 {
        return values;
    }
    let half = |first: usize| transform(values.iter().skip(first).step_by(2).copied().collect());
    let (even, odd) = (half(0), half(1));
    let mut out = vec![[0.0; 2]; n];
    for k in 0..n / 2 {
        let (sin, cos) = sin_cos(-TAU * k as f32 / n as f32);
        let (sin, cos) = (f64::from(sin), f64::from(cos));
        let turned = [odd[k][0] * cos - odd[k][1] * sin, odd[k][0] * sin + odd[k][1] * cos];
        out[k] = [even[k][0] + turned[0], even[k][1] + turned[1]];
        out[k + n / 2] = [even[k][0] - turned[0], even[k][1] - turned[1]];
    }
    out
}

#[cfg(test)]
mod tests;
