//! Microfacets: how many there are and how much of them is seen.

use super::first;
use crate::math::lanes::{F, splat};
use crate::math::lanes_f64::{in_f64, splat_d};
use crate::math::scalar::exp_wide;
use crate::shade;
use glam::Vec3;
use std::f64::consts::FRAC_1_PI;

/// Squared sine from a cosine, rounded once.
fn sine2(cos: F) -> F {
    in_f64([cos], |[cos]| (splat_d(1.0) - cos) * (splat_d(1.0) + cos))
}

/// The engine's D, which has π times that, rounded once more.
fn per_steradian(d: F) -> f32 {
    first(in_f64([d], |[d]| d * splat_d(FRAC_1_PI)))
}

/// GGX's distribution D, per steradian, of facets with unit normal `h` about the unit normal `n`; `alpha` is
/// the square of a material's roughness, at least 1e-4. Trowbridge and Reitz; Walter et al. 2007.
///
/// In f64 and rounded once: error at most 1 ulp for the angle between the two, whatever rounding left of their
/// lengths. Packets take n × h and [`shade::distribution`] in f32, which loses some 4 u / alpha near the peak.
pub fn ggx(n: Vec3, h: Vec3, alpha: f32) -> f32 {
    let ([sine2, cos], alpha) = (angle(n, h), f64::from(alpha));
    let q = alpha / (sine2 + alpha * cos * (alpha * cos));
    (q * q * FRAC_1_PI) as f32
}

/// The same from the cosine n·h, 0..=1. Error at most 4 ulp.
pub fn ggx_of_cosine(cos: f32, alpha: f32) -> f32 {
    let cos = splat(cos);
    per_steradian(shade::distribution(sine2(cos), cos, splat(alpha)))
}

/// Smith's share G1 of the facets that is seen under a cosine 0..=1; 0 for 0. Error at most 4 ulp.
pub fn smith_g1(cos: f32, alpha: f32) -> f32 {
    first(shade::masking(splat(cos), splat(alpha)))
}

/// Share G2 of the facets that is both lit and seen, height-correlated; 0 where a cosine is. Cosines are 0 or
/// at least 1e-18. Error at most 6.5 u, and 3.9 ulp in 40 million cases. Heitz, JCGT 3(2), 2014.
pub fn smith_g2(n_l: f32, n_v: f32, alpha: f32) -> f32 {
    let (l, v) = (splat(n_l), splat(n_v));
    // The engine's V has 4 n·l n·v divided out.
    first(in_f64([shade::visibility(l, v, splat(alpha)), l, v], |[shown, l, v]| splat_d(4.0) * shown * l * v))
}

/// Beckmann's distribution D, per steradian, of facets with unit normal `h` about the unit normal `n`; `m`
/// is their rms slope, at least 1e-18. 0 at and below the horizon. Beckmann and Spizzichino 1963.
///
/// In f64 and rounded once: error at most 1 ulp. Packets, [`shade::beckmann`], carry the rounding of the
/// exponent x = tan² / m² in f32: 4 + 6 x ulp.
pub fn beckmann(n: Vec3, h: Vec3, m: f32) -> f32 {
    of_beckmann(angle(n, h), m)
}

/// The same from the cosine n·h. Error at most 1 ulp.
pub fn beckmann_of_cosine(cos: f32, m: f32) -> f32 {
    let cos = f64::from(cos);
    of_beckmann([(1.0 - cos) * (1.0 + cos), cos], m)
}

fn of_beckmann([sine2, cos]: [f64; 2], m: f32) -> f32 {
    if cos.is_nan() || cos <= 0.0 {
        return 0.0;
    }
    let c2 = cos * cos;
    let m2 = f64::from(m.max(1e-18)) * f64::from(m.max(1e-18));
    (exp_wide(-(sine2 / (c2 * m2))) * FRAC_1_PI / (m2 * c2 * c2)) as f32
}

/// Squared sine and cosine of the angle between two vectors that are within rounding of length 1.
fn angle(a: Vec3, b: Vec3) -> [f64; 2] {
    let (a, b) = (a.as_dvec3(), b.as_dvec3());
    let length2 = a.length_squared() * b.length_squared();
    [a.cross(b).length_squared() / length2, a.dot(b) / length2.sqrt()]
}
