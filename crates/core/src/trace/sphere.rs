//! Ray and sphere: the discriminant from the perpendicular that runs from centre to ray.
//!
//! With f = o - c and l = f - ((f·d)/(d·d)) d: D = r² - l·l, q = b + sign(b) sqrt((d·d) D),
//! b = -f·d, and the roots (f·f - r²)/q and q/(d·d). f·f - r² is taken as (|f|-r)(|f|+r). Which
//! root comes first is asked of the roots: near a tangent, rounding may swap them.
//! Haines, Günther and Akenine-Möller, Ray Tracing Gems ch. 7.

use super::{Rays8, Span};
use crate::math::lanes::{Bound, F, V3, copysign, splat};
use crate::scene::Sphere;

/// Where `rays` cross the sphere, of a radius over 0. Score at most 4, as [`kernels`](crate::kernels) defines it, for squares
/// of coordinates within f32. Haines, Günther and Akenine-Möller, Ray Tracing Gems ch. 7.
pub fn sphere(rays: &Rays8, s: &Sphere) -> Span {
    let d = rays.direction;
    let f = rays.origin - V3::splat(s.centre);
    let r = splat(s.radius);
    let a = d.dot(d);
    let b = -f.dot(d);
    let l = f + d * (b / a);
    let disc = r * r - l.dot(l);
    let q = b + copysign((a * disc).sqrt(), b);
    let ff = f.dot(f).sqrt();
    let c = (ff - r) * (ff + r);
    let one = q / a;
    // Never the larger of the two: at a tangent, with q lost to rounding, c/q could be anything.
    let most = one.abs();
    let other = most.at_most((-most).at_least(q.simd_eq(F::ZERO).select(F::ZERO, c / q)));
    let hit = disc.simd_ge(F::ZERO);
    let miss = splat(-1.0);
    Span {
        enter: hit.select(one.at_most(other), miss),
        exit: hit.select(one.at_least(other), miss),
        enter_part: F::ZERO,
        exit_part: F::ZERO,
    }
}
