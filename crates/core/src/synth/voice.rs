//! The voice: oscillator or noise, filter, envelope, place. Eight at a time, one a lane.
//!
//! A note is as many voices as its instrument has copies of the oscillator, and voices that begin at
//! the same sample share packets. Nothing in here branches on the instrument: what one doesn't use is
//! there with a weight of 0.
//!
//! - Sine with frequency modulation: sin 2π(p + i/2π·sin 2πm) (Chowning 1973).
//! - Saw: 2p, its jump smoothed by polyBLEP (Välimäki & Huovilainen 2007), with p in turns from -1/2 to
//!   1/2 and d the step: 2p + max(0, 1 - (p + 1/2)/d)² - max(0, 1 + (p - 1/2)/d)². A pulse is the
//!   difference of two saws.
//! - Filter: state-variable, trapezoidal (Simper 2013), with tan x ≈ x(15 - x²)/(15 - 6x²).
//!
//! Pitch, modulation and filter change every 32 samples, counted from the note's start; the
//! envelope every sample.

use super::RATE;
use super::instrument::*;
use crate::math::hash::unit;
use crate::math::lanes::{Bound, F, LANES, ONE, RAMP, TRUE, U, ZERO, select, splat, splat_u};
use crate::math::lanes_fn::{exp, exp2, sin_turns, wrap};
use crate::math::{scalar, whole};

/// Samples between two changes of pitch, modulation and filter.
const CONTROL: u32 = 32;

/// A voice whose envelope falls below this has ended.
const END: f32 = 1e-4;

/// What falls towards 0 stops here: far from audible and from the subnormal numbers.
const LEAST: F = F::splat(1e-20);

/// What a voice adds to: left and right, the same for the reverb, and one channel for the delay.
pub const BUSES: usize = 5;

/// A note to play.
#[derive(Clone, Debug)]
pub struct Note<'a> {
    /// What plays it.
    pub instrument: &'a Instrument,
    /// MIDI number.
    pub pitch: i32,
    /// Samples from its start to its release.
    pub length: u32,
    /// Loudness.
    pub level: f32,
    /// How far the instrument's cutoff is moved, octaves.
    pub cutoff: f32,
    /// Place between left, -1, and right, 1.
    pub pan: f32,
    /// What is sent to the reverb, as a multiple of the instrument's share.
    pub reverb: f32,
    /// What is sent to the delay, as a multiple of the instrument's share.
    pub delay: f32,
    /// Where phases and noise begin.
    pub seed: u32,
}

/// What a lane has besides the numbers of its instrument: turns a sample, gains, samples to the release,
/// and where phase and noise begin, 0 to 1.
const FREQUENCY: usize = COLUMNS;
const LEFT: usize = COLUMNS + 1;
const RIGHT: usize = COLUMNS + 2;
const LENGTH: usize = COLUMNS + 3;
const SEED: usize = COLUMNS + 4;
const NUMBERS: usize = COLUMNS + 5;

/// Eight voices that began at the same sample.
#[derive(Clone, Copy, Debug)]
pub struct Packet {
    /// Lanes that are taken.
    used: usize,
    /// Samples since the start.
    age: u32,
    /// The voices' numbers; [`Packet::prepare`] makes seconds factors.
    column: [F; NUMBERS],

    /// Turns from -1/2 to 1/2, of the oscillator and of what modulates it.
    phase: F,
    modulator: F,
    noise: U,
    /// Mask of the voices that still rise to full level.
    rising: F,
    envelope: F,
    /// What the filter's two integrators hold.
    integrators: [F; 2],
    bend: F,
    index: F,
    sweep: F,

    /// Turns a sample at this moment, and its inverse.
    step: F,
    inverse: F,
    /// The filter's coefficients.
    filter: [F; 3],
}

/// Begins a note, all of it times `gain`: its voices take the lanes that are free in the last packet, if that has not begun to
/// sound.
#[inline(never)]
pub fn start(packets: &mut Vec<Packet>, note: &Note, gain: f32) {
    let mut v: [f32; NUMBERS] = [0.0; NUMBERS];
    for (column, v) in v.iter_mut().enumerate().take(COLUMNS) {
        *v = note.instrument.get(column);
    }
    v[CUTOFF] *= scalar::exp2(note.cutoff);
    v[REVERB] *= note.reverb;
    v[DELAY] *= note.delay * 0.5;
    v[LENGTH] = note.length as f32;
    let copies = v[COPIES];
    for copy in 0..whole(copies) as u32 {
        // -1 to 1 from the first copy to the last; places alternate where there are many.
        let x = if copies > 1.0 { 2.0 * copy as f32 / (copies - 1.0) - 1.0 } else { 0.0 };
        let side = v[SPREAD] * if copies > 2.0 && copy % 2 == 1 { -x } else { x };
        let semitones = note.pitch as f32 + v[PITCH] - 69.0 + 0.01 * v[DETUNE] * x;
        v[FREQUENCY] = 440.0 / RATE as f32 * scalar::exp2(semitones / 12.0);
        let level = gain * note.level * v[LEVEL];
        let gain = |pan: f32, side: f32| level * ((1.0 + pan) * (1.0 + side) / copies).sqrt();
        let gains = [gain(-note.pan, -side), gain(note.pan, side)];
        v[LEFT..LEFT + 2].copy_from_slice(&gains);
        // Spread by the golden ratio.
        v[SEED] = unit(note.seed.wrapping_add(copy.wrapping_mul(0x9e37_79b9)));

        if packets.last().is_none_or(|packet| packet.age > 0 || packet.used == LANES) {
            packets.push(Packet::EMPTY);
        }
        let Some(packet) = packets.last_mut() else { return };
        for (lanes, v) in packet.column.iter_mut().zip(v) {
            // Lanes that stay free must hold numbers that can be divided by.
            lanes.as_mut_array()[packet.used % LANES..].fill(v);
        }
        packet.used += 1;
    }
}

impl Packet {
    /// Nothing yet.
    const EMPTY: Packet = Packet {
        used: 0,
        age: 0,
        column: [ZERO; NUMBERS],
        phase: ZERO,
        modulator: ZERO,
        noise: U::ZERO,
        rising: ZERO,
        envelope: ZERO,
        integrators: [ZERO; 2],
        bend: ZERO,
        index: ZERO,
        sweep: ZERO,
        step: ZERO,
        inverse: ZERO,
        filter: [ZERO; 3],
    };

    /// Whether any voice may still be heard.
    pub fn sounds(&self) -> bool {
        (self.rising | self.envelope.simd_gt(ZERO)).any()
    }

    /// All numbers of its state.
    #[cfg(test)]
    pub fn numbers(&self) -> Vec<f32> {
        let [i1, i2] = self.integrators;
        let state = [self.phase, self.modulator, self.envelope, i1, i2, self.bend, self.index, self.sweep];
        state.iter().flat_map(|lanes| lanes.to_array()).collect()
    }

    /// At the start: makes seconds factors, and sets what falls or rises from here on.
    fn prepare(&mut self) {
        const RATE_F: F = F::splat(RATE as f32);
        for (column, samples) in [
            (INDEX_FALL, CONTROL as f32),
            (BEND_FALL, CONTROL as f32),
            (SWEEP_FALL, CONTROL as f32),
            (DECAY, 1.0),
            (RELEASE, 1.0),
        ] {
            self.column[column] = exp(splat(-samples) / (self.column[column] * RATE_F));
        }
        let c = &mut self.column;
        c[ATTACK] = ONE / (c[ATTACK] * RATE_F).at_least(ONE);
        c[RESONANCE] = ONE / c[RESONANCE];
        c[SWEEP_RISE] *= RATE_F;
        let taken = RAMP.simd_lt(splat(self.used as f32));
        c[LEFT] &= taken;
        c[RIGHT] &= taken;
        // Sines begin together, so that a bell's copies don't cancel out when it is struck.
        self.phase = (c[SEED] - splat(0.5)) & c[WAVE].simd_gt(ZERO);
        self.noise = c[SEED].to_bits();
        self.rising = TRUE;
        self.bend = c[BEND];
        self.index = c[INDEX];
        self.sweep = ONE & c[SWEEP_RISE].simd_le(ZERO);
    }

    /// Every [`CONTROL`] samples: pitch, modulation and filter.
    #[inline(never)]
    fn control(&mut self) {
        if self.age == 0 {
            self.prepare();
        }
        let c = &self.column;
        // Vibrato of 5.4 Hz comes in from 0.2 s to 0.5 s.
        let age = self.age as f32;
        let depth = ((age - 0.2 * RATE as f32) / (0.3 * RATE as f32)).clamp(0.0, 1.0);
        let swing =
            sin_turns(splat(age * (5.4 / RATE as f32))) * splat(depth * (core::f32::consts::LN_2 / 1200.0));
        self.step = c[FREQUENCY] * (ONE + self.bend) * (ONE + c[VIBRATO] * swing);
        self.inverse = ONE / self.step;

        let cutoff = (c[CUTOFF] * exp2(c[SWEEP] * self.sweep)).at_most(splat(14_000.0));
        let x = cutoff * splat(core::f32::consts::PI / RATE as f32);
        let xx = x * x;
        let g = x * (splat(15.0) - xx) / (splat(15.0) - splat(6.0) * xx);
        let a = ONE / (ONE + g * (g + c[RESONANCE]));
        self.filter = [a, g * a, g * (g * a)];

        self.bend = (self.bend * c[BEND_FALL]).at_least(LEAST);
        self.index = (self.index * c[INDEX_FALL]).at_least(LEAST);
        let next = splat((self.age + CONTROL) as f32);
        let fallen = (self.sweep * c[SWEEP_FALL]).at_least(LEAST);
        self.sweep = select(next.simd_lt(c[SWEEP_RISE]), next / c[SWEEP_RISE], fallen);
    }

    /// Adds the next samples to the buses, pressed down by `duck`, one value a sample.
    #[inline(never)]
    pub fn render(&mut self, duck: &[f32], buses: &mut [[F; BUSES]]) {
        for (duck, bus) in duck.iter().zip(buses) {
            if self.age.is_multiple_of(CONTROL) {
                self.control();
            }
            let c = &self.column;

            let white = F::from_bits((self.noise >> 9u32) | splat_u(0x4000_0000)) - splat(3.0);
            self.noise = self.noise * splat_u(1_664_525) + splat_u(1_013_904_223);

            let turns = self.index * splat(0.5 / core::f32::consts::PI) * sin_turns(self.modulator);
            let sine = sin_turns(self.phase + turns);
            let edge = ONE - splat(0.5) * self.inverse;
            let saw = |phase: F| {
                let way = phase * self.inverse;
                let (after, before) = ((edge - way).at_least(ZERO), (edge + way).at_least(ZERO));
                phase + phase + after * after - before * before
            };
            let is_pulse = (c[WAVE] - ONE).at_least(ZERO);
            let saws = saw(self.phase) - is_pulse * saw(wrap(self.phase + splat(0.3)));
            let tone = select(c[WAVE].simd_gt(ZERO), saws, sine);
            self.phase = wrap(self.phase + self.step);
            self.modulator = wrap(self.modulator + self.step * c[RATIO]);

            let [i1, i2] = self.integrators;
            let v0 = tone + c[NOISE] * (white - tone);
            let v3 = v0 - i2;
            let v1 = self.filter[0] * i1 + self.filter[1] * v3;
            let v2 = i2 + self.filter[1] * i1 + self.filter[2] * v3;
            // Between the edges of a pulse the first one falls to 0.
            self.integrators = [v1 + v1 - i1 + LEAST, v2 + v2 - i2];
            // Low, 0, is v2, a band, 1, is v1, and high, 2, the rest.
            let high = (c[PASS] - ONE).at_least(ZERO);
            let band = c[PASS] - high - high;
            let passed = (ONE - c[PASS]) * v2 + band * v1 + high * (v0 - c[RESONANCE] * v1);

            let over = splat(self.age as f32).simd_ge(c[LENGTH]);
            self.rising = self.rising & self.envelope.simd_lt(ONE) & !over;
            let goal = c[SUSTAIN] & !over;
            let fall = select(over, c[RELEASE], c[DECAY]);
            let fallen = goal + (self.envelope - goal) * fall;
            let envelope = select(self.rising, (self.envelope + c[ATTACK]).at_most(ONE), fallen);
            self.envelope = envelope & (envelope.simd_gt(splat(END)) | self.rising);

            let out = passed * self.envelope * (ONE - c[DUCK] * splat(*duck));
            let (left, right) = (out * c[LEFT], out * c[RIGHT]);
            bus[0] += left;
            bus[1] += right;
            bus[2] += left * c[REVERB];
            bus[3] += right * c[REVERB];
            bus[4] += (left + right) * c[DELAY];
            self.age += 1;
        }
    }
}
