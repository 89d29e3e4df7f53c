//! Microfacets: how many there are and how much of them is seen.

use super::first;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::lanes_f64::{in_f64, splat_d};
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
/// From n × h: the rounding of `n` and `h` themselves alone is left, some 4 u / alpha near the peak.
pub fn ggx(n: Vec3, h: Vec3, alpha: f32) -> f32 {
    let (n, h) = (V3::splat(n), V3::splat(h));
    let across = n.cross(h);
    per_steradian(shade::distribution(across.dot(across), n.dot(h), splat(alpha)))
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
/// is their rms slope. 0 at and below the horizon.
pub fn beckmann(n: Vec3, h: Vec3, m: f32) -> f32 {
    let (n, h) = (V3::splat(n), V3::splat(h));
    let across = n.cross(h);
    of_beckmann(across.dot(across), n.dot(h), m)
}

/// The same from the cosine n·h. The error is that of the exponent x = tan² / m²: 4 + 6 x ulp.
pub fn beckmann_of_cosine(cos: f32, m: f32) -> f32 {
    let cos = splat(cos);
    of_beckmann(sine2(cos), cos, m)
}

fn of_beckmann(sine2: F, cos: F, m: f32) -> f32 {
    // The engine's floor, under which e to the -1e8 is 0.
    let d = shade::beckmann(sine2, cos.at_least(splat(1e-4)), splat(m).at_least(splat(1e-3)));
    per_steradian(d)
}
