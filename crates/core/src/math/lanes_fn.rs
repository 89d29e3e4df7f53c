//! Elementary functions for eight f32 at a time, in f32 arithmetic.
//!
//! Less exact than [`scalar`](super::scalar) and several times cheaper per number: an error of 1 to 3 ulp
//! (more only for `pow` with large exponents), and the same bits in every build. The reductions are those
//! of the scalar functions; the polynomials are minimax fits to f32 accuracy. No result is NaN except
//! where stated, so that one bad sample cannot spread through a filter.

use super::lanes::{Bound, F, INFINITY, ONE, U, select, splat, splat_u};

/// Adding this to |t| < 2²¹ rounds t to the nearest integer and leaves it in the low bits.
const ROUND: F = F::splat(12_582_912.0); // 1.5·2²³
/// Below this 2^t leaves the normal numbers.
const MIN_EXPONENT: f32 = -126.0;

/// c₀ + z·(c₁ + z·(…)), the coefficients from the lowest power up.
#[inline(always)]
fn poly<const N: usize>(z: F, c: [f32; N]) -> F {
    c[..N - 1].iter().rev().fold(splat(c[N - 1]), |sum, &c| sum * z + splat(c))
}

/// 2^(n + r) for r ∈ [−½, ½] and n = `shifted` − ROUND, where the result is a normal number.
#[inline(always)]
fn exp2_kernel(shifted: F, r: F) -> F {
    let fraction = poly(
        r,
        [
            0.6931471880262288,
            0.24022650760568126,
            0.05550357114219078,
            0.009618082557277852,
            0.0013390863364671234,
            0.0001545316294512069,
        ],
    );
    // The integer goes straight into the exponent: 2^n alone may already be out of range for n = 128.
    F::from_bits((ONE + r * fraction).to_bits() + (shifted.to_bits() << 23u32))
}

/// 2^x. Error ≤ 1.2 ulp, exact for integers; inf from 128, 0 below −126 and for NaN.
#[inline(never)]
pub fn exp2(x: F) -> F {
    let t = x.at_least(splat(MIN_EXPONENT)).at_most(splat(128.0));
    let shifted = t + ROUND;
    // At 128 the kernel's exponent field is that of inf.
    x.simd_ge(splat(MIN_EXPONENT)) & exp2_kernel(shifted, t - (shifted - ROUND))
}

/// e^x. Error ≤ 1.4 ulp, `exp(0)` is 1; inf above 88.72, 0 below −87.33 and for NaN.
#[inline(never)]
pub fn exp(x: F) -> F {
    // ln 2 as 15 bits, whose products with n are exact, and the rest.
    const LN2_HIGH: F = F::splat(0.693145751953125);
    const LN2_LOW: F = F::splat(1.428606820309417e-6);
    const LOG2_E: F = F::splat(core::f32::consts::LOG2_E);
    const LOWEST: F = F::splat(-87.33654);
    const HIGHEST: F = F::splat(88.72283);
    let t = x.at_least(LOWEST).at_most(HIGHEST);
    let shifted = t * LOG2_E + ROUND;
    let n = shifted - ROUND;
    let r = (t - n * LN2_HIGH) - n * LN2_LOW;
    let value = select(x.simd_gt(HIGHEST), INFINITY, exp2_kernel(shifted, r * LOG2_E));
    x.simd_ge(LOWEST) & value
}

/// e^x − 1, with its digits kept where x is small. Error ≤ 2.5 ulp; inf above 88.72, −1 below −17.33 and
/// for NaN.
#[inline(never)]
pub fn exp_m1(x: F) -> F {
    // Up to ln 2 by (e^x − 1 − x) / x², beyond which no more than a digit cancels.
    let rest = poly(
        x,
        [
            0.5,
            0.16666670037122804,
            0.041666670032832708,
            0.0083327725382459128,
            0.0013888328756851774,
            0.00020074285947518774,
            2.5034391259368645e-05,
        ],
    );
    let small = x.abs().simd_lt(splat(core::f32::consts::LN_2));
    select(small, x + x * x * rest, exp(x) - ONE)
}

/// log₂ x as an integer and a rest in [−½, ½], for normal x > 0; finite for all others.
#[inline(always)]
fn log2_parts(x: F) -> (F, F) {
    const SQRT_HALF: U = U::splat(0x3f35_04f3);
    // x = 2^k·m with m in [√½, √2).
    let k = (x.to_bits() - SQRT_HALF).cast_signed() >> 23u32;
    let m = F::from_bits(x.to_bits() - (k.cast_unsigned() << 23u32));
    let s = (m - ONE) / (m + ONE);
    let odd = poly(s * s, [2.8853900798033365, 0.96179883880211, 0.5767151860190234, 0.43171769745887384]);
    (F::from_i32x8(k), s * odd)
}

/// log₂ x. Error ≤ 3 ulp for normal positive x, exact for powers of two; −inf for everything below (zero,
/// subnormal, negative) and for NaN; 128 for inf.
#[inline(never)]
pub fn log2(x: F) -> F {
    let (k, rest) = log2_parts(x);
    select(x.simd_ge(splat(f32::MIN_POSITIVE)), k + rest, -INFINITY)
}

/// x^y for x ≥ 0 and finite y. Error ≤ 2 + 2.5·min(|y|, |y·log₂ x|) ulp, ≤ 2 for |y| ≤ 1.
///
/// Subnormal and negative x and NaN count as 0, inf as 2¹²⁸; `pow(0, y)` is 0 for y > 0 and inf for
/// y < 0; `pow(x, 0)` and `pow(1, y)` are 1. Results below 2⁻¹²⁶ are 0, and so is that for y = NaN.
#[inline(never)]
pub fn pow(x: F, y: F) -> F {
    let (k, rest) = log2_parts(x);
    // Large enough to leave the range for any normal y, and still 0 for y = 0.
    let k = select(x.simd_ge(splat(f32::MIN_POSITIVE)), k, splat(-f32::MAX));
    // k times the upper 12 bits of y is exact, so no digits are lost to the integer part.
    let high = F::from_bits(y.to_bits() & splat_u(0xffff_f000));
    let whole = high * k;
    let rest = y * rest + (y - high) * k;
    let t = whole + rest;
    let shifted = t.at_least(splat(MIN_EXPONENT)).at_most(splat(128.0)) + ROUND;
    let value = exp2_kernel(shifted, (whole - (shifted - ROUND)) + rest);
    t.simd_ge(splat(MIN_EXPONENT)) & select(t.simd_ge(splat(128.0)), INFINITY, value)
}

/// (sin x, cos x), x in radians. Error ≤ 2.5 ulp for |x| ≤ 1600, but for results below 2⁻²⁰, whose error
/// is ≤ 2⁻⁴². In [−1, 1] for any finite x; NaN for inf and NaN.
#[inline(never)]
pub fn sin_cos(x: F) -> (F, F) {
    // π/2 as 14 + 14 + 24 bits: products with n < 2¹⁰ are exact in the first two.
    const HIGH: F = F::splat(1.5706787109375);
    const MIDDLE: F = F::splat(0.00011761486530303955);
    const LOW: F = F::splat(9.920935796805404e-10);
    let shifted = x * splat(core::f32::consts::FRAC_2_PI) + ROUND;
    let n = shifted - ROUND;
    let r = ((x - n * HIGH) - n * MIDDLE) - n * LOW;
    // The clamp only acts where |x| is so large that the remainder is lost anyway, and lets NaN through.
    let r = ONE.at_most(splat(-1.0).at_least(r));
    let z = r * r;
    let sin = poly(z, [-0.16666664661714697, 0.008332748154085032, -0.00019587865702101875]);
    let cos =
        poly(z, [-0.49999999969106984, 0.041666650639724655, -0.0013887588896733915, 2.4463754730095443e-05]);
    let (sin, cos) = (r + r * (z * sin), ONE + z * cos);
    // Odd quadrants swap the two; bit 1 of the quadrant negates the sine, of the next one the cosine.
    let quadrant = shifted.to_bits();
    let odd = F::from_bits((quadrant & splat_u(1)).simd_eq(splat_u(1)));
    let sign = |q: U| F::from_bits((q & splat_u(2)) << 30u32);
    (select(odd, cos, sin) ^ sign(quadrant), select(odd, sin, cos) ^ sign(quadrant + splat_u(1)))
}

/// `x` turns as the turns from -1/2 to 1/2 that lead to the same place, for |x| < 2²¹.
#[inline(always)]
pub fn wrap(x: F) -> F {
    x - ((x + ROUND) - ROUND)
}

/// sin 2πx, x in turns. Relative error ≤ 1.2e-6 (−118 dB) for |x| ≤ ½, more only by the rounding of
/// larger x; for |x| < 2²¹.
#[inline(always)]
pub fn sin_turns(x: F) -> F {
    let r = wrap(x);
    let y = r & splat(f32::from_bits(0x7fff_ffff));
    let y = y.at_most(splat(0.5) - y);
    let z = y * y;
    // Written out: compiled for size, `poly` is a loop, and this is the sound's innermost.
    let high = splat(81.395_355) + z * splat(-71.474_678);
    let value = y * (splat(6.283_179_3) + z * (splat(-41.338_943) + z * high));
    value | (r & splat(-0.0))
}

#[cfg(test)]
mod tests;
