//! Ray and triangle by edge functions that are watertight across shared edges.
//!
//! With corners relative to the ray's origin, u = d·(b×c), v = d·(c×a), w = d·(a×b). Swapping the
//! ends of an edge negates its function exactly in IEEE arithmetic, so a ray can't slip between
//! two triangles that share the edge. Zero counts as inside for both signs; only a vanishing sum
//! misses. The Plücker form of Davis, Reshetov and Hanika's robust tests, as in Embree's robust mode.

use super::{Rays8, Span};
use crate::math::lanes::{F, V3};
use crate::scene::Triangle;

/// Where `rays` cross the triangle.
pub fn triangle(rays: &Rays8, s: &Triangle) -> Span {
    let d = rays.direction;
    let [a, b, c] = s.corners.map(|p| V3::splat(p) - rays.origin);
    let (u, v, w) = (d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
    let zero = F::ZERO;
    let inside = (u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero))
        | (u.simd_le(zero) & v.simd_le(zero) & w.simd_le(zero));
    let sum = u + v + w;
    let t = (a * u + b * v + c * w).dot(d) / (sum * d.dot(d));
    Span::single(t, inside & sum.simd_ne(zero))
}
