//! The boundary of two clear bodies: how much it mirrors (Fresnel 1823), exactly.
//!
//! With n_i on the side of the light, n_t beyond and g² = n_t² - n_i² (1 - cos²), the amplitudes are
//! s = (n_i cos - g) / (n_i cos + g) and p = (n_t² cos - n_i g) / (n_t² cos + n_i g). g² is summed as
//! (n_t - n_i)(n_t + n_i) + (n_i cos)², of products that f64 holds exactly, and s as (n_i - n_t)(n_i + n_t) / (n_i cos + g)², which keeps its digits between bodies that are nearly
//! alike. Where g² < 0 all is mirrored. Own rearrangement.

use crate::math::lanes::{Bound, F};
use crate::math::lanes_f64::{D, in_f64, splat_d};

/// g² as above.
#[inline(always)]
fn beyond(cos: D, n_i: D, n_t: D) -> D {
    let along = n_i * cos;
    // In two parts whose squares are exact (Veltkamp, Dekker), as all but a digit may cancel.
    let shifted = along * splat_d(134_217_729.0);
    let high = shifted - (shifted - along);
    let low = along - high;
    ((n_t - n_i) * (n_t + n_i) + high * high) + ((high + high) * low + low * low)
}

#[inline(always)]
fn clamped(cos: F) -> F {
    cos.at_least(F::ZERO).at_most(F::ONE)
}

/// Share of unpolarised light that is mirrored where it falls in by an angle of this cosine (0..=1,
/// others are clamped) from refractive index `n_i` towards `n_t`, both over 0.
///
/// 1 under total internal reflection. Error at most 1 ulp.
#[inline(always)]
pub fn reflectance(cos: F, n_i: F, n_t: F) -> F {
    in_f64([clamped(cos), n_i, n_t], |[cos, n_i, n_t]| {
        let g2 = beyond(cos, n_i, n_t);
        let (zero, one) = (splat_d(0.0), splat_d(1.0));
        let g = g2.at_least(zero).sqrt();
        // Only along the border of equal bodies is nothing left to divide by.
        let least = splat_d(1e-200);
        let sum = n_i * cos + g;
        let s = (n_i - n_t) * (n_i + n_t) / (sum * sum).at_least(least);
        let (a, b) = (n_t * n_t * cos, n_i * g);
        let p = (a - b) / (a + b).at_least(least);
        let share = (s * s + p * p) * splat_d(0.5);
        g2.simd_lt(zero).select(one, share)
    })
}

/// Cosine of the refracted angle, for arguments as of [`reflectance`]; 0 under total internal reflection.
/// Error at most 1 ulp.
#[inline(always)]
pub fn cos_refracted(cos: F, n_i: F, n_t: F) -> F {
    in_f64([clamped(cos), n_i, n_t], |[cos, n_i, n_t]| {
        beyond(cos, n_i, n_t).at_least(splat_d(0.0)).sqrt() / n_t
    })
}

/// Mask of total internal reflection, for arguments as of [`reflectance`]. Exact: g² is below 0 in f64 only
/// where it is.
#[inline(always)]
pub fn is_total(cos: F, n_i: F, n_t: F) -> F {
    in_f64([clamped(cos), n_i, n_t], |[cos, n_i, n_t]| beyond(cos, n_i, n_t)).simd_lt(F::ZERO)
}

#[cfg(test)]
mod tests;
