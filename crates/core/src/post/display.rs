//! The curve from linear light to display values, as a table.
//!
//! exposure → tone map x(2.51x+0.03)/(x(2.43x+0.59)+0.14) (Narkowicz 2015) → sRGB → grade
//! lift + v (gain - lift) → v^(1/gamma). Each channel has its own curve, and only its own value
//! goes in, so a table of it is exact at its entries. 128 entries per octave, the nearest taken, stay
//! within 0.0012 of it, a third of an output step, and the three tables fit the first-level cache.

use crate::math::Vec3;
use crate::math::lanes::{Bound, F, V3, splat, splat_u};
use crate::math::scalar::{pow, srgb_encode};
use crate::scene::Grade;

/// Mantissa bits that choose an entry.
const FINE: u32 = 7;
/// Octaves of the table: from 2^-12, which displays as black, to 2^4, which displays as white.
const OCTAVES: u32 = 16;
/// Bits of the first entry: 2^-12.
const FIRST: u32 = (127 - 12) << 23;
const ENTRIES: usize = (OCTAVES << FINE) as usize + 1;

/// A table of display values for each channel, one after another.
#[derive(Default)]
pub struct Display(Vec<f32>);

fn tone(x: f32) -> f32 {
    (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0)
}

impl Display {
    /// The curves of a grade.
    pub fn new(grade: &Grade) -> Self {
        let mut display = Self::default();
        display.set(grade);
        display
    }

    /// Makes these the curves of a grade.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn set(&mut self, grade: &Grade) {
        let entry = |at: usize| {
            let (channel, i) = (at / ENTRIES, at % ENTRIES);
            let (lift, gain, gamma) = (grade.lift[channel], grade.gain[channel], grade.gamma[channel]);
            let x = f32::from_bits(FIRST + ((i as u32) << (23 - FINE)));
            let v = srgb_encode(tone(x * grade.exposure));
            pow((lift + v * (gain - lift)).clamp(0.0, 1.0), 1.0 / gamma)
        };
        self.0.clear();
        self.0.extend((0..3 * ENTRIES).map(entry));
    }

    /// Display value of a colour, 0 to 1. NaN counts as black.
    pub fn map(&self, linear: Vec3) -> Vec3 {
        self.map8(V3::splat(linear)).lane(0)
    }

    /// [`Display::map`] for eight colours.
    #[inline(never)]
    pub fn map8(&self, linear: V3) -> V3 {
        let channel = |k: usize, x: F| lookup(&self.0[k * ENTRIES..], x);
        V3 { x: channel(0, linear.x), y: channel(1, linear.y), z: channel(2, linear.z) }
    }
}

#[inline(never)]
fn lookup(curve: &[f32], x: F) -> F {
    // The maximum is its second operand if the first is NaN.
    let x = x.at_least(splat(f32::from_bits(FIRST))).at_most(splat(15.999));
    // Half an entry on, so that cutting the lower bits off takes the nearest.
    const HALF: u32 = 1 << (22 - FINE);
    let at = (x.to_bits() - splat_u(FIRST - HALF)) >> (23 - FINE);
    F::new(at.to_array().map(|i| curve[i as usize]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "an oracle in f64 that never reaches a pixel")]

    use super::*;

    fn grades() -> [Grade; 3] {
        let plain = Grade::DEFAULT;
        let (lift, gain) = (Vec3::new(0.0, 0.006, 0.03), Vec3::new(1.0, 0.985, 0.955));
        let graded = Grade { exposure: 1.3, lift, gain, gamma: Vec3::new(0.9, 0.89, 1.2), ..plain };
        [plain, graded, Grade { exposure: 0.25, ..plain }]
    }

    /// The curve of a channel.
    fn exact(grade: &Grade, channel: usize, x: f32) -> f64 {
        let x = f64::from(x) * f64::from(grade.exposure);
        let tone = (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0);
        let srgb = if tone <= 0.003_130_8 { 12.92 * tone } else { 1.055 * tone.powf(1.0 / 2.4) - 0.055 };
        let [lift, gain, gamma] = [grade.lift, grade.gain, grade.gamma].map(|v| f64::from(v[channel]));
        (lift + srgb * (gain - lift)).clamp(0.0, 1.0).powf(1.0 / gamma)
    }

    #[test]
    fn the_table_is_within_a_third_of_an_output_step_and_never_falls() {
        for grade in grades() {
            let display = Display::new(&grade);
            for channel in 0..3 {
                let (mut worst, mut before) = ((0.0, 0.0), 0.0);
                for bits in (0x3a00_0000..0x4180_0000_u32).step_by(997) {
                    let x = f32::from_bits(bits);
                    let found = display.map(Vec3::splat(x))[channel];
                    assert!(found >= before, "{found} after {before} at {x} in {grade:?}");
                    before = found;
                    let off = (f64::from(found) - exact(&grade, channel, x)).abs();
                    worst = if off > worst.0 { (off, x) } else { worst };
                }
                println!("channel {channel}: {worst:?}");
                assert!(worst.0 <= 0.0012, "{worst:?} in channel {channel} of {grade:?}");
            }
        }
    }

    #[test]
    fn no_light_is_black_much_is_white_and_what_is_no_number_black() {
        let display = Display::new(&Grade::DEFAULT);
        for (light, shown) in [(0.0, 0.0), (-1.0, 0.0), (f32::NAN, 0.0), (1e30, 1.0), (f32::INFINITY, 1.0)] {
            let found = display.map(Vec3::splat(light));
            assert!((found - Vec3::splat(shown)).abs().max_element() < 2e-3, "{light}: {found}");
        }
    }
}
