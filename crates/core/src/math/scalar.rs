//! Elementary functions for one f32, computed in f64 and rounded once.
//!
//! Each function reduces its argument, evaluates one short minimax polynomial in f64 (relative error
//! below 2⁻³¹) and rounds to f32, so the result is within 0.51 ulp of the exact value. Four kernels serve
//! all of them:
//!
//! * 2^t = 2ⁿ·2^r, r ∈ [−½, ½]
//! * log₂ v = k + (2/ln 2)·atanh((m−1)/(m+1)), m ∈ [√½, √2)
//! * sin, cos on [−π/4, π/4] after subtracting n·π/2 in two pieces (Cody & Waite 1980)
//! * atan on [0, tan π/8], larger quotients turned by π/4
//!
//! NaN in gives NaN out everywhere. Subnormal arguments and results are exact like all others.

use core::f64::consts::{FRAC_1_SQRT_2, FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LN_2, LOG2_E, PI};

/// Adding this to |t| < 2⁵¹ rounds t to the nearest integer and leaves it in the low bits.
const ROUND: f64 = 6755399441055744.0; // 1.5·2⁵²

/// c₀ + z·(c₁ + z·(…)), the coefficients from the lowest power up.
#[inline(always)]
fn poly<const N: usize>(z: f64, c: [f64; N]) -> f64 {
    c[..N - 1].iter().rev().fold(c[N - 1], |sum, c| sum * z + c)
}

/// 2^t; inf and 0 far outside the f32 range; error 2⁻³³ relative, exact for integers.
#[inline(never)]
fn exp2_kernel(t: f64) -> f64 {
    // Within ±1000 the scale stays a normal f64, beyond it f32 has only 0 and inf.
    let t = t.clamp(-1000.0, 1000.0);
    let shifted = t + ROUND;
    let r = t - (shifted - ROUND);
    let fraction = poly(
        r,
        [
            LN_2,
            0.24022650922288757,
            0.055504108839096185,
            0.009618056678524637,
            0.001333350238616277,
            0.0001546144469856913,
            1.5297323760701075e-05,
        ],
    );
    let scale = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    (1.0 + r * fraction) * scale
}

/// log₂ v; −inf at ±0, NaN below; error 2⁻³⁷ relative, exact for powers of two.
#[inline(never)]
fn log2_kernel(v: f64) -> f64 {
    if !(v > 0.0 && v < f64::INFINITY) {
        return if v == 0.0 {
            f64::NEG_INFINITY
        } else if v > 0.0 {
            v
        } else {
            f64::NAN
        };
    }
    // Callers pass f32 values, which are never subnormal in f64.
    let k = (v.to_bits().wrapping_sub(FRAC_1_SQRT_2.to_bits()) as i64) >> 52;
    let m = f64::from_bits(v.to_bits().wrapping_sub((k << 52) as u64));
    let s = (m - 1.0) / (m + 1.0);
    let odd = poly(
        s * s,
        [2.885390081789987, 0.9617966734515485, 0.5770835660048659, 0.41167376623771057, 0.3407120415619086],
    );
    k as f64 + s * odd
}

/// (sin x, cos x) before rounding.
#[inline(never)]
fn sin_cos_kernel(x: f64) -> (f64, f64) {
    // π/2 as 33 + 53 bits: n times the first piece is exact for n < 2²⁰.
    const HIGH: f64 = 1.5707963267341256;
    const LOW: f64 = 6.077100506506192e-11;
    let shifted = x * FRAC_2_PI + ROUND;
    let n = shifted - ROUND;
    // The clamp only acts where |x| is so large that the remainder is lost anyway.
    let r = ((x - n * HIGH) - n * LOW).clamp(-1.0, 1.0);
    let z = r * r;
    let sin =
        poly(z, [-0.16666666663854168, 0.008333331874273714, -0.000198400864995936, 2.7249895230611676e-06]);
    let cos =
        poly(z, [-0.49999999969106984, 0.041666650639724655, -0.0013887588896733915, 2.4463754730095443e-05]);
    // This form of the sine keeps the sign of −0.
    let (sin, cos) = (r * (1.0 + z * sin), 1.0 + z * cos);
    // Odd quadrants swap the two; bit 1 of the quadrant negates the sine, of the next one the cosine.
    let quadrant = shifted.to_bits();
    let (sin, cos) = if quadrant & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let signed = |v: f64, quadrant: u64| f64::from_bits(v.to_bits() ^ (quadrant & 2) << 62);
    (signed(sin, quadrant), signed(cos, quadrant.wrapping_add(1)))
}

/// The angle of (x, y) before rounding.
#[inline(never)]
fn atan2_kernel(y: f64, x: f64) -> f64 {
    let (ax, ay) = (x.abs(), y.abs());
    let (low, high) = if ay > ax { (ax, ay) } else { (ay, ax) };
    let quotient = if low == high {
        // 0/0 is the angle 0, inf/inf the diagonal.
        if low == 0.0 { 0.0 } else { 1.0 }
    } else {
        low / high
    };
    let (t, turn) = if quotient > 0.41421356237309503 {
        ((quotient - 1.0) / (quotient + 1.0), FRAC_PI_4)
    } else {
        (quotient, 0.0)
    };
    let z = t * t;
    let odd = poly(
        z,
        [
            -0.3333333327922454,
            0.1999997724823353,
            -0.14284150629730288,
            0.11071354571201351,
            -0.08624598215196126,
            0.05047937432040091,
        ],
    );
    let mut angle = turn + (t + t * z * odd);
    if ay > ax {
        angle = FRAC_PI_2 - angle;
    }
    if x.is_sign_negative() {
        angle = PI - angle;
    }
    angle.copysign(y)
}

/// Sine of `x` radians. Error ≤ 0.51 ulp for |x| ≤ 1.6e6; beyond that an absolute error of |x|·2⁻⁵²
/// up to 2⁵⁰ and any value in [−1, 1] from there on; NaN for ±inf. `sin(-0.0)` is −0.
pub fn sin(x: f32) -> f32 {
    sin_cos(x).0
}

/// Cosine of `x` radians; range and error as [`sin`].
pub fn cos(x: f32) -> f32 {
    sin_cos(x).1
}

/// Sine and cosine of `x` radians at the price of one; range and error as [`sin`].
pub fn sin_cos(x: f32) -> (f32, f32) {
    let (sin, cos) = sin_cos_kernel(x.into());
    (sin as f32, cos as f32)
}

/// e^x. Error ≤ 0.51 ulp; inf above 88.72, subnormal below −87.34, 0 below −103.98; `exp(0)` is 1.
pub fn exp(x: f32) -> f32 {
    exp2_kernel(f64::from(x) * LOG2_E) as f32
}

/// e^x before rounding.
pub(crate) fn exp_wide(x: f64) -> f64 {
    exp2_kernel(x * LOG2_E)
}

/// 2^x. Error ≤ 0.51 ulp, exact for integers; inf from 128, subnormal below −126, 0 from −150.
pub fn exp2(x: f32) -> f32 {
    exp2_kernel(x.into()) as f32
}

/// Natural logarithm. Error ≤ 0.51 ulp; −inf for ±0, NaN below 0, inf for inf; `ln(1)` is +0.
pub fn ln(x: f32) -> f32 {
    (log2_kernel(x.into()) * LN_2) as f32
}

/// Logarithm to base 2. Error ≤ 0.51 ulp, exact for powers of two; edge cases as [`ln`].
pub fn log2(x: f32) -> f32 {
    log2_kernel(x.into()) as f32
}

/// x^y before rounding.
fn pow_kernel(x: f32, y: f32) -> f64 {
    let t = f64::from(y) * log2_kernel(x.into());
    // With numbers given, the only NaN from a base that has a logarithm is 0·inf.
    if t.is_nan() && x >= 0.0 && !y.is_nan() {
        return 1.0;
    }
    exp2_kernel(t)
}

/// x^y for x ≥ 0. Error ≤ 0.51 ulp.
///
/// A negative base gives NaN for every y, integer or not; −0 counts as 0. `pow(0, y)` is 0 for y > 0 and
/// inf for y < 0; `pow(x, 0)` and `pow(1, y)` are 1 unless an argument is NaN; overflow is inf.
pub fn pow(x: f32, y: f32) -> f32 {
    pow_kernel(x, y) as f32
}

/// Arc cosine in radians, 0..=π. Error ≤ 0.51 ulp; NaN outside [−1, 1].
pub fn acos(x: f32) -> f32 {
    let x = f64::from(x);
    // 1 − |x| is exact in f64, so the sine keeps its relative accuracy next to ±1.
    atan2_kernel(((1.0 - x) * (1.0 + x)).sqrt(), x) as f32
}

/// Angle of the point (x, y) in radians, −π..=π. Error ≤ 0.51 ulp.
///
/// Signed zeros and infinities as in IEEE 754: `atan2(0, -1)` is π, `atan2(-0, -1)` is −π,
/// `atan2(0, 0)` is 0, `atan2(inf, inf)` is π/4.
pub fn atan2(y: f32, x: f32) -> f32 {
    atan2_kernel(y.into(), x.into()) as f32
}

/// Linear light 0..=1 to the sRGB display value 0..=1 (IEC 61966-2-1). Arguments outside are clamped.
/// Error ≤ 0.51 ulp.
pub fn srgb_encode(linear: f32) -> f32 {
    let v = f64::from(linear.clamp(0.0, 1.0));
    // The nearest f32 to this border lies on the curved side.
    let display = if v <= 0.0031308 { 12.92 * v } else { 1.055 * exp2_kernel(log2_kernel(v) / 2.4) - 0.055 };
    display as f32
}

/// sRGB display value 0..=1 to linear light 0..=1, the inverse of [`srgb_encode`]; clamps likewise.
/// Error ≤ 0.51 ulp.
pub fn srgb_decode(display: f32) -> f32 {
    let v = f64::from(display.clamp(0.0, 1.0));
    let linear = if v <= 0.04045 { v / 12.92 } else { exp2_kernel(2.4 * log2_kernel((v + 0.055) / 1.055)) };
    linear as f32
}

#[cfg(test)]
mod tests;
