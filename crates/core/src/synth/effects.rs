//! What all voices share: ping-pong delay, reverb, and the last stage before the card.
//!
//! - Delay: two lines of three sixteenths. The left one takes the voices and the dulled right echo, the
//!   right one the dulled left echo.
//! - Reverb: high-pass and two all-passes a side, then a feedback delay network of eight lines with
//!   one-pole damping and a Hadamard matrix (Jot & Chaigne 1991); even lines left, odd lines right.
//! - Master: the mean is taken out (one pole at 22 Hz), then a knee: straight up to half the ceiling,
//!   a parabola to the ceiling.
//!
//! All delays lie in one ring, one after the other, among them the one-sample memories of the filters.
//! Each sample the ring turns by one, so a line's end is read where it was written a length ago.

use super::RATE;
use super::voice::BUSES;

/// The delays, samples: echoes, before the reverb, all-passes of both sides, lines, and the memories of
/// the one-pole filters of the echoes, before the reverb, of the mean, of the lines.
const LENGTHS: [u16; 30] = [
    16_537, 16_537, 882, 882, 142, 379, 107, 277, 1433, 1601, 1867, 2053, 2251, 2399, 2617, 2797, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
];
/// Places of the kinds among them.
const ECHO: usize = 0;
const BEFORE: usize = 2;
const ALL_PASS: usize = 4;
const LINE: usize = 8;
const DULL: usize = 16;
const LOW: usize = 18;
const MEAN: usize = 20;
const DAMPED: usize = 22;

/// Where in the ring each delay ends; the next begins one sample later, so that none reads what another
/// has just written.
const ENDS: [u16; LENGTHS.len()] = {
    let mut ends = [LENGTHS[0]; LENGTHS.len()];
    let mut i = 1;
    while i < ends.len() {
        ends[i] = ends[i - 1] + 1 + LENGTHS[i];
        i += 1;
    }
    ends
};

/// A power of two, so that positions wrap by themselves; no less than all delays.
const RING: usize = 1 << 16;

/// Seconds in which the reverb falls by 60 dB.
const FADE: f32 = 3.4;
/// Levels of reverb and delay in the mix, and of the delay in the reverb.
const REVERB: f32 = 0.32;
const DELAY: f32 = 0.7;
const DELAY_IN_REVERB: f32 = 0.25;
/// What can't be heard but keeps states that fade from becoming subnormal.
const BIAS: f32 = 1e-18;
/// The loudest sample.
pub const CEILING: f32 = 0.745;

/// State of the effects.
#[derive(Clone, Debug)]
pub struct Effects {
    ring: Vec<f32>,
    at: u16,
}

impl Default for Effects {
    fn default() -> Self {
        Effects { ring: vec![0.0; RING], at: 0 }
    }
}

impl Effects {
    /// All numbers of its state.
    #[cfg(test)]
    pub fn numbers(&self) -> Vec<f32> {
        self.ring.clone()
    }

    /// One sample of the voices' buses becomes one of the mix.
    #[inline(never)]
    pub fn sample(&mut self, bus: &[f32; BUSES]) -> [f32; 2] {
        self.at = self.at.wrapping_sub(1);
        let at = self.at;
        self.ring.first_chunk_mut().map_or([0.0; 2], |ring| Delays { ring, at }.sample(bus))
    }
}

/// The delays at a sample.
struct Delays<'a> {
    ring: &'a mut [f32; RING],
    at: u16,
}

impl Delays<'_> {
    /// The end of a delay.
    fn read(&self, delay: usize) -> f32 {
        self.ring[usize::from(self.at.wrapping_add(ENDS[delay]))]
    }

    /// The start of a delay.
    fn write(&mut self, delay: usize, value: f32) {
        self.ring[usize::from(self.at.wrapping_add(ENDS[delay] - LENGTHS[delay]))] = value;
    }

    /// A one-pole low-pass with its memory in a delay of one sample.
    fn pole(&mut self, memory: usize, share: f32, value: f32) -> f32 {
        let before = self.read(memory);
        let after = before + share * (value - before);
        self.write(memory, after);
        after
    }

    fn sample(&mut self, bus: &[f32; BUSES]) -> [f32; 2] {
        let mut y = [0.0; 8];
        for (k, y) in y.iter_mut().enumerate() {
            let end = self.read(LINE + k);
            // What is left after a line is 10^(-3·seconds/FADE), as the first terms of its series.
            let x = f32::from(LENGTHS[LINE + k]) * (6.907_755 / RATE as f32 / FADE);
            *y = (1.0 - x + 0.5 * x * x) * self.pole(DAMPED + k, 0.58, end);
        }
        let reverb = [y[0] - y[2] + y[4] - y[6], y[1] - y[3] + y[5] - y[7]];
        let mut stride = 1;
        while stride < 8 {
            for k in 0..8 {
                if k & stride == 0 {
                    let (a, b) = (y[k], y[k + stride]);
                    (y[k], y[k + stride]) = (a + b, a - b);
                }
            }
            stride *= 2;
        }

        let mut out = [0.0; 2];
        for side in 0..2 {
            let end = self.read(ECHO + side);
            let echo = self.pole(DULL + side, 0.65, end);
            // Each side's echo goes on to the other one.
            let (new, share) = [(bus[4] + BIAS, 0.44), (0.0, 0.79)][side];
            let other = self.read(DULL + 1 - side);
            self.write(ECHO + side, new + share * other);

            let v = self.read(BEFORE + side);
            self.write(BEFORE + side, bus[2 + side] + DELAY_IN_REVERB * echo);
            // High-pass at 180 Hz.
            let mut v = v - self.pole(LOW + side, 0.025_320, v) + BIAS;
            for k in 0..2 {
                let line = ALL_PASS + 2 * side + k;
                let end = self.read(line);
                v -= 0.6 * end;
                self.write(line, v);
                v = end + 0.6 * v;
            }
            for k in 0..4 {
                let k = 2 * k + side;
                self.write(LINE + k, y[k] * (0.5 * core::f32::consts::FRAC_1_SQRT_2) + v * 0.5);
            }

            let v = bus[side] + BIAS + DELAY * echo + REVERB * reverb[side];
            let v = (v - self.pole(MEAN + side, 0.003_129_5, v)) * (1.0 / CEILING);
            let over = (v.abs() - 0.5).clamp(0.0, 1.0);
            let knee = v.abs().min(0.5) + over - 0.5 * over * over;
            out[side] = knee.copysign(v) * CEILING;
        }
        out
    }
}
