//! The curve from linear light to display values, as a table.
//!
//! exposure → tone map x(2.51x+0.03)/(x(2.43x+0.59)+0.14) (Narkowicz 2015) → sRGB → grade
//! lift + v (gain - lift) → v^(1/gamma). Each channel has its own curve, and only its own value
//! goes in, so a table of it is exact at its entries. 128 entries per octave, the nearest taken, stay
//! within 0.001 of it, a quarter of an output step, and the three tables fit the first-level cache.

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
pub struct Display(Vec<f32>);

fn tone(x: f32) -> f32 {
    (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0)
}

impl Display {
    /// The curves of a grade.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn new(grade: &Grade) -> Self {
        let entry = |at: usize| {
            let (channel, i) = (at / ENTRIES, at % ENTRIES);
            let (lift, gain, gamma) = (grade.lift[channel], grade.gain[channel], grade.gamma[channel]);
            let x = f32::from_bits(FIRST + ((i as u32) << (23 - FINE)));
            let v = srgb_encode(tone(x * grade.exposure));
            pow((lift + v * (gain - lift)).clamp(0.0, 1.0), 1.0 / gamma)
        };
        Self((0..3 * ENTRIES).map(entry).collect())
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
