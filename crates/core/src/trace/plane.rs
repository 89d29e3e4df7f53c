//! Ray and plane: t = n·(p - o) / (n·d), within the reach of p; a ray in the plane does not hit it.

use super::{Rays8, Span};
use crate::math::lanes::{F, V3, splat};
use crate::scene::Plane;

/// Where `rays` cross the plane, from either side. Score at most 4, as [`kernels`](crate::kernels) defines it.
pub fn plane(rays: &Rays8, s: &Plane) -> Span {
    let n = V3::splat(s.normal);
    let along = n.dot(rays.direction);
    let to_point = V3::splat(s.point) - rays.origin;
    let t = n.dot(to_point) / along;
    let off = rays.direction * t - to_point;
    let within = off.dot(off).simd_le(splat(s.reach * s.reach));
    Span::single(t, along.simd_ne(F::ZERO) & within)
}
