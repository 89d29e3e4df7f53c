//! Directions about a normal.

use crate::math::lanes::{V3, splat};
use crate::math::sampling;
use glam::Vec3;

/// Two unit vectors upright on each other and on the unit vector `n`, right-handed in the order (x, y, n).
/// Orthonormal within 4e-7 everywhere, the poles included. Duff et al., JCGT 6(1), 2017.
pub fn basis(n: Vec3) -> (Vec3, Vec3) {
    let (x, y) = sampling::basis(V3::splat(n));
    (x.lane(0).into(), y.lane(0).into())
}

/// A unit direction about the unit vector `n` with density cosine / π, drawn by `u` and `v` in 0..1. Its cosine
/// is √(1 - u), never 0 for u below 1. Error at most 1e-6.
pub fn cosine_weighted(n: Vec3, u: f32, v: f32) -> Vec3 {
    sampling::cosine(V3::splat(n), (splat(u), splat(v))).lane(0).into()
}
