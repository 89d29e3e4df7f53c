//! Ray and plane: t = n·(p - o) / (n·d); a ray in the plane does not hit it.

use super::{Rays8, Span};
use crate::math::lanes::{F, V3};
use crate::scene::Plane;

/// Where `rays` cross the plane.
pub fn plane(rays: &Rays8, s: &Plane) -> Span {
    let n = V3::splat(s.normal);
    let along = n.dot(rays.direction);
    let t = n.dot(V3::splat(s.point) - rays.origin) / along;
    Span::single(t, along.simd_ne(F::ZERO))
}
