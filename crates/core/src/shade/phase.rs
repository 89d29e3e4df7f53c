//! Where a medium's particles send light: the phase function of Henyey and Greenstein (1941).
//!
//! p = (1 - g²) / (4π d √d) with d = 1 + g² - 2 g cos, taken as (1 - g)² + 2 g (1 - cos), which keeps
//! its digits in the peak; for g < 0 both g and the cosine change sign. Drawn by inversion, in a form
//! without cancellation or a case for small g: with k = (1 - g) + 2 g u,
//! 1 - cos = 2 ((1 - g) / k)² (1 - u)(1 + g u). Own rearrangement.

use crate::math::lanes::{Bound, F};
use crate::math::lanes_f64::{D, in_f64, splat_d};

/// |g| beyond this counts as this: the peak would no longer be light that scatters.
pub const STEEPEST: f32 = 0.9999;

/// |g|, at most [`STEEPEST`], and whether g is below 0; 0 for NaN.
fn forward(g: f32) -> (f64, bool) {
    let size = if g.abs() > STEEPEST { STEEPEST } else { g.abs() };
    (if size >= 0.0 { size.into() } else { 0.0 }, g < 0.0)
}

/// Share of the scattered light that goes at an angle of this cosine to the way it came, per
/// steradian; `g` is the mean of that cosine, from -1 (back) to 1 (on). Over the sphere it sums to 1.
///
/// Error at most 0.51 ulp for cosines in -1..=1, which others are clamped to.
#[inline(always)]
pub fn phase(g: f32, cos: F) -> F {
    let (g, back) = forward(g);
    let cos = cos.at_least(-F::ONE).at_most(F::ONE);
    let cos = if back { -cos } else { cos };
    let (peak, slope) = (splat_d((1.0 - g) * (1.0 - g)), splat_d(g + g));
    let scale = splat_d((1.0 - g) * (1.0 + g) * (0.25 * std::f64::consts::FRAC_1_PI));
    in_f64([cos], |[cos]| {
        let d = peak + slope * (splat_d(1.0) - cos);
        scale / (d * d.sqrt())
    })
}

/// An angle to the way on, drawn in proportion to [`phase`] by `u` in 0..1.
pub struct Turn {
    /// Its cosine.
    pub cos: F,
    /// 1 - cosine, with its own digits where the turn is small.
    pub one_minus_cos: F,
    /// Its sine.
    pub sin: F,
}

/// Draws a turn; the cosine falls from 1 to -1 as `u` falls from 1 to 0. Each number of it is within
/// 0.51 ulp, the cosine or within 2⁻⁵⁰, for u in 0..=1, which others are clamped to.
#[inline(always)]
pub fn turn(g: f32, u: F) -> Turn {
    let (g, back) = forward(g);
    let u = u.at_least(F::ZERO).at_most(F::ONE);
    let peaked = g > 0.5;
    let (e, g) = (splat_d(1.0 - g), splat_d(g));
    let one = splat_d(1.0);
    // 1 - cos and 1 + cos; going back is going on with the other half of the turn.
    let both = |u: D| {
        let u = if back { one - u } else { u };
        let s = e / (e + (g + g) * u);
        let w = (s * s) * (one - u) * (one + g * u);
        let w = w + w;
        // 1 + cos = 2 u (1 + g)² / k² · (1 - g (1 - u)), by the same steps from the other end.
        let t = (one + g) / (e + (g + g) * u);
        let rest = (t * t) * u * (one - g * (one - u));
        let rest = rest + rest;
        if back { (rest, w) } else { (w, rest) }
    };
    let half = splat_d(0.5);
    Turn {
        cos: in_f64([u], |[u]| {
            if peaked {
                let (w, rest) = both(u);
                return (rest - w) * half;
            }
            // Summed up, which keeps the digits of an upright turn where g is as small.
            let s = u + u - one;
            let s = if back { -s } else { s };
            let (k, square) = (one + g * s, one + g * g);
            let cos = (s * square + half * g * (s * s * square + (splat_d(3.0) - g * g))) / (k * k);
            if back { -cos } else { cos }
        }),
        one_minus_cos: in_f64([u], |[u]| both(u).0),
        sin: in_f64([u], |[u]| {
            let (w, rest) = both(u);
            (w * rest).sqrt()
        }),
    }
}

#[cfg(test)]
mod tests;
